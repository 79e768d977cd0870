#include "cases/report/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "cases/metrics/work_precision.h"
#include "cases/report/console_table.h"
#include "cases/report/explanation.h"
#include "cases/report/verdict_matrix.h"

namespace rigor {
namespace {

// A metric with its sign, or not a number.
double value_of(const std::map<std::string, MetricValue>& metrics, const std::string& name) {
  const auto found = metrics.find(name);
  if (found == metrics.end() || !found->second.not_applicable.empty()) return std::nan("");
  const MetricValue& metric = found->second;
  return std::copysign(metric.value, metric.worst.found - metric.worst.expected);
}

// Names in a sentence, the first few of them.
std::string listed_names(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i ? ", " : "") + names[i];
  return names.size() > most ? text + fmt::format(" and {} more", names.size() - most) : text;
}

// "a, b in 2 of 3; c in 1 of 3": those that the same is said of stand together, in the order they came.
class Sayings {
 public:
  void add(const std::string& name, const std::string& what) {
    const auto said = std::find_if(said_.begin(), said_.end(), [&](const auto& s) { return s.first == what; });
    said == said_.end() ? said_.push_back({what, name}) : void(said->second += ", " + name);
  }
  bool empty() const { return said_.empty(); }
  std::string text() const {
    std::string text;
    for (const auto& [what, names] : said_) text += (text.empty() ? "" : "; ") + names + what;
    return text;
  }

 private:
  std::vector<std::pair<std::string, std::string>> said_;  // what, of whom
};

// The largest dt that keeps an error in bounds; 0 if no dt that was tried, or can be extrapolated to, does.
struct StepNeeded {
  double seconds = 0;
  bool is_extrapolated = false;
  bool operator<(const StepNeeded& other) const { return seconds < other.seconds; }
};

// Read off the straight line, in logarithms, through the cells; beyond the finest of them off the line through the last
// two, if the error falls there at all and no further than a factor of 30.
StepNeeded step_for(std::vector<ErrorPoint> points, double error) {
  constexpr double kFurthest = 30, kFalls = 0.5;  // order
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.dt.seconds > b.dt.seconds; });
  std::size_t i = 0;
  while (i < points.size() && !(points[i].error <= error)) ++i;
  const bool is_beyond = i == points.size();
  if (is_beyond && i == 1) return {};
  if (is_beyond) --i;
  if (i == 0 || !(points[i].error > 0)) return {points[i].dt.seconds, false};
  const double slope =
      std::log(points[i - 1].error / points[i].error) / std::log(points[i - 1].dt.seconds / points[i].dt.seconds);
  const double seconds = points[i].dt.seconds * std::pow(error / points[i].error, 1 / slope);
  if (is_beyond && !(slope >= kFalls && seconds * kFurthest >= points[i].dt.seconds)) return {};
  return {seconds, is_beyond};
}

class Finder {
 public:
  explicit Finder(const Results& results) : results_(results), dt_(headline_dt(results)) {}

  std::vector<Finding> all() {
    say_who_blows_up();
    say_who_holds_stiff_springs();
    say_what_a_millimetre_takes();
    say_where_energy_goes();
    say_whose_friction_is_a_pyramid();
    say_what_is_unexplained();
    return found_;
  }

 private:
  // Cells at the headline step that ran, each with its case.
  template <typename F>
  void for_cells(std::size_t run, const F& f) const {
    for (const CaseResult& result : results_.cases) {
      for (const Cell& cell : result.cells) {
        if (cell.run == run && cell.dt.seconds == dt_.seconds && !cell.metrics.empty()) f(result, cell);
      }
    }
  }

  void say(const std::string& topic, const std::string& text) { found_.push_back({topic, text}); }

  bool is_ours(std::size_t run) const { return results_.runs[run].engine == "core"; }

