#include "adapters/mjcf/mujoco3_reader.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "adapters/plugin/child_process.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolderVariable = "RIGOR_MUJOCO3";
constexpr double kTimeLimit = 60;                              // s
constexpr std::size_t kLongestModel = std::size_t{256} << 20;  // bytes

// It reads one request and writes one answer. Files reach MuJoCo by name alone, so that it opens none of the disk.
// Arrays of bytes cannot be read from the compiled model: what is limited or active is asked of the specification. So
// are names, for mj_id2name gives what has none the name "emsc". The text stands between single quotes of a shell, and
// holds none.
constexpr const char* kScript = R"js(
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { createInterface } from "node:readline";
const lines = createInterface({ input: process.stdin })[Symbol.asyncIterator]();
const request = JSON.parse((await lines.next()).value);
const answer = (value) => process.stdout.write(JSON.stringify(value) + "\n");
const found = createRequire(join(request.package, "x")).resolve("@mujoco/mujoco");
const warnings = [];
const mj = await (await import(pathToFileURL(found).href)).default({ print: (t) => warnings.push(t), printErr: (t) => warnings.push(t) });
function compiled() {
  const vfs = new mj.MjVFS();
  for (const name of request.files) vfs.addBuffer(name, readFileSync(join(request.folder, name)));
  const spec = mj.parseXMLString(readFileSync(join(request.folder, request.file), "utf8"), vfs);
  return [spec, mj.mj_compile(spec, vfs)];
}
const elements = function* (spec, type) {
  for (let e = mj.mjs_firstElement(spec, type); e; e = mj.mjs_nextElement(spec, e)) yield [mj.mjs_getId(e), e];
};
function flags(spec, type, as, count, read) {
  const out = new Array(count).fill(0);
  for (const [id, e] of elements(spec, type)) if (id >= 0 && id < count) out[id] = read(as(e)) ? 1 : 0;
  return out;
}
const limited = (how, range) => how.value === 1 || how === 1 || ((how.value === 2 || how === 2) && range[0] < range[1]);
function numbersOf(model, spec, object) {
  const numbers = {};
  for (const name of request.arrays) {
    const values = model[name];
    if (values !== undefined && values !== null) numbers[name] = Array.from(values.length === undefined ? [values] : values);
  }
  for (const name of ["gravity", "wind", "density", "viscosity"]) numbers["opt_" + name] = [model.opt[name]].flatMap((v) => (v.length === undefined ? [v] : Array.from(v)));
  numbers.jnt_limited = flags(spec, object.mjOBJ_JOINT, mj.mjs_asJoint, model.njnt, (j) => limited(j.limited, j.range));
  numbers.jnt_actfrclimited = flags(spec, object.mjOBJ_JOINT, mj.mjs_asJoint, model.njnt, (j) => limited(j.actfrclimited, j.actfrcrange));
  numbers.tendon_limited = flags(spec, object.mjOBJ_TENDON, mj.mjs_asTendon, model.ntendon, (t) => limited(t.limited, t.range));
  numbers.tendon_actfrclimited = flags(spec, object.mjOBJ_TENDON, mj.mjs_asTendon, model.ntendon, (t) => limited(t.actfrclimited, t.actfrcrange));
  numbers.actuator_ctrllimited = flags(spec, object.mjOBJ_ACTUATOR, mj.mjs_asActuator, model.nu, (a) => limited(a.ctrllimited, a.ctrlrange));
  numbers.actuator_forcelimited = flags(spec, object.mjOBJ_ACTUATOR, mj.mjs_asActuator, model.nu, (a) => limited(a.forcelimited, a.forcerange));
  numbers.eq_active = flags(spec, object.mjOBJ_EQUALITY, mj.mjs_asEquality, model.neq, (e) => e.active);
  return numbers;
}
// Two balls, 15 mm apart, with margins of 10 mm each.
function addsMargins() {
  const ball = "<body pos=\"0 0 X\"><freejoint/><geom size=\"0.1\" margin=\"0.01\"/></body>";
  const text = `<mujoco><worldbody>${ball.replace("X", "0")}${ball.replace("X", "0.215")}</worldbody></mujoco>`;
  const model = mj.mj_compile(mj.parseXMLString(text, new mj.MjVFS()), new mj.MjVFS()), data = new mj.MjData(model);
  mj.mj_forward(model, data);
  return data.ncon > 0;
}
try {
  const [spec, model] = compiled();
  const object = mj.mjtObj, names = {};
  const kinds = { body: [object.mjOBJ_BODY, model.nbody], joint: [object.mjOBJ_JOINT, model.njnt], geom: [object.mjOBJ_GEOM, model.ngeom],
    site: [object.mjOBJ_SITE, model.nsite], tendon: [object.mjOBJ_TENDON, model.ntendon], actuator: [object.mjOBJ_ACTUATOR, model.nu],
    equality: [object.mjOBJ_EQUALITY, model.neq], keyframe: [object.mjOBJ_KEY, model.nkey] };
  for (const [kind, [type, count]] of Object.entries(kinds)) {
    names[kind] = new Array(count).fill("");
    for (const [id, e] of elements(spec, type)) if (id >= 0 && id < count) names[kind][id] = mj.mjs_getName(e);
  }
  const numbers = numbersOf(model, spec, object), data = new mj.MjData(model);
  const off = Object.entries(mj.mjtDisableBit).filter(([word, bit]) => word.startsWith("mjDSBL_") && (model.opt.disableflags & bit.value) !== 0)
    .map(([word]) => word.slice(7).toLowerCase());
  const key = request.keyframe === "" ? -1 : names.keyframe.map((name, i) => name || String(i)).indexOf(request.keyframe);
  if (key >= 0) mj.mj_resetDataKeyframe(model, data, key);
  mj.mj_kinematics(model, data), mj.mj_comPos(model, data), mj.mj_comVel(model, data);
  for (const name of ["xpos", "xquat", "xanchor", "xaxis", "qpos", "ctrl", "act"]) numbers[name] = Array.from(data[name]);
  const velocity = new mj.DoubleBuffer(6);
  numbers.velocity = [];
  for (let body = 0; body < model.nbody; ++body) {
    mj.mj_objectVelocity(model, data, object.mjOBJ_XBODY.value, body, velocity, 0);
    numbers.velocity.push(...velocity.GetView());
  }
  answer({ ok: true, version: mj.mj_versionString(), numbers, names, off, warnings, addsMargins: addsMargins() });
} catch (error) {
  answer({ ok: false, version: mj.mj_versionString(), why: String(error?.message ?? error) + " " + warnings.join(" ") });
}
)js";

