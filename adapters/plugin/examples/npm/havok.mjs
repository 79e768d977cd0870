// Havok (npm @babylonjs/havok, single precision): each request one step of dt. It has no gyroscopic term: on the track
// `matched` this file adds it as a torque at the step's start. It has no plane: a box with edges of 1 km stands for one.
// The solver is told the step that is asked for, as Babylon.js does: it softens contacts and joints at other steps.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { add, back, cross, directionIn, gyroscopicTorque, oneLaw, pointIn, pose, principal, rotate, serve, times } from "./serve.mjs";
import start from "@babylonjs/havok";

const find = createRequire(import.meta.url), wasm = find.resolve("@babylonjs/havok/lib/esm/HavokPhysics.wasm");
const { version } = JSON.parse(readFileSync(wasm.replace(/lib\/esm\/[^/]*$/, "package.json"), "utf8"));
const Hk = await start({ wasmBinary: readFileSync(wasm), print: console.error, printErr: console.error });

const kEdge = 1000; // m, of the box that stands for a plane
const kFastest = 1e6; // m/s and rad/s
const { FREE, LOCKED } = Hk.ConstraintAxisLimitMode;
const xyzw = ([w, x, y, z]) => [x, y, z, w];

// A call answers with its result, or with a list that begins with it.
function checked(answer) {
  const [result, value] = Array.isArray(answer) ? answer : [answer];
  if (result === Hk.Result.RESULT_OK) return value;
  throw new Error(`Havok refuses a call: ${Object.keys(Hk.Result).find((name) => Hk.Result[name] === result)}`);
}

function shapeOf(shape, law) {
  const none = [0, 0, 0, 1], along = (length) => [0, 0, length / 2];
  const make = {
    sphere: () => Hk.HP_Shape_CreateSphere([0, 0, 0], shape.radius),
    box: () => Hk.HP_Shape_CreateBox([0, 0, 0], none, shape.size),
    capsule: () => Hk.HP_Shape_CreateCapsule(along(-shape.length), along(shape.length), shape.radius),
    plane: () => Hk.HP_Shape_CreateBox(shape.normal.map((n) => n * (shape.offset - kEdge / 2)), xyzw(fromZ(shape.normal)), [kEdge, kEdge, kEdge]),
  };
  const made = checked(make[shape.type]()), { MAXIMUM } = Hk.MaterialCombine;
  checked(Hk.HP_Shape_SetMaterial(made, [law.staticFriction, law.friction, law.restitution, MAXIMUM, MAXIMUM]));
  return made;
}

function fromZ([x, y, z]) {
  const q = z > -0.999 ? [1 + z, -y, x, 0] : [0, 1, 0, 0], size = Math.hypot(...q);
  return q.map((part) => part / size);
}

function bodyOf(world, body, law, matched) {
  const { x, q } = pose({ body: [body] }, body.name), made = checked(Hk.HP_Body_Create());
  if (body.collides) checked(Hk.HP_Body_SetShape(made, shapeOf(body.shape, law)));
  checked(Hk.HP_Body_SetMotionType(made, body.fixed ? Hk.MotionType.STATIC : Hk.MotionType.DYNAMIC));
  checked(Hk.HP_Body_SetQTransform(made, [x, xyzw(q)]));
  if (body.fixed) return checked(Hk.HP_World_AddBody(world, made, false)), { made };
  const { moments, frame } = principal(body.inertia); // Havok's are those of a mass of 1
  checked(Hk.HP_Body_SetMassProperties(made, [[0, 0, 0], body.mass, moments.map((one) => one / body.mass), xyzw(frame)]));
  if (matched) {
    checked(Hk.HP_Body_SetLinearDamping(made, 0)), checked(Hk.HP_Body_SetAngularDamping(made, 0));
    checked(Hk.HP_Body_SetActivationControl(made, Hk.ActivationControl.ALWAYS_ACTIVE));
  }
  checked(Hk.HP_World_AddBody(world, made, false));
  checked(Hk.HP_Body_SetLinearVelocity(made, body.velocity)), checked(Hk.HP_Body_SetAngularVelocity(made, body.angular_velocity));
  const round = Math.max(...moments) - Math.min(...moments) <= 1e-12 * Math.max(...moments);
  return { made, mass: body.mass, frame, moments, round };
}

// The frame of a joint: x along its axis, y across.
function axesOf({ axis }) {
  const x = axis ?? [1, 0, 0], least = x.map(Math.abs).indexOf(Math.min(...x.map(Math.abs)));
  const across = cross(x, [0, 1, 2].map((i) => (i === least ? 1 : 0))), size = Math.hypot(...across);
  return { x, y: across.map((part) => part / size) };
}

const kFreeAxes = { ball: ["ANGULAR_X", "ANGULAR_Y", "ANGULAR_Z"], hinge: ["ANGULAR_X"], slider: ["LINEAR_X"], fixed: [] };

