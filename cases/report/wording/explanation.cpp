#include "cases/report/wording/explanation.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "cases/analysis/energy_diagnosis.h"
#include "cases/analysis/stiffest_frequency.h"
#include "cases/report/wording/contact_explanation.h"
#include "cases/report/wording/ensemble_explanation.h"
#include "cases/report/wording/joint_explanation.h"

namespace rigor {
namespace {

const MethodInfo& method_of_run(const Results& results, std::size_t run) {
  for (const EngineInfo& engine : results.engines) {
    if (engine.name == results.runs[run].engine) return method_of(engine, results.runs[run].settings);
  }
  throw std::logic_error("a run of an engine that is not in the table");
}

// Explicit Euler is the only method that the literature's growth factor below holds for.
bool is_explicit_euler(const MethodInfo& method) { return method.name == "explicit-euler"; }

class Explainer {
 public:
  Explainer(const Results& results, const CaseResult& result)
      : results_(results), result_(result), omega_(stiffest_frequency(result.definition.scene)) {
    for (const StepSize& step : result.definition.dt) dt_ = step.seconds > dt_.seconds ? step : dt_;
  }

  std::vector<std::string> sentences() {
    if (omega_ > 0) explain_springs();
    if (omega_ == 0) explain_falling_too_far();
    explain_raw_energy();
    explain_gyroscopic_loss();
    explain_cut_searches();
    explain_verdicts();
    return sentences_;
  }

 private:
  template <typename F>
  void for_headline_cells(const F& f) const {
    for (const Cell& cell : result_.cells) {
      if (cell.dt == dt_ && !cell.metrics.empty()) f(cell, method_of_run(results_, cell.run));
    }
  }
  std::string name_of(const Cell& cell) const { return results_.runs[cell.run].text; }

  static void append(std::string& list, const std::string& word) { list += (list.empty() ? "" : ", ") + word; }

  void explain_springs() {
    const double phase = omega_ * dt_.seconds;
    std::string explicit_ones, others;
    for_headline_cells([&](const Cell& cell, const MethodInfo& method) {
      if (cell.stability.verdict != Verdict::blown_up) return;
      append(is_explicit_euler(method) ? explicit_ones : others, name_of(cell));
    });
    if (explicit_ones.empty() && others.empty()) return;
    std::string text = fmt::format(
        "Why: the stiffest oscillation of these springs has omega = {:.3g} rad/s, so omega dt = "
        "{:.2g} at dt = {} s.",
        omega_, phase, dt_.text);
    if (!explicit_ones.empty()) {
      text += fmt::format(
          " The explicit Euler step ({}) multiplies the energy of such an oscillation by 1 + (omega dt)^2 = {:.3g} in "
          "every step, that "
          "is {:.1e} times in a second; without damping a smaller dt slows that growth but never ends it.",
          explicit_ones, 1 + phase * phase, std::pow(1 + phase * phase, 1 / dt_.seconds));
    }
    if (!others.empty() && phase > 2) {
      text += fmt::format(" {} passed omega dt = 2, where a semi-implicit step loses every oscillation.", others);
    } else if (!others.empty()) {
      text += fmt::format(
          " {} blew up below omega dt = 2: large swings turn the springs and are stiffer than small ones.", others);
    }
    sentences_.push_back(text + semi_implicit_bound());
  }

  // The theory's bound for a semi-implicit step, and the best that one of those measured came to.
  std::string semi_implicit_bound() const {
    std::string measured;
    double largest = 0;
    for_headline_cells([&](const Cell& cell, const MethodInfo& method) {
      const StableStepResult& stable = result_.stable_steps[cell.run];
      if (method.leapfrog_stagger == 0 || stable.status != Status::pass || stable.step.is_cap || stable.step.is_floor)
        return;
      if (stable.step.dt <= largest) return;
      largest = stable.step.dt;
      measured =
          fmt::format("; {} kept these swings, which are not small, up to dt = {:.2g} s", name_of(cell), largest);
    });
    return fmt::format(" A semi-implicit step keeps small swings bounded while omega dt < 2, that is dt < {:.2g} s{}.",
                       2 / omega_, measured);
  }

  // In free fall a first-order step that takes the new velocity falls g/2 dt t too far, one that takes the old one as
  // much too short.
  void explain_falling_too_far() {
    const double expected = 0.5 * result_.definition.scene.gravity.norm() * dt_.seconds;  // m after 1 s
    if (expected == 0 || result_.definition.duration < 1) return;
    std::string list;
    for_headline_cells([&](const Cell& cell, const MethodInfo& method) {
      const auto found = cell.metrics.find("position_error");
      if (method.order != 1 || found == cell.metrics.end() || !found->second.not_applicable.empty()) return;
      const bool is_it = std::abs(found->second.first_second - expected) < 0.01 * expected;
      if (is_it) append(list, name_of(cell));
    });
    if (list.empty()) return;
    sentences_.push_back(
        fmt::format("Why: a first-order step takes one velocity for the whole of dt and misses a fall by "
                    "g/2 dt t, that is {:.3g} m after 1 s at dt = {} s: {}.",
                    expected, dt_.text, list));
  }

