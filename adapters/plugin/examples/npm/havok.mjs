// Havok (npm @babylonjs/havok, single precision). Havok divides a step into the more parts, the longer it is beside an
// ideal step: four parts for the ideal step itself. `matched` sets the ideal step to four times dt, so that each request
// is one step, switches off damping and sleeping, and lets bodies move as fast as they do. There is no gyroscopic term:
// on that track this file adds it as an angular impulse at the step's start.
import { add, cross, directionIn, gyroscopicTorque, oneLaw, pointIn, pose, principal, serve, times } from "./serve.mjs";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import start from "@babylonjs/havok";

const find = createRequire(import.meta.url), main = find.resolve("@babylonjs/havok");
const { version } = JSON.parse(readFileSync(main.replace(/lib\/.*$/, "package.json"), "utf8"));
const Hk = await start({ wasmBinary: readFileSync(find.resolve("@babylonjs/havok/lib/umd/HavokPhysics.wasm")), print: console.error, printErr: console.error });

// What a call returns beside its result; a call that fails throws.
function got(name, ...words) {
  const answer = Hk[name](...words), [result, ...values] = Array.isArray(answer) ? answer : [answer];
  if (result !== Hk.Result.RESULT_OK) throw new Error(`${name}: Havok answers ${result?.value ?? result}`);
  return values[0];
}
const quat = ([w, x, y, z]) => [x, y, z, w];
const kAxes = ["LINEAR_X", "LINEAR_Y", "LINEAR_Z", "ANGULAR_X", "ANGULAR_Y", "ANGULAR_Z"];

function shapeOf(shape) {
  switch (shape.type) {
    case "sphere": return got("HP_Shape_CreateSphere", [0, 0, 0], shape.radius);
    case "box": return got("HP_Shape_CreateBox", [0, 0, 0], [0, 0, 0, 1], shape.size);
    default: return got("HP_Shape_CreateCapsule", [0, 0, -shape.length / 2], [0, 0, shape.length / 2], shape.radius);
  }
}

function bodyOf(body, law, matched) {
  const { x, q } = pose({ body: [body] }, body.name), made = got("HP_Body_Create");
  if (body.collides) {
    const shape = shapeOf(body.shape), { FRICTION, RESTITUTION } = { FRICTION: Hk.MaterialCombine.MAXIMUM, RESTITUTION: Hk.MaterialCombine.MAXIMUM };
    got("HP_Shape_SetMaterial", shape, [law.friction, law.friction, law.restitution, FRICTION, RESTITUTION]);
    got("HP_Body_SetShape", made, shape);
  }
  got("HP_Body_SetMotionType", made, body.fixed ? Hk.MotionType.STATIC : Hk.MotionType.DYNAMIC);
  got("HP_Body_SetQTransform", made, [x, quat(q)]);
  if (body.fixed) return made;
  const { moments, frame } = principal(body.inertia);
  got("HP_Body_SetMassProperties", made, [[0, 0, 0], body.mass, moments, quat(frame)]);
  got("HP_Body_SetLinearVelocity", made, body.velocity), got("HP_Body_SetAngularVelocity", made, body.angular_velocity);
  if (!matched) return made;
  got("HP_Body_SetLinearDamping", made, 0), got("HP_Body_SetAngularDamping", made, 0);
  got("HP_Body_SetActivationControl", made, Hk.ActivationControl.ALWAYS_ACTIVE);
  return made;
}

function gyroscopicOf(body, { moments, frame }) {
  const [x, y, z, w] = got("HP_Body_GetOrientation", body);
  return gyroscopicTorque(times([w, x, y, z], frame), moments, got("HP_Body_GetAngularVelocity", body));
}

