// Velocity Verlet: half a kick, a drift, half a kick, for v and for the angular momentum L.
//   v += dt/2 F/m, L += dt/2 tau;   x += dt v, R by free_rotation.h;   the same kick at the new positions
// With dampers the second kick needs the velocity at its own end: one predictor and one corrector keep second order.
// With joints it is RATTLE (constrained_drift.h).
#include "core/dynamics/integrators/constrained_drift.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/model/wrench_columns.h"

namespace rigor::inline dynamics {
namespace {

class VelocityVerlet : public Stepper {
 public:
  explicit VelocityVerlet(const StepperParts& parts)
      : parts_(parts), wrenches_(parts.system), drift_(parts), carried_(kCarriedColumns, parts.system.size()) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    const BodyConstants& bodies = parts_.system.constants;
    const double* const wrench = wrenches_.over_step(state, t, dt);
    if (!drift_.is_free()) return constrained_step(state, wrench, t, dt);
    if (parts_.contact) {
      bodies.for_each_block([&](const Bodies& block) {
        first_kick(block, state, wrench, dt);
        kernels().velocity_of(block, state.column(0), carried_.data());
      });
      parts_.contact->resolve(state);
      bodies.for_each_block([&](const Bodies& block) {
        kernels().momentum_of(block, state.column(0), carried_.data());
        drift(block, state, dt);
      });
    } else {
      bodies.for_each_block([&](const Bodies& block) {
        first_kick(block, state, wrench, dt);
        drift(block, state, dt);
      });
    }
    second_kick(state, t, dt);
  }

  void archive_state(StateArchive&) override {}  // nothing outlives a step

 private:
  void constrained_step(MutableBodyColumns state, const double* wrench, double t, double dt) {
    const BodyConstants& bodies = parts_.system.constants;
    drift_.begin(state);
    bodies.for_each_block([&](const Bodies& block) { first_kick(block, state, wrench, dt); });
    drift_.drift(state, carried_, dt, [&](MutableBodyColumns at, const double* carried) {
      bodies.for_each_block([&](const Bodies& block) { kernels().free_drift(block, at.column(0), carried, dt); });
    });
    kernels().velocity_of(bodies.all(), state.column(0), carried_.data());
    second_kick(state, t, dt);
    drift_.settle(state, carried_);
  }

  void first_kick(const Bodies& block, MutableBodyColumns state, const double* wrench, double dt) {
    kernels().momentum_of(block, state.column(0), carried_.data());
    kernels().momentum_kick(block, state.column(0), carried_.data(), wrench, 0.5 * dt);
  }

  // Leaves behind w of the drift's end.
  void drift(const Bodies& block, MutableBodyColumns state, double dt) {
    kernels().free_drift(block, state.column(0), carried_.data(), dt);
    kernels().velocity_of(block, state.column(0), carried_.data());
  }

  void second_kick(MutableBodyColumns state, double t, double dt) {
    const double* wrench = wrenches_.over_step(state, t, dt);
    if (parts_.system.loads.damped()) {
      predicted_ = BodyColumns(state);
      predicted_momenta_ = carried_;
      kick(predicted_.columns(), predicted_momenta_, wrench, dt);
      drift_.settle(predicted_.columns(), predicted_momenta_);
      wrench = wrenches_.over_step(predicted_.columns(), t, dt);
    }
    kick(state, carried_, wrench, dt);
  }

  void kick(MutableBodyColumns state, Columns& carried, const double* wrench, double dt) const {
    parts_.system.constants.for_each_block([&](const Bodies& block) {
      kernels().momentum_kick(block, state.column(0), carried.data(), wrench, 0.5 * dt);
      if (wrench) kernels().velocity_of(block, state.column(0), carried.data());
    });
  }

  StepperParts parts_;
  WrenchColumns wrenches_;
  ConstrainedDrift drift_;
  Columns carried_, predicted_momenta_;  // of CarriedColumn
  BodyTable predicted_;
};

}  // namespace

extern const Integrator kVelocityVerlet;
const Integrator kVelocityVerlet = {
    .name = "velocity-verlet",
    .summary = "kick, drift, kick with an exact splitting of the free rotation; keeps |L| to rounding",
    .order = 2,
    .symplectic = true,
    .symmetric = true,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .takes_joints = true,
    .make = make_stepper<VelocityVerlet>,
};

}  // namespace rigor::inline dynamics
