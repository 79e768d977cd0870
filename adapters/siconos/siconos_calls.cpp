#include "adapters/siconos/siconos_calls.h"

#include <fmt/format.h>

#include "adapters/siconos/siconos_matched.h"
#include "adapters/siconos/siconos_options.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {

std::vector<std::string> siconos_calls(const Settings& settings, const std::string& dt) {
  const bool matched = settings.track == Track::matched;
  std::vector<std::string> calls = {
      fmt::format("auto osi = std::make_shared<MoreauJeanOSI>({});", number_option(settings, kSiconosThetaOption)),
      "auto osnsp = std::make_shared<FrictionContact>(3, SICONOS_FRICTION_3D_NSGS);"};
  if (matched) calls.push_back(fmt::format("osi->setConstraintActivationThreshold({:g});", kSiconosTouching));
  const auto set = [&](const OptionInfo& option, const char* place) {
    if (const auto number = number_to_set(settings, option))
      calls.push_back(fmt::format("osnsp->numericsSolverOptions()->{} = {};", place, *number));
  };
  set(kSiconosToleranceOption, "dparam[SICONOS_DPARAM_TOL]");
  set(kSiconosIterationsOption, "iparam[SICONOS_IPARAM_MAX_ITER]");
  if (matched) calls.push_back(fmt::format("simulation->setNewtonMaxIteration({});", kSiconosPasses));
  calls.push_back(fmt::format("TimeDiscretisation(0, {}); simulation->computeOneStep(); simulation->nextStep();", dt));
  return calls;
}

}  // namespace rigor::inline adapters
