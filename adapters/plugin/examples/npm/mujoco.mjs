// MuJoCo 3 (npm @mujoco/mujoco, double precision): each request one step of dt. A scene is handed over as MJCF.
import { Diverged, Unsupported, add, oneLaw, principal, pose, rotate, back, serve } from "./serve.mjs";
import loadMujoco from "@mujoco/mujoco";

const mujoco = await loadMujoco({ print: console.error, printErr: console.error });
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

function bodyOf(body, index) {
  const { x, q } = pose({ body: [body] }, body.name);
  const open = `<body name="b${index}" pos="${x.join(" ")}" quat="${q.join(" ")}">`;
  if (body.fixed) return `${open}${geomOf(body)}</body>`;
  const { moments, frame } = principal(body.inertia);
  return `${open}<freejoint/><inertial pos="0 0 0" mass="${body.mass}" diaginertia="${moments.join(" ")}" quat="${frame.join(" ")}"/>${geomOf(body)}</body>`;
}

function mjcf(scene, method, matched) {
  const { friction } = oneLaw(scene), as_true = matched ? 'cone="elliptic" impratio="100" iterations="200" tolerance="1e-15"' : "";
  return `<mujoco><compiler angle="radian" balanceinertia="false" boundmass="0" boundinertia="0" autolimits="false"/>
    <option gravity="${scene.gravity.join(" ")}" integrator="${kIntegrators[method]}" ${as_true}/>
    <default><geom friction="${friction} 0 0" condim="${friction > 0 ? 3 : 1}"/></default>
    <worldbody>${scene.body.map(bodyOf).join("\n")}</worldbody></mujoco>`;
}

// Where a body's numbers begin: of a free joint seven in qpos, and six in qvel, its angular velocity in the body's frame.
function places(scene) {
  let moving = 0;
  return scene.body.map((body) => (body.fixed ? -1 : moving++));
}

// Those of the step's start, with the forces held over the step. Rows of a contact's frame are in W, and the first is the
// normal, from the first body to the second. Body 0 is the world.
function contactsOf(model, data, wrench) {
  const found = [];
  for (let k = 0; k < data.ncon; ++k) {
    const at = data.contact.get(k), frame = Array.from(at.frame), body = (geom) => model.geom_bodyid[geom] - 1;
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
    name: "mujoco-js", version: mujoco.mj_versionString(), precision: "double", calls: ["run", "contacts"],
    features: ["wrench", "fixed-body", "friction:none", "friction:coulomb", "contact:plane-sphere", "contact:box-plane",
               "contact:capsule-plane", "contact:sphere-sphere", "contact:box-sphere", "contact:box-box", "contact:capsule-sphere",
               "contact:box-capsule", "contact:capsule-capsule"],
    methods: [
      { name: "euler", summary: "semi-implicit Euler, gyroscopic term explicit", order: 1, leapfrog_stagger: 0.5 },
      { name: "implicitfast", summary: "semi-implicit Euler, gyroscopic term implicit", order: 1, leapfrog_stagger: 0.5 },
      { name: "rk4", summary: "Runge and Kutta's method; attitude of second order", order: 2 },
    ],
  },
  load(scene, { method, track }) {
    const model = mujoco.MjModel.from_xml_string(mjcf(scene, method, track === "matched")), data = new mujoco.MjData(model);
    const at = places(scene), wrench = new mujoco.DoubleBuffer(6);
    scene.body.forEach((body, i) => {
      if (at[i] < 0) return;
      data.qvel.set(body.velocity, 6 * at[i]);
      data.qvel.set(rotate(back(pose(scene, body.name).q), body.angular_velocity), 6 * at[i] + 3);
    });
    return {
      settings: { integrator: kIntegrators[method], cone: track === "matched" ? "elliptic" : "as shipped" },
      step(dt, wrenches) {
        const before = data.time;
        model.opt.timestep = dt;
        data.xfrc_applied.fill(0);
        wrenches?.forEach((wrench, i) => data.xfrc_applied.set(wrench, 6 * (i + 1)));  // body 0 is the world
        mujoco.mj_step(model, data);
        // MuJoCo restarts silently after a blow-up.
        if (!(data.time > before)) throw new Diverged("MuJoCo found its state unstable and reset it");
      },
      rows: () => scene.body.map((body, i) => {
        if (at[i] < 0) return [...pose(scene, body.name).x, ...pose(scene, body.name).q, 0, 0, 0, 0, 0, 0];
        const p = Array.from(data.qpos.subarray(7 * at[i], 7 * at[i] + 7)), v = Array.from(data.qvel.subarray(6 * at[i], 6 * at[i] + 6));
        return [...p, ...v.slice(0, 3), ...rotate(p.slice(3), v.slice(3))];
      }),
      contacts() {
        if (method === "rk4") throw new Unsupported("of RK4 the forces of the last stage alone are known, which are no mean over the step");
        return contactsOf(model, data, wrench);
      },
      free: () => (wrench.delete(), data.delete(), model.delete()),
    };
  },
});
