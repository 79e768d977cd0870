#include "adapters/ode/ode_calls.h"

#include <fmt/format.h>

#include "core/engine/option_values.h"

namespace rigor {

std::vector<std::string> ode_calls(const Settings& settings, const std::string& dt) {
  const bool is_matched = settings.track == Track::matched;
  const bool is_quick = settings.method == "quickstep";
  std::vector<std::string> calls;
  if (is_matched) calls = {"dWorldSetAutoDisableFlag(world, 0);", "dWorldSetDamping(world, 0, 0);"};
  const auto add = [&](const char* option, const char* call) {
    const auto found = settings.options.find(option);
    if (found != settings.options.end()) calls.push_back(fmt::format("{}(world, {});", call, found->second));
  };
  add("erp", "dWorldSetERP"), add("cfm", "dWorldSetCFM");
  add("iterations", "dWorldSetQuickStepNumIterations"), add("sor", "dWorldSetQuickStepW");
  const std::string rotation = word_option(settings, "rotation", is_matched ? "finite" : "infinitesimal");
  calls.push_back(fmt::format("dBodySetFiniteRotationMode(body, {});", rotation == "finite" ? 1 : 0));
  calls.push_back(
      fmt::format("dBodySetGyroscopicMode(body, {});", word_option(settings, "gyroscopic", "on") == "on" ? 1 : 0));
  const std::string auto_note = settings.method == "auto" ? "  // dWorldQuickStep for large scenes" : "";
  calls.push_back(fmt::format("{}(world, {});{}", is_quick ? "dWorldQuickStep" : "dWorldStep", dt, auto_note));
  return calls;
}

}  // namespace rigor
