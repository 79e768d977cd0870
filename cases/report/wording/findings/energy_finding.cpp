#include "cases/report/wording/findings/energy_finding.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cases/analysis/energy_diagnosis.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {
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

class EnergyFinding {
 public:
  EnergyFinding(const Results& results, const RunNames& names, const StepSize& dt)
      : results_(results), names_(names), dt_(dt), all_(diagnoses(results, dt)) {}

  std::optional<Finding> finding() {
    std::vector<std::string> sentences;
    for (const bool is_loss : {true, false}) {
      const std::string text = sentence(is_loss);
      if (!text.empty())
        sentences.push_back(fmt::format("Energy {} at dt = {} s: {}.", is_loss ? "loss" : "gain", dt_.text, text));
    }
    if (sentences.empty()) return std::nullopt;
    return Finding{"energy", sentences[0], sentences.size() > 1 ? sentences[1] : "", claims_.take()};
  }

 private:
  Claim claim(const Diagnosis& found, const std::string& quantity, double value) const {
    return {quantity, found.of_case, names_.of(found.runs.front()), dt_.text, "", value};
  }

  // Why, as far as the twin shows it.
  std::string cause_of(const Diagnosis& drift) {
    constexpr double kAlike = 0.01;
    if (std::isnan(drift.beside)) return "";
    const double share = drift.beside / drift.value;
    if (std::abs(1 - share) > kAlike) {
      Claim of_share = claim(drift, "scheme's share of energy_drift", share);
      return fmt::format(", {} of it by the scheme", claims_.percent(of_share));
    }
    Claim same = claim(drift, "scheme's energy_drift", drift.beside);
    claims_.state(same);
    return drift.cause == kGyroscopicTerm ? ", by the scheme's gyroscopic term" : ", by the scheme";
  }

  // "ode, bullet −149 % on joints/chain-10 in 3 s, by the scheme; ..."
  std::string sentence(bool is_loss) {
    GroupedNames said;
    for (const std::size_t run : names_.order()) {
      if (names_.is_ours(run) || !names_.is_common(run)) continue;
      const Diagnosis* worst = worst_of(all_, run, [&](const Diagnosis& found) {
        return found.topic == kEnergyDrifts && (found.value < 0) == is_loss;
      });
      if (!worst) continue;
      const auto of_case = std::find_if(results_.cases.begin(), results_.cases.end(), [&](const CaseResult& result) {
        return result.definition.id == worst->of_case;
      });
      Claim duration{"duration", worst->of_case, "", "", "", of_case->definition.duration};
      said.add(names_.of(run),
               fmt::format(
                   " {} on {} in {}{}",
                   claims_.percent(claim(*worst, is_loss ? "worst energy loss" : "worst energy gain", worst->value)),
                   worst->of_case, claims_.printed(duration, fmt::format("{:g} s", duration.value)), cause_of(*worst)));
    }
    return said.text();
  }

  const Results& results_;
  const RunNames& names_;
  StepSize dt_;
  std::vector<Diagnosis> all_;
  Claims claims_;
};

}  // namespace

std::optional<Finding> energy_finding(const Results& results, const RunNames& names, const StepSize& dt) {
  return EnergyFinding(results, names, dt).finding();
}

std::optional<Finding> sampling_finding(const Results& results, const RunNames& names, const StepSize& dt) {
  const std::vector<Diagnosis> all = diagnoses(results, dt);
  const auto is_misread = [](const Diagnosis& found) { return found.topic == kEnergyMisread; };
  GroupedNames said;
  std::vector<std::string> cases;
  Claims claims;
  for (const std::size_t run : names.order()) {
    if (names.is_ours(run) || !names.is_common(run)) continue;
    for (const Diagnosis& found : all) {
      if (found.runs.front() == run && is_misread(found) &&
          std::find(cases.begin(), cases.end(), found.of_case) == cases.end())
        cases.push_back(found.of_case);
    }
    const Diagnosis* worst = worst_of(all, run, is_misread);
    if (!worst) continue;
    const auto claim = [&](const std::string& quantity, double value) {
      return Claim{quantity, worst->of_case, names.of(run), dt.text, "", value};
    };
    said.add(names.of(run),
             fmt::format(" {} as read, {} at one instant ({})", claims.percent(claim("worst sampling", worst->value)),
                         claims.percent(claim("energy_drift_synchronised", worst->beside)), worst->of_case));
  }
  if (said.empty()) return std::nullopt;
  return Finding{
      "sampling", fmt::format("Energy drift that is only sampling, at dt = {} s: {}.", dt.text, said.text()),
      fmt::format("A semi-implicit step leaves velocities half a step behind positions. At a bounce or a turn "
                  "energy then seems lost or gained. Cases: {}.",
                  fmt::join(cases, ", ")),
      claims.take()};
}

}  // namespace rigor::inline report
