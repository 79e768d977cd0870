// MuJoCo 3 (npm @mujoco/mujoco, double precision): each request one step of dt. A scene is handed over as MJCF, with
// joints as those of trees of bodies.
import { Diverged, Unsupported, add, back, cross, directionIn, oneLaw, pointIn, pose, principal, rotate, serve, times } from "./serve.mjs";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import loadMujoco from "@mujoco/mujoco";

const wasmBinary = readFileSync(createRequire(import.meta.url).resolve("@mujoco/mujoco/mujoco.wasm"));
const told = (text) => console.error(text);
export const mujoco = await loadMujoco({ wasmBinary, print: told, printErr: told });
const kIntegrators = { euler: "Euler", implicitfast: "implicitfast", rk4: "RK4" };

// Boxes by half their edges, capsules along z by half their cylinder; a plane of size 0 is infinite.
function geomOf({ shape, collides }) {
  if (!shape) return "";
  const bits = collides ? 1 : 0, touches = `contype="${bits}" conaffinity="${bits}" mass="0"`;
  switch (shape.type) {
    case "sphere": return `<geom type="sphere" size="${shape.radius}" ${touches}/>`;
    case "box": return `<geom type="box" size="${shape.size.map((edge) => edge / 2).join(" ")}" ${touches}/>`;
    case "capsule": return `<geom type="capsule" size="${shape.radius} ${shape.length / 2}" ${touches}/>`;
    default:
      return `<geom type="plane" size="0 0 1" pos="${shape.normal.map((n) => n * shape.offset).join(" ")}" zaxis="${shape.normal.join(" ")}" ${touches}/>`;
  }
}

// For each body its parent (-1: the world or a fixed body) and the joint between them (null: it floats free).
function treeOf(scene) {
  const places = new Map(scene.body.map(({ name, fixed }, i) => [name, fixed ? -1 : i])), at = (name) => places.get(name) ?? -1;
  const links = scene.body.map(({ fixed }) => (fixed ? null : { parent: -1, joint: null, below: [] })), reached = new Set(), roots = [];
  const left = new Set(scene.joint ?? []);
  const hang = (parent) => {
    for (const joint of [...left]) {
      const ends = [at(joint.a), at(joint.b)];
      if (!ends.includes(parent)) continue;
      left.delete(joint);
      const body = ends[0] === parent ? ends[1] : ends[0];
      if (body < 0 || reached.has(body)) throw new Unsupported("joints close a loop");
      Object.assign(links[body], { parent, joint }), reached.add(body), (parent < 0 ? roots : links[parent].below).push(body);
      hang(body);
    }
  };
  hang(-1);
  links.forEach((link, i) => link && !reached.has(i) && (reached.add(i), roots.push(i), hang(i)));
  return { links, roots };
}

function jointOf(scene, { joint }, index) {
  if (!joint) return "<freejoint/>";
  const body = pose(scene, scene.body[index].name), list = (v) => v.join(" ");
  const at = joint.anchor ? `pos="${list(pointIn(body, joint.anchor))}"` : "", along = joint.axis ? `axis="${list(directionIn(body, joint.axis))}"` : "";
  return { ball: `<joint type="ball" ${at}/>`, hinge: `<joint type="hinge" ${at} ${along}/>`, slider: `<joint type="slide" ${along}/>`, fixed: "" }[joint.type];
}

function bodyOf(scene, { links }, index) {
  const body = scene.body[index], { x, q } = pose(scene, body.name), link = links[index];
  const above = link?.parent >= 0 ? pose(scene, scene.body[link.parent].name) : { x: [0, 0, 0], q: [1, 0, 0, 0] };
  const open = `<body name="b${index}" pos="${pointIn(above, x).join(" ")}" quat="${times(back(above.q), q).join(" ")}">`;
  if (body.fixed) return `${open}${geomOf(body)}</body>`;
  const { moments, frame } = principal(body.inertia);
  return `${open}${jointOf(scene, link, index)}<inertial pos="0 0 0" mass="${body.mass}" diaginertia="${moments.join(" ")}" quat="${frame.join(" ")}"/>${geomOf(body)}
    ${link.below.map((one) => bodyOf(scene, { links }, one)).join("\n")}</body>`;
}

// As shipped, bodies that share a joint never touch. Here all do, for a scene that keeps pairs apart is not supported.
function mjcf(scene, tree, method, matched) {
  const { friction } = oneLaw(scene), as_true = matched ? 'cone="elliptic" impratio="100" iterations="200" tolerance="1e-15"' : "";
  const fixed = scene.body.flatMap((body, i) => (body.fixed ? [i] : []));
  return `<mujoco><compiler angle="radian" balanceinertia="false" boundmass="0" boundinertia="0" autolimits="false"/>
    <option gravity="${scene.gravity.join(" ")}" integrator="${kIntegrators[method]}" ${as_true}><flag filterparent="disable"/></option>
    <default><geom friction="${friction} 0 0" condim="${friction > 0 ? 3 : 1}"/></default>
    <worldbody>${[...fixed, ...tree.roots].map((i) => bodyOf(scene, tree, i)).join("\n")}</worldbody></mujoco>`;
}

const idsOf = (model, scene) => scene.body.map((_, i) => mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY.value, `b${i}`));

