// Semi-implicit (symplectic) Euler: velocities first, then positions with the new velocities.
//   v1 = v0 + dt F0/m,  w1 = w0 + dt I⁻¹(tau0 - w0 x I w0),  x1 = x0 + dt v1,  R1 = R0 turned by dt w1
// The course's contact rule acts between the two updates. Velocities lag half a step behind positions. An oscillation
// of frequency w is stable while w dt < 2. The gyroscopic term is explicit, so a free body's spin is not symplectic.
// With joints the velocities also get impulses that close all joints at the step's end (SHAKE). If bodies turn so far
// that no such impulses exist, the velocities are made to satisfy the joints at the step's start, and the mass-weighted
// least-norm projection closes the joints at its end.
#include <optional>

#include "core/dynamics/integrators/euler_passes.h"
#include "core/dynamics/joints/ball_joints.h"
#include "core/dynamics/joints/joints.h"
#include "core/dynamics/model/wrench_columns.h"

namespace rigor::inline dynamics {
namespace {

// As a share of the longest moving arm. Each step closes the gaps again, so no error accumulates and this is enough.
constexpr double kClosed = 1e-11;

class SemiImplicitEuler : public Stepper {
 public:
  explicit SemiImplicitEuler(const StepperParts& parts) : parts_(parts), passes_(parts), wrenches_(parts.system) {
    if (!parts.joints || !parts.scene || parts.orientation->keeps_matrix) return;
    if (BallJoints::are_all_of(*parts.scene) && parts.joints->rank() == parts.joints->rows())
      balls_.emplace(*parts.scene, parts.system, parts.joints->size(), kClosed);
  }

  void step(MutableBodyColumns state, double t, double dt) override {
    const BodyConstants& bodies = parts_.system.constants;
    const double* const wrench = wrenches_.over_step(state, t, dt);
    if (parts_.joints) return constrained_step(state, wrench, dt);
    if (!parts_.contact) {
      bodies.for_each_block([&](const Bodies& block) {
        passes_.kick(block, state, wrench, dt);
        passes_.drift(block, state, dt);
      });
      return;
    }
    bodies.for_each_block([&](const Bodies& block) { passes_.kick(block, state, wrench, dt); });
    parts_.contact->resolve(state);
    bodies.for_each_block([&](const Bodies& block) { passes_.drift(block, state, dt); });
  }

  void archive_state(StateArchive&) override {}  // nothing outlives a step

 private:
  void constrained_step(MutableBodyColumns state, const double* wrench, double dt) {
    const BodyConstants& bodies = parts_.system.constants;
    parts_.joints->note_rotors(state, 0.5 * dt);
    bodies.for_each_block([&](const Bodies& block) { passes_.kick(block, state, wrench, dt); });
    if (balls_ && balls_->drift(state, dt, parts_.orientation->turn)) return;
    const auto drift = [&](const double* impulse) -> BodyColumns {
      end_ = BodyColumns(state);
      parts_.joints->push(impulse, end_.columns());
      bodies.for_each_block([&](const Bodies& block) { passes_.drift(block, end_.columns(), dt); });
      return end_.columns();
    };
    if (!parts_.joints->close(state, dt, drift, kClosed)) {
      drift(parts_.joints->velocity_impulse_with_rotors(state));
      parts_.joints->project(end_.columns());
    }
    copy_columns(end_.columns(), state);
  }

  StepperParts parts_;
  EulerPasses passes_;
  WrenchColumns wrenches_;
  std::optional<BallJoints> balls_;  // where all joints are such, or hinges
  BodyTable end_;
};

}  // namespace

extern const Integrator kSemiImplicitEuler;
const Integrator kSemiImplicitEuler = {
    .name = "semi-implicit-euler",
    .summary = "velocities first, then positions with them; what most engines do",
    .order = 1,
    .symplectic = true,
    .leapfrog_stagger = 0.5,
    .default_orientation = "quaternion-exponential",
    .takes_joints = true,
    .make = make_stepper<SemiImplicitEuler>,
};

}  // namespace rigor::inline dynamics
