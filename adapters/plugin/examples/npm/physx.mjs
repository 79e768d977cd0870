// PhysX 5 (npm physx-js-webidl, single precision): each request one step of dt. Its bindings are made for a browser: for
// as long as they load, Node looks like one.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { back, oneLaw, pointIn, pose, principal, serve, times } from "./serve.mjs";
import PhysX from "physx-js-webidl";

const wasm = readFileSync(createRequire(import.meta.url).resolve("physx-js-webidl/physx-js-webidl.wasm"));
const node = globalThis.process;
globalThis.window = globalThis, globalThis.document = { currentScript: null };
globalThis.process = undefined;
const Px = await PhysX({ wasmBinary: wasm, print: console.error, printErr: console.error });
globalThis.process = node;
delete globalThis.window, delete globalThis.document;

const kGyroscopic = 1 << 10; // PxRigidBodyFlag::eENABLE_GYROSCOPIC_FORCES, which the bindings leave out
const version = Px.PHYSICS_VERSION;
const foundation = Px.CreateFoundation(version, new Px.PxDefaultAllocator(), new Px.PxDefaultErrorCallback());
const tolerances = new Px.PxTolerancesScale(), physics = Px.CreatePhysics(version, foundation, tolerances);

const vec = ([x, y, z]) => new Px.PxVec3(x, y, z);
const quat = ([w, x, y, z]) => new Px.PxQuat(x, y, z, w);
const transform = (x, q) => new Px.PxTransform(vec(x), quat(q));
const list = ({ x, y, z }) => [x, y, z];

// PhysX's planes have their normal along x, its capsules lie there.
function fromX([x, y, z]) {
  const q = x > -0.999 ? [1 + x, 0, -z, y] : [0, 0, 0, 1], size = Math.hypot(...q);
  return q.map((part) => part / size);
}

function geometryOf(shape) {
  switch (shape.type) {
    case "sphere": return [new Px.PxSphereGeometry(shape.radius)];
    case "box": return [new Px.PxBoxGeometry(...shape.size.map((edge) => edge / 2))];
    case "capsule": return [new Px.PxCapsuleGeometry(shape.radius, shape.length / 2), transform([0, 0, 0], fromX([0, 0, 1]))];
    default: return [new Px.PxPlaneGeometry(), transform(shape.normal.map((n) => n * shape.offset), fromX(shape.normal))];
  }
}

function addShape(actor, shape, material) {
  const [geometry, at] = geometryOf(shape);
  const made = physics.createShape(geometry, material, true, new Px.PxShapeFlags(Px.PxShapeFlagEnum.eSIMULATION_SHAPE));
  if (at) made.setLocalPose(at);
  made.setSimulationFilterData(new Px.PxFilterData(1, 1, 0, 0));
  actor.attachShape(made);
}

function actorOf(body, material, matched) {
  const { x, q } = pose({ body: [body] }, body.name), at = transform(x, q);
  const actor = body.fixed ? physics.createRigidStatic(at) : physics.createRigidDynamic(at);
  if (body.collides) addShape(actor, body.shape, material);
  if (body.fixed) return actor;
  const { moments, frame } = principal(body.inertia);
  actor.setMass(body.mass), actor.setCMassLocalPose(transform([0, 0, 0], frame)), actor.setMassSpaceInertiaTensor(vec(moments));
  actor.setLinearVelocity(vec(body.velocity)), actor.setAngularVelocity(vec(body.angular_velocity));
  if (!matched) return actor;
  actor.setRigidBodyFlag(kGyroscopic, true);
  actor.setLinearDamping(0), actor.setAngularDamping(0), actor.setSleepThreshold(0), actor.setStabilizationThreshold(0);
  actor.setMaxAngularVelocity(1e6), actor.setMaxLinearVelocity(1e6);
  return actor;
}

// A joint's frame has x along its axis. Bodies that share one may touch, as others.
function jointOf(scene, joint, actors) {
  const ends = [joint.a, joint.b], anchor = joint.anchor ?? pose(scene, joint.b).x, across = fromX(joint.axis ?? [1, 0, 0]);
  const [a, b] = ends.map((name) => actors[scene.body.findIndex((body) => body.name === name)] ?? null);
  const [at_a, at_b] = ends.map((name) => {
    const { x, q } = pose(scene, name);
    return transform(pointIn({ x, q }, anchor), times(back(q), across));
  });
  const make = { ball: "SphericalJointCreate", fixed: "FixedJointCreate", hinge: "RevoluteJointCreate" }[joint.type];
  const made = Px.PxTopLevelFunctions.prototype[make](physics, a, at_a, b, at_b);
  made.setConstraintFlag(Px.PxConstraintFlagEnum.eCOLLISION_ENABLED, true);
  return made;
}

// The points that the solver of the last step took, with their impulses along the normal. PhysX reports friction by
// other means, which these bindings lack; what it carries is missing from the forces (PhysX issue 276).
const kMostPoints = 64; // of a pair of shapes
class ContactReports {
  #points = new Px.Vector_PxContactPairPoint(kMostPoints);
  #callback = new Px.PxSimulationEventCallbackImpl();
  #filter = new Px.PassThroughFilterShaderImpl();
  #place = new Map();
  #seen = [];

