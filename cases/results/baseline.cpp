#include "cases/results/baseline.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "cases/metrics/metric.h"
#include "cases/metrics/verdict.h"
#include "cases/results/changes.h"
#include "cases/results/result_json.h"
#include "core/base/error.h"

namespace rigor {
namespace {

using Json = nlohmann::json;

constexpr const char* kTitle = "# Rigor baseline 1";
constexpr int kSchemas[] = {1, 2};  // in the first a number that was not finite is null
constexpr const char* kVerdictIs = "verdict=";

// A time is measured anew each run; a shift in time has a sign; and of two metrics more is better.
bool is_compared(const std::string& metric) {
  if (metric == "cost" || metric == "phase_error") return false;
  for (const MetricRow& row : metrics()) {
    if (row.name == metric) return !row.higher_is_better;
  }
  return false;
}

std::string joined(const std::vector<std::string>& parts) { return fmt::format("{}", fmt::join(parts, "\t")); }

std::string text_at(const Json& json, const char* key) { return json.at(key).get<std::string>(); }

const std::string& known_verdict(const std::string& word) {
  verdict_of(word);
  return word;
}

Outcomes::Cell cell_from(const Json& json) {
  Outcomes::Cell cell{text_at(json, "status"), "", {}};
  if (const Json& verdict = json.at("verdict"); !verdict.is_null())
    cell.verdict = known_verdict(text_at(verdict, "word"));
  for (const auto& [name, metric] : json.at("metrics").items()) {
    if (!is_compared(name) || !metric.contains("value")) continue;
    const Json& value = metric.at("value");
    cell.metrics[name] = value.is_null() ? HUGE_VAL : number_of(value);
  }
  return cell;
}

// A gate's answers by what it asks, for its number changes with the file; the worst where several ask the same.
void add_gates(const Json& json, Outcomes& out) {
  for (const Json& gate : json.at("gates")) {
    for (const Json& answer : gate.at("answers")) {
      std::string& word = out.gates[joined(
          {text_at(json, "id"), text_at(gate, "metric"), text_at(answer, "engine"), text_at(answer, "dt")})];
      if (word.empty() || word == "held") word = text_at(answer, "answer");
    }
  }
}

Outcomes from_json(const Json& json) {
  if (std::find(std::begin(kSchemas), std::end(kSchemas), json.at("schema").get<int>()) == std::end(kSchemas)) {
    throw InputError(
        fmt::format("its schema is {}; allowed: {}", json.at("schema").dump(), fmt::join(kSchemas, " and ")));
  }
  Outcomes out;
  std::map<std::string, std::set<std::string>> settings;
  for (const Json& cell : json.at("cells")) {
    const std::string engine = text_at(cell, "engine");
    out.cells[joined({text_at(cell, "case"), engine, text_at(cell, "dt")})] = cell_from(cell);
    for (const auto& [name, value] : cell.at("settings").items())
      settings[joined({engine, name})].insert(value.get<std::string>());
  }
  for (const auto& [key, values] : settings) out.settings[key] = fmt::format("{}", fmt::join(values, kBetweenValues));
  for (const Json& one : json.at("cases")) {
    add_gates(one, out);
    if (!one.at("error").is_null()) out.case_errors[text_at(one, "id")] = text_at(one, "error");
  }
  return out;
}

double number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(fmt::format("'{}' is no number", text));
  return value;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> parts;
  std::size_t at = 0;
  for (std::size_t tab; (tab = line.find('\t', at)) != std::string::npos; at = tab + 1)
    parts.push_back(line.substr(at, tab - at));
  parts.push_back(line.substr(at));
  return parts;
}

void add_cell(const std::vector<std::string>& parts, Outcomes& out) {
  Outcomes::Cell cell{parts[4], "", {}};
  for (std::size_t i = 5; i < parts.size(); ++i) {
    const std::size_t equals = parts[i].find('=');
    if (equals == std::string::npos) throw InputError(fmt::format("'{}' is no metric=value", parts[i]));
    if (parts[i].starts_with(kVerdictIs)) {
      cell.verdict = known_verdict(parts[i].substr(equals + 1));
      continue;
    }
    cell.metrics[parts[i].substr(0, equals)] = number(parts[i].substr(equals + 1));
  }
  out.cells[joined({parts[1], parts[2], parts[3]})] = cell;
}

void add_line(const std::string& line, Outcomes& out) {
  if (line.empty() || line[0] == '#') return;
  const std::vector<std::string> parts = split(line);
  const auto is = [&](const char* word, std::size_t least) { return parts[0] == word && parts.size() >= least; };
  if (is("cell", 5)) {
    add_cell(parts, out);
  } else if (is("gate", 6)) {
    out.gates[joined({parts[1], parts[2], parts[3], parts[4]})] = parts[5];
  } else if (is("setting", 4)) {
    out.settings[joined({parts[1], parts[2]})] = parts[3];
  } else if (is("metric", 2)) {
    out.left_out.insert(parts[1]);
  } else if (is("error", 3)) {
    out.case_errors[parts[1]] = parts[2];
  } else {
    throw InputError("it is no line of a baseline");
  }
}

Outcomes from_baseline(const std::string& text) {
  Outcomes out;
  std::istringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    ++count;
    try {
      add_line(line, out);
    } catch (const InputError& error) {
      throw InputError(fmt::format("line {}: {}", count, error.what()));
    }
  }
  return out;
}

// In a line of its own, with nothing in it that ends a part or the line.
std::string tidy(std::string text) {
  for (char& c : text) {
    if (c == '\t' || c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

}  // namespace

Outcomes read_outcomes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw InputError(fmt::format("{}: cannot be read; give a results.json or a baseline", path));
  try {
    return text.starts_with(kTitle) ? from_baseline(text) : from_json(Json::parse(text));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: neither a results.json nor a baseline: {}", path, tidy(error.what())));
  }
}

std::string baseline_text(const Outcomes& outcomes) {
  std::string text = fmt::format("{}: made by `rigor baseline`, read by `rigor compare`\n", kTitle);
  for (const auto& [key, values] : outcomes.settings) text += fmt::format("setting\t{}\t{}\n", key, tidy(values));
  for (const auto& [key, error] : outcomes.case_errors) text += fmt::format("error\t{}\t{}\n", key, tidy(error));
  std::set<std::string> names = outcomes.left_out;
  for (const auto& [key, cell] : outcomes.cells) {
    for (const auto& [name, value] : cell.metrics) names.insert(name);
  }
  for (const std::string& name : names) text += fmt::format("metric\t{}\n", name);
  for (const auto& [key, cell] : outcomes.cells) {
    text += fmt::format("cell\t{}\t{}", key, cell.status);
    if (!cell.verdict.empty()) text += fmt::format("\t{}{}", kVerdictIs, cell.verdict);
    for (const auto& [name, value] : cell.metrics) {
      if (value > kNoise) text += fmt::format("\t{}={:.4g}", name, value);
    }
    text += "\n";
  }
  // A gate on one cell that holds follows from the cell's status.
  for (const auto& [key, answer] : outcomes.gates) {
    if (answer != "held" || key.ends_with('\t')) text += fmt::format("gate\t{}\t{}\n", key, answer);
  }
  return text;
}

}  // namespace rigor
