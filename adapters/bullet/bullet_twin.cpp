// The smooth step of Bullet 3.24, for comparison with Bullet itself: semi-implicit Euler. I = R0 I_B R0ᵀ is that of the
// step's start, with I_B the inertia in any body frame (Bullet uses the principal one, which only changes rounding):
//   w1 = w0 + dt I⁻¹ tau + g,   v1 = v0 + dt F/m,   x1 = x0 + dt v1,   then a turn by dt w1
// g, the gyroscopic change of w, knows nothing of tau and is, as btRigidBody::setFlags says,
//   implicit-body, -world   one Newton step from w0 for I (w - w0) + dt w x I w = 0:
//                           g = -(I + dt ([w0]x I - [I w0]x))⁻¹ dt (w0 x I w0); the same in either frame, but for
//                           roundings
//   explicit                -dt I⁻¹ (w0 x I w0), the torque cut off at a limit (m_maxGyroscopicForce)
// The rotation is the exponential map. Beyond pi/4 its sine and cosine are those of pi/4, but the sine is still
// multiplied by the whole w1. The normalised quaternion then rotates by 2 atan(tan(pi/8) |w1| dt / (pi/4)). Below 1e-3
// rad/s Bullet uses the sine's series, which differs by less than a rounding. On the stock track a body below 0.8 m/s
// and 1 rad/s for more than 2 s falls asleep one step later, permanently if nothing touches it. Joints act between the
// velocities and the rotation: see bullet_twin_joints.h. One effect is no part of the scheme and not repeated. On the
// stock track Bullet removes a body from the simulation, with its velocity unchanged, once the box around its present
// and next position is 1e6 m across (btCollisionWorld::updateSingleAabb).
#include "adapters/bullet/bullet_twin.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "adapters/bullet/bullet_matched.h"
#include "adapters/bullet/bullet_options.h"
#include "adapters/bullet/bullet_turn.h"
#include "adapters/bullet/bullet_twin_joints.h"
#include "core/engine/option_values.h"
#include "core/engine/state_archive.h"

namespace rigor::inline adapters {
namespace {

constexpr double kSlow = 0.8, kSlowTurn = 1, kTimeToSleep = 2;  // m/s, rad/s, s

// The inputs of the gyroscopic torque: the inertia in W and in B, the orientation, w in W, the step, and the limit [N
// m].
struct Spin {
  Mat3 inertia_W, inertia_B;
  Quat q_WB;
  Vec3 w;
  double dt, limit;
};

// The change of angular velocity [rad/s, in W] that the gyroscopic torque makes in one step.
using GyroscopicChange = Vec3 (*)(const Spin& spin);

Vec3 no_change(const Spin&) { return Vec3::Zero(); }

// One Newton step, in the frame of its arguments. Bullet solves it by Cramer's rule and does not divide by a
// determinant below the rounding unit (btMatrix3x3::solve33). For moments of some 6e-6 kg m² or less, no gyroscopic
// torque remains.
Vec3 newton_change(const Mat3& inertia, const Vec3& w, double dt) {
  const Vec3 L = inertia * w;
  const Mat3 slope = inertia + dt * (cross_matrix(w) * inertia - cross_matrix(L));
  const double determinant = slope.determinant();
  const bool divides = std::abs(determinant) > std::numeric_limits<double>::epsilon();
  return -(divides ? 1 : determinant * determinant) * (slope.inverse() * (dt * w.cross(L)));
}

Vec3 implicit_world_change(const Spin& spin) { return newton_change(spin.inertia_W, spin.w, spin.dt); }

// The whole w is converted to B and back in each step, as in Bullet, which rounds more than converting only its change.
Vec3 implicit_body_change(const Spin& spin) {
  const auto turned = [](const Quat& q, const Vec3& v) {
    return Vec3((q * Quat(0, v.x(), v.y(), v.z()) * q.conjugate()).vec());
  };
  const Vec3 w_B = turned(spin.q_WB.conjugate(), spin.w);
  return turned(spin.q_WB, w_B + newton_change(spin.inertia_B, w_B, spin.dt)) - spin.w;
}

Vec3 explicit_change(const Spin& spin) {
  Vec3 torque = spin.w.cross(spin.inertia_W * spin.w);
  if (torque.norm() > spin.limit) torque *= spin.limit / torque.norm();
  return -spin.dt * (spin.inertia_W.inverse() * torque);
}

GyroscopicChange gyroscopic_change(const std::string& word) {
  if (word == "off") return no_change;
  if (word == "explicit") return explicit_change;
  return word == "implicit-world" ? implicit_world_change : implicit_body_change;
}

class BulletTwin : public Stepper {
 public:
  explicit BulletTwin(const StepperParts& parts)
      : parts_(parts),
        gyroscopic_change_(gyroscopic_change(word_option(parts.settings, bullet::kGyroscopic))),
        limit_(number_option(parts.settings, bullet::kGyroscopicLimit)),
        may_sleep_(word_option(parts.settings, bullet::kSleeping) == "on"),
        time_slow_(parts.system.size()) {
    if (!parts.scene || parts.scene->joints.empty()) return;
    const bool has_cfm = is_named(parts.settings, bullet::kTwinCfm);
    joints_ = std::make_unique<BulletTwinJoints>(
        *parts.scene, parts.system, number_option(parts.settings, bullet::kTwinErp),
        has_cfm ? std::optional(number_option(parts.settings, bullet::kTwinCfm, 0)) : std::nullopt);
  }

