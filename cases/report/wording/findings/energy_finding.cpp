#include "cases/report/wording/findings/energy_finding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "cases/analysis/energy_diagnosis.h"
#include "cases/report/wording/wording.h"

namespace rigor {
namespace {

std::vector<Diagnosis> diagnoses(const Results& results, const StepSize& dt) {
  std::vector<Diagnosis> all;
  for (const CaseResult& result : results.cases) {
    for (Diagnosis& found : energy_diagnoses(result, dt)) all.push_back(std::move(found));
  }
  return all;
}

// A run's largest of the chosen ones; null if it has none.
template <typename Chosen>
const Diagnosis* worst_of(const std::vector<Diagnosis>& all, std::size_t run, const Chosen& is_chosen) {
  const Diagnosis* worst = nullptr;
  for (const Diagnosis& found : all) {
    if (found.runs.front() != run || !is_chosen(found)) continue;
    if (!worst || std::abs(found.value) > std::abs(worst->value)) worst = &found;
  }
  return worst;
}

std::string text_of_cause(const Diagnosis& drift) {
  constexpr double kAlike = 0.01;
  if (std::isnan(drift.beside)) return ", its most.";
  if (std::abs(drift.value - drift.beside) > kAlike * std::abs(drift.value))
    return fmt::format(", {:.2g} % of it by the scheme.", 100 * drift.beside / drift.value);
  if (drift.cause == kGyroscopicTerm) return ", all by the gyroscopic part of the scheme.";
  return ", all by the scheme: the core, repeating it, comes to the same.";
}

double duration_of(const Results& results, const std::string& id) {
  const auto found = std::find_if(results.cases.begin(), results.cases.end(),
                                  [&](const CaseResult& result) { return result.definition.id == id; });
  return found->definition.duration;
}

}  // namespace

std::optional<Finding> energy_finding(const Results& results, const RunNames& names, const StepSize& dt) {
  const std::vector<Diagnosis> all = diagnoses(results, dt);
  std::string sentences[2];  // of losses, of gains
  for (const bool is_loss : {true, false}) {
    std::map<std::string, std::vector<std::size_t>> said;  // who, by what is said of them
    for (const std::size_t run : names.order()) {
      if (names.is_ours(run) || !names.is_common(run)) continue;
      const Diagnosis* worst = worst_of(all, run, [&](const Diagnosis& found) {
        return found.topic == kEnergyDrifts && (found.value < 0) == is_loss;
      });
      if (!worst) continue;
      said[fmt::format("{} % of that of {} in {:g} s{}", rounded(100 * std::abs(worst->value)), worst->of_case,
                       duration_of(results, worst->of_case), text_of_cause(*worst))]
          .push_back(run);
    }
    for (const auto& [text, who] : said) {
      std::string& sentence = sentences[is_loss ? 0 : 1];
      const std::string verb = is_loss ? " lose" : " gain";
      sentence += (sentence.empty() ? "" : " ") + names.all(who) + verb + (who.size() == 1 ? "s " : " ") + text;
    }
  }
  if (sentences[0].empty()) std::swap(sentences[0], sentences[1]);
  if (sentences[0].empty()) return std::nullopt;
  return Finding{"energy", fmt::format("Energy at dt = {} s: ", dt.text) + sentences[0], sentences[1]};
}

std::optional<Finding> sampling_finding(const Results& results, const RunNames& names, const StepSize& dt) {
  const std::vector<Diagnosis> all = diagnoses(results, dt);
  std::map<std::string, std::vector<std::size_t>> said;
  std::vector<std::string> cases;
  for (const std::size_t run : names.order()) {
    if (names.is_ours(run) || !names.is_common(run)) continue;
    const auto is_misread = [](const Diagnosis& found) { return found.topic == kEnergyMisread; };
    for (const Diagnosis& found : all) {
      if (found.runs.front() == run && is_misread(found) &&
          std::find(cases.begin(), cases.end(), found.of_case) == cases.end())
        cases.push_back(found.of_case);
    }
    const Diagnosis* worst = worst_of(all, run, is_misread);
    if (!worst) continue;
    said[fmt::format("in {} it strays by {} % as read, by {} % with both at one instant", worst->of_case,
                     rounded(100 * worst->value), rounded(100 * worst->beside))]
        .push_back(run);
  }
  if (said.empty()) return std::nullopt;
  std::string text = "Energy as read misleads where velocities are half a step from positions";
  for (const auto& [what, who] : said) text += "; " + names.all(who) + ": " + what;
  return Finding{"sampling", text + ".",
                 fmt::format("A semi-implicit step leaves the velocity half a step behind: at every bounce or turn the "
                             "energy of g dt/2 seems lost or gained, and is only read at the wrong instant. So it is, "
                             "for one engine or another, in {}.",
                             fmt::join(cases, ", "))};
}

}  // namespace rigor
