#include "adapters/ode/ode_engine.h"

#include <fmt/format.h>
#include <ode/ode.h>
#include <ode/version.h>

#include "adapters/common/coordinate_features.h"
#include "adapters/common/engine_row.h"
#include "adapters/common/option_values.h"
#include "adapters/ode/ode_calls.h"
#include "adapters/ode/ode_matched.h"
#include "adapters/ode/ode_options.h"
#include "adapters/ode/ode_twin.h"
#include "adapters/ode/ode_world.h"
#include "core/engine/run_name.h"

namespace rigor::inline adapters {
namespace {

// ODE reports all contacts of a hull with a plane or a ball. A hull on a box or on another hull gets one corner at a
// time, so these pairs are left out. A cylinder on a box keeps moving by quickstep, so that pair is left out too.
const Features kOdeContacts =
    joined(joined(contacts_among<Box, Capsule, Plane, Sphere>(),
                  {contact_feature<Convex, Plane>(), contact_feature<Convex, Sphere>(),
                   contact_feature<Cylinder, Plane>(), contact_feature<Cylinder, Sphere>()}),
           joined(contacts_on<Heightfield, Box, Capsule, Sphere>(), contacts_on<Mesh, Box, Capsule, Sphere>()));

std::vector<OptionInfo> options_of_both() { return {kOdeGyroscopic, kOdeRotation, kOdeErp, kOdeCfm, kOdeServo}; }

Features joints_of_all_kinds() {
  return joined(kCoordinateFeatures,
                {joint_feature<BallJoint>(), joint_feature<CylindricalJoint>(), joint_feature<DistanceJoint>(),
                 joint_feature<FixedJoint>(), joint_feature<HingeJoint>(), joint_feature<SliderJoint>(),
                 joint_feature<UniversalJoint>(), Feature::joint_limit, Feature::motor_speed, Feature::joint_friction,
                 Feature::joints_with_contacts, Feature::joint_limit_beyond_half_turn});
}

MethodInfo by_size() {
  return {
      .name = "auto",
      .summary = fmt::format("worldstep, but quickstep where more than {} moving bodies can touch", kMostForWorldStep),
      .leapfrog_stagger = 0.5,
      .options = options_of_both()};
}

MethodInfo worldstep() {
  return {.name = "worldstep",
          .summary = "semi-implicit Euler, joints and contacts by a direct (Dantzig) solver",
          .leapfrog_stagger = 0.5,
          .options = options_of_both()};
}

MethodInfo quickstep() {
  MethodInfo method = {.name = "quickstep",
                       .summary = "semi-implicit Euler, joints and contacts by successive over-relaxation",
                       .leapfrog_stagger = 0.5,
                       .options = options_of_both()};
  method.options.push_back(kOdeIterations);
  method.options.push_back(kOdeSor);
  return method;
}

}  // namespace

EngineInfo OdeEngine::info() const {
  return {.name = "ode",
          .version = dODE_VERSION,
          .precision = dCheckConfiguration("ODE_double_precision") ? "double" : "single",
          .features = joined(joined(kOdeContacts, joints_of_all_kinds()),
                             {Feature::placed_shapes, Feature::contact_filter, Feature::spring, Feature::timed_force,
                              Feature::fixed_body, Feature::restitution, Feature::friction_none,
                              Feature::friction_coulomb, Feature::friction_infinite, Feature::rolling_friction,
                              Feature::soft_contact, Feature::torsional_friction}),
          .methods = {by_size(), worldstep(), quickstep()}};
}

std::unique_ptr<World> OdeEngine::load(const Scene& scene, const Settings& settings) const {
  const EngineInfo engine = info();
  refuse_unsupported(engine, scene);
  method_of(engine, settings);  // throws for a method that is not there
  refuse_shared_motors(scene);
  return std::make_unique<OdeWorld>(scene, settings);
}

// Only these options affect smooth motion. An unnamed cfm follows from the masses, in the engine and in its twin.
std::string OdeEngine::twin(const Settings& settings) const {
  if (word_option(settings, kOdeServo) == "native") return "";  // its soft stops solve for the effort at the step's end
  const bool matched = settings.track == Track::matched;
  std::string name =
      fmt::format("core:ode-twin,gyroscopic={},rotation={},erp={}", word_option(settings, kOdeGyroscopic),
                  word_option(settings, kOdeRotation), number_option(settings, kOdeErp, kMatchedJointErp));
  if (!matched || is_named(settings, kOdeCfm)) name += fmt::format(",cfm={}", number_option(settings, kOdeCfm));
  return name + (settings.method == "quickstep" ? ",joints=none" : ",joints=direct");
}

EngineRow ode_row() {
  return {make_engine<OdeEngine>, [] { return std::vector<Integrator>{kOdeTwin}; }, ode_calls};
}

}  // namespace rigor::inline adapters