  void step(MutableBodyColumns state, double t, double dt) override {
    parts_.system.wrenches(state, t, dt, wrenches_);
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (!parts_.system.bodies[i].fixed) kick(state, i, dt);
    }
    if (parts_.contact) parts_.contact->resolve(state);
    if (joints_) joints_->push(state, dt);
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (!parts_.system.bodies[i].fixed) drift(state, i, dt);
    }
  }
  std::string solver_warning() const override { return joints_ ? joints_->warning() : ""; }
  void archive_state(StateArchive& archive) override { archive(time_slow_); }

 private:
  bool sleeps(std::size_t i) const { return may_sleep_ && time_slow_[i] > kTimeToSleep; }

  void kick(MutableBodyColumns state, std::size_t i, double dt) const {
    if (sleeps(i)) {
      state.set_velocity(i, Vec3::Zero());
      state.set_angular_velocity(i, Vec3::Zero());
      return;
    }
    const Inertia& body = parts_.system.bodies[i];
    const Mat3 R = state.rotation(i);
    const Vec3 w = state.angular_velocity(i);
    const Vec3 impulse = dt * (R * (body.inverse_inertia_B * (R.transpose() * wrenches_[i].torque)));
    const Vec3 gyroscopic =
        gyroscopic_change_({R * body.inertia_B * R.transpose(), body.inertia_B, state.orientation(i), w, dt, limit_});
    state.set_velocity(i, state.velocity(i) + dt * body.inverse_mass * wrenches_[i].force);
    state.set_angular_velocity(i, w + impulse + gyroscopic);
  }

  void drift(MutableBodyColumns state, std::size_t i, double dt) {
    if (sleeps(i)) return;
    const Vec3 v = state.velocity(i), w = state.angular_velocity(i);
    state.set_position(i, state.position(i) + dt * v);
    state.set_orientation(i, (bullet::turn_of(w, dt) * state.orientation(i)).normalized());
    const bool is_slow = v.norm() < kSlow && w.norm() < kSlowTurn;
    time_slow_[i] = is_slow ? time_slow_[i] + dt : 0;
  }

  StepperParts parts_;
  GyroscopicChange gyroscopic_change_;
  double limit_;  // N m
  bool may_sleep_;
  std::unique_ptr<BulletTwinJoints> joints_;  // null without joints
  std::vector<double> time_slow_;  // s. The one thing that a later step depends on beside the state, as in Bullet
  Wrenches wrenches_;
};

const Features kJointKinds =
    joints_of_types<BallJoint, CylindricalJoint, FixedJoint, HingeJoint, SliderJoint, UniversalJoint>();

}  // namespace

const Integrator kBulletTwin = {
    .name = "bullet-twin",
    .summary = "repeats Bullet's own smooth step, to explain its error",
    .order = 1,
    .symplectic = false,  // the gyroscopic term damps
    .leapfrog_stagger = 0.5,
    .default_orientation = "",
    .takes_joints = true,
    .lacks = {joint_feature<DistanceJoint>(), Feature::joint_limit, Feature::joints_with_contacts,
              Feature::joint_friction, Feature::motor_servo, Feature::motor_speed},  // no rows with bounds
    .options = {bullet::kGyroscopic,
                bullet::kGyroscopicLimit,
                bullet::kSleeping,
                bullet::kTwinErp,
                bullet::kTwinCfm,
                {.name = "joints",
                 .meaning = "direct: as mlcp solves for them; none: sweeps of sequential impulses are not repeated",
                 .choices = {"direct", "none"},
                 .by_default = DefaultRule{"the first that has the scene's joints"},
                 .features_of_choice = {{"direct", kJointKinds}, {"none", {}}}}},
    .twin_of = "bullet",
    .make = make_stepper<BulletTwin>,
};

}  // namespace rigor::inline adapters