const std::vector<std::string> kArrays = {"body_parentid",
                                          "body_weldid",
                                          "body_jntnum",
                                          "body_jntadr",
                                          "body_mocapid",
                                          "body_mass",
                                          "body_inertia",
                                          "body_ipos",
                                          "body_iquat",
                                          "body_gravcomp",
                                          "jnt_type",
                                          "jnt_qposadr",
                                          "jnt_dofadr",
                                          "jnt_bodyid",
                                          "jnt_stiffness",
                                          "jnt_stiffnesspoly",
                                          "jnt_range",
                                          "dof_armature",
                                          "dof_damping",
                                          "dof_dampingpoly",
                                          "dof_frictionloss",
                                          "geom_type",
                                          "geom_contype",
                                          "geom_conaffinity",
                                          "geom_condim",
                                          "geom_bodyid",
                                          "geom_dataid",
                                          "geom_size",
                                          "geom_pos",
                                          "geom_quat",
                                          "geom_friction",
                                          "geom_priority",
                                          "geom_margin",
                                          "geom_gap",
                                          "mesh_vertadr",
                                          "mesh_vertnum",
                                          "mesh_vert",
                                          "hfield_adr",
                                          "hfield_nrow",
                                          "hfield_ncol",
                                          "hfield_size",
                                          "hfield_data",
                                          "exclude_signature",
                                          "eq_type",
                                          "eq_obj1id",
                                          "eq_obj2id",
                                          "eq_objtype",
                                          "eq_data",
                                          "tendon_adr",
                                          "tendon_num",
                                          "tendon_range",
                                          "tendon_stiffness",
                                          "tendon_stiffnesspoly",
                                          "tendon_damping",
                                          "tendon_dampingpoly",
                                          "tendon_frictionloss",
                                          "tendon_armature",
                                          "tendon_lengthspring",
                                          "wrap_type",
                                          "wrap_objid",
                                          "wrap_prm",
                                          "site_bodyid",
                                          "site_pos",
                                          "actuator_trntype",
                                          "actuator_dyntype",
                                          "actuator_gaintype",
                                          "actuator_biastype",
                                          "actuator_trnid",
                                          "actuator_gainprm",
                                          "actuator_biasprm",
                                          "actuator_gear",
                                          "actuator_ctrlrange",
                                          "actuator_forcerange",
                                          "actuator_damping",
                                          "actuator_armature",
                                          "actuator_delay",
                                          "qpos0",
                                          "qpos_spring",
                                          "nsensor",
                                          "nskin",
                                          "nflex",
                                          "nplugin",
                                          "npair"};

