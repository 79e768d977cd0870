#include "adapters/bullet/bullet_calls.h"

#include <fmt/format.h>

#include <map>

#include "adapters/bullet/bullet_options.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {
namespace {

void append(std::vector<std::string>& calls, const std::vector<std::string>& more) {
  calls.insert(calls.end(), more.begin(), more.end());
}

// The calls of the options that the run names.
void add_option_calls(const Settings& settings, std::vector<std::string>& calls) {
  static const std::map<std::string, std::string> flags = {
      {"implicit-body", "BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY"},
      {"implicit-world", "BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD"},
      {"explicit", "BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT"},
      {"off", "0"}};
  for (const auto& [option, value] : settings.options) {
    if (option == "iterations") calls.push_back(fmt::format("world->getSolverInfo().m_numIterations = {};", value));
    if (option == "erp") calls.push_back(fmt::format("world->getSolverInfo().m_erp = {};", value));
    if (option == "cfm") calls.push_back(fmt::format("world->getSolverInfo().m_globalCfm = {};", value));
    if (option == "split-impulse")
      calls.push_back(fmt::format("world->getSolverInfo().m_splitImpulse = {};", value == "on" ? "true" : "false"));
    if (option == "gyroscopic") calls.push_back(fmt::format("body->setFlags({});", flags.at(value)));
  }
}

// Calls of BulletMultibodyWorld: `body` is a btMultiBody, `world` a btMultiBodyDynamicsWorld.
std::vector<std::string> multibody_calls(const Settings& settings) {
  std::vector<std::string> calls = {
      "btMultiBodyConstraintSolver solver;",
      "auto* world = new btMultiBodyDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration);",
      "body->setCanSleep(false);"};
  if (settings.track == Track::matched) {
    append(calls, {"body->setLinearDamping(0);", "body->setAngularDamping(0);", "body->setMaxCoordinateVelocity(1e30);",
                   "world->getSolverInfo().m_erp = 0;", "world->getSolverInfo().m_erp2 = 0;",
                   "limit->setMaxAppliedImpulse(1e30);  // of each btMultiBodyJointLimitConstraint"});
  }
  add_option_calls(settings, calls);
  return calls;
}

// The values that the matched track takes from the scene if the run does not set them.
void add_matched_defaults(const Settings& settings, std::vector<std::string>& calls) {
  if (!is_named(settings, bullet::kErpOption))
    calls.push_back(fmt::format("world->getSolverInfo().m_erp = {};  // in a scene with joints", bullet::kErp));
  if (settings.method == "mlcp" && !is_named(settings, bullet::kDirectCfm)) {
    calls.push_back(
        fmt::format("world->getSolverInfo().m_globalCfm = {} * dt / heaviest_mass;  // {} in a scene without joints",
                    bullet::kJointSoftness, bullet::kContactSoftness));
  }
}

// Calls of BulletWorld: `body` is a btRigidBody.
std::vector<std::string> rigid_body_calls(const Settings& settings) {
  std::vector<std::string> calls;
  if (settings.method == "mlcp")
    calls = {"btDantzigSolver dantzig;", "btMLCPSolver solver(&dantzig);", "world->setConstraintSolver(&solver);"};
  if (settings.track == Track::matched) {
    append(calls, {"world->getSolverInfo().m_restitutionVelocityThreshold = 0;",
                   "world->getSolverInfo().m_splitImpulsePenetrationThreshold = 1e30;",
                   "world->getSolverInfo().m_maxGyroscopicForce = 1e30;",
                   "configuration.setPlaneConvexMultipointIterations(4, 4);",
                   "body->setActivationState(DISABLE_DEACTIVATION);", "body->setDamping(0, 0);",
                   "body->setContactProcessingThreshold(0);  // in a scene where bodies bounce",
                   "body->setCcdMotionThreshold(inner_radius);  // in a scene where nothing bounces",
                   "body->setCcdSweptSphereRadius(inner_radius);  // likewise"});
    add_matched_defaults(settings, calls);
  }
  add_option_calls(settings, calls);
  return calls;
}

}  // namespace

std::vector<std::string> bullet_calls(const Settings& settings, const std::string& dt) {
  std::vector<std::string> calls =
      settings.method == "multibody" ? multibody_calls(settings) : rigid_body_calls(settings);
  calls.push_back(fmt::format("world->stepSimulation({}, 0);  // one step of it, and no substeps", dt));
  return calls;
}

}  // namespace rigor::inline adapters
