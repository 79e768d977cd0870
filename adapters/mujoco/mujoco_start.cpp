#include "adapters/mujoco/mujoco_start.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/math.h"
#include "core/base/near_match.h"

namespace rigor {

void take_switches(mjModel& model) {
  const int off = model.opt.disableflags;
  const auto is_off = [&](int part) { return (off & part) != 0; };
  const bool no_constraint = is_off(mjDSBL_CONSTRAINT);
  if (is_off(mjDSBL_GRAVITY)) std::fill_n(model.opt.gravity, 3, 0);
  if (no_constraint || is_off(mjDSBL_CONTACT))
    std::fill_n(model.geom_contype, model.ngeom, 0), std::fill_n(model.geom_conaffinity, model.ngeom, 0);
  if (no_constraint || is_off(mjDSBL_LIMIT))
    std::fill_n(model.jnt_limited, model.njnt, 0), std::fill_n(model.tendon_limited, model.ntendon, 0);
  if (no_constraint || is_off(mjDSBL_EQUALITY)) std::fill_n(model.eq_active, model.neq, 0);
  if (no_constraint || is_off(mjDSBL_FRICTIONLOSS))
    std::fill_n(model.dof_frictionloss, model.nv, 0), std::fill_n(model.tendon_frictionloss, model.ntendon, 0);
  if (is_off(mjDSBL_PASSIVE)) {  // springs and dampers
    std::fill_n(model.jnt_stiffness, model.njnt, 0), std::fill_n(model.dof_damping, model.nv, 0);
    std::fill_n(model.tendon_stiffness, model.ntendon, 0), std::fill_n(model.tendon_damping, model.ntendon, 0);
  }
  if (is_off(mjDSBL_ACTUATION)) {
    std::fill_n(model.actuator_biastype, model.nu, static_cast<int>(mjBIAS_NONE));
    std::fill_n(model.actuator_gainprm, mjNGAIN * model.nu, 0);
  }
}

std::vector<std::string> keyframes_of(const mjModel& model) {
  std::vector<std::string> names;
  for (int key = 0; key < model.nkey; ++key) {
    const char* name = mj_id2name(&model, mjOBJ_KEY, key);
    names.push_back(name && *name ? name : std::to_string(key));
  }
  return names;
}

mujoco_library::Data mujoco_start(const mjModel& model, const std::string& path, const std::string& keyframe) {
  mujoco_library::Data data(mj_makeData(&model));
  if (!keyframe.empty()) {
    const std::vector<std::string> names = keyframes_of(model);
    const auto found = std::find(names.begin(), names.end(), keyframe);
    if (found == names.end())
      throw InputError(fmt::format("{}:1: has no keyframe '{}'{}; it has: {}", path, keyframe,
                                   did_you_mean(keyframe, names), listed(names)));
    mj_resetDataKeyframe(&model, data.get(), static_cast<int>(found - names.begin()));
  }
  mj_kinematics(&model, data.get()), mj_comPos(&model, data.get()), mj_comVel(&model, data.get());
  return data;
}

double opening_of(const mjModel& model, const mjData& state, int equality) {
  const bool is_weld = model.eq_type[equality] == mjEQ_WELD;
  if (!is_weld && model.eq_type[equality] != mjEQ_CONNECT) return 0;
  const int a = model.eq_obj1id[equality], b = model.eq_obj2id[equality];
  // A point of each body: the first body's first, but of a weld last; then the turn from one body to the other.
  const mjtNum* data = model.eq_data + mjNEQDATA * equality;
  const auto point = [&](int body, const mjtNum* in_body) {
    mjtNum turned[3];
    mju_rotVecQuat(turned, in_body, state.xquat + 4 * body);
    return Vec3(Eigen::Map<const Vec3>(state.xpos + 3 * body) + Eigen::Map<const Vec3>(turned));
  };
  const double gap = (point(a, data + (is_weld ? 3 : 0)) - point(b, data + (is_weld ? 0 : 3))).norm();
  if (!is_weld) return gap;
  mjtNum held[4], between[3];
  mju_mulQuat(held, state.xquat + 4 * a, data + 6);
  mju_subQuat(between, held, state.xquat + 4 * b);
  return std::max(gap, Eigen::Map<const Vec3>(between).norm());
}

}  // namespace rigor
