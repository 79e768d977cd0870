// MuJoCo 3 (npm @mujoco/mujoco, WebAssembly, double precision) as the process of the engine `mujoco3`:
// node mujoco3.mjs FOLDER, whose node_modules has the package. A request to load a scene has the key "mjcf": the text
// and the numbers that ../mujoco3_engine.cpp makes of the scene.
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { Diverged, add, cross, pose, rotate, serve } from "./serve.mjs";

const found = createRequire(join(process.argv[2], "x")).resolve("@mujoco/mujoco");
const { default: loadMujoco } = await import(pathToFileURL(found).href);
const mujoco = await loadMujoco({ print: console.error, printErr: console.error });
const [kBody, kGeom, kJoint] = ["mjOBJ_BODY", "mjOBJ_GEOM", "mjOBJ_JOINT"].map((name) => mujoco.mjtObj[name].value);
const kIntegrators = { euler: "Euler, semi-implicit", implicit: "implicit in velocity", implicitfast: "implicit in velocity, without Coriolis terms", rk4: "RK4" };

const numbers = (array) => Array.from(array), part = (array, row, length) => numbers(array.subarray(length * row, length * (row + 1)));

function simulated(text) {
  const model = mujoco.MjModel.from_xml_string(text);
  return { model, data: new mujoco.MjData(model) };
}

// A pair's margin is the sum of both in MuJoCo 3.14, and was the larger one before. Two balls are 15 mm apart here, and
// have margins of 10 mm each.
function addsMargins() {
  const ball = (z) => `<body pos="0 0 ${z}"><freejoint/><geom size="0.1" margin="0.01"/></body>`;
  const { model, data } = simulated(`<mujoco><worldbody>${ball(0)}${ball(0.215)}</worldbody></mujoco>`);
  mujoco.mj_forward(model, data);
  const does = data.ncon > 0;
  return data.delete(), model.delete(), does;
}
const kAddsMargins = addsMargins();

// MuJoCo 3.14 takes a body whose inertia it finds diagonal for a simple one, and then refuses the axes that are set below.
// Earlier versions do not know the word.
function wordAgainstSimple() {
  const word = ' simple="false"';
  try {
    const { model, data } = simulated(`<mujoco><worldbody><body${word}><freejoint/><geom size="0.1"/></body></worldbody></mujoco>`);
    return data.delete(), model.delete(), word;
  } catch {
    return "";
  }
}
const kNotSimple = wordAgainstSimple();

// The package does not name the counters of warnings. The places of those for memory are checked against one that is
// made here: of a speed that is too large.
const kFull = [1, 2], kBadSpeed = 4;
const counts = (data) => {
  const warnings = data.warning, all = [];
  for (let i = 0; i < warnings.size(); ++i) {
    const one = warnings.get(i);
    all.push(one.number), one.delete();
  }
  return all;
};
function checkCounters() {
  const { model, data } = simulated(`<mujoco><worldbody><body><freejoint/><geom size="0.1"/></body></worldbody></mujoco>`);
  data.qvel[0] = 1e12, mujoco.mj_step(model, data);
  const made = counts(data);
  if (made.length !== 7 || made.some((count, i) => (count > 0) !== (i === kBadSpeed)))
    throw new Error(`MuJoCo ${mujoco.mj_versionString()} counts warnings in another order: ${made}`);
  data.delete(), model.delete();
}
checkCounters();

// Rows of { array, length, at, value, per_dt }: see ../../mujoco/mujoco_values.h.
function set(model, values, dt = 1) {
  for (const { array, length, at, value, per_dt } of values) {
    const into = model[array], half = array === "geom_margin" && kAddsMargins ? 0.5 : 1;
    if (!into) throw new Error(`this MuJoCo's model has no ${array}`);
    for (let i = at; i < into.length; i += length) into[i] = (half * value) / (per_dt === 2 ? dt * dt : per_dt === 1 ? dt : 1);
  }
}

function settingsOf(model, method, mjcf) {
  const option = model.opt, solver = ["PGS", "CG", "Newton"][option.solver];
  const words = ([time, damping], [start, deep, width]) => `solref ${time} ${damping}, solimp ${start} ${deep} ${width}`;
  return {
    integrator: kIntegrators[method], gravity: `${numbers(option.gravity).join(", ")} m/s^2`,
    solver: `${solver}, at most ${option.iterations} iterations to ${option.tolerance}`,
    "friction cone": option.cone === 1 ? "elliptic" : "pyramidal",
    impratio: `${option.impratio}: friction is that much stiffer than contact`,
    springs: "tendons, evaluated at each stage",
    ...(model.nhfield > 0 && {
      "collisions with heights": option.disableflags & mujoco.mjtDisableBit.mjDSBL_NATIVECCD.value ? "by libccd" : "by MuJoCo's own detector",
    }),
    ...(model.ngeom > 0 && {
      contacts: words(part(model.geom_solref, 0, 2), part(model.geom_solimp, 0, 5)),
      restitution: `by the damping ratio ${model.geom_solref[1]} of contacts`,
      ...(model.geom_margin[0] > 0 && { "contact margin": `${(kAddsMargins ? 2 : 1) * model.geom_margin[0]} m: bodies rest that far apart` }),
    }),
    ...(mjcf.stiff.length > 0 && { "loops and limits": "as stiff as the step allows" }),
  };
}

