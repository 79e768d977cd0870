// Linearly implicit Euler: one Newton step of implicit Euler, so one linear solve per step for the velocities V = (v,
// w) of all bodies. The wrenches W, their derivatives P by pose and D by velocity, and the inertia M in W are those at
// the start of the step. G = [w]x I - [I w]x is the derivative of the gyroscopic term w x I w:
//   (M - dt D - dt² P + dt G) (V1 - V0) = dt (W0 - w0 x I w0 + dt P V0),
//   x1 = x0 + dt v1,  R1 = exp([dt w1]x) R0.
// Stable on linear springs and dampers of any stiffness; takes energy from every oscillation, the more the coarser the
// step. One Newton step does not see how a stiff spring's line turns with a fast body: there it can gain energy.
// (P. Deuflhard, Recent progress in extrapolation methods for ordinary differential equations, 1985; D. Baraff,
// A. Witkin, Large steps in cloth simulation, 1998.)
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/model/block_system.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

class LinearlyImplicitEuler : public Stepper {
 public:
  explicit LinearlyImplicitEuler(const StepperParts& parts)
      : parts_(parts),
        equations_(parts.system.size()),
        impulse_(6 * static_cast<Eigen::Index>(parts.system.size())),
        change_(impulse_.size()) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    solver_warning_.clear();
    assemble(state, t, dt);
    if (equations_.solve(impulse_, change_))
      for (std::size_t i = 0; i < state.size(); ++i) change_velocity(state, i);
    else
      solver_warning_ = "the equations for the velocities were singular";
    if (parts_.contact) parts_.contact->resolve(state);
    for (std::size_t i = 0; i < state.size(); ++i) drift(state, i, dt);
  }

  std::string solver_warning() const override { return solver_warning_; }
  void archive_state(StateArchive& archive) override { archive(solver_warning_); }

 private:
  void assemble(BodyColumns state, double t, double dt) {
    parts_.system.wrenches(state, t, dt, wrenches_);
    equations_.clear();
    for (std::size_t i = 0; i < state.size(); ++i) assemble_body(state, i, dt);
    visit_load_jacobian(parts_.system.loads, state, t, dt, [&](const WrenchDerivative& d) {
      if (parts_.system.bodies[d.row].fixed || parts_.system.bodies[d.column].fixed) return;
      equations_.add(d.row, d.column, -dt * d.by_velocity - dt * dt * d.by_pose);
      Vec6 velocity;
      velocity << state.velocity(d.column), state.angular_velocity(d.column);
      impulse_of(d.row) += dt * dt * d.by_pose * velocity;
    });
  }

  void assemble_body(BodyColumns state, std::size_t i, double dt) {
    const Inertia& body = parts_.system.bodies[i];
    Mat6 matrix = Mat6::Identity();
    Vec6 impulse = Vec6::Zero();
    if (!body.fixed) {
      const Mat3 R = state.rotation(i), inertia_W = R * body.inertia_B * R.transpose();
      const Vec3 w = state.angular_velocity(i), L = inertia_W * w;
      matrix.topLeftCorner<3, 3>() *= body.mass;
      matrix.bottomRightCorner<3, 3>() = inertia_W + dt * (cross_matrix(w) * inertia_W - cross_matrix(L));
      impulse << dt * wrenches_[i].force, dt * (wrenches_[i].torque - w.cross(L));
    }
    equations_.add(i, i, matrix);
    impulse_of(i) = impulse;
  }

  void change_velocity(MutableBodyColumns state, std::size_t i) const {
    const Vec6 change = change_.segment<6>(6 * static_cast<Eigen::Index>(i));
    state.set_velocity(i, state.velocity(i) + change.head<3>());
    state.set_angular_velocity(i, state.angular_velocity(i) + change.tail<3>());
  }

  void drift(MutableBodyColumns state, std::size_t i, double dt) const {
    if (parts_.system.bodies[i].fixed) return;
    state.set_position(i, state.position(i) + dt * state.velocity(i));
    state.set_orientation(i, (rotation_by(dt * state.angular_velocity(i)) * state.orientation(i)).normalized());
  }

  Eigen::VectorXd::FixedSegmentReturnType<6>::Type impulse_of(std::size_t i) {
    return impulse_.segment<6>(6 * static_cast<Eigen::Index>(i));
  }

  StepperParts parts_;
  BlockSystem equations_;
  Wrenches wrenches_;
  Eigen::VectorXd impulse_, change_;
  std::string solver_warning_;
};

}  // namespace

extern const Integrator kLinearlyImplicitEuler;
const Integrator kLinearlyImplicitEuler = {
    .name = "linearly-implicit-euler",
    .summary =
        "one linear solve a step with the loads' exact derivative; for stiff springs and dampers; no joints, for its "
        "equations have no multipliers",
    .order = 1,
    .symplectic = false,
    .leapfrog_stagger = 0.5,
    .default_orientation = "",
    .make = make_stepper<LinearlyImplicitEuler>,
};

}  // namespace rigor::inline dynamics
