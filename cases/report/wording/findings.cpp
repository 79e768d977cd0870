#include "cases/report/wording/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "cases/analysis/step_needed.h"
#include "cases/analysis/work_precision.h"
#include "cases/metrics/measures/energy_series.h"
#include "cases/report/wording/explanation.h"
#include "cases/report/wording/impacts_finding.h"
#include "cases/report/wording/joints_finding.h"
#include "cases/report/wording/verdict_matrix.h"
#include "cases/report/wording/wording.h"

namespace rigor {
namespace {

// A metric with its sign, or not a number.
double value_of(const std::map<std::string, MetricValue>& metrics, const std::string& name) {
  const auto found = metrics.find(name);
  if (found == metrics.end() || !found->second.not_applicable.empty()) return std::nan("");
  const MetricValue& metric = found->second;
  return std::copysign(metric.value, metric.worst.found - metric.worst.expected);
}

// 0.0031 s as 3.1 ms.
std::string milliseconds(double seconds) { return fmt::format("{:.2g} ms", 1e3 * seconds); }

class Finder {
 public:
  explicit Finder(const Results& results) : results_(results), dt_(headline_dt(results)) {}

  std::vector<Finding> all() {
    say_who_holds_stiff_springs();
    say_what_a_millimetre_takes();
    say_where_energy_goes();
    say_whose_friction_is_a_pyramid();
    if (const auto impacts = impacts_finding(results_, runs())) found_.push_back(*impacts);
    if (const auto joints = joints_finding(results_, runs(), dt_)) found_.push_back(*joints);
    say_who_blows_up();
    say_what_sampling_does();
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

  bool is_ours(std::size_t run) const { return is_in_house(results_, run); }
  const std::string& name_of(std::size_t run) const { return results_.runs[run].text; }

  // Whether it is more than a run that a case or two ask for.
  bool is_common(std::size_t run) const {
    const auto is_its = [run](const Cell& cell) { return cell.run == run; };
    return 2 * std::count_if(results_.cases.begin(), results_.cases.end(),
                             [&](const CaseResult& result) {
                               return std::any_of(result.cells.begin(), result.cells.end(), is_its);
                             }) >=
           std::ssize(results_.cases);
  }

  std::string names(const std::vector<std::size_t>& runs) const {
    std::vector<std::string> names;
    for (const std::size_t run : runs) names.push_back(name_of(run));
    return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
  }

  // In few words: our own methods, of which `all_ours` were asked, are counted where they are many.
  std::string brief(const std::vector<std::size_t>& runs, std::size_t all_ours) const {
    std::vector<std::size_t> named;
    std::copy_if(runs.begin(), runs.end(), std::back_inserter(named), [&](std::size_t run) { return !is_ours(run); });
    const std::size_t ours = runs.size() - named.size();
    if (ours <= kFewOfOurs) return names(runs);
    const std::string count = ours == all_ours ? fmt::format("all {} of the core's methods", ours)
                                               : fmt::format("{} of the core's {} methods", ours, all_ours);
    return named.empty() ? count : names(named) + ", " + count;
  }

  // What is said of each that failed; of ours likewise, or only how many of them did.
  std::string losers(GroupedNames theirs, const GroupedNames& text_of_ours, const std::vector<std::size_t>& ours,
                     std::size_t all_ours) const {
    ours.size() > kFewOfOurs ? theirs.add(brief(ours, all_ours), " in some") : theirs.add(text_of_ours);
    return theirs.text();
  }

  std::size_t ours_among(const std::vector<std::size_t>& runs) const {
    return static_cast<std::size_t>(
        std::count_if(runs.begin(), runs.end(), [&](std::size_t run) { return is_ours(run); }));
  }

  // Engines that are not ours first: they are what a reader has come for.
  std::vector<std::size_t> runs() const {
    std::vector<std::size_t> order(results_.runs.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_partition(order.begin(), order.end(), [&](std::size_t run) { return !is_ours(run); });
    return order;
  }

  void say_who_blows_up() {
    std::vector<std::size_t> steady, ours;
    GroupedNames lost, of_ours, where;
    for (const std::size_t run : runs()) {
      std::vector<std::string> blown;
      std::size_t ran = 0;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        ++ran;
        if (cell.stability.verdict == Verdict::blown_up) blown.push_back(result.definition.id);
      });
      if (blown.empty() && 2 * ran > results_.cases.size()) steady.push_back(run);
      if (blown.empty()) continue;
      if (is_ours(run)) ours.push_back(run);
      (is_ours(run) ? of_ours : lost).add(name_of(run), fmt::format(" in {} of {}", blown.size(), ran));
      where.add(name_of(run), fmt::format(" in {}", listed_names(blown, 6)));
    }
    const std::size_t all_ours = ours_among(steady) + ours.size();
    if (where.empty() && !steady.empty()) say("stability", fmt::format("At dt = {} s nothing blows up.", dt_.text));
    if (where.empty()) return;
    say("stability",
        fmt::format("At dt = {} s these blow up: {}. Never: {}.", dt_.text, losers(lost, of_ours, ours, all_ours),
                    brief(steady, all_ours)),
        fmt::format("Blown up: {}. Never: {}.", where.text(), names(steady)));
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
    for (const std::size_t run : runs()) {
      std::size_t ran = 0, blown = 0, drifts = 0;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        if (std::find(stiff.begin(), stiff.end(), &result) == stiff.end()) return;
        ++ran;
        blown += cell.stability.verdict == Verdict::blown_up, drifts += cell.stability.verdict == Verdict::drifting;
      });
      if (ran == 0 || 2 * ran < stiff.size()) continue;
      if (blown > 0) (is_ours(run) ? of_ours : lost).add(name_of(run), fmt::format(" in {} of {}", blown, ran));
      if (blown > 0 && is_ours(run)) ours.push_back(run);
      if (blown == 0) (drifts > 0 ? drifting : stable).push_back(run);
    }
    if (stable.empty() && drifting.empty() && lost.empty() && of_ours.empty()) return;
    const std::size_t all_ours = ours_among(stable) + ours_among(drifting) + ours.size();
    const auto listed = [&](const auto& list) {
      std::string text = "Stable: " + list(stable) + ".";
      if (!drifting.empty()) text += " Bounded, but drifting: " + list(drifting) + ".";
      return text;
    };
    std::string text = fmt::format("At dt = {} s on springs with omega dt above {:g}. ", dt_.text, kStiff) +
                       listed([&](const auto& runs) { return brief(runs, all_ours); });
    std::string more = listed([&](const auto& runs) { return names(runs); });
    const std::string blown = losers(lost, of_ours, ours, all_ours);
    lost.add(of_ours);
    if (!lost.empty()) text += fmt::format(" Blown up: {}.", blown), more += fmt::format(" Blown up: {}.", lost.text());
    say("stiff springs", text, more + fmt::format(" The cases: {}.", fmt::join(ids, ", ")));
  }

