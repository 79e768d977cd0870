// The steps of Simbody 3.7's integrators for free bodies and trees of joints, for comparison with Simbody itself. q and
// u are its coordinates and speeds (simbody_coordinates.h), f is u' at a state, and N maps u to q':
//   explicit-euler       q1 = q0 + h N(q0) u0,   u1 = u0 + h f0
//   semi-explicit-euler  u1 = u0 + h f0,         q1 = q0 + h N(q0) u1
//   verlet               q1 = q0 + h q0' + h²/2 q0'',  u1 = u0 + h/2 (f0 + f(q1, u1)) by iteration from u0 + h f0
//   rk2, rk3, merson     explicit Runge-Kutta methods on (q, u)
// Quaternions are added to as any other coordinate, and made unit at the end of a step. Loads are asked at each stage.
#include "adapters/simbody/simbody_twin.h"

#include <algorithm>
#include <limits>

#include "adapters/simbody/simbody_coordinates.h"
#include "core/engine/body_column.h"

namespace rigor::inline adapters {
namespace {

using Vector = Eigen::VectorXd;

// A step on (q, u); it asks for the needed data of the bodies.
class SimbodyTwin : public Stepper {
 public:
  explicit SimbodyTwin(const StepperParts& parts)
      : system_(parts.system), coordinates_(*parts.scene, parts.system), bodies_(parts.system.size()) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    for (int c = 0; c < kRotation; ++c)
      std::copy_n(state.column(c), state.size(), bodies_.columns().column(c));  // where fixed bodies are
    system_.loads.for_each_smooth_part(t, dt, [&](double from, double length) {
      from_ = from, length_ = length;
      SimbodyCoordinates::State now = coordinates_.state_of(state);
      advance(now, length);
      coordinates_.normalise(now.q);
      coordinates_.place(now, state);
    });
  }

  void archive_state(StateArchive&) override {}  // nothing outlives a step

 protected:
  using State = SimbodyCoordinates::State;
  virtual void advance(State& state, double h) = 0;

  Vector q_rate(const Vector& q, const Vector& u) const { return coordinates_.q_rate(q, u); }
  Vector u_rate(const State& state) {
    coordinates_.place(state, bodies_.columns());
    system_.wrenches(bodies_.columns(), from_, length_, wrenches_);
    return coordinates_.u_rate(wrenches_);
  }
  const SimbodyCoordinates& coordinates() const { return coordinates_; }

 private:
  const System& system_;
  SimbodyCoordinates coordinates_;
  BodyTable bodies_;
  Wrenches wrenches_;
  double from_ = 0, length_ = 0;  // s
};

class ExplicitEulerTwin : public SimbodyTwin {
 public:
  using SimbodyTwin::SimbodyTwin;

 private:
  void advance(State& state, double h) override {
    const Vector f = u_rate(state);
    state.q += h * q_rate(state.q, state.u);
    state.u += h * f;
  }
};

class SemiExplicitEulerTwin : public SimbodyTwin {
 public:
  using SimbodyTwin::SimbodyTwin;

 private:
  void advance(State& state, double h) override {
    state.u += h * u_rate(state);
    state.q += h * q_rate(state.q, state.u);
  }
};

// The iteration ends like Simbody's (VerletIntegrator.cpp): if u changes by at most 1e-4 of itself, after ten
// iterations, or if a later iteration than the second changes more than the one before.
class VerletTwin : public SimbodyTwin {
 public:
  using SimbodyTwin::SimbodyTwin;
  std::string solver_warning() const override {
    return converged_ ? "" : "the iteration for the velocities at the step's end did not converge";
  }

 private:
  void advance(State& state, double h) override {
    const Vector u = state.u, f = u_rate(state);
    state.q += h * q_rate(state.q, u) + h * h / 2 * coordinates().q_second_rate(state, f);
    state.u += h * f;
    coordinates().normalise(state.q);
    converged_ = false;
    double last = std::numeric_limits<double>::infinity();
    for (int turn = 0; turn < 10 && !converged_; ++turn) {
      const Vector before = state.u;
      state.u = u + h / 2 * (f + u_rate(state));
      const double change = (state.u - before).norm() / before.norm();
      converged_ = change <= 1e-4;
      if (turn > 1 && change > last) break;
      last = change;
    }
  }

  bool converged_ = true;
};

struct Tableau {
  std::vector<std::vector<double>> stages;  // the weights of earlier rates, for each stage but the first
  std::vector<double> weights;
};
const Tableau kTrapezoid = {{{1}}, {0.5, 0.5}};
const Tableau kKutta3 = {{{0.5}, {-1, 2}}, {1.0 / 6, 2.0 / 3, 1.0 / 6}};
const Tableau kMerson = {{{1.0 / 3}, {1.0 / 6, 1.0 / 6}, {1.0 / 8, 0, 3.0 / 8}, {0.5, 0, -1.5, 2}},
                         {1.0 / 6, 0, 0, 2.0 / 3, 1.0 / 6}};

template <const Tableau& tableau>
class RungeKuttaTwin : public SimbodyTwin {
 public:
  using SimbodyTwin::SimbodyTwin;

 private:
  void advance(State& state, double h) override {
    std::vector<State> rates = {{q_rate(state.q, state.u), u_rate(state)}};
    const auto at = [&](const std::vector<double>& shares) {
      State sum = state;
      for (std::size_t i = 0; i < shares.size(); ++i)
        sum.q += h * shares[i] * rates[i].q, sum.u += h * shares[i] * rates[i].u;
      return sum;
    };
    for (const std::vector<double>& shares : tableau.stages) {
      const State stage = at(shares);
      rates.push_back({q_rate(stage.q, stage.u), u_rate(stage)});
    }
    state = at(tableau.weights);
  }
};

Integrator row(const std::string& method, int order, std::unique_ptr<Stepper> (*make)(const StepperParts&)) {
  return {.name = "simbody-" + method + "-twin",
          .summary = "repeats Simbody's own step, to explain its error",
          .order = order,
          .symplectic = false,
          .leapfrog_stagger = method == "semi-explicit-euler" ? 0.5
                              : method == "explicit-euler"    ? -0.5
                                                              : 0,
          .default_orientation = "",
          .takes_contact = false,
          .takes_joints = true,
          .lacks = {joint_feature<DistanceJoint>(), Feature::joint_limit, Feature::joint_loop, Feature::joint_friction,
                    Feature::motor_servo, Feature::motor_speed},
          .twin_of = "simbody",
          .make = make};
}

}  // namespace

std::vector<Integrator> simbody_twins() {
  return {row("explicit-euler", 1, make_stepper<ExplicitEulerTwin>),
          row("merson", 4, make_stepper<RungeKuttaTwin<kMerson>>),
          row("rk2", 2, make_stepper<RungeKuttaTwin<kTrapezoid>>),
          row("rk3", 3, make_stepper<RungeKuttaTwin<kKutta3>>),
          row("semi-explicit-euler", 1, make_stepper<SemiExplicitEulerTwin>),
          row("verlet", 2, make_stepper<VerletTwin>)};
}

}  // namespace rigor::inline adapters
