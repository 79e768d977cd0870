// Bullet 2.82 as ammo.js (npm ammojs-typed, the build that is still made; WebAssembly, single precision): each request one
// step of dt. A body's axes are its principal ones, so shapes are turned into them. A contact multiplies the values of
// two bodies, so each body has the square root of the pair's. A body turns by at most pi/4 in a step; a faster one is
// refused. The gyroscopic term is Bullet 2.82's explicit one, on the track `matched` alone.
import { back, directionIn, oneLaw, pointIn, pose, principal, serve, times, Unsupported } from "./serve.mjs";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import start from "ammojs-typed/wasm";

const find = createRequire(import.meta.url), { version } = JSON.parse(readFileSync(find.resolve("ammojs-typed/package.json"), "utf8"));
const Bullet = await start({ wasmBinary: readFileSync(find.resolve("ammojs-typed/ammo.wasm.wasm")), print: console.error, printErr: console.error });

const kNeverSleeps = 4, kMostRotation = Math.PI / 4, kGyroscopicTerm = 2;
const vec = (v) => new Bullet.btVector3(...v);
const quat = ([w, x, y, z]) => new Bullet.btQuaternion(x, y, z, w);
const list = (v) => [v.x(), v.y(), v.z()];
const transform = (x, q) => {
  const made = new Bullet.btTransform();
  made.setIdentity(), made.setOrigin(vec(x)), made.setRotation(quat(q));
  return made;
};

function shapeOf(shape) {
  switch (shape?.type) {
    case "box": return new Bullet.btBoxShape(vec(shape.size.map((edge) => edge / 2)));
    case "capsule": return new Bullet.btCapsuleShapeZ(shape.radius, shape.length);
    case "plane": return new Bullet.btStaticPlaneShape(vec(shape.normal), shape.offset);
    default: return new Bullet.btSphereShape(shape?.radius ?? 0.5);
  }
}

const isTurned = ([w]) => Math.abs(w) < 1 - 1e-12;

function bodyOf(body, law, matched) {
  const { x, q } = pose({ body: [body] }, body.name);
  const { moments, frame } = body.fixed ? { moments: [0, 0, 0], frame: [1, 0, 0, 0] } : principal(body.inertia);
  let shape = shapeOf(body.shape);
  if (isTurned(frame)) {
    const turned = new Bullet.btCompoundShape();
    turned.addChildShape(transform([0, 0, 0], back(frame)), shape), (shape = turned);
  }
  const state = new Bullet.btDefaultMotionState(transform(x, times(q, frame)));
  const made = new Bullet.btRigidBody(new Bullet.btRigidBodyConstructionInfo(body.fixed ? 0 : body.mass, state, shape, vec(moments)));
  made.setFriction(Math.sqrt(law.friction)), made.setRestitution(Math.sqrt(law.restitution));
  if (body.fixed) return { made, frame };
  made.setLinearVelocity(vec(body.velocity)), made.setAngularVelocity(vec(body.angular_velocity));
  if (matched) made.setDamping(0, 0), made.setActivationState(kNeverSleeps), made.setFlags(kGyroscopicTerm);
  return { made, frame };
}

function jointOf(scene, joint, bodies, ground) {
  const of = (name) => bodies[scene.body.findIndex((body) => body.name === name)] ?? { made: ground, frame: [1, 0, 0, 0] };
  const [a, b] = [of(joint.a), of(joint.b)];
  const [at_a, at_b] = [[joint.a, a], [joint.b, b]].map(([name, { frame }]) => {
    const { x, q } = pose(scene, name);
    return { x, q: times(q, frame) };
  });
  const pivots = [vec(pointIn(at_a, joint.anchor)), vec(pointIn(at_b, joint.anchor))];
  if (joint.type === "ball") return new Bullet.btPoint2PointConstraint(a.made, b.made, ...pivots);
  return new Bullet.btHingeConstraint(a.made, b.made, ...pivots, vec(directionIn(at_a, joint.axis)), vec(directionIn(at_b, joint.axis)), true);
}

