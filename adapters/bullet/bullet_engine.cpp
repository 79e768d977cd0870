#include "adapters/bullet/bullet_engine.h"

#include <LinearMath/btScalar.h>
#include <fmt/format.h>

#include "adapters/bullet/bullet_calls.h"
#include "adapters/bullet/bullet_matched.h"
#include "adapters/bullet/bullet_multibody_twin.h"
#include "adapters/bullet/bullet_multibody_world.h"
#include "adapters/bullet/bullet_options.h"
#include "adapters/bullet/bullet_turn.h"
#include "adapters/bullet/bullet_twin.h"
#include "adapters/bullet/bullet_world.h"
#include "adapters/common/coordinate_features.h"
#include "adapters/common/engine_row.h"
#include "adapters/common/option_values.h"
#include "core/engine/run_name.h"

namespace rigor::inline adapters {
namespace {

// Bullet has no ellipsoid. A hull without a margin sinks centimetres into fine triangles, and moves there.
const Features kBulletContacts = joined(contacts_among<Box, Capsule, Convex, Cylinder, Plane, Sphere>(),
                                        joined(contacts_on<Heightfield, Box, Capsule, Cylinder, Sphere>(),
                                               contacts_on<Mesh, Box, Capsule, Cylinder, Sphere>()));

// Bullet gives its version as one number: 324 is 3.24.
std::string version() { return fmt::format("{}.{:02}", btGetVersion() / 100, btGetVersion() % 100); }

const Features kJoints =
    joined(kCoordinateFeatures, {joint_feature<BallJoint>(), joint_feature<CylindricalJoint>(),
                                 joint_feature<FixedJoint>(), joint_feature<HingeJoint>(), joint_feature<SliderJoint>(),
                                 joint_feature<UniversalJoint>(), Feature::joints_with_contacts, Feature::joint_limit,
                                 Feature::motor_speed, Feature::joint_friction, Feature::joint_limit_beyond_half_turn});

MethodInfo sequential_impulse() {
  return {
      .name = "sequential-impulse",
      .summary = "semi-implicit Euler, joints and contacts by projected Gauss-Seidel",
      .leapfrog_stagger = 0.5,
      .lacks = {Feature::speed_motor_with_limits, Feature::two_speeds_at_once},
      .options = {bullet::kIterations, bullet::kGyroscopic, bullet::kSplitImpulse, bullet::kErpOption, bullet::kCfm}};
}

MethodInfo mlcp() {
  return {.name = "mlcp",
          .summary =
              "semi-implicit Euler, joints and contacts by a direct (Dantzig) solver, dense: a step takes "
              "the cube of its rows, 30 ms for 500",
          .leapfrog_stagger = 0.5,
          .lacks = {Feature::soft_contact, Feature::speed_motor_with_limits, Feature::two_speeds_at_once},
          .options = {bullet::kGyroscopic, bullet::kSplitImpulse, bullet::kErpOption, bullet::kDirectCfm}};
}

// Its contacts push an overlap out by a speed that stays, which adds to a rebound: restitution is left out.
MethodInfo multibody() {
  return {.name = "multibody",
          .summary =
              "semi-implicit Euler in the reduced coordinates of trees (Featherstone); limits do not bounce, nor do "
              "contacts",
          .leapfrog_stagger = 0.5,
          .lacks = {Feature::joint_limit_that_bounces, Feature::joint_loop, Feature::restitution, Feature::soft_contact,
                    Feature::two_speeds_at_once},
          .options = {bullet::kIterations}};
}

}  // namespace

EngineInfo BulletEngine::info() const {
  return {.name = "bullet",
          .version = version(),
          .precision = sizeof(btScalar) == sizeof(double) ? "double" : "single",
          .features =
              joined(kJoints, joined(kBulletContacts, {Feature::placed_shapes, Feature::contact_filter, Feature::spring,
                                                       Feature::timed_force, Feature::fixed_body, Feature::restitution,
                                                       Feature::friction_none, Feature::friction_coulomb,
                                                       Feature::friction_infinite, Feature::soft_contact})),
          .methods = {sequential_impulse(), mlcp(), multibody()},
          .max_rotation_per_step = bullet::kLargestTurn};  // a faster body keeps its speed and turns too little
}

std::unique_ptr<World> BulletEngine::load(const Scene& scene, const Settings& settings) const {
  refuse_unsupported(info(), settings, scene);
  if (settings.method == "multibody") return std::make_unique<BulletMultibodyWorld>(scene, settings);
  return std::make_unique<BulletWorld>(scene, settings);
}

// An unnamed cfm follows from the masses, in the engine and in its twin.
// On the stock track jointed bodies fall asleep together, and reduced coordinates are damped; the twin repeats neither.
std::string BulletEngine::twin(const Settings& settings) const {
  if (settings.method == "multibody") return settings.track == Track::matched ? "core:bullet-multibody-twin" : "";
  std::string name = "core:bullet-twin,gyroscopic=" + word_option(settings, bullet::kGyroscopic) + ",sleeping=";
  if (settings.track == Track::stock)
    return fmt::format("{}on,gyroscopic-limit={},joints=none", name, btContactSolverInfo().m_maxGyroscopicForce);
  if (settings.method != "mlcp") return name + "off,joints=none";
  name += fmt::format("off,erp={},joints=direct", number_option(settings, bullet::kErpOption, bullet::kErp));
  return is_named(settings, bullet::kDirectCfm) ? name + ",cfm=" + settings.options.at("cfm") : name;
}

EngineRow bullet_row() {
  return {make_engine<BulletEngine>,
          [] {
            return std::vector<Integrator>{kBulletMultibodyTwin, kBulletTwin};
          },
          bullet_calls};
}

}  // namespace rigor::inline adapters
