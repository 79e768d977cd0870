#include "cases/report/wording/explanations/ensemble_explanation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>

#include "cases/report/wording/cell_claim.h"

namespace rigor::inline report {
namespace {

constexpr double kDiffers = 0.01;  // a p-value below: of equal distributions one in a hundred would be called different

// Runs with the same answer.
struct Group {
  std::vector<std::string> runs;
  Claims claims;

  void add(const Results& results, const CaseResult& result, const Cell& cell, Relation relation) {
    const double distance = cell.metrics.at("ensemble_distance").value, p = cell.metrics.at("ensemble_p_value").value;
    Claim of_p = claim_of_cell(results, result, cell, "ensemble_p_value", p);
    of_p.relation = relation, of_p.bound = kDiffers;
    runs.push_back(fmt::format("{} (H = {}, p = {})", results.runs[cell.run].text,
                               claims.quantity(claim_of_cell(results, result, cell, "ensemble_distance", distance), ""),
                               claims.quantity(of_p, "")));
  }
};

}  // namespace

std::vector<Message> ensemble_explanations(const Results& results, const CaseResult& result) {
  if (result.definition.ensemble == 0) return {};
  const StepSize dt = coarsest_dt(result);
  Group alike, different, own;
  std::map<std::string, std::vector<std::string>> not_compared;  // by the reason
  for (const Cell& cell : result.cells) {
    const auto distance = cell.metrics.find("ensemble_distance"), p = cell.metrics.find("ensemble_p_value");
    if (cell.dt != dt || distance == cell.metrics.end() || p == cell.metrics.end()) continue;
    if (!distance->second.not_applicable.empty()) {
      not_compared[distance->second.not_applicable].push_back(results.runs[cell.run].text);
    } else if (p->second.is_held_to_itself) {
      own.add(results, result, cell, Relation::none);
    } else if (p->second.value < kDiffers) {
      different.add(results, result, cell, Relation::below);
    } else {
      alike.add(results, result, cell, Relation::at_least);
    }
  }
  std::vector<Message> messages;
  const auto tell = [&](const std::string& text, Group& group) {
    if (group.runs.empty()) return;
    Claim starts = claim_of_scene(result, "ensemble starts", result.definition.ensemble);
    const std::string count = group.claims.count(starts);
    messages.push_back(
        {"ensemble",
         fmt::format("{} Ensemble of {} starts at dt = {} s: {}.", text, count, dt.text, fmt::join(group.runs, ", ")),
         "", group.claims.take()});
  };
  tell("Final places are distributed differently from the reference's (energy distance H, chance p).", different);
  tell("Final places cannot be told from the reference's (energy distance H, chance p).", alike);
  tell("The reference uses this run's own code and is no independent check of it.", own);
  for (const auto& [why, runs] : not_compared)
    messages.push_back({"ensemble", fmt::format("No ensembles compared ({}): {}.", why, fmt::join(runs, ", "))});
  return messages;
}

}  // namespace rigor::inline report
