#include "adapters/bullet/bullet_calls.h"

#include <fmt/format.h>

#include <map>

namespace rigor {

std::vector<std::string> bullet_calls(const Settings& settings, const std::string& dt) {
  static const std::map<std::string, std::string> flags = {
      {"implicit-body", "BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY"},
      {"implicit-world", "BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD"},
      {"explicit", "BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT"},
      {"off", "0"}};
  std::vector<std::string> calls;
  if (settings.track == Track::matched) {
    calls = {"world->getSolverInfo().m_restitutionVelocityThreshold = 0;",
             "world->getSolverInfo().m_splitImpulsePenetrationThreshold = 1e30;",
             "world->getSolverInfo().m_maxGyroscopicForce = 1e30;", "body->setActivationState(DISABLE_DEACTIVATION);",
             "body->setDamping(0, 0);"};
  }
  for (const auto& [option, value] : settings.options) {
    if (option == "iterations") calls.push_back(fmt::format("world->getSolverInfo().m_numIterations = {};", value));
    if (option == "erp") calls.push_back(fmt::format("world->getSolverInfo().m_erp = {};", value));
    if (option == "cfm") calls.push_back(fmt::format("world->getSolverInfo().m_globalCfm = {};", value));
    if (option == "split-impulse")
      calls.push_back(fmt::format("world->getSolverInfo().m_splitImpulse = {};", value == "on" ? "true" : "false"));
    if (option == "gyroscopic") calls.push_back(fmt::format("body->setFlags({});", flags.at(value)));
  }
  calls.push_back(fmt::format("world->stepSimulation({}, 0);  // one step of it, and no substeps", dt));
  return calls;
}

}  // namespace rigor
