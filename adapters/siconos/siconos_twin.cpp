// Siconos's coordinates are position x and quaternion p, B to W, and u = (v in W, w in B), with M u' = f(t, x, p, u),
// of which -w x I w is a part. A step solves
//   M (u1 - u0) = h (theta f1 + (1 - theta) f0),
//   x1 = x0 + h (theta v1 + (1 - theta) v0),   p1 = p0 exp(h (theta w1 + (1 - theta) w0))
// solved by Newton's method for u. The derivative leaves out the coupling between bodies, and positions lag one
// iteration behind (MoreauJeanOSI.cpp; Acary and Brogliato, Numerical Methods for Nonsmooth Dynamical Systems, 2008,
// chapter 10).
#include "adapters/siconos/siconos_twin.h"

#include <Eigen/LU>
#include <cmath>

#include "adapters/common/option_values.h"
#include "adapters/siconos/siconos_options.h"
#include "adapters/siconos/siconos_slope.h"

namespace rigor::inline adapters {
namespace {

// The inverse of the map from w in B to the state's; for a quaternion longer than 1 it is no rotation.
Vec3 in_body(BodyColumns state, std::size_t i) {
  const Quat q = state.orientation(i);
  Mat3 turn;
  turn << q * Vec3::UnitX(), q * Vec3::UnitY(), q * Vec3::UnitZ();
  return turn.partialPivLu().solve(state.angular_velocity(i));
}

// For small angles Siconos takes the ratio sin(x)/x from the series of the tangent (RotationQuaternion.cpp: sin_x). A
// rotation of less than 2e-3 rad in a step is then too large by an eighth of its third power. The quaternion grows,
// because it is not normalised.
Quat exponential(const Vec3& turn) {
  constexpr double kSmall = 1e-3;  // rad
  const double half = 0.5 * turn.norm();
  if (half > kSmall) return rotation_by(turn);
  const double s = half * half;
  const double over = 1 + s * (1.0 / 3 + s * (2.0 / 15 + s * (17.0 / 315 + s * 62.0 / 2835)));
  const Vec3 part = 0.5 * over * turn;
  return Quat(std::cos(half), part.x(), part.y(), part.z());
}

class SiconosTwin : public Stepper {
 public:
  explicit SiconosTwin(const StepperParts& parts)
      : system_(parts.system), theta_(number_option(parts.settings, kSiconosThetaOption)) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    system_.loads.for_each_smooth_part(t, dt, [&](double from, double length) { step_part(state, from, length); });
  }
  void archive_state(StateArchive&) override {}  // nothing outlives a step

 private:
  // Timed loads are constant over the step.
  void step_part(MutableBodyColumns state, double t, double dt) {
    const double middle = t + 0.5 * dt;
    start_ = BodyColumns(state);
    system_.wrenches(state, middle, 0, wrenches_);
    starts_.resize(state.size());
    for (std::size_t i = 0; i < state.size(); ++i) {
      const Vec3 w = in_body(state, i);
      starts_[i] = {w, forces_of(state, i, w)};
    }
    for (std::size_t i = 0; i < state.size(); ++i) place(state, i, starts_[i].w, dt);
    for (int pass = 0; pass < kSiconosPasses; ++pass) {
      system_.wrenches(state, middle, 0, wrenches_);
      load_slopes(system_.loads, state, wrenches_, middle, theta_ * dt, slopes_);
      for (std::size_t i = 0; i < state.size(); ++i) improve(state, i, dt);
    }
  }

  struct Forces {
    Vec3 force, moment;  // N, in W; N m, in B, with the gyroscopic one
  };
  struct Start {
    Vec3 w;  // rad/s, in B
    Forces forces;
  };

  Forces forces_of(BodyColumns state, std::size_t i, const Vec3& w) const {
    return {wrenches_[i].force,
            state.orientation(i).conjugate() * wrenches_[i].torque - w.cross(system_.bodies[i].inertia_B * w)};
  }

  void improve(MutableBodyColumns state, std::size_t i, double dt) const {
    const Inertia& body = system_.bodies[i];
    if (body.fixed) return;
    const Vec3 w = in_body(state, i);
    const Forces begin = starts_[i].forces, end = forces_of(state, i, w);
    Vec6 residual;
    residual << body.mass * (state.velocity(i) - start_.columns().velocity(i)) -
                    dt * (theta_ * end.force + (1 - theta_) * begin.force),
        body.inertia_B * (w - starts_[i].w) - dt * (theta_ * end.moment + (1 - theta_) * begin.moment);
    Mat6 matrix = -theta_ * dt * slopes_[i];
    matrix.topLeftCorner<3, 3>() += body.mass * Mat3::Identity();
    matrix.bottomRightCorner<3, 3>() +=
        body.inertia_B + theta_ * dt * (cross_matrix(w) * body.inertia_B - cross_matrix(body.inertia_B * w));
    const Vec6 change = matrix.partialPivLu().solve(residual);
    state.set_velocity(i, state.velocity(i) - change.head<3>());
    place(state, i, w - change.tail<3>(), dt);
  }

  // The position from the velocity, and the turn from the angular velocity w in B, which then is the body's.
  void place(MutableBodyColumns state, std::size_t i, const Vec3& w, double dt) const {
    if (system_.bodies[i].fixed) return;
    const BodyColumns start = start_.columns();
    state.set_position(i, start.position(i) + dt * (theta_ * state.velocity(i) + (1 - theta_) * start.velocity(i)));
    const Vec3 turn = dt * (theta_ * w + (1 - theta_) * starts_[i].w);
    const Quat q = start.orientation(i) * exponential(turn);
    state.set_orientation(i, q);
    state.set_angular_velocity(i, q * w);
  }

  const System& system_;
  double theta_;
  BodyTable start_;
  std::vector<Start> starts_;
  Wrenches wrenches_;
  std::vector<Mat6> slopes_;
};

}  // namespace

const Integrator kSiconosTwin = {
    .name = "siconos-twin",
    .summary = "repeats Siconos's own smooth step, to explain its error",
    .order = 2,
    .symplectic = false,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .takes_contact = false,
    .options = {kSiconosThetaOption},
    .twin_of = "siconos",
    .make = make_stepper<SiconosTwin>,
};

}  // namespace rigor::inline adapters
