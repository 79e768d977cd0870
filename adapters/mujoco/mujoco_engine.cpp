#include "adapters/mujoco/mujoco_engine.h"

#include <fmt/format.h>

#include "adapters/common/engine_row.h"
#include "adapters/common/option_values.h"
#include "adapters/mujoco/mujoco_calls.h"
#include "adapters/mujoco/mujoco_export.h"
#include "adapters/mujoco/mujoco_import.h"
#include "adapters/mujoco/mujoco_options.h"
#include "adapters/mujoco/mujoco_twin.h"
#include "adapters/mujoco/mujoco_world.h"
#include "core/engine/run_name.h"

namespace rigor::inline adapters {
namespace {

// A hull on a box or on another hull rests deeper than the fall of one step. The cause is not known, so these pairs are
// left out. MuJoCo takes the convex hull of any mesh.
const Features kMujocoContacts = [] {
  Features contacts = contacts_among<Box, Capsule, Convex, Cylinder, Ellipsoid, Plane, Sphere>();
  contacts.erase(contact_feature<Box, Convex>());
  contacts.erase(contact_feature<Convex, Convex>());
  return joined(contacts, contacts_on<Heightfield, Box, Capsule, Cylinder, Ellipsoid, Sphere>());
}();

std::vector<std::string> calls_of_mujoco(const Settings& settings, const std::string& dt) {
  return mujoco_calls(settings, dt, kMujoco2);
}

std::vector<OptionInfo> options_of_all() {
  return {kMujocoCone,        kMujocoImpratio,     kMujocoContactTime,   kMujocoContactDamping, kMujocoContactStart,
          kMujocoContactDeep, kMujocoContactWidth, kMujocoContactMargin, kMujocoIterations};
}

MethodInfo euler() {
  return {.name = "euler",
          .summary = "semi-implicit Euler in the joints' coordinates, gyroscopic term explicit",
          .leapfrog_stagger = 0.5,
          .lacks = {Feature::joint_limit_that_bounces, Feature::restitution},
          .options = options_of_all()};
}

MethodInfo implicit() {
  return {.name = "implicit",
          .summary = "the same with one Newton step for what depends on velocity: damps spinning bodies",
          .leapfrog_stagger = 0.5,
          .lacks = {Feature::joint_limit_that_bounces, Feature::restitution},
          .options = options_of_all()};
}

// Its stages have order 4, but it adds the rotations of a step's stages as if they commuted.
MethodInfo rk4() {
  return {.name = "rk4",
          .summary = "Runge and Kutta's method; of order 2 in the orientation of a free body",
          .order = 2,
          .lacks = {Feature::joint_limit_that_bounces, Feature::restitution},
          .options = options_of_all()};
}

}  // namespace

Features mujoco_features() {
  return joined(kMujocoContacts, {Feature::placed_shapes,
                                  Feature::contact_filter,
                                  Feature::spring,
                                  Feature::timed_force,
                                  Feature::fixed_body,
                                  Feature::friction_none,
                                  Feature::friction_coulomb,
                                  Feature::restitution,
                                  Feature::rolling_friction,
                                  Feature::torsional_friction,
                                  joint_feature<BallJoint>(),
                                  joint_feature<CompoundJoint>(),
                                  joint_feature<CylindricalJoint>(),
                                  joint_feature<DistanceJoint>(),
                                  joint_feature<FixedJoint>(),
                                  joint_feature<HingeJoint>(),
                                  joint_feature<PlanarJoint>(),
                                  joint_feature<ScrewJoint>(),
                                  joint_feature<SliderJoint>(),
                                  joint_feature<UniversalJoint>(),
                                  Feature::armature,
                                  Feature::coupling,
                                  Feature::coupling_of_several_joints,
                                  Feature::joint_spring,
                                  Feature::joint_damper,
                                  Feature::joint_friction,
                                  Feature::joint_limit,
                                  Feature::joint_limit_beyond_half_turn,
                                  Feature::joint_limit_of_compound_slider,
                                  Feature::joints_with_contacts,
                                  Feature::joints_with_dampers,
                                  Feature::motor_effort,
                                  Feature::motor_servo,
                                  Feature::motor_servo_of_several_joints,
                                  Feature::motor_table});
}

std::vector<MethodInfo> mujoco_methods() { return {euler(), implicit(), rk4()}; }

EngineInfo MujocoEngine::info() const {
  const int version = mj_version();  // 222 is 2.2.2
  std::vector<MethodInfo> methods = mujoco_methods();
  for (MethodInfo& method : methods) method.options.push_back(kMujocoServo);
  return {.name = "mujoco",
          .version = fmt::format("{}.{}.{}", version / 100, version / 10 % 10, version % 10),
          .precision = sizeof(mjtNum) == sizeof(double) ? "double" : "single",
          .features = mujoco_features(),
          .methods = methods};
}

std::unique_ptr<World> MujocoEngine::load(const Scene& scene, const Settings& settings) const {
  const EngineInfo engine = info();
  refuse_unsupported(engine, settings, scene);
  method_of(engine, settings);  // throws for a method that is not there
  return std::make_unique<MujocoWorld>(scene, settings);
}

// Neither cone nor solver touches smooth motion. At the start of a step both kinds of servos have the same effort; the
// twins of the other methods do not know what it is later.
std::string MujocoEngine::twin(const Settings& settings) const {
  if (word_option(settings, kMujocoServo) == "native" && settings.method != "euler") return "";
  return fmt::format("core:mujoco-{}-twin", settings.method);
}

EngineRow mujoco_row() {
  return {make_engine<MujocoEngine>,
          [] {
            return std::vector<Integrator>{kMujocoEulerTwin, kMujocoImplicitTwin, kMujocoRk4Twin};
          },
          calls_of_mujoco, read_with_mujoco, mjcf_for_others};
}

}  // namespace rigor::inline adapters
