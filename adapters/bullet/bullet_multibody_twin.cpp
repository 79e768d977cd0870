// The step of bullet:multibody (btMultiBody of Bullet 3.24, matched track), for comparison with Bullet itself.
// turn_of() rotates ball joints and free bases.
#include "adapters/bullet/bullet_multibody_twin.h"

#include "adapters/bullet/bullet_turn.h"
#include "adapters/common/reduced_twin.h"

namespace rigor::inline adapters {
namespace {

Quat turned_by_bullet(const Quat& from, const Vec3& w, double dt) { return from * bullet::turn_of(w, dt); }

}  // namespace

const Integrator kBulletMultibodyTwin = {
    .name = "bullet-multibody-twin",
    .summary = "repeats the smooth step of Bullet's reduced coordinates, to explain its error",
    .order = 1,
    .symplectic = false,
    .leapfrog_stagger = 0.5,
    .default_orientation = "",
    .takes_contact = false,
    .takes_joints = true,
    .lacks = {joint_feature<DistanceJoint>(), Feature::joint_limit, Feature::joint_loop, Feature::joint_friction,
              Feature::motor_servo, Feature::motor_speed},
    .twin_of = "bullet",
    .make = [](const StepperParts& parts) { return make_reduced_twin(parts, turned_by_bullet); },
};

}  // namespace rigor::inline adapters
