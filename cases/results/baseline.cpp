#include "cases/results/baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "cases/metrics/metric.h"
#include "cases/metrics/verdict.h"
#include "cases/results/changes.h"
#include "cases/results/input_file.h"
#include "cases/results/results.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/json_words.h"

namespace rigor::inline results {
namespace {

constexpr const char* kTabForm = "# Rigor baseline 1";
constexpr const char* kTitleKey = "rigor_baseline";
constexpr int kForm = 2;
constexpr int kOldestSchema = 1, kSchema = 2;  // of results.json; in version 1 non-finite numbers are null

std::string text_at(const Json& json, const char* key) { return json.at(key).get<std::string>(); }

CellKey key_at(const Json& json) { return {text_at(json, "case"), text_at(json, "engine"), text_at(json, "dt")}; }
RunKey run_at(const Json& json) { return {text_at(json, "case"), text_at(json, "engine")}; }

// Reads a word of one of the enumerations; `place` is where it stands.
template <typename Word>
Word word_at(const Json& json, const char* key, Word last, const std::string& place) {
  const std::string word = text_at(json, key);
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    if (word_of(static_cast<Word>(i)) == word) return static_cast<Word>(i);
  }
  throw InputError(fmt::format("{}: there is no {} '{}'", place, key, word));
}
Status status_at(const Json& json, const std::string& place) { return word_at(json, "status", Status::invalid, place); }
GateAnswer answer_at(const Json& json, const std::string& place) {
  return word_at(json, "answer", GateAnswer::not_recorded, place);
}

Verdict verdict_at(const Json& json, const char* key, const std::string& place) {
  try {
    return verdict_of(text_at(json, key));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place, error.what()));
  }
}

// For a time shift its size; a non-finite value is worse than any number.
double value_from(const Json& value, const std::string& metric, const std::string& place) {
  if (value.is_number()) return std::abs(value.get<double>());
  const bool is_not_finite = value.is_null() || value == "inf" || value == "-inf" || value == "nan";
  if (!is_not_finite) throw InputError(fmt::format("{}: found {}; allowed: a number", place, value.dump()));
  return is_higher_better(metric) ? 0 : HUGE_VAL;
}

const Json& object_at(const Json& json, const char* key, const std::string& place) {
  const Json& found = json.at(key);
  if (!found.is_object())
    throw InputError(fmt::format("{}: {}: found {}; allowed: an object", place, key, found.dump()));
  return found;
}

Baseline::Cell cell_from(const Json& json, const std::string& place) {
  Baseline::Cell cell{status_at(json, place)};
  if (const Json& verdict = json.at("verdict"); !verdict.is_null()) cell.verdict = verdict_at(verdict, "word", place);
  for (const auto& [name, metric] : object_at(json, "metrics", place).items()) {
    const MetricRow* row = find_metric(name);
    if (!row || !row->is_compared) continue;
    if (!metric.contains("value")) {
      if (text_at(metric, "not_applicable").starts_with("not measured")) cell.not_asked.insert(name);
      continue;
    }
    cell.metrics[name] = value_from(metric.at("value"), name, fmt::format("{}: {}", place, name));
  }
  return cell;
}

// A gate's answers by its content, because its number changes with the file. The worst of several with the same content
// counts. A missing recorded value of a regression does not affect the cell.
void add_gates(const Json& json, const std::string& place, Baseline& out) {
  for (const Json& gate : json.at("gates")) {
    for (const Json& answer : gate.at("answers")) {
      const GateAnswer found = answer_at(answer, fmt::format("{}: gate of {}", place, text_at(gate, "metric")));
      if (found == GateAnswer::not_recorded) continue;
      const GateKey key{text_at(json, "id"), text_at(gate, "metric"), text_at(answer, "engine"), text_at(answer, "dt")};
      GateAnswer& worst = out.gates.try_emplace(key, found).first->second;
      if (worst == GateAnswer::held) worst = found;
    }
  }
}

void check_schema(const Json& json) {
  const int schema = json.at("schema").get<int>();
  if (schema < kOldestSchema || schema > kSchema)
    throw InputError(fmt::format("its schema is {}; allowed: {} to {}", schema, kOldestSchema, kSchema));
}

// Grouped by case, because a long result states it once per case.
std::map<std::string, std::set<std::string>> metrics_not_measured(const Json& cases) {
  std::map<std::string, std::set<std::string>> found;
  for (const Json& one : cases) {
    if (one.contains("not_measured")) found[text_at(one, "id")] = one.at("not_measured").get<std::set<std::string>>();
  }
  return found;
}

Baseline from_json(const Json& json) {
  check_schema(json);
  Baseline out;
  const auto not_measured = metrics_not_measured(json.at("cases"));
  std::size_t index = 0;
  for (const Json& cell : json.at("cells")) {
    const std::string place = fmt::format("cells[{}]", index++);
    const CellKey key = key_at(cell);
    const auto [made, is_new] = out.cells.emplace(key, cell_from(cell, place));
    if (!is_new) throw InputError(fmt::format("{}: is there twice: {}", place, key.text()));
    const auto unmeasured = not_measured.find(key.case_id);
    if (unmeasured != not_measured.end() && !cell.at("metrics").empty())
      made->second.not_asked.insert(unmeasured->second.begin(), unmeasured->second.end());
    for (const auto& [name, value] : cell.at("settings").items())
      out.settings[{key.engine, name}].insert(value.get<std::string>());
  }
  index = 0;
  for (const Json& one : json.at("cases")) {
    add_gates(one, fmt::format("cases[{}]", index++), out);
    if (!one.at("error").is_null()) out.case_errors[text_at(one, "id")] = text_at(one, "error");
    if (one.contains("duration")) out.durations[text_at(one, "id")] = one.at("duration").get<double>();
  }
  if (!json.contains("stable_dt")) return out;
  for (const Json& one : json.at("stable_dt")) {
    if (one.at("dt").is_number()) out.stable_steps[run_at(one)] = one.at("dt");
  }
  return out;
}