  // For each engine that is not ours: where its mean energy falls most, and where it rises most, without blowing up.
  void say_where_energy_goes() {
    std::string sentences[2];  // of losses, of gains
    for (const bool is_loss : {true, false}) {
      std::map<std::string, std::vector<std::size_t>> said;  // who, by what is said of them
      for (const std::size_t run : runs()) {
        const std::string text = is_ours(run) || !is_common(run) ? "" : worst_drift(run, is_loss);
        if (!text.empty()) said[text].push_back(run);
      }
      for (const auto& [text, who] : said) {
        std::string& all = sentences[is_loss ? 0 : 1];
        const std::string verb = is_loss ? " lose" : " gain";
        all += (all.empty() ? "" : " ") + names(who) + verb + (who.size() == 1 ? "s " : " ") + text;
      }
    }
    if (sentences[0].empty()) std::swap(sentences[0], sentences[1]);
    const std::string where = fmt::format("Energy at dt = {} s: ", dt_.text);
    if (!sentences[0].empty()) say("energy", where + sentences[0], sentences[1]);
  }

  // Only where nothing is meant to take or give energy.
  std::string worst_drift(std::size_t run, bool is_loss) const {
    const CaseResult* worst_case = nullptr;
    const Cell* worst = nullptr;
    double largest = 0.01;  // of the largest kinetic energy: what is less is not worth a sentence
    for_cells(run, [&](const CaseResult& result, const Cell& cell) {
      const double drift = value_of(cell.metrics, kDrift);
      if (may_change_energy(result.definition.scene)) return;
      const Verdict verdict = cell.stability.verdict;
      if (verdict != Verdict::drifting && verdict != Verdict::gaining) return;
      if (std::isnan(drift) || (drift < 0) != is_loss) return;
      if (std::abs(drift) > largest) largest = std::abs(drift), worst = &cell, worst_case = &result;
    });
    if (!worst) return "";
    return fmt::format("{} % of that of {} in {:g} s{}", rounded(100 * largest), worst_case->definition.id,
                       worst_case->definition.duration, cause_of(*worst, is_loss ? -largest : largest));
  }

