#include "cases/case/case_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/case/gate_reader.h"
#include "cases/case/recording/recording_reader.h"
#include "cases/case/run_selector.h"
#include "cases/case/seconds_reader.h"
#include "core/base/error.h"
#include "core/scene/toml/file_reader.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline cases {
namespace {

// Each start is another run, of joints that then do not fit.
void read_ensemble(const TomlValue& value, Case& out) {
  constexpr int kFewest = 16, kMost = 10000;  // fewer tell no distributions apart
  const double count = value.number();
  if (count != std::floor(count) || count < kFewest || count > kMost)
    value.refuse(fmt::format("found {}; allowed: a whole number from {} to {}", count, kFewest, kMost));
  out.ensemble = static_cast<int>(count);
  if (!out.scene.joints.empty()) value.refuse("starts that are moved about would break the scene's joints");
}

// A servo that samples more often than in each of the steps cannot be told from a continuous one.
void check_servo_periods(const TableReader& table, const Case& of) {
  const auto by_length = [](const StepSize& a, const StepSize& b) { return a.seconds < b.seconds; };
  const StepSize shortest = *std::min_element(of.dt.begin(), of.dt.end(), by_length);
  for (const Motor& motor : of.scene.motors) {
    constexpr double kRounding = 1 + 1e-9;
    if (motor.servo && motor.servo->period > 0 && shortest.seconds > motor.servo->period * kRounding)
      table.at("dt").refuse(
          fmt::format("found {} s at least, and a servo samples every {:g} s; allowed: a step of at most its period",
                      shortest.text, motor.servo->period));
  }
}

void read_run(const TableReader& table, Case& out) {
  out.duration = read_seconds(table.at("duration")).seconds;
  for (const TomlValue& value : table.at("dt").items()) {
    const StepSize dt = read_seconds(value);
    check_step_size(dt, out.duration, value.label());
    if (std::find(out.dt.begin(), out.dt.end(), dt) != out.dt.end())
      value.refuse(fmt::format("the step {} s is given twice", dt.text));
    out.dt.push_back(dt);
  }
  check_servo_periods(table, out);
  if (const auto ensemble = table.find("ensemble")) read_ensemble(*ensemble, out);
}

void read_truth(const TableReader& table, const Vocabulary& words, Case& out) {
  Keys known = words.truths;
  known.push_back("none");
  const TomlValue kind = table.at("kind");
  out.truth = kind.choice(known);
  out.truth_where = kind.where();
  if (out.truth == "recording") return read_recording(table, out);
  for (const std::string& key : truth_keys()) {
    const auto value = table.find(key);
    if (value && key != "kind") value->refuse("a computed truth has no file; allowed: only with kind = \"recording\"");
  }
}

// A run that comes from the same code as the truth agrees with it however wrong both are. One that a selector takes is
// left out where gates are checked.
void check_not_held_to_itself(const TableReader& table, const Vocabulary& words, const Case& of) {
  for (const char* key : {"engines", "better_than"}) {
    const auto value = table.find(key);
    for (const TomlValue& item : value ? value->items() : std::vector<TomlValue>()) {
      if (is_run_selector(item.text())) continue;
      const RunName run = parse_run_name(item.text(), words.engines);
      for (const TomlValue& metric : table.at("metric").items()) {
        if (!words.is_held_to_itself(of.truth, metric.text(), run, of.scene)) continue;
        item.refuse(fmt::format(
            "found {}, whose own code makes the truth '{}' that {} is measured against; allowed: a run of other code, "
            "or a metric that needs no truth",
            item.text(), of.truth, metric.text()));
      }
    }
  }
}

}  // namespace

Case read_case(const std::string& path, const std::string& id, const Vocabulary& words) {
  return read_case_text(read_text_file(path), path, id, words);
}

Case read_case_text(const std::string& text, const std::string& path, const std::string& id, const Vocabulary& words,
                    Gates gates) {
  const TomlFile file = TomlFile::parse(text, path);
  const TableReader root = file.root(case_keys());
  Case out;
  out.id = id;
  out.text = file.text();
  out.title = root.at("title").text();
  if (const auto source = root.find("source")) out.source = source->text();
  out.scene = read_scene(root.at("scene"));
  read_run(root.at("run").table({"duration", "dt", "ensemble"}), out);
  if (const auto truth = root.find("truth")) read_truth(truth->table(truth_keys()), words, out);
  const auto found = gates == Gates::read ? root.find("gate") : std::nullopt;
  if (found) {
    for (const TableReader& table : found->tables(gate_keys())) {
      for (Gate& gate : gates_of(read_gate_table(table, words), out)) out.gates.push_back(std::move(gate));
      check_not_held_to_itself(table, words, out);
    }
  }
  return out;
}

}  // namespace rigor::inline cases
