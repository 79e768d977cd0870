// cannon-es (npm, double precision): each request one step of dt. It has no gyroscopic term: on the track `matched` this
// file adds it as a torque at the step's start. A body's axes are its principal ones, so shapes are turned into them. Friction is bounded by the weight and not by the normal force, which
// is not Coulomb's law: only none and infinite friction are declared. Contacts and joints are soft springs.
import { add, back, directionIn, gyroscopicTorque, oneLaw, pointIn, pose, principal, serve, times } from "./serve.mjs";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import * as CANNON from "cannon-es";

const home = createRequire(import.meta.url).resolve("cannon-es").replace(/dist\/[^/]*$/, "");
const { version } = JSON.parse(readFileSync(`${home}package.json`, "utf8"));

const vec = (v) => new CANNON.Vec3(...v);
const quat = ([w, x, y, z]) => new CANNON.Quaternion(x, y, z, w);
const list = ({ x, y, z }) => [x, y, z];

// A plane's normal lies along z in cannon-es.
function fromZ([x, y, z]) {
  const q = z > -0.999 ? [1 + z, -y, x, 0] : [0, 1, 0, 0], size = Math.hypot(...q);
  return q.map((part) => part / size);
}

function shapeOf(shape) {
  switch (shape.type) {
    case "sphere": return new CANNON.Sphere(shape.radius);
    case "box": return new CANNON.Box(vec(shape.size.map((edge) => edge / 2)));
    default: return new CANNON.Plane();
  }
}

function bodyOf(body, matched) {
  const { x, q } = pose({ body: [body] }, body.name);
  const { moments, frame } = body.fixed ? { moments: null, frame: [1, 0, 0, 0] } : principal(body.inertia);
  const made = new CANNON.Body({ mass: body.fixed ? 0 : body.mass, position: vec(x), quaternion: quat(times(q, frame)) });
  if (body.collides && body.shape.type === "plane")
    made.addShape(shapeOf(body.shape), vec(body.shape.normal.map((n) => n * body.shape.offset)), quat(fromZ(body.shape.normal)));
  else if (body.collides) made.addShape(shapeOf(body.shape), vec([0, 0, 0]), quat(back(frame)));
  if (body.fixed) return { made, frame, moments };
  made.velocity.copy(vec(body.velocity)), made.angularVelocity.copy(vec(body.angular_velocity));
  made.inertia.copy(vec(moments)), made.invInertia.copy(vec(moments.map((one) => 1 / one)));
  made.updateInertiaWorld(true);
  if (matched) made.linearDamping = made.angularDamping = 0;
  return { made, frame, moments };
}

// The pose of a body's own frame in cannon-es, at t = 0.
const framed = (scene, name, frame) => {
  const { x, q } = pose(scene, name);
  return { x, q: times(q, frame) };
};

function addJoint(world, scene, joint, bodies) {
  const ground = new CANNON.Body({ mass: 0 });
  if (joint.a === "world" || joint.b === "world") world.addBody(ground);
  const of = (name) => bodies[scene.body.findIndex((body) => body.name === name)] ?? { made: ground, frame: [1, 0, 0, 0] };
  const [a, b] = [of(joint.a), of(joint.b)], at = (name, one) => framed(scene, name, one.frame);
  const [frame_a, frame_b] = [at(joint.a, a), at(joint.b, b)];
  const pivotA = vec(pointIn(frame_a, joint.anchor)), pivotB = vec(pointIn(frame_b, joint.anchor));
  if (joint.type === "ball") return world.addConstraint(new CANNON.PointToPointConstraint(a.made, pivotA, b.made, pivotB));
  const axisA = vec(directionIn(frame_a, joint.axis)), axisB = vec(directionIn(frame_b, joint.axis));
  world.addConstraint(new CANNON.HingeConstraint(a.made, b.made, { pivotA, axisA, pivotB, axisB, collideConnected: true }));
}

// The contacts of the last step. Each has two rows of friction after those of the contacts before it, or none at all.
function contactsOf(world, bodies) {
  const place = new Map(bodies.map(({ made }, i) => [made, i])), { contacts, frictionEquations: rows } = world;
  return contacts.map(({ bi, bj, ni, ri, rj, multiplier }, k) => {
    const point = bi.position.vadd(ri), gap = ni.dot(bj.position.vadd(rj).vsub(point)), force = ni.scale(multiplier);
    for (const { t, multiplier: along } of rows.slice(2 * k, rows.length ? 2 * k + 2 : 0)) force.vadd(t.scale(along), force);
    return { a: place.get(bi), b: place.get(bj), point: list(point), normal: list(ni), gap, force: list(force) };
  });
}

serve({
  info: {
    name: "cannon-es", version, precision: "double", columns: "f64le", calls: ["run", "contacts"],
    features: ["wrench", "fixed-body", "joint:ball", "joint:hinge", "joints-with-contacts", "restitution", "friction:none",
               "friction:infinite", "contact:plane-sphere", "contact:box-plane", "contact:sphere-sphere", "contact:box-sphere",
               "contact:box-box"],
    methods: [{ name: "spook", summary: "semi-implicit Euler; contacts and joints are SPOOK's soft springs",
                order: 1, leapfrog_stagger: 0.5,
                options: [{ name: "iterations", meaning: "passes of Gauss and Seidel over contacts and joints", min: 1, max: 1000, whole: true }] }],
  },
  load(scene, { track, options }) {
    const matched = track === "matched", law = oneLaw(scene), world = new CANNON.World({ gravity: vec(scene.gravity) });
    world.allowSleep = false;
    if (options.iterations) world.solver.iterations = options.iterations;
    world.defaultContactMaterial.friction = law.friction, world.defaultContactMaterial.restitution = law.restitution;
    const bodies = scene.body.map((body) => bodyOf(body, matched));
    for (const { made } of bodies) world.addBody(made);
    for (const joint of scene.joint ?? []) addJoint(world, scene, joint, bodies);
    const moving = bodies.find(({ made }) => made.mass > 0)?.made;
    return {
      settings: {
        gyroscopic: matched ? "on, explicit, added by the plug-in" : "off, there is none", solver: "Gauss and Seidel", iterations: world.solver.iterations, tolerance: world.solver.tolerance,
        damping: moving ? `linear ${moving.linearDamping}, angular ${moving.angularDamping}` : "none", sleeping: world.allowSleep ? "on" : "off",
        "contact stiffness": world.defaultContactMaterial.contactEquationStiffness,
        "contact relaxation": world.defaultContactMaterial.contactEquationRelaxation,
      },
      step(dt, wrenches) {
        bodies.forEach(({ made, moments }, i) => {
          if (scene.body[i].fixed) return;
          const { x, y, z, w } = made.quaternion, [force, torque] = [wrenches?.[i].slice(0, 3) ?? [0, 0, 0], wrenches?.[i].slice(3) ?? [0, 0, 0]];
          made.force.set(...force);
          made.torque.set(...(matched ? add(torque, gyroscopicTorque([w, x, y, z], moments, list(made.angularVelocity))) : torque));
        });
        world.step(dt);
      },
      contacts: () => contactsOf(world, bodies),
      rows: () => bodies.map(({ made, frame }) => {
        const { x, y, z, w } = made.quaternion;
        return [...list(made.position), ...times([w, x, y, z], back(frame)), ...list(made.velocity), ...list(made.angularVelocity)];
      }),
    };
  },
});