  void explain_raw_energy() {
    std::string list;
    for_headline_cells([&](const Cell& cell, const MethodInfo& method) {
      const auto raw = cell.metrics.find("energy_drift"), synchronised = cell.metrics.find("energy_drift_synchronised");
      if (method.leapfrog_stagger == 0 || cell.stability.verdict == Verdict::blown_up) return;
      if (raw == cell.metrics.end() || synchronised == cell.metrics.end()) return;
      if (!raw->second.not_applicable.empty() || !synchronised->second.not_applicable.empty()) return;
      constexpr double kNotable = 1e-3;
      if (raw->second.value > 3 * synchronised->second.value && raw->second.value > kNotable)
        append(list, name_of(cell));
    });
    if (list.empty()) return;
    sentences_.push_back(
        fmt::format("Raw energy drift is mostly sampling for {}: a semi-implicit step leaves the velocity "
                    "half a step from the position; sync brings both to one instant.",
                    list));
  }

  // Energy that the engine and its twin lose or gain alike, and that the twin keeps once its gyroscopic term is off.
  void explain_gyroscopic_loss() {
    constexpr double kNotable = 0.01, kAlike = 1e-3, kGone = 0.1;
    std::map<std::string, std::string> names;  // by what is said of them
    for_headline_cells([&](const Cell& cell, const MethodInfo&) {
      const double engine = signed_value(cell.metrics, "energy_drift"),
                   scheme = signed_value(cell.scheme.metrics, "energy_drift"),
                   without = signed_value(cell.scheme.without_gyroscopic_term, "energy_drift"),
                   momentum = signed_value(cell.scheme.without_gyroscopic_term, "angular_momentum_drift");
      const bool is_it = std::abs(engine) > kNotable && std::abs(engine - scheme) < kAlike * std::abs(engine) &&
                         std::abs(without) < kGone * std::abs(engine);
      if (!is_it) return;
      const std::string wrong =
          std::isnan(momentum)
              ? ""
              : fmt::format(", but its angular momentum strays by {:.2g} kg m^2/s", std::abs(momentum));
      append(
          names[fmt::format("energy changes by {:+.3g} %, and so does that of the scheme alone, repeated by the core: "
                            "it is the gyroscopic term's doing. Without that term the same step keeps the energy to "
                            "{:.1g} %{}.",
                            100 * engine, 100 * std::abs(without), wrong)],
          name_of(cell));
    });
    for (const auto& [text, engines] : names) sentences_.push_back(fmt::format("Why: {}: {}", engines, text));
  }

  // What the words "overlapping", "gaining" and "collapsed" stand on.
  void explain_cut_searches() {
    std::map<std::string, std::string> engines;  // by what was left out
    for (std::size_t run = 0; run < result_.stable_steps.size(); ++run) {
      const StableStepResult& stable = result_.stable_steps[run];
      if (stable.status != Status::pass || stable.step.cut.empty()) continue;
      std::string& names = engines[stable.step.cut];
      names += (names.empty() ? "" : ", ") + results_.runs[run].text;
    }
    for (const auto& [what, names] : engines)
      sentences_.push_back(fmt::format("The largest stable step of {}: {}.", names, what));
  }

  void explain_verdicts() {
    for_headline_cells([&](const Cell& cell, const MethodInfo&) {
      const Verdict verdict = cell.stability.verdict;
      if (verdict == Verdict::stable || verdict == Verdict::drifting || verdict == Verdict::blown_up) return;
      sentences_.push_back(fmt::format("{} is {}: {}.", name_of(cell), word_of(verdict), cell.stability.why));
    });
  }

  const Results& results_;
  const CaseResult& result_;
  double omega_;
  StepSize dt_{0, ""};
  std::vector<std::string> sentences_;
};

}  // namespace

std::vector<std::string> explanations(const Results& results, const CaseResult& result) {
  std::vector<std::string> sentences = Explainer(results, result).sentences();
  for (std::string& sentence : contact_explanations(results, result)) sentences.push_back(std::move(sentence));
  for (std::string& sentence : joint_explanations(results, result)) sentences.push_back(std::move(sentence));
  for (std::string& sentence : ensemble_explanations(results, result)) sentences.push_back(std::move(sentence));
  return sentences;
}

}  // namespace rigor
