#include "tests/cases/report/wording/claim_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <utility>

#include "cases/metrics/metric.h"

namespace rigor::test {
namespace {

void remove_all(std::string& text, const std::string& part) {
  if (part.empty()) return;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at))
    text.replace(at, part.size(), "#");
}

// Numbers that belong to the wording: "within 1 mm", "needs less than 2", "After 1 s".
const std::vector<std::string> kFixed = {
    "Largest step within 1 mm", "needs less than 2", "After 1 s",         "off by g dt t/2",
    "within 1 mm of the truth", "1 mrad where",      "ω dt of 1 or more", " : 1 slow"};

}  // namespace

bool holds(const Claim& claim) {
  switch (claim.relation) {
    case Relation::none:
      return true;
    case Relation::below:
      return claim.value < claim.bound;
    case Relation::at_most:
      return claim.value <= claim.bound;
    case Relation::above:
      return claim.value > claim.bound;
    case Relation::at_least:
      return claim.value >= claim.bound;
    case Relation::equal:
      return std::abs(claim.value - claim.bound) < 0.01 * std::abs(claim.bound);
  }
  return false;
}

std::string without_names(const Results& results, std::string text) {
  std::vector<std::string> names;
  for (const RunName& run : results.runs) names.push_back(run.text);
  for (const CaseResult& one : results.cases) {
    names.push_back(one.definition.id);
    for (const StepSize& dt : one.definition.dt) names.push_back(dt.text + " s");
    for (std::size_t j = 0; j < one.definition.scene.joints.size(); ++j)
      names.push_back(one.definition.scene.joint_name(j));
    for (const Body& body : one.definition.scene.bodies) names.push_back("'" + body.name + "'");
    for (const Cell& cell : one.cells) {
      names.push_back(cell.stability.why);
      for (const auto& [setting, words] : cell.settings) {
        names.push_back(fmt::format("\"{}\": {}.", setting, words));
        if (setting == "singular positions") names.push_back(words);
      }
      for (const auto& [name, value] : cell.metrics)
        names.push_back(value.worst.component), names.push_back(value.not_applicable);
    }
  }
  const auto is_number = [](const std::string& name) {
    return name.find_first_not_of("0123456789.e-") == std::string::npos;
  };
  std::erase_if(names, [&](const std::string& name) { return name.size() < 2 || is_number(name); });
  std::sort(names.begin(), names.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  for (const std::string& name : names) remove_all(text, name);
  return text;
}

std::vector<std::string> numbers_in(std::string text) {
  for (const std::string& fixed : kFixed) remove_all(text, fixed);
  static const std::regex kNumber("[0-9]+([.][0-9]+)?(e-?[0-9]+)?");
  std::vector<std::string> numbers;
  for (std::sregex_iterator at(text.begin(), text.end(), kNumber), end; at != end; ++at) numbers.push_back(at->str());
  return numbers;
}

double printed_value(const std::string& quantity, const std::string& printed) {
  std::size_t end = 0;
  const double number = std::stod(printed, &end);
  const std::string unit = printed.substr(std::min(printed.size(), end + 1));
  if (unit == "%") return unit_of_metric(quantity) == "%" ? number : number / 100;
  for (const char* base : {"m", "s", "rad"}) {
    for (const auto& [prefix, factor] : {std::pair("m", 1e-3), {"µ", 1e-6}, {"n", 1e-9}, {"p", 1e-12}})
      if (unit == std::string(prefix) + base) return number * factor;
  }
  return number;
}

}  // namespace rigor::test
