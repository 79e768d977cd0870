#include "adapters/ode/ode_calls.h"
#include "adapters/ode/ode_options.h"

#include <fmt/format.h>

#include "core/engine/option_values.h"

namespace rigor::inline adapters {

std::vector<std::string> ode_calls(const Settings& settings, const std::string& dt) {
  const bool is_matched = settings.track == Track::matched;
  const bool is_quick = settings.method == "quickstep";
  std::vector<std::string> calls;
  if (is_matched) calls = {"dWorldSetAutoDisableFlag(world, 0);", "dWorldSetDamping(world, 0, 0);"};
  const auto add = [&](const OptionInfo& option, const char* call) {
    if (is_named(settings, option))
      calls.push_back(fmt::format("{}(world, {});", call, settings.options.at(option.name)));
  };
  add(kOdeErp, "dWorldSetERP"), add(kOdeCfm, "dWorldSetCFM");
  add(kOdeIterations, "dWorldSetQuickStepNumIterations"), add(kOdeSor, "dWorldSetQuickStepW");
  const bool is_finite = word_option(settings, kOdeRotation) == "finite";
  calls.push_back(fmt::format("dBodySetFiniteRotationMode(body, {});", is_finite ? 1 : 0));
  const bool is_gyroscopic = word_option(settings, kOdeGyroscopic) == "on";
  calls.push_back(fmt::format("dBodySetGyroscopicMode(body, {});", is_gyroscopic ? 1 : 0));
  if (is_named(settings, kOdeServo) && word_option(settings, kOdeServo) == "native")
    calls.push_back(
        "// each servo is both stops at its target: dParamStopERP dt kp/(dt kp + kd), dParamStopCFM 1/(dt kp + kd)");
  const std::string auto_note = settings.method == "auto" ? "  // dWorldQuickStep for large scenes" : "";
  calls.push_back(fmt::format("{}(world, {});{}", is_quick ? "dWorldQuickStep" : "dWorldStep", dt, auto_note));
  return calls;
}

}  // namespace rigor::inline adapters
