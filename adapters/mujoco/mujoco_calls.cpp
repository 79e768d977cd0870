#include "adapters/mujoco/mujoco_calls.h"

#include <fmt/format.h>

#include <map>

#include "adapters/mujoco/mujoco_options.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {

std::vector<std::string> mujoco_calls(const Settings& settings, const std::string& dt, const MujocoVersion& version) {
  static const std::map<std::string, std::string> integrators = {{"euler", "mjINT_EULER"},
                                                                 {"implicit", "mjINT_IMPLICIT"},
                                                                 {"implicitfast", "mjINT_IMPLICITFAST"},
                                                                 {"rk4", "mjINT_RK4"}};
  const bool matched = settings.track == Track::matched;
  std::vector<std::string> calls = {fmt::format("m->opt.integrator = {};", integrators.at(settings.method))};
  if (matched)
    calls.insert(calls.end(),
                 {"m->opt.solver = mjSOL_NEWTON;", fmt::format("m->opt.tolerance = {:g};", version.tolerance)});
  if (matched && version.has_native_collisions)
    calls.push_back("m->opt.disableflags |= mjDSBL_NATIVECCD;  // in a scene with a height field");
  if (const auto cone = word_to_set(settings, kMujocoCone)) {
    calls.push_back(fmt::format("m->opt.cone = {};", *cone == "elliptic" ? "mjCONE_ELLIPTIC" : "mjCONE_PYRAMIDAL"));
  }
  for (const OptionInfo& option : {kMujocoIterations, kMujocoImpratio}) {
    if (const auto number = number_to_set(settings, option))
      calls.push_back(fmt::format("m->opt.{} = {};", option.name, *number));
  }
  if (matched) {
    calls.push_back(
        "for (int i = 0; i < m->ngeom; ++i) m->geom_solimp[mjNIMP*i] = m->geom_solimp[mjNIMP*i + 1] = 0.999;");
  }
  struct OfContacts {
    const OptionInfo& option;
    const char* place;
  };
  for (const auto& [option, place] : {OfContacts{kMujocoContactTime, "solref[mjNREF*i]"},
                                      {kMujocoContactDamping, "solref[mjNREF*i + 1]"},
                                      {kMujocoContactStart, "solimp[mjNIMP*i]"},
                                      {kMujocoContactDeep, "solimp[mjNIMP*i + 1]"},
                                      {kMujocoContactWidth, "solimp[mjNIMP*i + 2]"},
                                      {kMujocoContactMargin, "margin[i]"}}) {
    if (is_named(settings, option))
      calls.push_back(
          fmt::format("for (int i = 0; i < m->ngeom; ++i) m->geom_{} = {};", place, number_option(settings, option)));
  }
  if (is_named(settings, kMujocoServo) && word_option(settings, kMujocoServo) == "native") {
    calls.push_back("// each servo is an actuator: gaintype fixed, gainprm 1, biastype affine, biasprm 0 -kp -kd");
    calls.push_back("d->ctrl[i] = kp * target + kd * target_speed;");
  }
  calls.push_back(fmt::format("m->opt.timestep = {}; mj_step(m, d);", dt));
  return calls;
}

}  // namespace rigor::inline adapters