function jointOf(scene, joint, bodies, ground) {
  const made = checked(Hk.HP_Constraint_Create()), { x, y } = axesOf(joint), anchor = joint.anchor ?? pose(scene, joint.b).x;
  const ends = [["Parent", joint.a], ["Child", joint.b]];
  for (const [end, name] of ends) {
    const at = pose(scene, name), place = [pointIn(at, anchor), directionIn(at, x), directionIn(at, y)];
    checked(Hk[`HP_Constraint_Set${end}Body`](made, bodies[scene.body.findIndex((body) => body.name === name)]?.made ?? ground));
    checked(Hk[`HP_Constraint_SetAnchorIn${end}`](made, ...place));
  }
  for (const kind of ["LINEAR", "ANGULAR"])
    for (const axis of ["X", "Y", "Z"].map((letter) => `${kind}_${letter}`))
      checked(Hk.HP_Constraint_SetAxisMode(made, Hk.ConstraintAxis[axis], kFreeAxes[joint.type].includes(axis) ? FREE : LOCKED));
  checked(Hk.HP_Constraint_SetCollisionsEnabled(made, 1)), checked(Hk.HP_Constraint_SetEnabled(made, 1));
  return made;
}

function fixedBody(world) {
  const made = checked(Hk.HP_Body_Create());
  checked(Hk.HP_Body_SetMotionType(made, Hk.MotionType.STATIC)), checked(Hk.HP_World_AddBody(world, made, false));
  return made;
}

// As shipped, F dt and T dt are impulses.
function pushAsShipped({ made }, wrench, dt) {
  checked(Hk.HP_Body_ApplyImpulse(made, checked(Hk.HP_Body_GetPosition(made)), wrench.slice(0, 3).map((f) => f * dt)));
  checked(Hk.HP_Body_ApplyAngularImpulse(made, wrench.slice(3).map((t) => t * dt)));
}

// v += F/m dt, w += I^-1 (T - w x I w) dt. Havok's own inverse masses and inertias have eight bits.
function push({ made, mass, frame, moments, round }, wrench, dt) {
  if (wrench) checked(Hk.HP_Body_SetLinearVelocity(made, add(checked(Hk.HP_Body_GetLinearVelocity(made)), wrench.slice(0, 3), dt / mass)));
  if (!wrench && round) return;
  const [x, y, z, w] = checked(Hk.HP_Body_GetOrientation(made)), q = times([w, x, y, z], frame), spin = checked(Hk.HP_Body_GetAngularVelocity(made));
  const torque = add(gyroscopicTorque(q, moments, spin), wrench?.slice(3) ?? [0, 0, 0]);
  const change = rotate(q, rotate(back(q), torque).map((part, i) => part / moments[i]));
  checked(Hk.HP_Body_SetAngularVelocity(made, add(spin, change, dt)));
}

serve({
  info: {
    name: "havok", version, precision: "single", columns: "f64le", calls: ["run"],
    features: ["wrench", "fixed-body", "joint:ball", "joint:fixed", "joint:hinge", "joint:slider", "joints-with-contacts", "restitution",
               "friction:none", "friction:coulomb", "friction:infinite", "static-friction", "contact:plane-sphere", "contact:box-plane",
               "contact:capsule-plane", "contact:sphere-sphere", "contact:box-sphere", "contact:box-box", "contact:capsule-sphere",
               "contact:box-capsule", "contact:capsule-capsule"],
    methods: [{ name: "euler", summary: "semi-implicit Euler in four sub-steps", order: 1, leapfrog_stagger: 0.125 }],
  },
  load(scene, { track }) {
    const matched = track === "matched", law = oneLaw(scene), world = checked(Hk.HP_World_Create());
    checked(Hk.HP_World_SetGravity(world, scene.gravity));
    if (matched) checked(Hk.HP_World_SetSpeedLimit(world, kFastest, kFastest));
    const bodies = scene.body.map((body) => bodyOf(world, body, law, matched)), ground = fixedBody(world);
    const joints = (scene.joint ?? []).map((joint) => jointOf(scene, joint, bodies, ground));
    const moving = bodies.find(({ moments }) => moments)?.made, damping = (of) => Number(checked(of(moving)).toPrecision(3));
    const hasPlane = scene.body.some(({ collides, shape }) => collides && shape.type === "plane");
    return {
      settings: {
        gyroscopic: matched ? "on, explicit, added by the plug-in" : "off, there is none", sleeping: matched ? "off" : "on",
        damping: moving ? `linear ${damping(Hk.HP_Body_GetLinearDamping)}, angular ${damping(Hk.HP_Body_GetAngularDamping)}` : "none",
        "fastest [m/s, rad/s]": checked(Hk.HP_World_GetSpeedLimit(world)), ...(hasPlane ? { plane: `a box with edges of ${kEdge} m` } : {}),
      },
      step(dt, wrenches) {
        bodies.forEach((body, i) => {
          if (matched && body.moments) push(body, wrenches?.[i], dt);
          else if (wrenches && body.moments) pushAsShipped(body, wrenches[i], dt);
        });
        checked(Hk.HP_World_SetIdealStepTime(world, dt)), checked(Hk.HP_World_Step(world, dt));
      },
      rows: () => bodies.map(({ made, moments }) => {
        const [position, [x, y, z, w]] = checked(Hk.HP_Body_GetQTransform(made));
        if (!moments) return [...position, w, x, y, z, 0, 0, 0, 0, 0, 0];
        return [...position, w, x, y, z, ...checked(Hk.HP_Body_GetLinearVelocity(made)), ...checked(Hk.HP_Body_GetAngularVelocity(made))];
      }),
      free() {
        for (const joint of joints) Hk.HP_Constraint_Release(joint);
        for (const made of [...bodies.map((body) => body.made), ground]) Hk.HP_World_RemoveBody(world, made), Hk.HP_Body_Release(made);
        Hk.HP_World_Release(world);
      },
    };
  },
});
