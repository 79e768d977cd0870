#include "cases/analysis/small_motions/oscillator_growth.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "adapters/engines.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"
#include "core/engine/run_name.h"

namespace rigor::inline analysis {
namespace {

using State = Eigen::Vector2d;  // frequency times the coordinate (or the coordinate, without a spring), and its speed

// Small, so that a state that grows by orders is still linear: a hinge turns by little, a spring keeps its line.
constexpr double kSmallStart = 1e-9;
constexpr double kLinearRange = 0.1;  // m, rad: beyond it the motion is no longer linear

// One oscillator as a scene: a body of unit mass and inertia. A spring hangs on x = 0, its body at 1 m.
class OneOscillator {
 public:
  OneOscillator(const Engine& engine, const Settings& settings, ForceElement::Kind kind, const Oscillator& oscillator)
      : engine_(engine), settings_(settings), kind_(kind), oscillator_(oscillator) {}

  Scene scene(const State& start) const {
    Scene scene;
    Body body;
    body.name = "body";
    const double x = start[0] / scale(), stiffness = oscillator_.frequency * oscillator_.frequency;
    const Vec3 along(1, 0, 0), about(0, 0, 1);
    if (kind_ == ForceElement::Kind::hinge) {
      body.orientation = Quat(Eigen::AngleAxisd(x, about)), body.angular_velocity = start[1] * about;
    } else {
      body.position = (x + (kind_ == ForceElement::Kind::spring ? 1 : 0)) * along, body.velocity = start[1] * along;
    }
    if (kind_ == ForceElement::Kind::spring) {
      scene.springs.push_back({kWorld, 0, Vec3::Zero(), Vec3::Zero(), stiffness, oscillator_.rate, 1});
    } else {
      Joint joint{.a = kWorld, .b = 0, .type = SliderJoint{along}};
      if (kind_ == ForceElement::Kind::hinge) joint.type = HingeJoint{Vec3::Zero(), about};
      // A joint's coordinate counts from the start.
      joint.stiffness = stiffness, joint.damping = oscillator_.rate, joint.rest = -x;
      scene.joints.push_back(joint);
    }
    scene.bodies.push_back(body);
    return scene;
  }

  // The states after each step, the start first, as long as they are linear.
  std::vector<State> states(const State& start, double dt, int steps) const {
    const auto world = engine_.load(scene(start), settings_);
    std::vector<State> all = {start};
    Snapshot now;
    for (int step = 0; step < steps; ++step) {
      world->step(dt), world->read(now);
      const State state = read(now.bodies());
      if (!state.allFinite() || std::max(std::abs(state[0] / scale()), dt * std::abs(state[1])) > kLinearRange) break;
      all.push_back(state);
    }
    return all;
  }

 private:
  double scale() const { return oscillator_.frequency > 0 ? oscillator_.frequency : 1; }

  State read(BodyColumns bodies) const {
    if (kind_ == ForceElement::Kind::hinge) {
      const Quat q = bodies.orientation(0);
      return {scale() * 2 * std::atan2(q.vec().z(), q.w()), bodies.angular_velocity(0).z()};
    }
    const double x = bodies.position(0).x() - (kind_ == ForceElement::Kind::spring ? 1 : 0);
    return {scale() * x, bodies.velocity(0).x()};
  }

  const Engine& engine_;
  const Settings& settings_;
  ForceElement::Kind kind_;
  Oscillator oscillator_;
};

// One step from each of two states, the larger the more exact, as long as the step is linear.
std::optional<Eigen::Matrix2d> first_step(const OneOscillator& oscillator, double dt) {
  for (const double start : {1e-3, 1e-5, 1e-7}) {
    const auto first = oscillator.states(start * State::Unit(0), dt, 1),
               second = oscillator.states(start * State::Unit(1), dt, 1);
    if (first.size() < 2 || second.size() < 2) continue;
    Eigen::Matrix2d matrix;
    matrix << first[1] / start, second[1] / start;
    return matrix;
  }
  return {};
}

// The matrix of a one-step method. Nothing if a longer run does not follow it, as of a method that remembers earlier
// steps, or if no step is linear.
std::optional<Eigen::Matrix2d> step_matrix(const OneOscillator& oscillator, double dt) {
  constexpr double kFollows = 1e-5;  // the small start has 1e-7 of rounding beside a place of 1 m
  constexpr int kStepsTaken = 40;
  const auto matrix = first_step(oscillator, dt);
  if (!matrix) return {};
  const auto states = oscillator.states(kSmallStart * State(1, 1), dt, kStepsTaken);
  for (std::size_t n = 1; n < states.size(); ++n) {
    const State expected = *matrix * states[n - 1];
    if ((states[n] - expected).norm() > kFollows * std::max({states[n].norm(), states[n - 1].norm(), kSmallStart}))
      return {};
  }
  return matrix;
}

// Per step: from the largest energy about the first quarter of a run to the largest at its end.
double measured_growth(const std::vector<State>& states) {
  const std::size_t count = states.size(), window = std::max<std::size_t>(1, count / 8), from = count / 4;
  const auto largest = [&](std::size_t first) {
    const auto begin = states.begin() + static_cast<std::ptrdiff_t>(first);
    return std::max_element(begin, begin + static_cast<std::ptrdiff_t>(window),
                            [](const State& a, const State& b) { return a.norm() < b.norm(); });
  };
  const auto early = largest(from), late = largest(count - window);
  if (!(early->norm() > 0) || late <= early) return 0;
  return std::pow(late->squaredNorm() / early->squaredNorm(), 1 / static_cast<double>(late - early));
}

}  // namespace

std::optional<double> energy_growth(const std::string& core_run, ForceElement::Kind kind, const Oscillator& oscillator,
                                    double dt) {
  constexpr int kStepsTaken = 800;
  try {
    const RunName run = parse_run_name(core_run, engines().infos());
    if (!engines().info_of(run.engine).is_in_house) return {};
    const OneOscillator one(engines().find(run.engine), run.settings, kind, oscillator);
    const Scene scene = one.scene(State(0, kSmallStart));
    if (!why_unsupported(engines().info_of(run.engine), run.settings, scene, dt).empty()) return {};
    if (const auto matrix = step_matrix(one, dt)) {
      const double radius = matrix->eigenvalues().cwiseAbs().maxCoeff();
      return radius * radius;
    }
    const auto states = one.states(kSmallStart * State(0, 1), dt, kStepsTaken);
    if (states.size() < 4) return {};
    return measured_growth(states);
  } catch (const InputError&) {
    return {};
  } catch (const EngineFailure&) {
    return {};
  }
}

}  // namespace rigor::inline analysis
