// The smooth step of ODE 0.16, for comparison with ODE itself. It is semi-implicit Euler with Lacoursière's implicit
// gyroscopic term ("Stabilizing gyroscopic forces in rigid multibody simulations", 2006). This is one linearised step
// of L' = tau with L0 = I w0 constant in the gyroscopic product, at the inertia I = R0 I_B R0ᵀ of the step's start:
//   (I - dt [L0]x) w* = I w0,   w1 = w* + dt I⁻¹ tau,   v1 = v0 + dt F/m,   x1 = x0 + dt v1
// and then a turn by dt w1: exact ("finite"), or q <- (q + dt/2 (0, w1) q) / |...| ("infinitesimal"), as
// dBodySetFiniteRotationMode says. Loads are constant over the step. Nothing is damped unless it is asked for. Joints
// act between w1, v1 and x1: see ode_twin_joints.h.
#include "adapters/ode/ode_twin.h"

#include <Eigen/LU>

#include "adapters/ode/ode_options.h"
#include "adapters/ode/ode_twin_joints.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {
namespace {

class OdeTwin : public Stepper {
 public:
  explicit OdeTwin(const StepperParts& parts)
      : parts_(parts),
        is_gyroscopic_(word_option(parts.settings, kOdeGyroscopic) == "on"),
        turn_(orientation_update(word_option(parts.settings, kOdeTwinRotation) == "finite" ? "quaternion-exponential"
                                                                                           : "quaternion-additive")) {
    if (!parts.scene || parts.scene->joints.empty()) return;
    const bool has_cfm = is_named(parts.settings, kOdeTwinCfm);
    joints_ = std::make_unique<OdeTwinJoints>(
        *parts.scene, parts.system, number_option(parts.settings, kOdeTwinErp),
        has_cfm ? std::optional(number_option(parts.settings, kOdeTwinCfm, 0)) : std::nullopt);
  }

  void step(MutableBodyColumns state, double t, double dt) override {
    parts_.system.wrenches(state, t, dt, wrenches_);
    for (std::size_t i = 0; i < state.size(); ++i) kick(state, i, dt);
    if (parts_.contact) parts_.contact->resolve(state);
    if (joints_) joints_->push(state, dt);
    for (std::size_t i = 0; i < state.size(); ++i) {
      state.set_position(i, state.position(i) + dt * state.velocity(i));
      turn_.advance(state, i, state.angular_velocity(i), dt);
    }
  }
  std::string solver_warning() const override { return joints_ ? joints_->warning() : ""; }
  void archive_state(StateArchive&) override {}  // nothing outlives a step

 private:
  void kick(MutableBodyColumns state, std::size_t i, double dt) const {
    const Inertia& body = parts_.system.bodies[i];
    if (body.fixed) return;
    state.set_velocity(i, state.velocity(i) + dt * body.inverse_mass * wrenches_[i].force);
    const Mat3 R = state.rotation(i);
    Vec3 w = state.angular_velocity(i);
    const Vec3 impulse = dt * (R * (body.inverse_inertia_B * (R.transpose() * wrenches_[i].torque)));
    if (is_gyroscopic_) {
      const Mat3 inertia = R * body.inertia_B * R.transpose();
      const Vec3 L = inertia * w;
      w = (inertia - dt * cross_matrix(L)).inverse() * L;
    }
    state.set_angular_velocity(i, w + impulse);
  }

  StepperParts parts_;
  bool is_gyroscopic_;
  const OrientationUpdate& turn_;
  std::unique_ptr<OdeTwinJoints> joints_;  // null without joints
  Wrenches wrenches_;
};

const Features kJointKinds =
    joints_of_types<BallJoint, CylindricalJoint, DistanceJoint, FixedJoint, HingeJoint, SliderJoint, UniversalJoint>();

}  // namespace

const Integrator kOdeTwin = {
    .name = "ode-twin",
    .summary = "repeats ODE's own smooth step, to explain its error",
    .order = 1,
    .symplectic = false,  // the gyroscopic term damps
    .leapfrog_stagger = 0.5,
    .default_orientation = "",
    .takes_joints = true,
    .lacks = {Feature::joint_limit, Feature::joints_with_contacts, Feature::joint_friction, Feature::motor_servo,
              Feature::motor_speed},  // rows that act on one side or up to a bound
    .options = {kOdeGyroscopic,
                kOdeTwinRotation,
                kOdeTwinErp,
                kOdeTwinCfm,
                {.name = "joints",
                 .meaning = "direct: as worldstep solves for them; none: quickstep's sweeps are not repeated",
                 .choices = {"direct", "none"},
                 .by_default = DefaultRule{"the first that has the scene's joints"},
                 .features_of_choice = {{"direct", kJointKinds}, {"none", {}}}}},
    .twin_of = "ode",
    .make = make_stepper<OdeTwin>,
};

}  // namespace rigor::inline adapters
