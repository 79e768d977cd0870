#include "adapters/mujoco/mujoco_import.h"

#include <fmt/format.h>
#include <mujoco/mjxmacro.h>

#include <algorithm>
#include <type_traits>

#include "adapters/mujoco/mujoco_library.h"

namespace rigor::inline adapters {
namespace {

template <typename Number>
void keep(CompiledMjcf& out, const char* name, const Number* values, long count) {
  if constexpr (std::is_arithmetic_v<Number>) out.numbers[name].assign(values, values + count);
}

// Every array of the model, but textures and names.
void keep_arrays(const mjModel& model, CompiledMjcf& out) {
  const mjModel* m = &model;
  MJMODEL_POINTERS_PREAMBLE(m)
#define X(type, name, rows, columns)                                           \
  if (std::string(#name).find("tex_") != 0 && std::string(#name) != "names" && \
      std::string(#name).find("_user") == std::string::npos)                   \
    keep(out, #name, m->name, long{m->rows} * (columns));
  MJMODEL_POINTERS
#undef X
  const auto count = [&](const char* name, int value) { out.numbers[name] = {double(value)}; };
  count("nsensor", m->nsensor), count("nskin", m->nskin), count("npair", m->npair);
  keep(out, "opt_gravity", m->opt.gravity, 3);
  keep(out, "opt_density", &m->opt.density, 1), keep(out, "opt_viscosity", &m->opt.viscosity, 1);
  // A body's number there is one more than itself. A tendon's spring has one length.
  for (double& signature : out.numbers["exclude_signature"]) signature -= (1 << 16) + 1;
  std::vector<double> lengths;
  for (const double length : out.numbers["tendon_lengthspring"]) lengths.insert(lengths.end(), {length, length});
  out.numbers["tendon_lengthspring"] = lengths;
}

void keep_names(const mjModel& model, CompiledMjcf& out) {
  const auto keep_kind = [&](const char* kind, int type, int count) {
    for (int id = 0; id < count; ++id) {
      const char* name = mj_id2name(&model, type, id);
      out.names[kind].emplace_back(name ? name : "");
    }
  };
  keep_kind("body", mjOBJ_BODY, model.nbody), keep_kind("joint", mjOBJ_JOINT, model.njnt);
  keep_kind("geom", mjOBJ_GEOM, model.ngeom), keep_kind("site", mjOBJ_SITE, model.nsite);
  keep_kind("tendon", mjOBJ_TENDON, model.ntendon), keep_kind("actuator", mjOBJ_ACTUATOR, model.nu);
  keep_kind("equality", mjOBJ_EQUALITY, model.neq), keep_kind("keyframe", mjOBJ_KEY, model.nkey);
  out.names["model"] = {model.names ? model.names : ""};
}

void keep_switches(const mjModel& model, CompiledMjcf& out) {
  constexpr std::pair<int, const char*> kSwitches[] = {
      {mjDSBL_CONSTRAINT, "constraint"}, {mjDSBL_EQUALITY, "equality"},        {mjDSBL_FRICTIONLOSS, "frictionloss"},
      {mjDSBL_LIMIT, "limit"},           {mjDSBL_CONTACT, "contact"},          {mjDSBL_PASSIVE, "spring"},
      {mjDSBL_PASSIVE, "damper"},        {mjDSBL_GRAVITY, "gravity"},          {mjDSBL_CLAMPCTRL, "clampctrl"},
      {mjDSBL_ACTUATION, "actuation"},   {mjDSBL_FILTERPARENT, "filterparent"}};
  for (const auto& [bit, word] : kSwitches) {
    if (model.opt.disableflags & bit) out.off.insert(word);
  }
}

void keep_start(const mjModel& model, const std::string& keyframe, CompiledMjcf& out) {
  const mujoco_library::Data data(mj_makeData(&model));
  for (std::size_t k = 0; k < out.names["keyframe"].size() && !keyframe.empty(); ++k) {
    const std::string name = out.names["keyframe"][k].empty() ? std::to_string(k) : out.names["keyframe"][k];
    if (name == keyframe) mj_resetDataKeyframe(&model, data.get(), static_cast<int>(k));
  }
  mj_kinematics(&model, data.get()), mj_comPos(&model, data.get()), mj_comVel(&model, data.get());
  keep(out, "xpos", data->xpos, 3L * model.nbody), keep(out, "xquat", data->xquat, 4L * model.nbody);
  keep(out, "xanchor", data->xanchor, 3L * model.njnt), keep(out, "xaxis", data->xaxis, 3L * model.njnt);
  keep(out, "qpos", data->qpos, model.nq), keep(out, "ctrl", data->ctrl, model.nu);
  keep(out, "act", data->act, model.na);
  for (int body = 0; body < model.nbody; ++body) {
    mjtNum velocity[6];
    mj_objectVelocity(&model, data.get(), mjOBJ_XBODY, body, velocity, 0);
    out.numbers["velocity"].insert(out.numbers["velocity"].end(), velocity, velocity + 6);
  }
}

}  // namespace

CompiledMjcf read_with_mujoco(const MjcfSource& source) {
  const mujoco_library::Model model = mujoco_library::read_file(source.path);
  CompiledMjcf out;
  out.parser = fmt::format("MuJoCo {}", mj_versionString());
  keep_arrays(*model, out), keep_names(*model, out), keep_switches(*model, out);
  keep_start(*model, source.keyframe, out);
  if (const std::string warnings = mujoco_library::take_warnings(); !warnings.empty()) out.warnings.push_back(warnings);
  return out;
}

}  // namespace rigor::inline adapters