// By geom: the body of the scene, from the names g0, g0p1, … of ../../mujoco/mujoco_mjcf.h.
function bodiesOfGeoms(model) {
  return Array.from({ length: model.ngeom }, (_, geom) => Number(/^g(\d+)(p\d+)?$/.exec(mujoco.mj_id2name(model, kGeom, geom))[1]));
}

// Those of the step's start, with the forces held over the step. Rows of a contact's frame are in W, and the first is
// the normal, from the first geom to the second.
function contactsOf(model, data, bodyOf, six) {
  const contacts = data.contact, all = [];
  for (let k = 0; k < data.ncon; ++k) {
    const at = contacts.get(k), frame = numbers(at.frame), row = (r) => frame.slice(3 * r, 3 * r + 3);
    mujoco.mj_contactForce(model, data, k, six);
    const force = numbers(six.GetView()).slice(0, 3);
    all.push({
      a: bodyOf[at.geom1], b: bodyOf[at.geom2], point: numbers(at.pos), normal: row(0), gap: at.dist,
      force: [0, 1, 2].reduce((sum, r) => add(sum, row(r), force[r]), [0, 0, 0]),
    });
    at.delete();
  }
  return all;
}

// cfrc_int is torque and force on a body from its parent, in W, with the torque about the centre of mass of the whole
// tree. It includes the effort on the joint's free axis, which is taken out: of a hinge about its axis, of a slider
// along the line through the centre of the scene's body b.
function hangingReaction(model, data, ids, { body, joint, b, turns }) {
  const id = ids[body], [tx, ty, tz, ...force] = part(data.cfrc_int, id, 6), centre = part(data.xipos, id, 3);
  const about = part(data.subtree_com, model.body_rootid[id], 3), dot = (u, v) => u.reduce((sum, x, i) => sum + x * v[i], 0);
  const torque = add([tx, ty, tz], cross(add(about, centre, -1), force));
  const at = joint === undefined ? -1 : mujoco.mj_name2id(model, kJoint, joint);
  if (at < 0) return { body, force, torque };
  const axis = part(data.xaxis, at, 3);
  if (turns) {
    const arm = add(part(data.xanchor, at, 3), centre, -1), effort = dot(axis, add(torque, cross(arm, force), -1));
    return { body, force, torque: add(torque, axis, -effort) };
  }
  const effort = dot(axis, force), arm = add(b < 0 ? [0, 0, 0] : part(data.xipos, ids[b], 3), centre, -1);
  return { body, force: add(force, axis, -effort), torque: add(torque, cross(arm, axis), -effort) };
}

// An equality's rows are the three components in W of the force on its point of the first body.
function loopReaction(model, data, ids, { body, equalities }) {
  const types = numbers(data.efc_type), owners = numbers(data.efc_id), sum = { body, force: [0, 0, 0], torque: [0, 0, 0] };
  for (const equality of equalities) {
    const first = owners.findIndex((owner, row) => types[row] === 0 && owner === equality);
    const force = numbers(data.efc_force.subarray(first, first + 3)), length = model.eq_data.length / model.neq;
    const turned = rotate(part(data.xquat, ids[body], 4), part(model.eq_data, equality, length).slice(0, 3));
    sum.force = add(sum.force, force), sum.torque = add(sum.torque, cross(turned, force));
  }
  return sum;
}

function reactionsOf(model, data, ids, rows) {
  mujoco.mj_rnePostConstraint(model, data);
  return rows.map((row) => (row.equalities ? loopReaction : hangingReaction)(model, data, ids, row));
}

class World {
  constructor(scene, mjcf) {
    const { model, data } = simulated(mjcf.text.replace(/<body name="b(\d+)"/g, (open, i) => (mjcf.inertias[i] ? open + kNotSimple : open)));
    Object.assign(this, { scene, mjcf, model, data, six: new mujoco.DoubleBuffer(6), isJointed: !!scene.joint?.length, isFull: false });
    this.ids = scene.body.map((_, i) => mujoco.mj_name2id(model, kBody, `b${i}`)), (this.bodyOf = bodiesOfGeoms(model));
    mjcf.inertias.forEach((inertia, i) => {
      if (!inertia) return;
      model.body_inertia.set(inertia.slice(0, 3), 3 * this.ids[i]), model.body_iquat.set(inertia.slice(3), 4 * this.ids[i]);
      model.body_sameframe[this.ids[i]] = 0;
    });
    if (mjcf.heights.length) model.hfield_data.set(mjcf.heights);
    set(model, mjcf.contacts);
    // Constants that follow from the inertias, worked out at the pose of t = 0, which the data then holds again.
    mujoco.mj_setConst(model, data), mujoco.mj_resetData(model, data);
    mjcf.speeds.forEach((speeds, i) => speeds.length && data.qvel.set(speeds, model.body_dofadr[this.ids[i]]));
  }