// The speeds of a body's joint at t = 0, against its parent, as MuJoCo counts them; a ball turns in the body's frame.
function speedsOf(scene, { parent, joint }, index) {
  const body = scene.body[index], rest = { velocity: [0, 0, 0], angular_velocity: [0, 0, 0] }, above = parent < 0 ? rest : scene.body[parent];
  if (!joint) return [...body.velocity, ...rotate(back(pose(scene, body.name).q), body.angular_velocity)];
  const dot = (u, v) => u.reduce((sum, x, i) => sum + x * v[i], 0), w = add(body.angular_velocity, above.angular_velocity, -1);
  const arm = parent < 0 ? [0, 0, 0] : add(pose(scene, body.name).x, pose(scene, above.name).x, -1);
  const v = add(add(body.velocity, above.velocity, -1), cross(above.angular_velocity, arm), -1);
  return { ball: () => directionIn(pose(scene, body.name), w), hinge: () => [dot(w, joint.axis)], slider: () => [dot(v, joint.axis)], fixed: () => [] }[joint.type]();
}

// Those of the step's start, with the forces held over the step. Rows of a contact's frame are in W, and the first is the
// normal, from the first body to the second.
function contactsOf(model, data, ids, wrench) {
  const found = [];
  for (let k = 0; k < data.ncon; ++k) {
    const at = data.contact.get(k), frame = Array.from(at.frame), body = (geom) => ids.indexOf(model.geom_bodyid[geom]);
    mujoco.mj_contactForce(model, data, k, wrench);
    const force = Array.from(wrench.GetView()).slice(0, 3), row = (r) => frame.slice(3 * r, 3 * r + 3);
    found.push({
      a: body(at.geom1), b: body(at.geom2), point: Array.from(at.pos), normal: row(0), gap: at.dist,
      force: [0, 1, 2].reduce((sum, r) => add(sum, row(r), force[r]), [0, 0, 0]),
    });
    at.delete();
  }
  return found;
}

serve({
  info: {
    name: "mujoco-js", version: mujoco.mj_versionString(), precision: "double", columns: "f64le", calls: ["run", "contacts"],
    features: ["wrench", "fixed-body", "friction:none", "friction:coulomb", "joint:ball", "joint:fixed", "joint:hinge",
               "joint:slider", "joints-with-contacts", "contact:plane-sphere", "contact:box-plane",
               "contact:capsule-plane", "contact:sphere-sphere", "contact:box-sphere", "contact:box-box", "contact:capsule-sphere",
               "contact:box-capsule", "contact:capsule-capsule"],
    methods: [
      { name: "euler", summary: "semi-implicit Euler, gyroscopic term explicit", order: 1, leapfrog_stagger: 0.5 },
      { name: "implicitfast", summary: "semi-implicit Euler, gyroscopic term implicit", order: 1, leapfrog_stagger: 0.5 },
      { name: "rk4", summary: "Runge and Kutta's method; attitude of second order", order: 2 },
    ],
  },
  load(scene, { method, track }) {
    const tree = treeOf(scene), model = mujoco.MjModel.from_xml_string(mjcf(scene, tree, method, track === "matched")), data = new mujoco.MjData(model);
    const ids = idsOf(model, scene), wrench = new mujoco.DoubleBuffer(6);
    // A body on a fixed joint has no speeds, and MuJoCo gives it the address -1.
    scene.body.forEach(({ fixed }, i) => {
      const speeds = fixed ? [] : speedsOf(scene, tree.links[i], i);
      if (speeds.length) data.qvel.set(speeds, model.body_dofadr[ids[i]]);
    });
    // Of a free body the joint has all; of a jointed one the pose and speed follow from its parents.
    const free = (i) => {
      const q = model.jnt_qposadr[model.body_jntadr[ids[i]]], v = model.body_dofadr[ids[i]];
      const p = Array.from(data.qpos.subarray(q, q + 7)), u = Array.from(data.qvel.subarray(v, v + 6));
      return [...p, ...u.slice(0, 3), ...rotate(p.slice(3), u.slice(3))];
    };
    const jointed = (i) => {
      mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY.value, ids[i], wrench, 0);  // angular, then linear
      const u = Array.from(wrench.GetView()), x = Array.from(data.xpos.subarray(3 * ids[i], 3 * ids[i] + 3));
      return [...x, ...data.xquat.subarray(4 * ids[i], 4 * ids[i] + 4), ...u.slice(3), ...u.slice(0, 3)];
    };
    return {
      settings: {
        integrator: kIntegrators[method], cone: track === "matched" ? "elliptic" : "as shipped",
        impratio: `${model.opt.impratio}: friction is that much stiffer than contact`,
      },
      step(dt, wrenches) {
        const before = data.time;
        model.opt.timestep = dt;
        data.xfrc_applied.fill(0);
        wrenches?.forEach((wrench, i) => data.xfrc_applied.set(wrench, 6 * ids[i]));
        mujoco.mj_step(model, data);
        // MuJoCo restarts silently after a blow-up.
        if (!(data.time > before)) throw new Diverged("MuJoCo found its state unstable and reset it");
      },
      rows() {
        if (scene.joint) mujoco.mj_kinematics(model, data), mujoco.mj_comPos(model, data), mujoco.mj_comVel(model, data);
        return scene.body.map((body, i) => {
          if (body.fixed) return [...pose(scene, body.name).x, ...pose(scene, body.name).q, 0, 0, 0, 0, 0, 0];
          return scene.joint ? jointed(i) : free(i);
        });
      },
      contacts() {
        if (method === "rk4") throw new Unsupported("of RK4 the forces of the last stage alone are known, which are no mean over the step");
        return contactsOf(model, data, ids, wrench);
      },
      free: () => (wrench.delete(), data.delete(), model.delete()),
    };
  },
});
