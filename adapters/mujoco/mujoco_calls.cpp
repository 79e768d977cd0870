#include "adapters/mujoco/mujoco_calls.h"

#include <fmt/format.h>

#include <map>

#include "core/engine/option_values.h"

namespace rigor {

std::vector<std::string> mujoco_calls(const Settings& settings, const std::string& dt) {
  static const std::map<std::string, std::string> integrators = {
      {"euler", "mjINT_EULER"}, {"implicit", "mjINT_IMPLICIT"}, {"rk4", "mjINT_RK4"}};
  const bool matched = settings.track == Track::matched;
  std::vector<std::string> calls = {fmt::format("m->opt.integrator = {};", integrators.at(settings.method))};
  const auto set = [&](const std::string& option, const std::string& matched_value) {
    if (matched || settings.options.contains(option))
      calls.push_back(fmt::format("m->opt.{} = {};", option, word_option(settings, option, matched_value)));
  };
  if (matched) calls.insert(calls.end(), {"m->opt.solver = mjSOL_NEWTON;", "m->opt.tolerance = 1e-10;"});
  if (matched || settings.options.contains("cone")) {
    calls.push_back(fmt::format("m->opt.cone = {};", word_option(settings, "cone", "elliptic") == "elliptic"
                                                         ? "mjCONE_ELLIPTIC"
                                                         : "mjCONE_PYRAMIDAL"));
  }
  set("iterations", "200");
  set("impratio", "100");
  if (matched) {
    calls.push_back(
        "for (int i = 0; i < m->ngeom; ++i) m->geom_solimp[mjNIMP*i] = m->geom_solimp[mjNIMP*i + 1] = 0.999;");
  }
  if (settings.options.contains("contact-time"))
    calls.push_back(fmt::format("for (int i = 0; i < m->ngeom; ++i) m->geom_solref[mjNREF*i] = {};",
                                settings.options.at("contact-time")));
  calls.push_back(fmt::format("m->opt.timestep = {}; mj_step(m, d);", dt));
  return calls;
}

}  // namespace rigor
