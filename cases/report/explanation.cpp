#include "cases/report/explanation.h"

#include <fmt/format.h>

#include <cmath>

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
    return sentences_;
  }

 private:
  template <typename F>
  void for_headline_cells(const F& f) const {
    for (const Cell& cell : result_.cells) {
      if (cell.dt.seconds == dt_.seconds && !cell.metrics.empty()) f(cell, method_of_run(results_, cell.run));
    }
  }
  std::string name_of(const Cell& cell) const { return results_.runs[cell.run].text; }

  void explain_springs() {
    const double phase = omega_ * dt_.seconds;
    std::string explicit_ones, others, stable_ones;
    for_headline_cells([&](const Cell& cell, const MethodInfo& method) {
      const StableStepResult& stable = result_.stable_steps[cell.run];
      if (cell.stability.verdict == Verdict::blown_up) {
        std::string& list = is_explicit_euler(method) ? explicit_ones : others;
        list += (list.empty() ? "" : ", ") + name_of(cell);
      } else if (stable.status == Status::pass && !stable.step.is_cap && stable_ones.empty()) {
        stable_ones = fmt::format("{}, say, keeps it up to dt = {:.2g} s here (omega dt = {:.2g})", name_of(cell),
                                  stable.step.dt, omega_ * stable.step.dt);
      }
    });
    if (explicit_ones.empty() && others.empty()) return;
    std::string text = fmt::format(
        "Why: the stiffest oscillation of these springs has omega = {:.3g} rad/s, so omega dt = "
        "{:.2g} at dt = {} s.",
        omega_, phase, dt_.text);
    if (!explicit_ones.empty()) {
      text += fmt::format(
          " {} multiplies such an oscillation's energy by 1 + (omega dt)^2 = {:.3g} in every step, {:.2g} "
          "times in a second, and by more than 1 at any dt without damping: a smaller dt only delays the end.",
          explicit_ones, 1 + phase * phase, std::pow(1 + phase * phase, 1 / dt_.seconds));
    }
    if (!others.empty() && phase > 2) {
      text +=
          fmt::format(" {} passed omega dt = 2, beyond which a semi-implicit step loses every oscillation.", others);
    } else if (!others.empty()) {
      text +=
          fmt::format(" {} blew up although omega dt is below 2: large swings stiffen what small ones show.", others);
    }
    text += fmt::format(
        " A semi-implicit step bounds the energy of small swings while omega dt < 2, that is dt < {:.2g} s.",
        2 / omega_);
    sentences_.push_back(stable_ones.empty() ? text : text + " " + stable_ones + ".");
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
      if (is_it) list += (list.empty() ? "" : ", ") + name_of(cell);
    });
    if (list.empty()) return;
    sentences_.push_back(
        fmt::format("Why: a first-order step takes one velocity for the whole of dt and misses a fall by "
                    "g/2 dt t, that is {:.3g} m after 1 s at dt = {} s: {}.",
                    expected, dt_.text, list));
  }

  void explain_raw_energy() {
    for_headline_cells([&](const Cell& cell, const MethodInfo& method) {
      const auto raw = cell.metrics.find("energy_drift"), synchronised = cell.metrics.find("energy_drift_synchronised");
      if (said_raw_ || method.velocity_lag == 0 || raw == cell.metrics.end() || synchronised == cell.metrics.end())
        return;
      if (cell.stability.verdict == Verdict::blown_up || !synchronised->second.not_applicable.empty()) return;
      if (!(raw->second.value > 3 * synchronised->second.value && raw->second.value > 1e-3)) return;
      said_raw_ = true;
      sentences_.push_back(
          "Raw energy takes a position and a velocity that a semi-implicit step leaves half a step apart; "
          "most of that drift is sampling. The sync column brings both to the same instant.");
    });
  }

  const Results& results_;
  const CaseResult& result_;
  double omega_;
  StepSize dt_{0, ""};
  bool said_raw_ = false;
  std::vector<std::string> sentences_;
};

}  // namespace

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
