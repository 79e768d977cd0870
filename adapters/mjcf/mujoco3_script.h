// JavaScript that compiles an MJCF file with MuJoCo 3 to plain data: answerTo(MuJoCo, request, read, warnings).
// mujoco3_reader.cpp starts it in Node. The laboratory's page (cases/laboratory/page/build.mjs) takes the same text
// from this file.
#pragma once

namespace rigor::inline adapters {

// Files reach MuJoCo by name alone, so that it opens none of the disk. Arrays of bytes cannot be read from the compiled
// model: what is limited or active is asked of the specification. So are names, for mj_id2name gives what has none the
// name "emsc". The text stands between single quotes of a shell, and holds none.
inline constexpr const char* kMujoco3Script = R"js(
function compiled(mj, request, read) {
  const vfs = new mj.MjVFS();
  for (const name of request.files) vfs.addBuffer(name, read(name));
  const spec = mj.parseXMLString(read(request.file, "utf8"), vfs);
  return [spec, mj.mj_compile(spec, vfs)];
}
const elements = function* (mj, spec, type) {
  for (let e = mj.mjs_firstElement(spec, type); e; e = mj.mjs_nextElement(spec, e)) yield [mj.mjs_getId(e), e];
};
function flags(mj, spec, type, as, count, read) {
  const out = new Array(count).fill(0);
  for (const [id, e] of elements(mj, spec, type)) if (id >= 0 && id < count) out[id] = read(as(e)) ? 1 : 0;
  return out;
}
const limited = (how, range) => how.value === 1 || how === 1 || ((how.value === 2 || how === 2) && range[0] < range[1]);
function numbersOf(mj, request, model, spec, object) {
  const numbers = {};
  for (const name of request.arrays) {
    const values = model[name];
    if (values !== undefined && values !== null) numbers[name] = Array.from(values.length === undefined ? [values] : values);
  }
  for (const name of ["gravity", "wind", "density", "viscosity"]) numbers["opt_" + name] = [model.opt[name]].flatMap((v) => (v.length === undefined ? [v] : Array.from(v)));
  numbers.jnt_limited = flags(mj, spec, object.mjOBJ_JOINT, mj.mjs_asJoint, model.njnt, (j) => limited(j.limited, j.range));
  numbers.jnt_actfrclimited = flags(mj, spec, object.mjOBJ_JOINT, mj.mjs_asJoint, model.njnt, (j) => limited(j.actfrclimited, j.actfrcrange));
  numbers.tendon_limited = flags(mj, spec, object.mjOBJ_TENDON, mj.mjs_asTendon, model.ntendon, (t) => limited(t.limited, t.range));
  numbers.tendon_actfrclimited = flags(mj, spec, object.mjOBJ_TENDON, mj.mjs_asTendon, model.ntendon, (t) => limited(t.actfrclimited, t.actfrcrange));
  numbers.actuator_ctrllimited = flags(mj, spec, object.mjOBJ_ACTUATOR, mj.mjs_asActuator, model.nu, (a) => limited(a.ctrllimited, a.ctrlrange));
  numbers.actuator_forcelimited = flags(mj, spec, object.mjOBJ_ACTUATOR, mj.mjs_asActuator, model.nu, (a) => limited(a.forcelimited, a.forcerange));
  numbers.eq_active = flags(mj, spec, object.mjOBJ_EQUALITY, mj.mjs_asEquality, model.neq, (e) => e.active);
  return numbers;
}
// Two balls, 15 mm apart, with margins of 10 mm each.
function addsMargins(mj) {
  const ball = "<body pos=\"0 0 X\"><freejoint/><geom size=\"0.1\" margin=\"0.01\"/></body>";
  const text = `<mujoco><worldbody>${ball.replace("X", "0")}${ball.replace("X", "0.215")}</worldbody></mujoco>`;
  const model = mj.mj_compile(mj.parseXMLString(text, new mj.MjVFS()), new mj.MjVFS()), data = new mj.MjData(model);
  mj.mj_forward(model, data);
  return data.ncon > 0;
}
function answerTo(mj, request, read, warnings) {
  try {
    const [spec, model] = compiled(mj, request, read);
    const object = mj.mjtObj, names = {};
    const kinds = { body: [object.mjOBJ_BODY, model.nbody], joint: [object.mjOBJ_JOINT, model.njnt], geom: [object.mjOBJ_GEOM, model.ngeom],
      site: [object.mjOBJ_SITE, model.nsite], tendon: [object.mjOBJ_TENDON, model.ntendon], actuator: [object.mjOBJ_ACTUATOR, model.nu],
      equality: [object.mjOBJ_EQUALITY, model.neq], keyframe: [object.mjOBJ_KEY, model.nkey] };
    for (const [kind, [type, count]] of Object.entries(kinds)) {
      names[kind] = new Array(count).fill("");
      for (const [id, e] of elements(mj, spec, type)) if (id >= 0 && id < count) names[kind][id] = mj.mjs_getName(e);
    }
    const numbers = numbersOf(mj, request, model, spec, object), data = new mj.MjData(model);
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
    return { ok: true, version: mj.mj_versionString(), numbers, names, off, warnings, addsMargins: addsMargins(mj) };
  } catch (error) {
    return { ok: false, version: mj.mj_versionString(), why: String(error?.message ?? error) + " " + warnings.join(" ") };
  }
}
)js";

}  // namespace rigor::inline adapters