  constructor(desc) {
    this.#filter.filterShader = () => 0;
    const { eSOLVE_CONTACT, eDETECT_DISCRETE_CONTACT, eNOTIFY_TOUCH_FOUND, eNOTIFY_TOUCH_PERSISTS, eNOTIFY_CONTACT_POINTS } = Px.PxPairFlagEnum;
    const flags = eSOLVE_CONTACT | eDETECT_DISCRETE_CONTACT | eNOTIFY_TOUCH_FOUND | eNOTIFY_TOUCH_PERSISTS | eNOTIFY_CONTACT_POINTS;
    Px.PxTopLevelFunctions.prototype.setupPassThroughFilterShader(desc, this.#filter);
    this.#filter.filterShader = () => ((this.#filter.outputPairFlags = flags), 0); // which each call finds at their default
    this.#callback.onContact = (header, pairs, count) => this.#note(Px.wrapPointer(header, Px.PxContactPairHeader), pairs, count);
    for (const ignored of ["onConstraintBreak", "onWake", "onSleep", "onTrigger"]) this.#callback[ignored] = () => {};
  }
  of(actors, world) {
    actors.forEach((actor, i) => this.#place.set(Px.getPointer(actor), i));
    world.setSimulationEventCallback(this.#callback);
  }
  begin() { this.#seen = []; }
  free() { [this.#points, this.#callback, this.#filter].forEach((one) => Px.destroy(one)); }

  #note(header, pairs, count) {
    const [a, b] = [0, 1].map((end) => this.#place.get(Px.getPointer(header.get_actors(end))));
    for (let k = 0; k < count; ++k) {
      const pair = Px.NativeArrayHelpers.prototype.getContactPairAt(Px.wrapPointer(pairs, Px.PxContactPair), k);
      const points = pair.extractContacts(this.#points.data(), kMostPoints);
      for (let i = 0; i < points; ++i) {
        const { position, separation, normal, impulse } = this.#points.at(i);
        this.#seen.push({ a, b, point: list(position), normal: list(normal), gap: separation, impulse: list(impulse) });
      }
    }
  }
  // The normal of PhysX points from the second to the first actor, and its impulse acts on the first.
  over(dt) {
    return this.#seen.map(({ impulse, normal, ...rest }) => ({ ...rest, normal: normal.map((n) => -n), force: impulse.map((p) => -p / dt) }));
  }
}

serve({
  info: {
    name: "physx", version: [version >> 24, (version >> 16) & 255, (version >> 8) & 255].join("."), precision: "single", columns: "f64le", calls: ["run", "contacts"],
    features: ["wrench", "fixed-body", "joint:ball", "joint:fixed", "joint:hinge", "joints-with-contacts", "restitution", "friction:none", "friction:coulomb", "friction:infinite", "static-friction", "contact:plane-sphere",
               "contact:box-plane", "contact:capsule-plane", "contact:sphere-sphere", "contact:box-sphere", "contact:box-box",
               "contact:capsule-sphere", "contact:box-capsule", "contact:capsule-capsule"],
    methods: [{ name: "pgs", summary: "semi-implicit Euler, projected Gauss and Seidel", order: 1, leapfrog_stagger: 0.5 }],
  },
  load(scene, { track }, { reports: wanted = true }) {
    const matched = track === "matched", law = oneLaw(scene), desc = new Px.PxSceneDesc(tolerances);
    desc.gravity = vec(scene.gravity), desc.cpuDispatcher = Px.DefaultCpuDispatcherCreate(0);
    desc.filterShader = Px.DefaultFilterShader();
    const reports = wanted ? new ContactReports(desc) : null; // each contact calls JavaScript: a host that measures time does without
    let last = 0;
    if (matched) desc.bounceThresholdVelocity = 1e-3; // m/s; 0 is refused
    const world = physics.createScene(desc), material = physics.createMaterial(law.staticFriction, law.friction, law.restitution);
    const actors = scene.body.map((body) => actorOf(body, material, matched));
    for (const actor of actors) world.addActor(actor);
    const joints = (scene.joint ?? []).map((joint) => jointOf(scene, joint, actors));
    reports?.of(actors, world);
    return {
      settings: { gyroscopic: matched ? "on" : "off, as shipped", solver: "PGS", sleeping: matched ? "off" : "on", "contact forces": "normal parts alone: these bindings report no friction" },
      step(dt, wrenches) {
        wrenches?.forEach((wrench, i) => {
          if (scene.body[i].fixed) return;
          actors[i].addForce(vec(wrench.slice(0, 3))), actors[i].addTorque(vec(wrench.slice(3)));
        });
        reports?.begin(), last = dt;
        world.simulate(dt), world.fetchResults(true);
      },
      rows: () => actors.map((actor, i) => {
        const { p, q } = actor.getGlobalPose(), at = [...list(p), q.w, q.x, q.y, q.z];
        return scene.body[i].fixed ? [...at, 0, 0, 0, 0, 0, 0] : [...at, ...list(actor.getLinearVelocity()), ...list(actor.getAngularVelocity())];
      }),
      contacts: () => reports.over(last),
      free: () => (joints.forEach((joint) => joint.release()), actors.forEach((actor) => actor.release()), world.release(), reports?.free()),
    };
  },
});
