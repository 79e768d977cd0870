#include "adapters/simbody/simbody_calls.h"

#include <fmt/format.h>

#include <map>

#include "adapters/simbody/simbody_world.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {

std::vector<std::string> simbody_calls(const Settings& settings, const std::string& dt) {
  static const std::map<std::string, std::string> kinds = {{"cpodes", "CPodes"},
                                                           {"explicit-euler", "ExplicitEuler"},
                                                           {"feldberg", "RungeKuttaFeldberg"},
                                                           {"merson", "RungeKuttaMerson"},
                                                           {"rk2", "RungeKutta2"},
                                                           {"rk3", "RungeKutta3"},
                                                           {"semi-explicit-euler", "SemiExplicitEuler"},
                                                           {"semi-explicit-euler-2", "SemiExplicitEuler2"},
                                                           {"verlet", "Verlet"}};
  const std::string own_step = settings.method == "semi-explicit-euler" ? ", " + dt : "";
  std::vector<std::string> calls = {fmt::format("{}Integrator integ(system{});", kinds.at(settings.method), own_step)};
  const SimbodySteps steps = simbody_steps(settings);
  if (steps.are_fixed && own_step.empty()) calls.push_back(fmt::format("integ.setFixedStepSize({});", dt));
  if (steps.are_fixed) calls.push_back("integ.setProjectEveryStep(true);");
  if (steps.accuracy) calls.push_back(fmt::format("integ.setAccuracy({:g});", *steps.accuracy));
  if (steps.constraint_tolerance)
    calls.push_back(fmt::format("integ.setConstraintTolerance({:g});", *steps.constraint_tolerance));
  if (!steps.reads_between) calls.push_back("integ.setAllowInterpolation(false);");
  calls.insert(calls.end(), {"integ.initialize(state);",
                             fmt::format("for (int k = 1; k <= steps; ++k) while (integ.getTime() < k * {0}) "
                                         "integ.stepTo(k * {0});",
                                         dt)});
  return calls;
}

}  // namespace rigor::inline adapters
