#include "cases/case/gate_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cases/case/run_selector.h"
#include "cases/case/seconds_reader.h"
#include "cases/case/selection.h"
#include "core/base/error.h"
#include "core/base/near_match.h"
#include "core/scene/features/feature.h"

namespace rigor::inline cases {
namespace {

// A tenth for the next term of the error, and for steps that are not yet short.
constexpr double kShortOfDeclaredOrder = 0.1;

// The first of the metrics that is measured across runs; null if there is none.
const std::string* cross_metric_of(const GateTable& table, const Vocabulary& words) {
  const auto is_cross = [&](const std::string& name) {
    return std::find(words.cross_metrics.begin(), words.cross_metrics.end(), name) != words.cross_metrics.end();
  };
  const auto found = std::find_if(table.metrics.begin(), table.metrics.end(), is_cross);
  return found == table.metrics.end() ? nullptr : &*found;
}

std::vector<std::string> read_metrics(const TomlValue& value, const Vocabulary& words) {
  Keys known = words.metrics;
  known.insert(known.end(), words.cross_metrics.begin(), words.cross_metrics.end());
  std::vector<std::string> names;
  for (const TomlValue& item : value.items()) names.push_back(item.choice(known));
  return names;
}

std::string read_run(const TomlValue& value, const Vocabulary& words) {
  try {
    return parse_run_name(value.text(), words.engines).text;
  } catch (const InputError& error) {
    value.refuse(error.what());
  }
}

std::vector<std::string> read_runs(const TomlValue& value, const Vocabulary& words) {
  if (!is_run_selector(value.text())) return {read_run(value, words)};
  try {
    return selected_runs(value.text(), words.engines);
  } catch (const InputError& error) {
    value.refuse(error.what());
  }
}

std::vector<std::string> read_engines(const TomlValue& value, const Vocabulary& words) {
  std::vector<std::string> names;
  for (const TomlValue& item : value.items()) {
    for (const std::string& name : read_runs(item, words)) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

StepTerm read_step(const TomlValue& value) {
  if (!value.is_text()) return {"", read_seconds(value), value.label()};
  const std::string text = value.text();
  const std::size_t begin = std::min(text.find_first_not_of("<>="), text.size());
  const std::string sign = text.substr(0, begin);
  constexpr std::array<const char*, 5> kSigns = {"", "<", "<=", ">", ">="};
  if (std::find(kSigns.begin(), kSigns.end(), sign) == kSigns.end())
    value.refuse_found("a step such as 1/30, or <, <=, >, >= before it");
  return {sign, parse_step_size(text.substr(begin), value.label()), value.label()};
}

bool takes(const StepTerm& term, const StepSize& dt) {
  const double a = dt.seconds, b = term.dt.seconds;
  if (dt == term.dt) return term.sign.empty() || term.sign.ends_with('=');
  return !term.sign.empty() && (term.sign.starts_with('<') ? a < b : a > b);
}

// A ranking: the metric of every run the gate names must be better than this one's.
void read_better_than(const TableReader& table, const TomlValue& value, const Vocabulary& words, GateTable& out) {
  if (const std::string* ranks_nothing = cross_metric_of(out, words))
    value.refuse(fmt::format("{} does not rank runs; give max, min or equals", *ranks_nothing));
  Gate& gate = out.gate;
  const std::string other = read_run(value, words);
  gate.limit = RankingLimit{other};
  if (gate.engines.empty()) value.refuse("a ranking names the runs that are better; give engines");
  for (const TomlValue& item : table.at("engines").items()) {
    if (item.text() == other)
      value.refuse(fmt::format("found {}, which is among engines; no run is better than itself", other));
  }
  std::erase(gate.engines, other);  // a selector took it
  if (gate.engines.empty()) value.refuse("no other run is among engines");
}

void read_order(const TomlValue& value, const Vocabulary& words, GateTable& out) {
  const bool is_declared = value.is_text() && value.choice({"declared"}) == "declared";
  out.gate.limit = OrderLimit{is_declared ? kShortOfDeclaredOrder : value.positive(), is_declared};
  out.order_label = value.label();
  if (const std::string* cross = cross_metric_of(out, words))
    value.refuse(fmt::format("{} has no order; give max, min or equals", *cross));
}

void read_regression(const TomlValue& value, const Vocabulary& words, GateTable& out) {
  const double factor = value.number();
  out.gate.limit = RegressionLimit{factor};
  if (!(factor > 1)) value.refuse_found("a number above 1: by how much a value may differ");
  if (cross_metric_of(out, words))
    value.refuse("what is measured across runs is not recorded; give max, min or equals");
}

std::optional<double> number_if_given(const TableReader& table, const char* key) {
  const auto value = table.find(key);
  return value ? std::optional(value->number()) : std::nullopt;
}

void read_limits(const TableReader& table, const Vocabulary& words, GateTable& out) {
  const BoundLimit bound{number_if_given(table, "max"), number_if_given(table, "min"),
                         number_if_given(table, "equals")};
  out.gate.limit = bound;
  const auto order = table.find("at_least_order");
  const auto factor = table.find("regression");
  const auto other = table.find("better_than");
  if (order) read_order(*order, words, out);
  if (factor) read_regression(*factor, words, out);
  if (other) read_better_than(table, *other, words, out);
  const int limits =
      (bound.max || bound.min) + bound.equals.has_value() + order.has_value() + factor.has_value() + other.has_value();
  if (limits != 1) {
    table.refuse(
        fmt::format("found {}; allowed: one of max, min, equals, at_least_order, better_than, regression, or min and "
                    "max together",
                    limits == 0 ? "no bound" : "bounds that do not go together"));
  }
  if (bound.min && bound.max && *bound.min > *bound.max) {
    table.at("min").refuse(fmt::format("found {}, more than max, {}", *bound.min, *bound.max));
  }
}

// A word may have ! before it.
std::vector<std::string> read_scene_words(const TomlValue& value) {
  static const Keys kKnown = known_scene_words();
  std::vector<std::string> words;
  for (const TomlValue& item : value.items()) {
    const std::string word = item.text();
    const std::string bare = word.substr(word.starts_with('!'));
    if (!std::binary_search(kKnown.begin(), kKnown.end(), bare))
      item.refuse(fmt::format("found '{}'{}; allowed, also with ! before it: {}", word, did_you_mean(bare, kKnown),
                              listed(kKnown)));
    words.push_back(word);
  }
  return words;
}

}  // namespace

Keys known_scene_words() {
  Keys words = {"damping", "gravity"};
  for (const FeatureWord& row : feature_words()) {
    if (row.feature == Feature::wrench) continue;
    words.push_back(row.word);
    words.push_back(row.word.substr(0, row.word.find(':')));
  }
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  return words;
}

const Keys& gate_keys() {
  static const Keys keys = {"metric",         "engines", "dt",          "max",        "min",
                            "at_least_order", "equals",  "better_than", "regression", "because"};
  return keys;
}

const Keys& family_gate_keys() {
  static const Keys keys = [] {
    Keys all = gate_keys();
    all.insert(all.end(), {"scene", "truth", "except"});
    return all;
  }();
  return keys;
}

GateTable read_gate_table(const TableReader& table, const Vocabulary& words) {
  GateTable out;
  out.gate.where = table.self().where();
  out.metrics = read_metrics(table.at("metric"), words);
  if (const auto value = table.find("engines")) out.gate.engines = read_engines(*value, words);
  if (const auto value = table.find("dt")) {
    for (const TomlValue& item : value->items()) out.steps.push_back(read_step(item));
  }
  read_limits(table, words, out);
  out.gate.because = table.at("because").text();
  return out;
}

GateTable read_family_gate_table(const TableReader& table, const Keys& cases, const Vocabulary& words) {
  GateTable out = read_gate_table(table, words);
  out.gate.is_of_family = true;
  if (const auto value = table.find("scene")) out.scene = read_scene_words(*value);
  if (const auto value = table.find("truth")) {
    Keys known = words.truths;
    known.push_back("none");
    for (const TomlValue& item : value->items()) out.truths.push_back(item.choice(known));
  }
  if (const auto value = table.find("except")) {
    for (const TomlValue& item : value->items()) out.except.push_back(item.choice(cases));
  }
  return out;
}

std::vector<StepSize> selected_steps(const std::vector<StepTerm>& terms, const std::vector<StepSize>& of_run) {
  std::vector<StepSize> steps;
  std::copy_if(of_run.begin(), of_run.end(), std::back_inserter(steps), [&](const StepSize& dt) {
    return terms.empty() ||
           std::any_of(terms.begin(), terms.end(), [&](const StepTerm& term) { return takes(term, dt); });
  });
  return steps;
}

std::vector<Gate> gates_of(const GateTable& table, const Case& of) {
  for (const StepTerm& term : table.steps) {
    if (!selected_steps({term}, of.dt).empty()) continue;
    Keys known;
    for (const StepSize& dt : of.dt) known.push_back(dt.text);
    throw InputError(
        fmt::format("{}: the run has no step {}{} s; allowed: {}", term.label, term.sign, term.dt.text, listed(known)));
  }
  Gate gate = table.gate;
  const auto steps = selected_steps(table.steps, of.dt);
  if (!table.steps.empty()) gate.dt = steps;
  if (gate.order() && steps.size() < 2)
    throw InputError(table.order_label + ": an order is observed over two step sizes or more");
  std::vector<Gate> gates;
  for (const std::string& metric : table.metrics) {
    gate.metric = metric;
    gates.push_back(gate);
  }
  return gates;
}

}  // namespace rigor::inline cases
