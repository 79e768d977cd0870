#include "cases/report/wording/findings/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cases/analysis/energy_diagnosis.h"
#include "cases/analysis/step_needed.h"
#include "cases/analysis/stiffest_frequency.h"
#include "cases/analysis/work_precision.h"
#include "cases/report/wording/findings/energy_finding.h"
#include "cases/report/wording/findings/impacts_finding.h"
#include "cases/report/wording/findings/joints_finding.h"
#include "cases/report/wording/run_names.h"
#include "cases/report/wording/verdict_matrix.h"
#include "cases/report/wording/wording.h"
#include "cases/results/main_error.h"

namespace rigor {
namespace {

// 0.0031 s as 3.1 ms.
std::string milliseconds(double seconds) { return fmt::format("{:.2g} ms", 1e3 * seconds); }

class Finder {
 public:
  explicit Finder(const Results& results) : results_(results), names_(results), dt_(headline_dt(results)) {}

  std::vector<Finding> all() {
    say_who_holds_stiff_springs();
    say_what_a_millimetre_takes();
    add(energy_finding(results_, names_, dt_));
    say_whose_friction_is_a_pyramid();
    add(impacts_finding(results_, names_.order()));
    add(joints_finding(results_, names_.order(), dt_));
    say_who_blows_up();
    add(sampling_finding(results_, names_, dt_));
    say_what_is_unexplained();
    return found_;
  }

 private:
  // Cells at the headline step that ran, each with its case.
  template <typename F>
  void for_cells(std::size_t run, const F& f) const {
    for (const CaseResult& result : results_.cases) {
      for (const Cell& cell : result.cells) {
        if (cell.run == run && cell.dt == dt_ && !cell.metrics.empty()) f(result, cell);
      }
    }
  }

  void say(const std::string& topic, const std::string& text, const std::string& more = "") {
    found_.push_back({topic, text, more});
  }

  void add(std::optional<Finding> finding) {
    if (finding) found_.push_back(std::move(*finding));
  }

  // What is said of each that failed; of ours likewise, or only how many of them did.
  std::string losers(GroupedNames theirs, const GroupedNames& text_of_ours, const std::vector<std::size_t>& ours,
                     std::size_t all_ours) const {
    ours.size() > RunNames::kFewOfOurs ? theirs.add(names_.brief(ours, all_ours), " in some")
                                       : theirs.add(text_of_ours);
    return theirs.text();
  }

  void say_who_blows_up() {
    std::vector<std::size_t> steady, ours;
    GroupedNames lost, of_ours, where;
    for (const std::size_t run : names_.order()) {
      std::vector<std::string> blown;
      std::size_t ran = 0;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        ++ran;
        if (cell.stability.verdict == Verdict::blown_up) blown.push_back(result.definition.id);
      });
      if (blown.empty() && 2 * ran > results_.cases.size()) steady.push_back(run);
      if (blown.empty()) continue;
      if (names_.is_ours(run)) ours.push_back(run);
      (names_.is_ours(run) ? of_ours : lost).add(names_.of(run), fmt::format(" in {} of {}", blown.size(), ran));
      where.add(names_.of(run), fmt::format(" in {}", listed_names(blown, 6)));
    }
    const std::size_t all_ours = names_.ours_among(steady) + ours.size();
    if (where.empty() && !steady.empty()) say("stability", fmt::format("At dt = {} s nothing blows up.", dt_.text));
    if (where.empty()) return;
    say("stability",
        fmt::format("At dt = {} s these blow up: {}. Never: {}.", dt_.text, losers(lost, of_ours, ours, all_ours),
                    names_.brief(steady, all_ours)),
        fmt::format("Blown up: {}. Never: {}.", where.text(), names_.all(steady)));
  }

