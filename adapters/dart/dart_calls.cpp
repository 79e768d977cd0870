#include "adapters/dart/dart_calls.h"

#include <fmt/format.h>

#include "adapters/dart/dart_options.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {

std::vector<std::string> dart_calls(const Settings& settings, const std::string& dt) {
  const bool matched = settings.track == Track::matched;
  std::vector<std::string> calls;
  if (settings.method == "pgs") {
    calls = {"auto* solver = static_cast<BoxedLcpConstraintSolver*>(world->getConstraintSolver());",
             "solver->setBoxedLcpSolver(std::make_shared<PgsBoxedLcpSolver>());",
             "solver->setSecondaryBoxedLcpSolver(nullptr);"};
  }
  if (matched) {
    calls.insert(calls.end(), {"world->getConstraintSolver()->setCollisionDetector(DARTCollisionDetector::create());",
                               fmt::format("world->getConstraintSolver()->getCollisionOption().maxNumContacts = {};",
                                           kDartMostContacts)});
  }
  const auto set = [&](const OptionInfo& option, const char* call, double contacts, double loops) {
    if (!matched && !is_named(settings, option)) return;
    calls.push_back(fmt::format("ContactConstraint::{}({});", call, number_option(settings, option, contacts)));
    calls.push_back(fmt::format("DynamicJointConstraint::{}({});", call, number_option(settings, option, loops)));
  };
  set(kDartErp, "setErrorReductionParameter", kDartContactErp, kDartLoopErp);
  set(kDartSoftness, "setConstraintForceMixing", kDartCfm, kDartCfm);
  if (matched) calls.push_back(fmt::format("ContactConstraint::setMaxErrorReductionVelocity({});", kDartContactSpeed));
  calls.push_back(fmt::format("world->setTimeStep({}); world->step();", dt));
  return calls;
}

}  // namespace rigor::inline adapters
