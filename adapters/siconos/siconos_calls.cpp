#include "adapters/siconos/siconos_calls.h"

#include <fmt/format.h>

#include "adapters/siconos/siconos_matched.h"
#include "core/engine/option_values.h"

namespace rigor {

std::vector<std::string> siconos_calls(const Settings& settings, const std::string& dt) {
  const bool matched = settings.track == Track::matched;
  std::vector<std::string> calls = {
      fmt::format("auto osi = std::make_shared<MoreauJeanOSI>({});", number_option(settings, "theta", kSiconosTheta)),
      "auto osnsp = std::make_shared<FrictionContact>(3, SICONOS_FRICTION_3D_NSGS);"};
  const auto set = [&](const char* option, const char* place, double matched_value) {
    if (matched || settings.options.contains(option))
      calls.push_back(fmt::format("osnsp->numericsSolverOptions()->{} = {};", place,
                                  number_option(settings, option, matched_value)));
  };
  set("tolerance", "dparam[SICONOS_DPARAM_TOL]", kSiconosTolerance);
  set("iterations", "iparam[SICONOS_IPARAM_MAX_ITER]", kSiconosIterations);
  if (matched) calls.push_back(fmt::format("simulation->setNewtonMaxIteration({});", kSiconosPasses));
  calls.push_back(fmt::format("TimeDiscretisation(0, {}); simulation->computeOneStep(); simulation->nextStep();", dt));
  return calls;
}

}  // namespace rigor