  step(dt, wrenches) {
    const { model, data, ids } = this, before = data.time;
    model.opt.timestep = dt;
    if (dt !== this.stiffDt) set(model, this.mjcf.stiff, dt), (this.stiffDt = dt);
    data.xfrc_applied.fill(0);
    wrenches?.forEach((wrench, i) => data.xfrc_applied.set(wrench, 6 * ids[i]));
    mujoco.mj_step(model, data), (this.isStepInData = true);
    // MuJoCo sets the world back to its start after a number that is not finite or beyond 1e10, and goes on.
    const made = data.time !== before + dt || before === 0 || data.ncon > 0 ? counts(data) : [];
    if (made.slice(kFull[1] + 1).some((count) => count > 0))
      throw new Diverged("a number passed 1e10 or was not finite: MuJoCo sets such a world back to its start");
    this.isFull ||= kFull.some((place) => made[place] > 0);
    return this.isFull ? "MuJoCo had no room for all contacts and left some out" : "";
  }

  rows() {
    const { model, data, scene } = this;
    if (this.isJointed) this.keepReactions(), mujoco.mj_kinematics(model, data), mujoco.mj_comPos(model, data), mujoco.mj_comVel(model, data);
    return scene.body.map((body, i) => {
      if (body.fixed) return [...pose(scene, body.name).x, ...pose(scene, body.name).q, 0, 0, 0, 0, 0, 0];
      return this.isJointed ? this.jointed(this.ids[i]) : this.free(this.ids[i]);
    });
  }
  // Velocity in W, but angular velocity in B.
  free(id) {
    const { model, data } = this, q = model.jnt_qposadr[model.body_jntadr[id]], v = model.body_dofadr[id];
    const p = numbers(data.qpos.subarray(q, q + 7)), u = numbers(data.qvel.subarray(v, v + 6));
    return [...p, ...u.slice(0, 3), ...rotate(p.slice(3), u.slice(3))];
  }
  // Poses and speeds follow from those of joints. A step leaves them where it began.
  jointed(id) {
    const { model, data, six } = this;
    mujoco.mj_objectVelocity(model, data, kBody, id, six, 0);  // angular, then linear
    const u = numbers(six.GetView());
    return [...part(data.xpos, id, 3), ...part(data.xquat, id, 4), ...u.slice(3), ...u.slice(0, 3)];
  }

  contacts() { return contactsOf(this.model, this.data, this.bodyOf, this.six); }

  // Uses the data that the step left, before they are computed for the new positions.
  keepReactions() {
    if (this.isAsked && this.isStepInData) this.kept = reactionsOf(this.model, this.data, this.ids, this.mjcf.reactions);
    this.isStepInData = false;
  }
  reactions() {
    if (!this.isAsked) return (this.isAsked = true), [];
    return this.keepReactions(), this.kept;
  }

  save() {
    const { data } = this;
    return new Uint8Array(Float64Array.of(this.isFull ? 1 : 0, data.time, ...data.qpos, ...data.qvel, ...data.qacc_warmstart).buffer);
  }
  restore(bytes) {
    const { model, data } = this, all = new Float64Array(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
    const [isFull, time] = all, of = (from, count) => all.subarray(2 + from, 2 + from + count);
    this.isFull = isFull > 0, (data.time = time), (this.isStepInData = false);
    data.qpos.set(of(0, model.nq)), data.qvel.set(of(model.nq, model.nv)), data.qacc_warmstart.set(of(model.nq + model.nv, model.nv));
  }
  free_() { this.six.delete(), this.data.delete(), this.model.delete(); }
}

serve({
  // ../mujoco3_engine.cpp knows the rest of the description.
  info: { name: "mujoco3", version: mujoco.mj_versionString(), precision: "double", methods: [{ name: "euler" }] },
  load(scene, { method }, { mjcf }) {
    const world = new World(scene, mjcf);
    return {
      settings: settingsOf(world.model, method, mjcf),
      step: (dt, wrenches) => world.step(dt, wrenches), rows: () => world.rows(), contacts: () => world.contacts(),
      reactions: () => world.reactions(), save: () => world.save(), restore: (bytes) => world.restore(bytes), free: () => world.free_(),
    };
  },
});