// One line of a baseline: the title, or a setting, an error, a gate's answer or a cell.
void add_line(const Json& json, Baseline& out) {
  if (json.contains(kTitleKey)) {
    if (json.at(kTitleKey) != kForm) throw InputError(fmt::format("{} is not {}", kTitleKey, kForm));
    for (const Json& name : json.at("metrics")) out.left_out.insert(name.get<std::string>());
  } else if (json.contains("setting")) {
    out.settings[{text_at(json, "engine"), text_at(json, "setting")}] = json.at("values").get<std::set<std::string>>();
  } else if (json.contains("error")) {
    out.case_errors[text_at(json, "case")] = text_at(json, "error");
  } else if (json.contains("duration")) {
    out.durations[text_at(json, "case")] = json.at("duration").get<double>();
  } else if (json.contains("stable_dt")) {
    out.stable_steps[run_at(json)] = json.at("stable_dt").get<double>();
  } else if (json.contains("gate")) {
    out.gates[{text_at(json, "case"), text_at(json, "gate"), text_at(json, "engine"), text_at(json, "dt")}] =
        answer_at(json, "gate");
  } else {
    Baseline::Cell cell{status_at(json, "cell")};
    if (json.contains("verdict")) cell.verdict = verdict_at(json, "verdict", "cell");
    for (const auto& [name, value] : object_at(json, "metrics", "cell").items())
      cell.metrics[name] = value_from(value, name, name);
    const CellKey key = key_at(json);
    if (!out.cells.emplace(key, cell).second) throw InputError("is there twice: " + key.text());
  }
}

Baseline from_baseline(const std::string& text) {
  Baseline out;
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    ++count;
    try {
      add_line(parse_json(line), out);
    } catch (const InputError& error) {
      throw InputError(fmt::format("line {}: {}", count, error.what()));
    } catch (const Json::exception& error) {
      throw InputError(fmt::format("line {}: is no line of a baseline: {}", count, in_words(error)));
    }
  }
  return out;
}

bool is_baseline(const std::string& text) {
  const Json first = parse_json_or_discard(text.substr(0, text.find('\n')));
  return first.is_object() && first.contains(kTitleKey);
}

std::string line_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

double rounded_to_four(double value) { return std::stod(fmt::format("{:.4g}", value)); }

Json json_of(const CellKey& key, const Baseline::Cell& cell) {
  Json json = {{"case", key.case_id}, {"engine", key.engine}, {"dt", key.dt}, {"status", word_of(cell.status)}};
  if (cell.verdict) json["verdict"] = word_of(*cell.verdict);
  json["metrics"] = Json::object();
  for (const auto& [name, value] : cell.metrics) {
    if (!std::isfinite(value))
      json["metrics"][name] = "inf";
    else if (value > kNoise)
      json["metrics"][name] = rounded_to_four(value);
  }
  return json;
}

}  // namespace

std::string joined_parts(std::initializer_list<std::string> parts, const std::string& between) {
  std::string text;
  for (const std::string& part : parts) {
    if (!part.empty()) text += (text.empty() ? "" : between) + part;
  }
  return text;
}

bool is_higher_better(const std::string& metric) {
  const MetricRow* row = find_metric(metric);
  return row && row->higher_is_better;
}

Baseline read_baseline(const std::string& path) {
  const std::string text = read_input_file(path, "a results.json or a baseline");
  try {
    if (text.starts_with(kTabForm))
      throw InputError("is a baseline of an older form; make it anew by `rigor baseline`");
    return is_baseline(text) ? from_baseline(text) : from_json(parse_json(text));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: neither a results.json nor a baseline: {}", path, in_words(error)));
  }
}

std::string baseline_text(const Baseline& baseline) {
  std::set<std::string> names = baseline.left_out;
  for (const auto& [key, cell] : baseline.cells) {
    for (const auto& [name, value] : cell.metrics) names.insert(name);
  }
  std::string text = line_of({{kTitleKey, kForm}, {"metrics", names}});
  for (const auto& [key, values] : baseline.settings)
    text += line_of({{"engine", key.engine}, {"setting", key.setting}, {"values", values}});
  for (const auto& [id, error] : baseline.case_errors) text += line_of({{"case", id}, {"error", error}});
  for (const auto& [id, duration] : baseline.durations) text += line_of({{"case", id}, {"duration", duration}});
  for (const auto& [key, dt] : baseline.stable_steps)
    text += line_of({{"case", key.case_id}, {"engine", key.engine}, {"stable_dt", rounded_to_four(dt)}});
  for (const auto& [key, cell] : baseline.cells) text += line_of(json_of(key, cell));
  // A gate on one cell that holds follows from the cell's status.
  for (const auto& [key, answer] : baseline.gates) {
    if (answer == GateAnswer::held && !key.dt.empty()) continue;
    text += line_of({{"case", key.case_id},
                     {"gate", key.metric},
                     {"engine", key.engine},
                     {"dt", key.dt},
                     {"answer", word_of(answer)}});
  }
  return text;
}

}  // namespace rigor::inline results