  // Springs are stiff for a step once omega dt comes near the 2 at which a semi-implicit step loses every oscillation.
  void say_who_holds_stiff_springs() {
    constexpr double kStiff = 1;  // omega dt
    std::vector<const CaseResult*> stiff;
    for (const CaseResult& result : results_.cases) {
      if (stiffest_frequency(result.definition.scene) * dt_.seconds >= kStiff) stiff.push_back(&result);
    }
    std::vector<std::string> ids;
    std::vector<std::size_t> stable, drifting, ours;
    GroupedNames lost, of_ours;
    for (const CaseResult* result : stiff) ids.push_back(result->definition.id);
    for (const std::size_t run : names_.order()) {
      std::size_t ran = 0, blown = 0, drifts = 0;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        if (std::find(stiff.begin(), stiff.end(), &result) == stiff.end()) return;
        ++ran;
        blown += cell.stability.verdict == Verdict::blown_up, drifts += cell.stability.verdict == Verdict::drifting;
      });
      if (ran == 0 || 2 * ran < stiff.size()) continue;
      if (blown > 0)
        (names_.is_ours(run) ? of_ours : lost).add(names_.of(run), fmt::format(" in {} of {}", blown, ran));
      if (blown > 0 && names_.is_ours(run)) ours.push_back(run);
      if (blown == 0) (drifts > 0 ? drifting : stable).push_back(run);
    }
    if (stable.empty() && drifting.empty() && lost.empty() && of_ours.empty()) return;
    const std::size_t all_ours = names_.ours_among(stable) + names_.ours_among(drifting) + ours.size();
    const auto listed = [&](const auto& list) {
      std::string text = "Stable: " + list(stable) + ".";
      if (!drifting.empty()) text += " Bounded, but drifting: " + list(drifting) + ".";
      return text;
    };
    std::string text = fmt::format("At dt = {} s on springs with omega dt above {:g}. ", dt_.text, kStiff) +
                       listed([&](const auto& runs) { return names_.brief(runs, all_ours); });
    std::string more = listed([&](const auto& runs) { return names_.all(runs); });
    const std::string blown = losers(lost, of_ours, ours, all_ours);
    lost.add(of_ours);
    if (!lost.empty()) text += fmt::format(" Blown up: {}.", blown), more += fmt::format(" Blown up: {}.", lost.text());
    say("stiff springs", text, more + fmt::format(" The cases: {}.", fmt::join(ids, ", ")));
  }

  // Two friction forces along fixed axes, each limited by itself, brake along the diagonal with sqrt(2) of the force:
  // distances to a stop then spread by 1 - 1/sqrt(2) = 0.29 over the directions. A cone has no spread.
  void say_whose_friction_is_a_pyramid() {
    constexpr double kPyramid = 0.2, kCone = 0.05;
    std::vector<std::size_t> cones;
    std::vector<std::string> pyramids, others;
    std::string where;
    for (const std::size_t run : names_.order()) {
      double worst = -1;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        const double spread = std::abs(signed_value(cell.metrics, "friction_anisotropy"));
        if (cell.stability.verdict != Verdict::blown_up && spread > worst) worst = spread, where = result.definition.id;
      });
      if (worst < 0) continue;
      const std::string spread = fmt::format("{} ({:.0f} %)", names_.of(run), 100 * worst);
      if (worst < kCone) {
        cones.push_back(run);
      } else {
        (worst >= kPyramid ? pyramids : others).push_back(spread);
      }
    }
    if (pyramids.empty() && cones.empty() && others.empty()) return;
    constexpr std::size_t kMost = 6;
    std::string text = fmt::format("A pyramid, braking harder along its diagonals: {}. A cone, as Coulomb's: {}.",
                                   pyramids.empty() ? "none" : listed_names(pyramids, kMost),
                                   names_.brief(cones, names_.ours_among(cones)));
    if (!others.empty()) text += fmt::format(" Uneven, but no pyramid: {}.", listed_names(others, kMost));
    say("friction", text,
        fmt::format("The per cent are how distances to a stop spread over directions ({}, dt = {} s). Cones: {}.",
                    where, dt_.text, names_.all(cones)));
  }

  void say_what_is_unexplained() {
    double largest = 0;
    std::string where;
    int compared = 0;
    for (std::size_t run = 0; run < results_.runs.size(); ++run) {
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        const double rest = std::abs(signed_value(cell.metrics, "unexplained_error"));
        if (cell.scheme.twin.empty() || std::isnan(rest) || cell.stability.verdict == Verdict::blown_up) return;
        ++compared;
        if (rest > largest) largest = rest, where = results_.runs[run].text + " on " + result.definition.id;
      });
    }
    if (compared == 0) return;
    say("unexplained",
        fmt::format("Beside {} runs the core repeated the engine's own scheme: the largest position error that this "
                    "leaves unexplained is {:.2g} m{}.",
                    compared, largest, where.empty() ? "" : ", by " + where));
  }

  void say_what_a_millimetre_takes() {
    constexpr double kMillimetre = 1e-3;  // m, or rad
    std::vector<std::pair<StepNeeded, std::size_t>> needs;
    for (const std::size_t run : names_.order()) {
      std::vector<StepNeeded> steps;
      for (const CaseResult& result : results_.cases) {
        const std::string metric = main_error(result);
        const auto points = error_points(result, run, metric);
        if (!metric.starts_with("energy") && !points.empty()) steps.push_back(step_for(points, kMillimetre));
      }
      if (steps.empty() || steps.size() * 2 < results_.cases.size()) continue;  // too few to speak of a middle one
      std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
      needs.emplace_back(steps[steps.size() / 2], run);
    }
    if (needs.empty()) return;
    std::stable_sort(needs.begin(), needs.end(), [](const auto& a, const auto& b) { return b.first < a.first; });
    std::vector<std::string> ours, others;
    for (const auto& [step, run] : needs) {
      const std::string taken =
          step.seconds > 0 ? (step.is_extrapolated ? "~" : "") + milliseconds(step.seconds) : "less than was tried";
      (names_.is_ours(run) ? ours : others).push_back(fmt::format("{} {}", names_.of(run), taken));
    }
    std::string text = "dt for 1 mm, in the middle one of the cases: ", more;
    text += fmt::format("{}", fmt::join(others, ", "));
    if (!ours.empty()) text += (others.empty() ? "" : "; ") + ours.front();
    if (ours.size() > 1) text += fmt::format(", the best of the core's {} methods", ours.size());
    if (!ours.empty()) more = fmt::format(" Ours: {}.", fmt::join(ours, ", "));
    say("step size", text + ".",
        "The largest step that stays within 1 mm of the truth, or 1 mrad where nothing moves away; ~ is extrapolated "
        "below the steps that were tried." +
            more);
  }

  const Results& results_;
  RunNames names_;
  StepSize dt_;
  std::vector<Finding> found_;
};

}  // namespace

std::vector<Finding> findings(const Results& results) { return Finder(results).all(); }

StepSize headline_dt(const Results& results) {
  const StepSize headline{1.0 / 30, "1/30"};
  StepSize coarsest{0, ""};
  for (const CaseResult& result : results.cases) {
    for (const StepSize& step : result.definition.dt) {
      if (step == headline) return step;
      if (step.seconds > coarsest.seconds) coarsest = step;
    }
  }
  return coarsest;
}

}  // namespace rigor
