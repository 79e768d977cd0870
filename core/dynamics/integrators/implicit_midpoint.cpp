// The implicit midpoint rule on positions and rotations. The unknowns are the velocities (v, w) at mid-step:
//   x_m = x0 + dt/2 v_m,  R_m = exp(dt/2 [w_m]x) R0,  L_m = I(R_m) w_m,
//   m (v_m - v0) = dt/2 F_m,   L_m - L0 = dt/2 tau_m,
//   x1 = x0 + dt v_m,  R1 = exp(dt [w_m]x) R0,  v1 = 2 v_m - v0,  L1 = 2 L_m - L0.
// Symmetric; conserves L without torque. Newton's method solves for all bodies together with the exact derivative. It
// stops when the next correction, the square of the last one, is below rounding.
#include <fmt/format.h>

#include <utility>

#include "core/base/rotation_vector.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/model/block_system.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

constexpr int kMostIterations = 50;
constexpr double kLastCorrection = 1e-9;  // relative; Newton's next correction is about its square

class ImplicitMidpoint : public Stepper {
 public:
  explicit ImplicitMidpoint(const StepperParts& parts) : parts_(parts), newton_(parts.system.size()) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    if (parts_.contact) {
      parts_.system.wrenches(state, t, dt, wrenches_);
      resolve_ahead(*parts_.contact, parts_.system, wrenches_, dt, state);
    }
    start_ = BodyColumns(state);
    middle_ = BodyColumns(state);
    solve_for_middle(t, dt);
    for (std::size_t i = 0; i < state.size(); ++i) finish(state, i, dt);
  }

  std::string solver_warning() const override { return solver_warning_; }
  void archive_state(StateArchive& archive) override { archive(solver_warning_); }

 private:
  // Newton's method on middle_'s velocities; solver_warning_ says if it did not arrive.
  void solve_for_middle(double t, double dt) {
    solver_warning_.clear();
    double correction = 0;
    for (int iteration = 0; iteration < kMostIterations; ++iteration) {
      place_middle(dt);
      parts_.system.wrenches(middle_.columns(), t, dt, wrenches_);
      assemble(t, dt);
      if (!newton_.solve(residual_, correction_)) {
        solver_warning_ = "Newton's method met a singular matrix";
        return;
      }
      correction = apply_correction();
      if (correction <= kLastCorrection) {
        place_middle(dt);
        return;
      }
    }
    solver_warning_ = fmt::format("Newton's method did not converge in {} iterations; its last correction was {:.1e}",
                                  kMostIterations, correction);
    place_middle(dt);
  }

  // The positions and rotations that follow from the velocities at mid-step.
  void place_middle(double dt) {
    const BodyColumns start = std::as_const(start_).columns();
    const MutableBodyColumns middle = middle_.columns();
    for (std::size_t i = 0; i < middle.size(); ++i) {
      middle.set_position(i, start.position(i) + 0.5 * dt * middle.velocity(i));
      middle.set_orientation(i,
                             (rotation_by(0.5 * dt * middle.angular_velocity(i)) * start.orientation(i)).normalized());
    }
  }

  void assemble(double t, double dt) {
    residual_.resize(static_cast<Eigen::Index>(6 * parts_.system.size()));
    newton_.clear();
    for (std::size_t i = 0; i < parts_.system.size(); ++i) assemble_body(i, dt);
    const BodyColumns middle = std::as_const(middle_).columns();
    visit_load_jacobian(parts_.system.loads, middle, t, dt, [&](const WrenchDerivative& d) {
      if (parts_.system.bodies[d.row].fixed || parts_.system.bodies[d.column].fixed) return;
      Mat6 pose_by_velocity = 0.5 * dt * Mat6::Identity();
      pose_by_velocity.bottomRightCorner<3, 3>() *= left_jacobian(0.5 * dt * middle.angular_velocity(d.column));
      newton_.add(d.row, d.column, -0.5 * dt * (d.by_pose * pose_by_velocity + d.by_velocity));
    });
  }

  void assemble_body(std::size_t i, double dt) {
    const Inertia& body = parts_.system.bodies[i];
    const BodyColumns start = std::as_const(start_).columns(), middle = std::as_const(middle_).columns();
    if (body.fixed) {
      residual_.segment<6>(static_cast<Eigen::Index>(6 * i)).setZero();
      newton_.add(i, i, Mat6::Identity());
      return;
    }
    const Vec3 w = middle.angular_velocity(i);
    const Mat3 R = middle.rotation(i), inertia_W = R * body.inertia_B * R.transpose();
    const Vec3 L0 = angular_momentum_of(body, start.rotation(i), start.angular_velocity(i)), L = inertia_W * w;
    Vec6 residual;
    residual << body.mass * (middle.velocity(i) - start.velocity(i)) - 0.5 * dt * wrenches_[i].force,
        L - L0 - 0.5 * dt * wrenches_[i].torque;
    residual_.segment<6>(static_cast<Eigen::Index>(6 * i)) = residual;

    Mat6 derivative = Mat6::Zero();
    derivative.topLeftCorner<3, 3>() = body.mass * Mat3::Identity();
    derivative.bottomRightCorner<3, 3>() =
        inertia_W + (inertia_W * cross_matrix(w) - cross_matrix(L)) * (0.5 * dt * left_jacobian(0.5 * dt * w));
    newton_.add(i, i, derivative);
  }

  // Returns the largest correction relative to the velocity it corrects (or to 1, for small ones).
  double apply_correction() {
    const MutableBodyColumns middle = middle_.columns();
    double largest = 0;
    for (std::size_t i = 0; i < middle.size(); ++i) {
      const Vec6 correction = correction_.segment<6>(static_cast<Eigen::Index>(6 * i));
      const Vec3 v = middle.velocity(i) - correction.head<3>(), w = middle.angular_velocity(i) - correction.tail<3>();
      middle.set_velocity(i, v);
      middle.set_angular_velocity(i, w);
      largest = std::max(
          {largest, correction.head<3>().norm() / (1 + v.norm()), correction.tail<3>().norm() / (1 + w.norm())});
    }
    return largest;
  }

  void finish(MutableBodyColumns state, std::size_t i, double dt) const {
    const Inertia& body = parts_.system.bodies[i];
    if (body.fixed) return;
    const BodyColumns start = start_.columns(), middle = middle_.columns();
    const Vec3 v = middle.velocity(i), w = middle.angular_velocity(i);
    const Vec3 L = 2 * angular_momentum_of(body, middle.rotation(i), w) -
                   angular_momentum_of(body, start.rotation(i), start.angular_velocity(i));
    state.set_position(i, start.position(i) + dt * v);
    state.set_velocity(i, 2 * v - start.velocity(i));
    state.set_orientation(i, (rotation_by(dt * w) * start.orientation(i)).normalized());
    state.set_angular_velocity(i, angular_velocity_of(body, state.rotation(i), L));
  }

  StepperParts parts_;
  BlockSystem newton_;
  BodyTable start_, middle_;
  Wrenches wrenches_;
  Eigen::VectorXd residual_, correction_;
  std::string solver_warning_;
};

}  // namespace

extern const Integrator kImplicitMidpoint;
const Integrator kImplicitMidpoint = {
    .name = "implicit-midpoint",
    .summary =
        "solved for the velocities at mid-step by Newton's method; symmetric; no joints, for its equations have no "
        "multipliers",
    .order = 2,
    .symplectic = true,
    .symmetric = true,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .make = make_stepper<ImplicitMidpoint>,
};

}  // namespace rigor::inline dynamics
