// Rapier (npm @dimforge/rapier3d-compat, single precision). Each request is one step of dt. The track `matched` uses
// one solver iteration, because more of them split the step and hold forces over the parts; the stock track uses four.
import { back, directionIn, oneLaw, pointIn, pose, principal, serve, times } from "./serve.mjs";
import RAPIER from "@dimforge/rapier3d-compat";

await RAPIER.init();

const xyz = ([x, y, z]) => ({ x, y, z });
const quat = ([w, x, y, z]) => ({ w, x, y, z });
const list = ({ x, y, z }) => [x, y, z];

// Rapier's capsules lie along y and its half-spaces have their normal there: ours are along z and anywhere.
function colliderOf(shape) {
  switch (shape.type) {
    case "sphere": return RAPIER.ColliderDesc.ball(shape.radius);
    case "box": return RAPIER.ColliderDesc.cuboid(...shape.size.map((edge) => edge / 2));
    case "capsule":
      return RAPIER.ColliderDesc.capsule(shape.length / 2, shape.radius).setRotation(quat([Math.SQRT1_2, Math.SQRT1_2, 0, 0]));
    default:
      return new RAPIER.ColliderDesc(new RAPIER.HalfSpace(xyz(shape.normal)))
        .setTranslation(...shape.normal.map((n) => n * shape.offset));
  }
}

function bodyOf(world, body, law, canSleep) {
  const desc = body.fixed ? RAPIER.RigidBodyDesc.fixed() : RAPIER.RigidBodyDesc.dynamic();
  const { x, q } = pose({ body: [body] }, body.name);
  desc.setTranslation(...x).setRotation(quat(q)).setLinvel(...body.velocity).setAngvel(xyz(body.angular_velocity)).setCanSleep(canSleep);
  if (!body.fixed) {
    const { moments, frame } = principal(body.inertia);
    desc.setAdditionalMassProperties(body.mass, xyz([0, 0, 0]), xyz(moments), quat(frame));
  }
  const made = world.createRigidBody(desc);
  if (body.collides) {
    const collider = colliderOf(body.shape).setDensity(0).setFriction(law.friction).setRestitution(law.restitution);
    world.createCollider(collider, made);
  }
  return made;
}

function addJoint(world, scene, joint, bodies) {
  const names = scene.body.map(({ name }) => name);
  const ground = joint.a === "world" || joint.b === "world" ? world.createRigidBody(RAPIER.RigidBodyDesc.fixed()) : null;
  const of = (name) => (name === "world" ? ground : bodies[names.indexOf(name)]);
  const [a, b] = [pose(scene, joint.a), pose(scene, joint.b)];
  const at_a = xyz(pointIn(a, joint.anchor ?? b.x)), at_b = xyz(pointIn(b, joint.anchor ?? b.x));
  const data = {
    ball: () => RAPIER.JointData.spherical(at_a, at_b),
    hinge: () => RAPIER.JointData.revoluteWithAxes(at_a, at_b, xyz(directionIn(a, joint.axis)), xyz(directionIn(b, joint.axis))),
    fixed: () => RAPIER.JointData.fixed(at_a, quat(times(back(a.q), b.q)), at_b, quat([1, 0, 0, 0])),
  }[joint.type]();
  world.createImpulseJoint(data, of(joint.a), of(joint.b), true);
}

serve({
  info: {
    name: "rapier", version: RAPIER.version(), precision: "single", columns: "f64le", calls: ["run", "save", "restore"],
    features: ["wrench", "fixed-body", "joint:ball", "joint:fixed", "joint:hinge", "joints-with-contacts", "restitution", "friction:none",
               "friction:coulomb", "friction:infinite", "contact:plane-sphere", "contact:box-plane", "contact:capsule-plane",
               "contact:sphere-sphere", "contact:box-sphere", "contact:box-box", "contact:capsule-sphere", "contact:box-capsule",
               "contact:capsule-capsule"],
    methods: [{ name: "euler", summary: "semi-implicit Euler, one solver iteration a step", order: 1, leapfrog_stagger: 0.5,
                options: [{ name: "iterations", meaning: "solver iterations: parts into which a step is divided", min: 1, max: 100, whole: true }] }],
  },
  load(scene, { track, options }) {
    const matched = track === "matched", law = oneLaw(scene);
    let world = new RAPIER.World(xyz(scene.gravity));
    if (matched || options.iterations) world.numSolverIterations = options.iterations ?? 1;
    let bodies = scene.body.map((body) => bodyOf(world, body, law, !matched));
    for (const joint of scene.joint ?? []) addJoint(world, scene, joint, bodies);
    return {
      settings: { "solver iterations": world.numSolverIterations, sleeping: matched ? "off" : "on" },
      step(dt, wrenches) {
        world.timestep = dt;
        wrenches?.forEach((wrench, i) => {
          if (scene.body[i].fixed) return;
          bodies[i].addForce(xyz(wrench.slice(0, 3)), true), bodies[i].addTorque(xyz(wrench.slice(3)), true);
        });
        world.step();
        if (wrenches) bodies.forEach((body) => (body.resetForces(false), body.resetTorques(false)));
      },
      rows: () => bodies.map((body) => {
        const { w, x, y, z } = body.rotation();
        return [...list(body.translation()), w, x, y, z, ...list(body.linvel()), ...list(body.angvel())];
      }),
      save: () => world.takeSnapshot(),
      restore(bytes) {
        const restored = RAPIER.World.restoreSnapshot(bytes);
        if (!restored) throw new Error("Rapier does not take this snapshot");
        bodies = bodies.map(({ handle }) => restored.getRigidBody(handle));
        world.free(), (world = restored);
      },
      free: () => world.free(),
    };
  },
});