function checkRotation(scene, bodies, dt) {
  for (const [i, { made }] of bodies.entries()) {
    const angle = dt * Math.hypot(...list(made.getAngularVelocity()));
    if (angle > kMostRotation) throw new Unsupported(`Bullet turns a body by at most 0.785 rad in one step; '${scene.body[i].name}' turns by ${angle.toPrecision(3)} rad`);
  }
}

serve({
  info: {
    name: "ammo", version, precision: "single", columns: "f64le", calls: ["run"],
    features: ["wrench", "fixed-body", "joint:ball", "joint:hinge", "joints-with-contacts", "restitution", "friction:none",
               "friction:coulomb", "friction:infinite", "contact:plane-sphere", "contact:box-plane", "contact:capsule-plane",
               "contact:sphere-sphere", "contact:box-sphere", "contact:box-box", "contact:capsule-sphere", "contact:box-capsule",
               "contact:capsule-capsule"],
    methods: [{ name: "sequential-impulse", summary: "semi-implicit Euler, sequential impulses", order: 1, leapfrog_stagger: 0.5,
                options: [{ name: "iterations", meaning: "passes over contacts and joints", min: 1, max: 1000, whole: true }] }],
  },
  load(scene, { track, options }) {
    const matched = track === "matched", law = oneLaw(scene), configuration = new Bullet.btDefaultCollisionConfiguration();
    const parts = [configuration, new Bullet.btCollisionDispatcher(configuration), new Bullet.btDbvtBroadphase(), new Bullet.btSequentialImpulseConstraintSolver()];
    const world = new Bullet.btDiscreteDynamicsWorld(parts[1], parts[2], parts[3], configuration), solver = world.getSolverInfo();
    world.setGravity(vec(scene.gravity));
    if (options.iterations) solver.set_m_numIterations(options.iterations);
    const bodies = scene.body.map((body) => bodyOf(body, law, matched));
    scene.body.forEach((body, i) => body.collides ? world.addRigidBody(bodies[i].made) : world.addRigidBody(bodies[i].made, 0, 0));
    const ground = new Bullet.btRigidBody(new Bullet.btRigidBodyConstructionInfo(0, new Bullet.btDefaultMotionState(transform([0, 0, 0], [1, 0, 0, 0])), shapeOf(), vec([0, 0, 0])));
    const joints = (scene.joint ?? []).map((joint) => jointOf(scene, joint, bodies, ground));
    for (const joint of joints) world.addConstraint(joint, false);
    const moving = bodies.find((_, i) => !scene.body[i].fixed)?.made, force = vec([0, 0, 0]);
    return {
      settings: {
        solver: "sequential impulses", iterations: solver.get_m_numIterations(), "split impulse": solver.get_m_splitImpulse() ? "on" : "off",
        gyroscopic: moving && moving.getFlags() & kGyroscopicTerm ? "on, explicit" : "off",
        damping: moving ? `linear ${moving.getLinearDamping()}, angular ${moving.getAngularDamping()}` : "none", sleeping: matched ? "off" : "on",
      },
      step(dt, wrenches) {
        checkRotation(scene, bodies, dt);
        wrenches?.forEach((wrench, i) => {
          if (scene.body[i].fixed) return;
          force.setValue(...wrench.slice(0, 3)), bodies[i].made.applyCentralForce(force);
          force.setValue(...wrench.slice(3)), bodies[i].made.applyTorque(force);
        });
        world.stepSimulation(dt, 0);
      },
      rows: () => bodies.map(({ made, frame }) => {
        const at = made.getCenterOfMassTransform(), q = at.getRotation();
        const row = [...list(at.getOrigin()), ...times([q.w(), q.x(), q.y(), q.z()], back(frame)), ...list(made.getLinearVelocity()), ...list(made.getAngularVelocity())];
        Bullet.destroy(q);
        return row;
      }),
      free() {
        for (const joint of joints) world.removeConstraint(joint), Bullet.destroy(joint);
        for (const { made } of bodies) world.removeRigidBody(made), Bullet.destroy(made);
        for (const part of [world, ...parts.reverse()]) Bullet.destroy(part);
      },
    };
  },
});
