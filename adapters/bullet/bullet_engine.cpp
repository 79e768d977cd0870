#include "adapters/bullet/bullet_engine.h"

#include <LinearMath/btScalar.h>
#include <fmt/format.h>

#include <numbers>

#include "adapters/bullet/bullet_world.h"
#include "adapters/option_values.h"
#include "core/engine/run_name.h"

namespace rigor {
namespace {

// Bullet gives its version as one number: 324 is 3.24.
std::string version() { return fmt::format("{}.{:02}", btGetVersion() / 100, btGetVersion() % 100); }

MethodInfo sequential_impulse() {
  return {.name = "sequential-impulse",
          .summary = "semi-implicit Euler, contacts by projected Gauss-Seidel",
          .leapfrog_stagger = 0.5,
          .options = {{"iterations", "sweeps of the contact solver a step", {}, 1, 10000, true},
                      {"gyroscopic", "the gyroscopic torque", {"implicit-body", "implicit-world", "explicit", "off"}},
                      {"split-impulse", "penetration corrected without adding velocity", {"on", "off"}}}};
}

// Bullet turns a body by the exponential map, but by at most a quarter of pi in one step (ANGULAR_MOTION_THRESHOLD of
// btTransformUtil.h): a faster body keeps its angular velocity and turns too little.
constexpr double kMaxRotationPerStep = std::numbers::pi / 4;  // rad

}  // namespace

EngineInfo BulletEngine::info() const {
  return {.name = "bullet",
          .version = version(),
          .precision = sizeof(btScalar) == sizeof(double) ? "double" : "single",
          .features = joined(contacts_of_all_shapes(), {"spring", "timed-force", "fixed-body", "restitution",
                                                        "friction:none", "friction:coulomb", "friction:infinite"}),
          .methods = {sequential_impulse()},
          .max_rotation_per_step = kMaxRotationPerStep};
}

std::unique_ptr<World> BulletEngine::load(const Scene& scene, const Settings& settings) const {
  const EngineInfo engine = info();
  refuse_unsupported(engine, scene);
  method_of(engine, settings);  // throws for a method that is not there
  return std::make_unique<BulletWorld>(scene, settings);
}

// The defaults are those that BulletWorld sets, or leaves.
std::string BulletEngine::twin(const Settings& settings) const {
  const std::string name =
      "core:bullet-twin,gyroscopic=" + word_option(settings, "gyroscopic", "implicit-body") + ",sleeping=";
  if (settings.track == Track::matched) return name + "off";
  return fmt::format("{}on,gyroscopic-limit={}", name, btContactSolverInfo().m_maxGyroscopicForce);
}

}  // namespace rigor
