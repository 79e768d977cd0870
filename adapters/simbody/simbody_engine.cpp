#include "adapters/simbody/simbody_engine.h"

#include <fmt/format.h>

#include "adapters/common/coordinate_features.h"
#include "adapters/common/engine_row.h"
#include "adapters/common/option_values.h"
#include "adapters/simbody/simbody_calls.h"
#include "adapters/simbody/simbody_twin.h"
#include "adapters/simbody/simbody_world.h"
#include "core/engine/run_name.h"

namespace rigor::inline adapters {
namespace {

MethodInfo runge_kutta(const std::string& name, const std::string& summary, int order) {
  return {.name = name, .summary = summary, .order = order};
}

// Its projection changes the energy if a step leaves a constraint with a first-order error: a pendulum of mass 1 on a
// rod of 1 m gains joules in ten seconds at 1/30 s.
MethodInfo semi_explicit_euler() {
  return {.name = "semi-explicit-euler",
          .summary = "velocities first, then positions; no loops nor rods, whose projection would feed it energy",
          .leapfrog_stagger = 0.5,
          .lacks = {Feature::joint_loop, joint_feature<DistanceJoint>()}};
}

MethodInfo adaptive(const std::string& name, const std::string& summary, int order) {
  return {.name = name, .summary = summary, .order = order, .adaptive = true, .options = {simbody_accuracy(name)}};
}

std::vector<MethodInfo> methods() {
  return {
      runge_kutta("merson", "Runge, Kutta and Merson's five stages", 4),
      adaptive("cpodes", "backward differences of order 1 to 5, by error control", 1),
      {.name = "explicit-euler", .summary = "everything from the step's start: swings grow", .leapfrog_stagger = -0.5},
      adaptive("feldberg", "Runge, Kutta and Fehlberg's six stages, by error control", 4),
      runge_kutta("rk2", "the explicit trapezoid", 2),
      runge_kutta("rk3", "Kutta's three stages", 3),
      semi_explicit_euler(),
      adaptive("semi-explicit-euler-2", "semi-explicit Euler, its steps halved, by error control", 1),
      {.name = "verlet", .summary = "positions by Taylor, velocities by an iterated trapezoid", .order = 2}};
}

}  // namespace

EngineInfo SimbodyEngine::info() const {
  return {.name = "simbody",
          .version = simbody_version(),
          .precision = "double",
          .features =
              joined(kCoordinateFeatures,
                     {Feature::spring, Feature::timed_force, Feature::fixed_body, joint_feature<BallJoint>(),
                      joint_feature<DistanceJoint>(), joint_feature<FixedJoint>(), joint_feature<CylindricalJoint>(),
                      joint_feature<HingeJoint>(), joint_feature<SliderJoint>(), joint_feature<UniversalJoint>()}),
          .methods = methods()};
}

std::unique_ptr<World> SimbodyEngine::load(const Scene& scene, const Settings& settings) const {
  refuse_unsupported(info(), settings, scene);
  return simbody_world(scene, settings);
}

// Stock integrators choose their steps by error control, except semi-explicit Euler, which estimates no error.
std::string SimbodyEngine::twin(const Settings& settings) const {
  const MethodInfo method = method_of(info(), settings);
  const bool takes_fixed_steps =
      !method.adaptive && (settings.track == Track::matched || method.name == "semi-explicit-euler");
  return takes_fixed_steps ? fmt::format("core:simbody-{}-twin", method.name) : "";
}

EngineRow simbody_row() { return {make_engine<SimbodyEngine>, simbody_twins, simbody_calls}; }

}  // namespace rigor::inline adapters
