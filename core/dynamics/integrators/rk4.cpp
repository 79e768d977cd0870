// The classical fourth-order Runge–Kutta method on (x, q, v, L):
//   x' = v,  q' = (0, w) q / 2,  v' = F/m,  L' = tau,  with w from L and q at every stage.
// The quaternion's length is not kept by the stages: rotations use its direction, and the step ends with a unit one.
#include <array>

#include "core/dynamics/integrators/integrator.h"

namespace rigor {
namespace {

struct Rates {
  Vec3 position, velocity, momentum;
  Eigen::Vector4d orientation;  // (x, y, z, w), Eigen's order
};

struct BodyMotion {
  Vec3 position, velocity, momentum;  // L in W
  Eigen::Vector4d orientation;
};

class Rk4 : public Stepper {
 public:
  explicit Rk4(const StepperParts& parts)
      : parts_(parts), start_(parts.system.size()), sum_(parts.system.size()), stage_(parts.system.size()) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    if (parts_.contact) {
      parts_.system.wrenches(state, t, dt, wrenches_);
      resolve_ahead(*parts_.contact, parts_.system, wrenches_, dt, state);
    }
    for (std::size_t i = 0; i < state.size(); ++i) start_[i] = motion_of(state, i);
    constexpr std::array<double, 4> kWeight = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    constexpr std::array<double, 4> kNextStage = {0.5, 0.5, 1, 0};
    stage_ = BodyColumns(state);
    for (std::size_t s = 0; s < kWeight.size(); ++s) {
      parts_.system.wrenches(stage_.columns(), t, dt, wrenches_);
      for (std::size_t i = 0; i < state.size(); ++i) {
        const Rates rates = rates_of(i);
        if (s == 0) sum_[i] = start_[i];
        add(sum_[i], dt * kWeight[s], rates);
        BodyMotion next = start_[i];
        add(next, dt * kNextStage[s], rates);
        write(next, i, stage_.columns());
      }
    }
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (!parts_.system.bodies[i].fixed) write(sum_[i], i, state);
    }
  }

 private:
  BodyMotion motion_of(BodyColumns state, std::size_t i) const {
    return {state.position(i), state.velocity(i),
            angular_momentum_of(parts_.system.bodies[i], state.rotation(i), state.angular_velocity(i)),
            state.orientation(i).coeffs()};
  }

  Rates rates_of(std::size_t i) const {
    const BodyColumns stage = stage_.columns();
    const Vec3 w = stage.angular_velocity(i);
    const Quat spin = Quat(0, 0.5 * w.x(), 0.5 * w.y(), 0.5 * w.z()) * stage.orientation(i);
    return {stage.velocity(i), parts_.system.bodies[i].inverse_mass * wrenches_[i].force, wrenches_[i].torque,
            spin.coeffs()};
  }

  static void add(BodyMotion& motion, double h, const Rates& rates) {
    motion.position += h * rates.position;
    motion.velocity += h * rates.velocity;
    motion.momentum += h * rates.momentum;
    motion.orientation += h * rates.orientation;
  }

  void write(const BodyMotion& motion, std::size_t i, MutableBodyColumns out) const {
    const Quat q = Quat(motion.orientation).normalized();
    out.set_position(i, motion.position);
    out.set_velocity(i, motion.velocity);
    out.set_orientation(i, q);
    out.set_angular_velocity(i, angular_velocity_of(parts_.system.bodies[i], matrix_of(q), motion.momentum));
  }

  StepperParts parts_;
  std::vector<BodyMotion> start_, sum_;
  BodyTable stage_;
  Wrenches wrenches_;
};

}  // namespace

extern const Integrator kRk4;
const Integrator kRk4 = {
    .name = "rk4",
    .summary = "the classical Runge-Kutta method, four evaluations a step",
    .order = 4,
    .symplectic = false,
    .velocity_lag = 0,
    .default_orientation = "",
    .make = make_stepper<Rk4>,
};

}  // namespace rigor