function addJoint(world, scene, joint, bodies) {
  const made = got("HP_Constraint_Create"), ground = got("HP_Body_Create");
  got("HP_Body_SetMotionType", ground, Hk.MotionType.STATIC), got("HP_World_AddBody", world, ground, false);
  const of = (name) => bodies[scene.body.findIndex((body) => body.name === name)] ?? ground;
  got("HP_Constraint_SetParentBody", made, of(joint.a)), got("HP_Constraint_SetChildBody", made, of(joint.b));
  const axis = joint.axis ?? [1, 0, 0], other = cross(axis, Math.abs(axis[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0]), size = Math.hypot(...other);
  for (const [side, name] of [["Parent", joint.a], ["Child", joint.b]]) {
    const at = pose(scene, name);
    got(`HP_Constraint_SetAnchorIn${side}`, made, pointIn(at, joint.anchor), directionIn(at, axis), directionIn(at, other.map((v) => v / size)));
  }
  const free = joint.type === "ball" ? ["ANGULAR_X", "ANGULAR_Y", "ANGULAR_Z"] : ["ANGULAR_X"];
  for (const name of kAxes)
    got("HP_Constraint_SetAxisMode", made, Hk.ConstraintAxis[name], free.includes(name) ? Hk.ConstraintAxisLimitMode.FREE : Hk.ConstraintAxisLimitMode.LOCKED);
  got("HP_Constraint_SetCollisionsEnabled", made, 1), got("HP_Constraint_SetEnabled", made, 1);
}

serve({
  info: {
    name: "havok", version, precision: "single", calls: ["run"],
    features: ["wrench", "fixed-body", "joint:ball", "joint:hinge", "joints-with-contacts", "restitution", "friction:none",
               "friction:coulomb", "friction:infinite", "contact:sphere-sphere", "contact:box-sphere", "contact:box-box",
               "contact:capsule-sphere", "contact:box-capsule", "contact:capsule-capsule"],
    methods: [{ name: "havok", summary: "semi-implicit Euler, one part a step", order: 1, leapfrog_stagger: 0.5,
                options: [{ name: "parts", meaning: "parts into which a step is divided", min: 1, max: 100, whole: true }] }],
  },
  load(scene, { track, options }) {
    const matched = track === "matched", law = oneLaw(scene), world = got("HP_World_Create");
    got("HP_World_SetGravity", world, scene.gravity);
    if (matched) got("HP_World_SetSpeedLimit", world, 1e6, 1e6);
    const bodies = scene.body.map((body) => bodyOf(body, law, matched));
    for (const body of bodies) got("HP_World_AddBody", world, body, false);
    for (const joint of scene.joint ?? []) addJoint(world, scene, joint, bodies);
    const [, linear, angular] = Hk.HP_World_GetSpeedLimit(world), moving = bodies.find((_, i) => !scene.body[i].fixed);
    const inertias = scene.body.map((body) => (body.fixed ? null : principal(body.inertia)));
    const parts = options.parts ?? (matched ? 1 : 0);
    let told = 0;
    return {
      settings: {
        damping: moving ? `linear ${got("HP_Body_GetLinearDamping", moving)}, angular ${got("HP_Body_GetAngularDamping", moving)}` : "none",
        "speed limits": `${linear} m/s, ${angular} rad/s`, "parts of a step": parts || "as shipped", gyroscopic: matched ? "on, explicit, added by the plug-in" : "off, there is none", sleeping: matched ? "off" : "on",
      },
      step(dt, wrenches) {
        if (parts && dt !== told) got("HP_World_SetIdealStepTime", world, (4 * (told = dt)) / parts);
        bodies.forEach((body, i) => {
          if (scene.body[i].fixed) return;
          let torque = wrenches?.[i].slice(3) ?? [0, 0, 0];
          if (matched) torque = add(torque, gyroscopicOf(body, inertias[i]));
          if (wrenches) got("HP_Body_ApplyImpulse", body, got("HP_Body_GetPosition", body), wrenches[i].slice(0, 3).map((part) => part * dt));
          got("HP_Body_ApplyAngularImpulse", body, torque.map((part) => part * dt));
        });
        got("HP_World_Step", world, dt);
      },
      rows: () => bodies.map((body, i) => {
        const [position, [x, y, z, w]] = got("HP_Body_GetQTransform", body);
        const rates = scene.body[i].fixed ? [0, 0, 0, 0, 0, 0] : [...got("HP_Body_GetLinearVelocity", body), ...got("HP_Body_GetAngularVelocity", body)];
        return [...position, w, x, y, z, ...rates];
      }),
      free() {
        for (const body of bodies) Hk.HP_World_RemoveBody(world, body), Hk.HP_Body_Release(body);
        Hk.HP_World_Release(world);
      },
    };
  },
});
