// Contact by impulses (impulse.cpp) of bodies that joints hold together, with limits and motors. A sub-step is the same
// but for three things: the integrator moves the bodies with their joints; the impulses of rows act through the joints
// (jointed_rows.h); and the sub-step ends with the mass-weighted least-norm projection that closes the joints again,
// for the corrections of positions went along their tangents.
#include "core/dynamics/contact/impulse/jointed_impulse.h"

#include <algorithm>

#include "core/dynamics/contact/impulse/jointed_rows.h"
#include "core/dynamics/contact/impulse/mean_motion.h"
#include "core/dynamics/contact/impulse/step_impulses.h"
#include "core/dynamics/contact/impulse/sub_steps.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

class JointedImpulseStepper : public ContactStepper {
 public:
  JointedImpulseStepper(const Scene& scene, const ContactParts& parts)
      : joints_(*parts.joints),
        sub_steps_(scene, parts),
        manifolds_(scene, alone_),
        rows_(scene, parts.system, joints_),
        mean_motion_(parts.integrator),
        integrator_(parts.integrator.make({parts.system, nullptr, parts.orientation, parts.settings, parts.joints})) {}

  void step(MutableBodyColumns state, double t, double dt) override {
    if (!(dt > 0)) return integrator_->step(state, t, dt);
    const int count = sub_steps_.of(dt), updates = sub_steps_.contact_updates(dt, count);
    const double h = dt / count;
    reports_.begin_step();
    for (int update = 0, k = 0; update < updates; ++update) {
      const int end = (update + 1) * count / updates;
      std::vector<ContactConstraint>& contacts = manifolds_.find(state, (end - k) * h);
      rows_.assign(state, contacts, parameters_.h > 0 ? h / parameters_.h : 1);
      parameters_ = sub_steps_.parameters(h);
      if (reports_.is_asked()) reports_.begin_update(contacts, state);
      for (; k < end; ++k) {
        sub_step(state, t + k * h);
        if (reports_.is_asked()) rows_.add_impulses(reports_.impulses());
      }
      rows_.store_impulses(contacts);
      if (reports_.is_asked()) reports_.end_update();
    }
    reports_.end_step(dt);
  }

  ReportsContacts* contact_reports() override { return &reports_; }

  std::string solver_warning() const override {
    const std::string warning = integrator_->solver_warning();
    return warning.empty() ? manifolds_.failure() : warning;
  }

  void archive_state(StateArchive& archive) override {
    archive(parameters_.h, manifolds_, rows_);
    integrator_->archive_state(archive);
  }

  std::optional<double> sub_step() const override {
    return parameters_.h > 0 ? std::optional(parameters_.h) : std::nullopt;
  }

  SettingsInForce settings_in_force() const override {
    SettingsInForce settings = sub_steps_.settings_in_force();
    settings.insert(settings.begin(),
                    {"contact solver", "sequential impulses that act through the joints, two passes a sub-step"});
    return settings;
  }

 private:
  void sub_step(MutableBodyColumns state, double t) {
    rows_.prepare(state, t, parameters_);
    mean_motion_.begin(state);
    integrator_->step(state, t, parameters_.h);
    mean_motion_.end(state);
    rows_.load_velocities(state);
    rows_.warm_start();
    rows_.solve_with_bias();
    integrate_corrections(state);
    rows_.relax();
    rows_.apply_restitution(state);
    store_velocities(state);
    joints_.project(state);
  }

  // The integrator has moved the bodies; the velocity changes by the impulses move them further.
  void integrate_corrections(MutableBodyColumns state) {
    const double h = parameters_.theta * parameters_.h;
    for (std::size_t i = 0; i < state.size(); ++i) {
      const Vec6 change = rows_.change(i);
      if (change.isZero(0)) continue;
      mean_motion_.apply(i, h, state);
      displace(i, h * change.head<3>(), h * change.tail<3>(), state);
    }
  }

  void store_velocities(MutableBodyColumns state) {
    for (std::size_t i = 0; i < state.size(); ++i) {
      const Vec6 change = rows_.change(i);
      if (change.isZero(0)) continue;
      state.set_velocity(i, state.velocity(i) + change.head<3>());
      state.set_angular_velocity(i, state.angular_velocity(i) + change.tail<3>());
    }
  }

  Joints& joints_;
  ThreadPool alone_{1};
  SubSteps sub_steps_;
  Manifolds manifolds_;
  JointedRows rows_;
  MeanMotion mean_motion_;
  StepImpulses reports_;
  SolverParameters parameters_{};
  std::unique_ptr<Stepper> integrator_;
};

}  // namespace

std::unique_ptr<ContactStepper> make_jointed_impulse_stepper(const Scene& scene, const ContactParts& parts) {
  return std::make_unique<JointedImpulseStepper>(scene, parts);
}

}  // namespace rigor::inline dynamics