  // Engines that are not ours first: they are what a reader has come for.
  std::vector<std::size_t> runs() const {
    std::vector<std::size_t> order(results_.runs.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_partition(order.begin(), order.end(), [&](std::size_t run) { return !is_ours(run); });
    return order;
  }

  void say_who_blows_up() {
    std::vector<std::string> steady;
    Sayings lost;
    for (const std::size_t run : runs()) {
      std::vector<std::string> blown;
      std::size_t ran = 0;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        ++ran;
        if (cell.stability.verdict == Verdict::blown_up) blown.push_back(result.definition.id);
      });
      const std::string& name = results_.runs[run].text;
      if (blown.empty() && 2 * ran > results_.cases.size()) steady.push_back(name);
      if (blown.empty()) continue;
      lost.add(name, fmt::format(" in {} of {}", blown.size(), ran) +
                         (is_ours(run) ? "" : fmt::format(" ({})", listed_names(blown, 3))));
    }
    if (lost.empty() && !steady.empty()) say("stability", fmt::format("At dt = {} s nothing blows up.", dt_.text));
    if (lost.empty()) return;
    std::string text = fmt::format("At dt = {} s these blow up: {}.", dt_.text, lost.text());
    if (!steady.empty()) text += fmt::format(" Never: {}.", listed_names(steady, 5));
    say("stability", text);
  }

  // Springs are stiff for a step once omega dt comes near the 2 at which a semi-implicit step loses every oscillation.
  void say_who_holds_stiff_springs() {
    constexpr double kStiff = 1;  // omega dt
    std::vector<const CaseResult*> stiff;
    for (const CaseResult& result : results_.cases) {
      if (stiffest_frequency(result.definition.scene) * dt_.seconds >= kStiff) stiff.push_back(&result);
    }
    std::vector<std::string> ids, stable, drifting;
    Sayings lost;
    for (const CaseResult* result : stiff) ids.push_back(result->definition.id);
    for (const std::size_t run : runs()) {
      std::size_t ran = 0, blown = 0, drifts = 0;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        if (std::find(stiff.begin(), stiff.end(), &result) == stiff.end()) return;
        ++ran;
        blown += cell.stability.verdict == Verdict::blown_up, drifts += cell.stability.verdict == Verdict::drifting;
      });
      if (ran == 0 || 2 * ran < stiff.size()) continue;
      const std::string& name = results_.runs[run].text;
      if (blown > 0) lost.add(name, fmt::format(" in {} of {}", blown, ran));
      if (blown == 0) (drifts > 0 ? drifting : stable).push_back(name);
    }
    if (stable.empty() && drifting.empty() && lost.empty()) return;
    constexpr std::size_t kAll = 12;  // of a question that is asked of each engine
    const auto list = [&](const std::vector<std::string>& names) {
      return names.empty() ? std::string("none") : listed_names(names, kAll);
    };
    std::string text =
        fmt::format("Where springs are stiff for dt = {} s, omega dt above {:g} ({}), these stay stable: {}.", dt_.text,
                    kStiff, listed_names(ids, 4), list(stable));
    if (!drifting.empty()) text += fmt::format(" Bounded, but drifting: {}.", list(drifting));
    if (!lost.empty()) text += fmt::format(" Blown up: {}.", lost.text());
    say("stiff springs", text);
  }

  // For each engine that is not ours: where its mean energy falls most, and where it rises most, without blowing up.
  void say_where_energy_goes() {
    for (const bool is_loss : {true, false}) {
      std::map<std::string, std::vector<std::string>> said;  // who, by what is said of them
      for (const std::size_t run : runs()) {
        const std::string text = is_ours(run) ? "" : worst_drift(run, is_loss);
        if (!text.empty()) said[text].push_back(results_.runs[run].text);
      }
      for (const auto& [text, names] : said) {
        const std::string verb = is_loss ? " lose" : " gain";
        say("energy", listed_names(names, 4) + verb + (names.size() == 1 ? "s " : " ") + text);
      }
    }
  }

  std::string worst_drift(std::size_t run, bool is_loss) const {
    const CaseResult* worst_case = nullptr;
    const Cell* worst = nullptr;
    double largest = 0.01;  // of the largest kinetic energy: what is less is not worth a sentence
    for_cells(run, [&](const CaseResult& result, const Cell& cell) {
      const double drift = value_of(cell.metrics, kDrift);
      if (cell.stability.verdict != Verdict::drifting || std::isnan(drift) || (drift < 0) != is_loss) return;
      if (std::abs(drift) > largest) largest = std::abs(drift), worst = &cell, worst_case = &result;
    });
    if (!worst) return "";
    return fmt::format("{} % of the energy of {} within {:g} s at dt = {} s{}", rounded(100 * largest),
                       worst_case->definition.id, worst_case->definition.duration, dt_.text,
                       cause_of(*worst, is_loss ? -largest : largest));
  }

  static std::string cause_of(const Cell& cell, double drift) {
    constexpr double kAlike = 0.01, kGone = 0.1;
    const double scheme = value_of(cell.scheme.metrics, kDrift),
                 without = value_of(cell.scheme.without_gyroscopic_term, kDrift);
    if (std::isnan(scheme)) return ", the most of all its cases.";
    if (std::abs(drift - scheme) > kAlike * std::abs(drift))
      return fmt::format("; of that the scheme explains {:.2g} %.", 100 * scheme / drift);
    if (std::abs(without) < kGone * std::abs(drift)) return "; all of it is the gyroscopic part of the scheme.";
    return "; all of it is the scheme: the core, repeating it, comes to the same.";
  }

  // Two friction forces along fixed axes, each limited by itself, brake along the diagonal with sqrt(2) of the force:
  // distances to a stop then spread by 1 - 1/sqrt(2) = 0.29 over the directions. A cone has no spread.
  void say_whose_friction_is_a_pyramid() {
    constexpr double kPyramid = 0.2, kCone = 0.05;
    std::vector<std::string> pyramids, cones, others;
    std::string where;
    for (const std::size_t run : runs()) {
      double worst = -1;
      for_cells(run, [&](const CaseResult& result, const Cell& cell) {
        const double spread = std::abs(value_of(cell.metrics, "friction_anisotropy"));
        if (cell.stability.verdict != Verdict::blown_up && spread > worst) worst = spread, where = result.definition.id;
      });
      if (worst < 0) continue;
      const std::string spread = fmt::format("{} ({:.0f} %)", results_.runs[run].text, 100 * worst);
      if (worst < kCone) {
        cones.push_back(results_.runs[run].text);
      } else {
        (worst >= kPyramid ? pyramids : others).push_back(spread);
      }
    }
    if (pyramids.empty() && cones.empty() && others.empty()) return;
    const std::string none = "none";
    std::string text = fmt::format(
        "Friction is a pyramid, braking harder along its diagonals, with: {}; a cone, as Coulomb's, with: {}",
        pyramids.empty() ? none : listed_names(pyramids, 6), cones.empty() ? none : listed_names(cones, 6));
    if (!others.empty()) text += fmt::format("; uneven, but no pyramid, with: {}", listed_names(others, 6));
    say("friction",
        text + fmt::format(". The per cent are how distances to a stop spread over directions ({}, dt = {} s).", where,
                           dt_.text));
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
    std::vector<std::pair<StepNeeded, std::string>> needs;
    for (const std::size_t run : runs()) {
      std::vector<StepNeeded> steps;
      for (const CaseResult& result : results_.cases) {
        const std::string metric = main_error(result);
        const auto points = error_points(result, run, metric);
        if (!metric.starts_with("energy") && !points.empty()) steps.push_back(step_for(points, kMillimetre));
      }
      if (steps.empty() || steps.size() * 2 < results_.cases.size()) continue;  // too few to speak of a middle one
      std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
      needs.emplace_back(steps[steps.size() / 2], results_.runs[run].text);
    }
    if (needs.empty()) return;
    std::stable_sort(needs.begin(), needs.end(), [](const auto& a, const auto& b) { return b.first < a.first; });
    std::vector<std::string> enough, too_few;
    for (const auto& [step, name] : needs) {
      const bool is_known = step.seconds > 0;
      (is_known ? enough : too_few)
          .push_back(is_known ? fmt::format("{} {}{:.2g} s", name, step.is_extrapolated ? "~" : "", step.seconds)
                              : name);
    }
    std::string text =
        "To stay within 1 mm of the truth, or 1 mrad where nothing moves away, takes in the middle one of the cases a "
        "dt of: ";
    text += enough.empty() ? "less than was tried with any of them" : fmt::format("{}", fmt::join(enough, ", "));
    if (!enough.empty() && !too_few.empty())
      text += fmt::format("; less than was tried with {}", fmt::join(too_few, ", "));
    say("step size", text + ".");
  }

  static constexpr const char* kDrift = "energy_drift";
  const Results& results_;
  StepSize dt_;
  std::vector<Finding> found_;
};

}  // namespace

std::vector<Finding> findings(const Results& results) { return Finder(results).all(); }

StepSize headline_dt(const Results& results) {
  constexpr double kHeadline = 1.0 / 30;
  StepSize coarsest{0, ""};
  for (const CaseResult& result : results.cases) {
    for (const StepSize& step : result.definition.dt) {
      if (std::abs(step.seconds - kHeadline) < 1e-12) return step;
      if (step.seconds > coarsest.seconds) coarsest = step;
    }
  }
  return coarsest;
}

}  // namespace rigor