// "XML Error: … Element 'geom', line 5": the line goes where lines go.
[[noreturn]] void refuse_for(const MjcfSource& source, const std::string& parser, std::string why) {
  const std::size_t at = why.find("line ");
  const int line = at == std::string::npos ? 1 : std::max(1, std::atoi(why.c_str() + at + 5));
  for (char& c : why) c = static_cast<unsigned char>(c) < 32 ? ' ' : c;
  throw InputError(fmt::format("{}:{}: {} refuses the model: {}", source.path, line, parser, why.substr(0, 400)));
}

}  // namespace

std::string mujoco3_folder() {
  const char* folder = std::getenv(kFolderVariable);
  std::error_code error;
  const bool is_there = folder && fs::is_directory(fs::path(folder) / "node_modules/@mujoco/mujoco", error);
  return is_there ? fs::absolute(folder, error).string() : "";
}

CompiledMjcf read_with_mujoco3(const MjcfSource& source) {
  const fs::path path = source.path;
  std::error_code error;
  const Json request = {
      {"package", mujoco3_folder()},      {"folder", fs::absolute(path, error).parent_path().string()},
      {"file", path.filename().string()}, {"files", source.files},
      {"keyframe", source.keyframe},      {"arrays", kArrays}};
  // The limit of an import's memory is on this process. WebAssembly reserves addresses beyond it, and has limits
  // itself.
  ChildProcess node(fmt::format("sh -c \"ulimit -S -v unlimited 2>/dev/null; exec node --max-old-space-size=1000 "
                                "--input-type=module --eval \\\"\\$0\\\"\" '{}'",
                                kScript),
                    kTimeLimit, -1, "MuJoCo 3");
  const Json answer = Json::parse(node.ask(request.dump(), "read", kLongestModel));
  CompiledMjcf model;
  model.parser = "MuJoCo " + answer.at("version").get<std::string>();
  if (!answer.at("ok").get<bool>()) refuse_for(source, model.parser, answer.at("why").get<std::string>());
  model.adds_margins = answer.at("addsMargins").get<bool>();
  for (const auto& [name, values] : answer.at("numbers").items()) {
    std::vector<double>& row = model.numbers[name];
    for (const Json& value : values)  // JSON has no infinity
      row.push_back(value.is_boolean() ? double(value.get<bool>()) : value.is_number() ? value.get<double>() : 0);
  }
  for (const auto& [kind, values] : answer.at("names").items())
    model.names[kind] = values.get<std::vector<std::string>>();
  for (const Json& word : answer.at("off")) model.off.insert(word.get<std::string>());
  for (const Json& line : answer.at("warnings")) model.warnings.push_back(line.get<std::string>());
  return model;
}

}  // namespace rigor