  static std::string cause_of(const Cell& cell, double drift) {
    constexpr double kAlike = 0.01, kGone = 0.1;
    const double scheme = value_of(cell.scheme.metrics, kDrift),
                 without = value_of(cell.scheme.without_gyroscopic_term, kDrift);
    if (std::isnan(scheme)) return ", its most.";
    if (std::abs(drift - scheme) > kAlike * std::abs(drift))
      return fmt::format(", {:.2g} % of it by the scheme.", 100 * scheme / drift);
    if (std::abs(without) < kGone * std::abs(drift)) return ", all by the gyroscopic part of the scheme.";
    return ", all by the scheme: the core, repeating it, comes to the same.";
  }

  // Two friction forces along fixed axes, each limited by itself, brake along the diagonal with sqrt(2) of the force:
  // distances to a stop then spread by 1 - 1/sqrt(2) = 0.29 over the directions. A cone has no spread.
  void say_whose_friction_is_a_pyramid() {
    constexpr double kPyramid = 0.2, kCone = 0.05;
    std::vector<std::size_t> cones;
    std::vector<std::string> pyramids, others;
    std::string where;
    for (const std::size_t run : runs()) {
      double worst = -1;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        const double spread = std::abs(value_of(cell.metrics, "friction_anisotropy"));
        if (cell.stability.verdict != Verdict::blown_up && spread > worst) worst = spread, where = result.definition.id;
      });
      if (worst < 0) continue;
      const std::string spread = fmt::format("{} ({:.0f} %)", name_of(run), 100 * worst);
      if (worst < kCone) {
        cones.push_back(run);
      } else {
        (worst >= kPyramid ? pyramids : others).push_back(spread);
      }
    }
    if (pyramids.empty() && cones.empty() && others.empty()) return;
    constexpr std::size_t kMost = 6;
    std::string text =
        fmt::format("A pyramid, braking harder along its diagonals: {}. A cone, as Coulomb's: {}.",
                    pyramids.empty() ? "none" : listed_names(pyramids, kMost), brief(cones, ours_among(cones)));
    if (!others.empty()) text += fmt::format(" Uneven, but no pyramid: {}.", listed_names(others, kMost));
    say("friction", text,
        fmt::format("The per cent are how distances to a stop spread over directions ({}, dt = {} s). Cones: {}.",
                    where, dt_.text, names(cones)));
  }

  // Energy that seems to come and go because velocities are read half a step apart from positions.
  void say_what_sampling_does() {
    constexpr double kNotable = 0.01, kKept = 0.01;  // of the largest kinetic energy: as read, and in truth
    std::map<std::string, std::vector<std::size_t>> said;
    std::vector<std::string> cases;
    for (const std::size_t run : runs()) {
      if (is_ours(run) || !is_common(run)) continue;
      double largest = kNotable, then = 0;
      std::string where;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        const double raw = std::abs(value_of(cell.metrics, kDrift)),
                     synchronised = std::abs(value_of(cell.metrics, "energy_drift_synchronised"));
        if (cell.stability.verdict == Verdict::blown_up || !(synchronised < kKept) || !(raw > kNotable)) return;
        const std::string& id = result.definition.id;
        if (std::find(cases.begin(), cases.end(), id) == cases.end()) cases.push_back(id);
        if (raw > largest) largest = raw, then = synchronised, where = id;
      });
      if (where.empty()) continue;
      said[fmt::format("in {} it strays by {} % as read, by {} % with both at one instant", where,
                       rounded(100 * largest), rounded(100 * then))]
          .push_back(run);
    }
    if (said.empty()) return;
    std::string text = "Energy as read misleads where velocities are half a step from positions";
    for (const auto& [what, who] : said) text += "; " + names(who) + ": " + what;
    say("sampling", text + ".",
        fmt::format(
            "A semi-implicit step leaves the velocity half a step behind: at every bounce or turn the energy of "
            "g dt/2 seems lost or gained, and is only read at the wrong instant. So it is, for one engine or "
            "another, in {}.",
            fmt::join(cases, ", ")));
  }

  void say_what_is_unexplained() {
    double largest = 0;
    std::string where;
    int compared = 0;
    for (std::size_t run = 0; run < results_.runs.size(); ++run) {
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        const double rest = std::abs(value_of(cell.metrics, "unexplained_error"));
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
    for (const std::size_t run : runs()) {
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
      (is_ours(run) ? ours : others).push_back(fmt::format("{} {}", name_of(run), taken));
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

  static constexpr const char* kDrift = "energy_drift";
  static constexpr std::size_t kFewOfOurs = 3;  // methods of ours that a sentence may name
  const Results& results_;
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
