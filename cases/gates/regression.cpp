#include "cases/gates/regression.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "cases/metrics/metric.h"
#include "cases/results/changes.h"
#include "cases/results/input_file.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/json_words.h"
#include "core/base/near_match.h"

namespace rigor::inline gates {
namespace {

namespace fs = std::filesystem;

// One line of an engine's file, the errors of which have its place before them.
class LineReader {
 public:
  LineReader(std::string place, const std::string& engine, const std::vector<EngineInfo>& engines)
      : place_(std::move(place)), engine_(engine), engines_(engines) {}

  void read(const std::string& line, RecordedValues& out) const {
    const Json json = parsed(line);
    if (!json.is_object()) refuse(1, "is no JSON object");
    const std::string case_id = text_at(json, "case");
    const RunName run = run_of(text_at(json, "run"));
    const StepSize dt = parse_step_size(text_at(json, "dt"), place_ + ":1: dt");
    for (const auto& [name, value] : json.items()) {
      if (name == "case" || name == "run" || name == "dt") continue;
      check_metric(name);
      if (!value.is_number()) refuse(1, fmt::format("{}: found {}; allowed: a number", name, value.dump()));
      if (!out.add(case_id, run, dt.seconds, name, value.get<double>()))
        refuse(1, fmt::format("{} of {}, {}, dt = {} is given twice", name, case_id, run.text, dt.text));
    }
  }

 private:
  [[noreturn]] void refuse(std::size_t column, const std::string& fault) const {
    throw InputError(fmt::format("{}:{}: {}", place_, column, fault));
  }

  Json parsed(const std::string& line) const {
    try {
      return parse_json(line);
    } catch (const Json::parse_error& error) {
      refuse(error.byte, "is not JSON");
    }
  }

  std::string text_at(const Json& json, const char* key) const {
    const auto found = json.find(key);
    if (found == json.end()) refuse(1, fmt::format("{}: missing", key));
    if (!found->is_string()) refuse(1, fmt::format("{}: found {}; allowed: a string", key, found->dump()));
    return found->get<std::string>();
  }

  RunName run_of(const std::string& text) const {
    try {
      RunName run = parse_run_name(text, engines_);
      if (run.engine == engine_) return run;
    } catch (const InputError& error) {
      refuse(1, fmt::format("run: {}", error.what()));
    }
    refuse(1, fmt::format("run: found '{}'; allowed: runs of {}, beside whose adapter the file stands", text, engine_));
  }

  void check_metric(const std::string& name) const {
    std::vector<std::string> known = {"case", "run", "dt"};
    for (const MetricRow& row : metrics()) known.push_back(row.name);
    if (std::find(known.begin(), known.end(), name) == known.end())
      refuse(1, fmt::format("{}: unknown key{}; allowed: {}", name, did_you_mean(name, known), listed(known)));
  }

  std::string place_;
  const std::string& engine_;
  const std::vector<EngineInfo>& engines_;
};

// The values of a line in the order of the file, four digits each: what changes less is not worth a line.
using Lines = std::map<std::vector<std::string>, std::map<std::string, double>>;

bool is_of(const Json& results, const std::string& run, const std::string& engine) {
  for (const Json& row : results.at("engines")) {
    if (row.at("name") == run) return row.at("engine") == engine;
  }
  return false;
}

// The values that the regressions of a results.json found, those of one engine.
Lines found_values(const Json& results, const std::string& engine, int& left_out) {
  Lines lines;
  for (const Json& one : results.at("cases")) {
    for (const Json& gate : one.at("gates")) {
      if (gate.at("kind") != "regression") continue;
      for (const Json& answer : gate.at("answers")) {
        const std::string run = answer.at("engine").get<std::string>();
        if (!is_of(results, run, engine)) continue;
        const Json& value = answer.at("value");
        if (!value.is_number()) {
          ++left_out;
          continue;
        }
        lines[{one.at("id").get<std::string>(), run, answer.at("dt").get<std::string>()}]
             [gate.at("metric").get<std::string>()] = value.get<double>();
      }
    }
  }
  return lines;
}

double rounded_to_four(double value) { return std::stod(fmt::format("{:.4g}", value)); }

}  // namespace

RecordedValues::Key RecordedValues::key_of(const std::string& case_id, const RunName& run, double dt,
                                           const std::string& metric) {
  const Settings& settings = run.settings;
  return {
      case_id, run.engine, settings.method, settings.options, settings.track == Track::stock, fmt::format("{:.9e}", dt),
      metric};
}

std::optional<double> RecordedValues::find(const std::string& case_id, const RunName& run, double dt,
                                           const std::string& metric) const {
  const auto found = values_.find(key_of(case_id, run, dt, metric));
  return found == values_.end() ? std::nullopt : std::optional(found->second);
}

bool RecordedValues::add(const std::string& case_id, const RunName& run, double dt, const std::string& metric,
                         double value) {
  return values_.emplace(key_of(case_id, run, dt, metric), value).second;
}

RecordedValues read_recorded_values(const std::string& adapters_dir, const std::vector<EngineInfo>& engines) {
  RecordedValues values;
  for (const EngineInfo& engine : engines) {
    const fs::path path = fs::path(adapters_dir) / engine.name / kRegressionFile;
    std::error_code error;
    if (!fs::exists(fs::symlink_status(path, error))) continue;
    std::istringstream lines(read_input_file(path.string(), "the recorded values of an engine"));
    int count = 0;
    for (std::string line; std::getline(lines, line);)
      LineReader(fmt::format("{}:{}", path.string(), ++count), engine.name, engines).read(line, values);
  }
  return values;
}

RegressionText regression_text(const std::string& results_path, const std::string& engine) {
  RegressionText out;
  try {
    const Json results = parse_json(read_input_file(results_path, "a results.json"));
    for (const auto& [cell, values] : found_values(results, engine, out.left_out)) {
      Json line = {{"case", cell[0]}, {"run", cell[1]}, {"dt", cell[2]}};
      for (const auto& [metric, value] : values) line[metric] = std::abs(value) > kNoise ? rounded_to_four(value) : 0.0;
      out.text += line.dump() + "\n";
    }
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is no results.json of this version: {}", results_path, in_words(error)));
  }
  if (out.text.empty())
    throw InputError(fmt::format("{}: no regression there found a value of '{}'", results_path, engine));
  return out;
}

std::string change_from(double recorded, double value, double factor) {
  const double high = factor * std::abs(recorded) + kNoise, low = std::abs(recorded) / factor - kNoise;
  if (!(std::abs(value) <= high)) return fmt::format("more than {:g} times what was recorded", factor);
  if (!(std::abs(value) >= low)) return fmt::format("less than what was recorded by more than {:g} times", factor);
  return "";
}

}  // namespace rigor::inline gates
