#include "adapters/mujoco/mujoco_values.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

#include "adapters/mujoco/mujoco_options.h"
#include "core/engine/option_values.h"

namespace rigor::inline adapters {
namespace {

struct Array {
  const char* name;
  mjtNum* mjModel::*numbers;
  int mjModel::*rows;
};

constexpr Array kArrays[] = {
    {"dof_solimp", &mjModel::dof_solimp, &mjModel::nv},      {"dof_solref", &mjModel::dof_solref, &mjModel::nv},
    {"eq_solimp", &mjModel::eq_solimp, &mjModel::neq},       {"eq_solref", &mjModel::eq_solref, &mjModel::neq},
    {"geom_margin", &mjModel::geom_margin, &mjModel::ngeom}, {"geom_solimp", &mjModel::geom_solimp, &mjModel::ngeom},
    {"geom_solref", &mjModel::geom_solref, &mjModel::ngeom}, {"jnt_solimp", &mjModel::jnt_solimp, &mjModel::njnt},
    {"jnt_solref", &mjModel::jnt_solref, &mjModel::njnt},    {"pair_margin", &mjModel::pair_margin, &mjModel::npair},
    {"pair_solimp", &mjModel::pair_solimp, &mjModel::npair}, {"pair_solref", &mjModel::pair_solref, &mjModel::npair}};

// Contacts keep the shipped time constant (0.02 s, at least 2 dt). Friction that ends a slide at once would press the
// bodies apart, and they would hop. Only the share of the law's acceleration is changed: the shipped 0.9 lets bodies
// creep down slopes that should hold them. With 0.9999 the solver's line search sometimes fails.
constexpr double kContactImpedance = 0.999;

// A constraint's acceleration towards its rest is -b v - k r (negative solref means k and b themselves).
constexpr std::array<double, mjNIMP> kImpedance = {0.9999, 0.9999, 0.001, 0.5, 1};  // nearly all of that acceleration

// Of a loop a gap and its speed are gone after one step: k = 1/dt², b = 1/dt.
// A limit stops the motion within a step. The small overshoot remains and falls with the step. Pushing it back would
// add a speed that stays, and a stop without restitution would bounce. MuJoCo reads these of limited joints alone.
// A joint's friction ends its speed within a step. Its softness still lets the joint creep under a load.
std::vector<MujocoValue> stiff_values() {
  std::vector<MujocoValue> values = {{"eq_solref", mjNREF, 0, -1, 2}, {"eq_solref", mjNREF, 1, -1, 1},
                                     {"jnt_solref", mjNREF, 0, 0},    {"jnt_solref", mjNREF, 1, -1, 1},
                                     {"dof_solref", mjNREF, 0, 0},    {"dof_solref", mjNREF, 1, -1, 1}};
  for (const char* array : {"eq_solimp", "jnt_solimp", "dof_solimp"}) {
    for (int at = 0; at < mjNIMP; ++at) values.push_back({array, mjNIMP, at, kImpedance[static_cast<std::size_t>(at)]});
  }
  return values;
}

}  // namespace

std::vector<MujocoValue> mujoco_contact_values(const Settings& settings) {
  std::vector<MujocoValue> values;
  if (settings.track == Track::matched) {
    for (const char* array : {"geom_solimp", "pair_solimp"}) {
      for (const int at : {0, 1}) values.push_back({array, mjNIMP, at, kContactImpedance});
    }
  }
  const auto add_if_named = [&](const OptionInfo& option, std::initializer_list<const char*> arrays, int length,
                                int at) {
    if (!is_named(settings, option)) return;
    for (const char* array : arrays) values.push_back({array, length, at, number_option(settings, option)});
  };
  add_if_named(kMujocoContactTime, {"geom_solref", "pair_solref"}, mjNREF, 0);
  add_if_named(kMujocoContactDamping, {"geom_solref", "pair_solref"}, mjNREF, 1);
  add_if_named(kMujocoContactStart, {"geom_solimp", "pair_solimp"}, mjNIMP, 0);
  add_if_named(kMujocoContactDeep, {"geom_solimp", "pair_solimp"}, mjNIMP, 1);
  add_if_named(kMujocoContactWidth, {"geom_solimp", "pair_solimp"}, mjNIMP, 2);
  add_if_named(kMujocoContactMargin, {"geom_margin", "pair_margin"}, 1, 0);
  return values;
}

const std::vector<MujocoValue>& mujoco_stiff_values() {
  static const std::vector<MujocoValue> values = stiff_values();
  return values;
}

void mujoco_set(mjModel& model, const std::vector<MujocoValue>& values, double dt) {
  for (const MujocoValue& one : values) {
    const auto* const array = std::find_if(std::begin(kArrays), std::end(kArrays),
                                           [&](const Array& row) { return !std::strcmp(row.name, one.array); });
    assert(array != std::end(kArrays) && "an array of mjModel that has no row");
    const double value = one.value / (one.per_dt == 2 ? dt * dt : one.per_dt == 1 ? dt : 1);
    mjtNum* const numbers = model.*(array->numbers);
    for (int i = 0; i < model.*(array->rows); ++i) numbers[one.length * i + one.at] = value;
  }
}

}  // namespace rigor::inline adapters
