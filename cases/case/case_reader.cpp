#include "cases/case/case_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/engine/run_name.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor {
namespace {

// A number of seconds, or a fraction of one in quotes.
StepSize read_seconds(const TomlValue& value) {
  if (value.is_text()) return parse_step_size(value.text(), value.label());
  const double seconds = value.positive();
  return {seconds, fmt::format("{}", seconds)};
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
}

void read_truth(const TableReader& table, const Vocabulary& words, Case& out) {
  Keys known = words.truths;
  known.push_back("none");
  const TomlValue kind = table.at("kind");
  out.truth = kind.choice(known);
  out.truth_where = kind.where();
}

RunName read_run_name(const TomlValue& value, const Vocabulary& words) {
  try {
    return parse_run_name(value.text(), words.engines);
  } catch (const InputError& error) {
    value.refuse(error.what());
  }
}

std::vector<std::string> read_engines(const TomlValue& value, const Vocabulary& words) {
  std::vector<std::string> names;
  for (const TomlValue& item : value.items()) names.push_back(read_run_name(item, words).text);
  return names;
}

bool is_cross_metric(const std::string& name, const Vocabulary& words) {
  return std::find(words.cross_metrics.begin(), words.cross_metrics.end(), name) != words.cross_metrics.end();
}

// A run that comes from the same code as the truth agrees with it however wrong both are.
void check_not_held_to_itself(const TomlValue& value, const Vocabulary& words, const Case& of, const Gate& gate) {
  for (const TomlValue& item : value.items()) {
    if (!words.is_held_to_itself(of.truth, gate.metric, parse_run_name(item.text(), words.engines), of.scene)) continue;
    item.refuse(fmt::format(
        "found {}, whose own code makes the truth '{}' that {} is measured against; allowed: a run of other code, or a "
        "metric that needs no truth",
        item.text(), of.truth, gate.metric));
  }
}

// A ranking: the metric of every run the gate names must be better than this one's.
void read_better_than(const TomlValue& value, const Vocabulary& words, Gate& gate) {
  if (is_cross_metric(gate.metric, words))
    value.refuse(fmt::format("{} does not rank runs; give max, min or equals", gate.metric));
  gate.better_than = read_run_name(value, words).text;
  if (gate.engines.empty()) value.refuse("a ranking names the runs that are better; give engines");
  if (std::find(gate.engines.begin(), gate.engines.end(), gate.better_than) != gate.engines.end())
    value.refuse(fmt::format("found {}, which is among engines; no run is better than itself", gate.better_than));
}

// The run's own step sizes that the gate names.
std::vector<StepSize> read_gate_dt(const TomlValue& value, const std::vector<StepSize>& of_run) {
  std::vector<StepSize> steps;
  for (const TomlValue& item : value.items()) {
    const StepSize wanted = read_seconds(item);
    const auto found = std::find(of_run.begin(), of_run.end(), wanted);
    if (found == of_run.end()) {
      Keys known;
      for (const StepSize& dt : of_run) known.push_back(dt.text);
      item.refuse(fmt::format("the run has no step {} s; allowed: {}", wanted.text, listed(known)));
    }
    steps.push_back(*found);
  }
  return steps;
}

std::optional<double> number_if_given(const TableReader& table, const char* key) {
  const auto value = table.find(key);
  return value ? std::optional(value->number()) : std::nullopt;
}

void read_bounds(const TableReader& table, const Case& of, const Vocabulary& words, Gate& gate) {
  gate.max = number_if_given(table, "max");
  gate.min = number_if_given(table, "min");
  gate.equals = number_if_given(table, "equals");
  if (const auto order = table.find("at_least_order")) {
    gate.at_least_order = order->positive();
    if (is_cross_metric(gate.metric, words))
      order->refuse(fmt::format("{} has no order; give max, min or equals", gate.metric));
    if ((gate.dt.empty() ? of.dt : gate.dt).size() < 2)
      order->refuse("an order is observed over two step sizes or more");
  }
  if (const auto other = table.find("better_than")) read_better_than(*other, words, gate);
  const int bounds =
      (gate.max || gate.min) + gate.equals.has_value() + gate.at_least_order.has_value() + !gate.better_than.empty();
  if (bounds != 1) {
    table.refuse(
        fmt::format("found {}; allowed: one of max, min, equals, at_least_order, better_than, or min and max "
                    "together",
                    bounds == 0 ? "no bound" : "bounds that do not go together"));
  }
  if (gate.min && gate.max && *gate.min > *gate.max) {
    table.at("min").refuse(fmt::format("found {}, more than max, {}", *gate.min, *gate.max));
  }
}

Gate read_gate(const TableReader& table, const Case& of, const Vocabulary& words) {
  Gate gate;
  gate.where = table.self().where();
  Keys known = words.metrics;
  known.insert(known.end(), words.cross_metrics.begin(), words.cross_metrics.end());
  gate.metric = table.at("metric").choice(known);
  if (const auto value = table.find("engines")) gate.engines = read_engines(*value, words);
  if (const auto value = table.find("dt")) gate.dt = read_gate_dt(*value, of.dt);
  read_bounds(table, of, words, gate);
  for (const char* key : {"engines", "better_than"}) {
    if (const auto value = table.find(key)) check_not_held_to_itself(*value, words, of, gate);
  }
  gate.because = table.at("because").text();
  return gate;
}

}  // namespace

Case read_case(const std::string& path, const std::string& id, const Vocabulary& words) {
  const TomlFile file = TomlFile::read(path);
  const TableReader root = file.root({"title", "source", "scene", "run", "truth", "gate"});
  Case out;
  out.id = id;
  out.text = file.text();
  out.title = root.at("title").text();
  if (const auto source = root.find("source")) out.source = source->text();
  out.scene = read_scene(root.at("scene"));
  read_run(root.at("run").table({"duration", "dt"}), out);
  if (const auto truth = root.find("truth")) read_truth(truth->table({"kind"}), words, out);
  if (const auto gates = root.find("gate")) {
    for (const TableReader& gate : gates->tables(
             {"metric", "engines", "dt", "max", "min", "at_least_order", "equals", "better_than", "because"})) {
      out.gates.push_back(read_gate(gate, out, words));
    }
  }
  return out;
}

}  // namespace rigor
