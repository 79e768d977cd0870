#include "adapters/dart/dart_engine.h"

#include <dart/config.hpp>

#include "adapters/common/coordinate_features.h"
#include "adapters/common/engine_row.h"
#include "adapters/common/option_values.h"
#include "adapters/dart/dart_calls.h"
#include "adapters/dart/dart_options.h"
#include "adapters/dart/dart_twin.h"
#include "adapters/dart/dart_world.h"
#include "core/engine/run_name.h"

namespace rigor::inline adapters {
namespace {

// Spheres and boxes are all that DART's own detector of collisions knows; a plane is the face of a wide box.
const Features kDartContacts = {contact_feature<Box, Box>(), contact_feature<Box, Plane>(),
                                contact_feature<Box, Sphere>(), contact_feature<Plane, Sphere>(),
                                contact_feature<Sphere, Sphere>()};

const Features kDartJoints =
    joined(kCoordinateFeatures, {joint_feature<BallJoint>(), joint_feature<FixedJoint>(), joint_feature<HingeJoint>(),
                                 joint_feature<SliderJoint>(), joint_feature<UniversalJoint>(), Feature::joint_limit,
                                 Feature::joint_limit_beyond_half_turn, Feature::joints_with_contacts,
                                 Feature::joint_friction, Feature::motor_speed});

MethodInfo by_solver(const std::string& name, const std::string& solver) {
  return {.name = name,
          .summary = "semi-implicit Euler in the joints' coordinates, gyroscopic term explicit; contacts by " + solver,
          .leapfrog_stagger = 0.5,
          .lacks = {Feature::speed_motor_with_limits, Feature::two_speeds_at_once},
          .options = {kDartErp, kDartSoftness}};
}

}  // namespace

EngineInfo DartEngine::info() const {
  return {.name = "dart",
          .version = DART_VERSION,
          .precision = "double",  // it is written for no other
          .features =
              joined(joined(kDartContacts, kDartJoints),
                     {Feature::placed_shapes, Feature::contact_filter, Feature::spring, Feature::timed_force,
                      Feature::fixed_body, Feature::restitution, Feature::friction_none, Feature::friction_coulomb}),
          .methods = {by_solver("dantzig", "Dantzig's direct solver"),
                      by_solver("pgs", "projected Gauss-Seidel, 30 sweeps")}};
}

std::unique_ptr<World> DartEngine::load(const Scene& scene, const Settings& settings) const {
  refuse_unsupported(info(), settings, scene);
  return make_dart_world(scene, settings);
}

// Neither solver touches smooth motion, nor do its options.
std::string DartEngine::twin(const Settings&) const { return "core:dart-twin"; }

EngineRow dart_row() {
  return {make_engine<DartEngine>, [] { return std::vector<Integrator>{kDartTwin}; }, dart_calls};
}

}  // namespace rigor::inline adapters
