#include "cases/report/wording/ensemble_explanation.h"

#include <fmt/format.h>

#include <map>

namespace rigor {
namespace {

constexpr double kDiffers = 0.01;  // a p-value below: one in a hundred of equal distributions is called different

void append(std::string& list, const std::string& word) { list += (list.empty() ? "" : ", ") + word; }

}  // namespace

std::vector<std::string> ensemble_explanations(const Results& results, const CaseResult& result) {
  if (result.definition.ensemble == 0) return {};
  const StepSize dt = coarsest_dt(result);
  std::string alike, different, own;
  std::map<std::string, std::string> untold;  // by the reason
  for (const Cell& cell : result.cells) {
    const auto distance = cell.metrics.find("ensemble_distance"), p_value = cell.metrics.find("ensemble_p_value");
    if (cell.dt != dt || distance == cell.metrics.end() || p_value == cell.metrics.end()) continue;
    const std::string& name = results.runs[cell.run].text;
    if (!distance->second.not_applicable.empty()) {
      append(untold[distance->second.not_applicable], name);
      continue;
    }
    std::string& list = p_value->second.is_held_to_itself ? own : p_value->second.value < kDiffers ? different : alike;
    append(list, fmt::format("{} (H = {:.2g}, p = {:.2g})", name, distance->second.value, p_value->second.value));
  }
  std::vector<std::string> sentences;
  const auto say = [&](const std::string& what, const std::string& names) {
    if (!names.empty()) sentences.push_back(fmt::format("{}: {}.", what, names));
  };
  say(fmt::format("From {} starts 1e-6 apart, at dt = {} s, bodies end in places distributed otherwise than the "
                  "reference's, by their energy distance H and the share p of chance divisions as far apart",
                  result.definition.ensemble, dt.text),
      different);
  say(fmt::format(
          "From {} starts 1e-6 apart, at dt = {} s, nothing tells where bodies end from where the reference's do",
          result.definition.ensemble, dt.text),
      alike);
  say("Made by the reference's own code, which is no witness of it", own);
  for (const auto& [why, names] : untold) say(fmt::format("No ensembles compared, for {}", why), names);
  return sentences;
}

}  // namespace rigor
