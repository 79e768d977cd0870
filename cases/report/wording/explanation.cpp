#include "cases/report/wording/explanation.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "cases/report/wording/contact_explanation.h"
#include "cases/report/wording/ensemble_explanation.h"
#include "cases/report/wording/joint_explanation.h"

namespace rigor {
namespace {

// What a spring's unit pull does to one of its bodies: a force and a torque, both in W.
struct Pull {
  int body;
  Vec3 force, torque;
};

std::vector<std::vector<Pull>> pulls_of(const Scene& scene) {
  const auto point_in_world = [&](int body, const Vec3& point) {
    return body == kWorld ? point : Vec3(scene.bodies[body].position + scene.bodies[body].orientation * point);
  };
  std::vector<std::vector<Pull>> pulls;
  for (const Spring& spring : scene.springs) {
    const Vec3 a = point_in_world(spring.a, spring.point_a), b = point_in_world(spring.b, spring.point_b);
    const Vec3 line = (b - a).normalized() * std::sqrt(spring.stiffness);
    auto& row = pulls.emplace_back();
    for (const auto& [body, point, force] : {std::tuple(spring.a, a, Vec3(-line)), std::tuple(spring.b, b, line)}) {
      if (body == kWorld || scene.bodies[body].fixed) continue;
      row.push_back({body, force, (point - scene.bodies[body].position).cross(force)});
    }
  }
  return pulls;
}

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
      constexpr double kWorthSaying = 1e-3;
      if (raw->second.value > 3 * synchronised->second.value && raw->second.value > kWorthSaying)
        append(list, name_of(cell));
    });
    if (list.empty()) return;
    sentences_.push_back(
        fmt::format("Raw energy drift is mostly sampling for {}: a semi-implicit step leaves the velocity "
                    "half a step from the position; sync brings both to one instant.",
                    list));
  }

  // A drift with its sign, if there is one; else not a number.
  static double signed_drift(const std::map<std::string, MetricValue>& metrics, const std::string& name) {
    const auto found = metrics.find(name);
    if (found == metrics.end() || !found->second.not_applicable.empty()) return std::nan("");
    return std::copysign(found->second.value, found->second.worst.found - found->second.worst.expected);
  }

  // Energy that the engine and its twin lose or gain alike, and that the twin keeps once its gyroscopic term is off.
  void explain_gyroscopic_loss() {
    constexpr double kWorthSaying = 0.01, kAlike = 1e-3, kGone = 0.1;
    std::map<std::string, std::string> names;  // by what is said of them
    for_headline_cells([&](const Cell& cell, const MethodInfo&) {
      const double engine = signed_drift(cell.metrics, "energy_drift"),
                   scheme = signed_drift(cell.scheme.metrics, "energy_drift"),
                   without = signed_drift(cell.scheme.without_gyroscopic_term, "energy_drift"),
                   momentum = signed_drift(cell.scheme.without_gyroscopic_term, "angular_momentum_drift");
      const bool is_it = std::abs(engine) > kWorthSaying && std::abs(engine - scheme) < kAlike * std::abs(engine) &&
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

double stiffest_frequency(const Scene& scene) {
  const auto pulls = pulls_of(scene);
  const std::size_t count = scene.bodies.size();
  // The power method on K^½ J M⁻¹ Jᵀ K^½, one entry a spring; 300 rounds settle the digits that a sentence shows.
  std::vector<double> mode(pulls.size());
  for (std::size_t i = 0; i < mode.size(); ++i) mode[i] = 1 + 0.1 * std::sin(1.0 + i);  // along no symmetry
  double eigenvalue = 0;
  for (int round = 0; round < 300 && !mode.empty(); ++round) {
    std::vector<Vec3> linear(count, Vec3::Zero()), angular(count, Vec3::Zero());
    for (std::size_t i = 0; i < pulls.size(); ++i) {
      for (const Pull& pull : pulls[i])
        linear[pull.body] += mode[i] * pull.force, angular[pull.body] += mode[i] * pull.torque;
    }
    for (std::size_t b = 0; b < count; ++b) {
      const Body& body = scene.bodies[b];
      if (linear[b].isZero(0) && angular[b].isZero(0)) continue;
      linear[b] /= body.mass;
      angular[b] = body.orientation * (body.inertia.inverse() * (body.orientation.conjugate() * angular[b]));
    }
    double norm = 0;
    for (std::size_t i = 0; i < pulls.size(); ++i) {
      mode[i] = 0;
      for (const Pull& pull : pulls[i])
        mode[i] += pull.force.dot(linear[pull.body]) + pull.torque.dot(angular[pull.body]);
      norm += mode[i] * mode[i];
    }
    eigenvalue = std::sqrt(norm);
    if (!(eigenvalue > 0)) return 0;
    for (double& entry : mode) entry /= eigenvalue;
  }
  return std::sqrt(eigenvalue);
}

}  // namespace rigor
