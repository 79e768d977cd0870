// Jolt (npm jolt-physics, single precision): each request one step of dt. `matched` switches off damping and sleeping
// and lets bodies turn as fast as they do. Jolt combines the laws of two bodies (the root of the product of frictions, the
// larger restitution), so each body has the values of the scene's one law.
import { oneLaw, pose, serve } from "./serve.mjs";
import initJolt from "jolt-physics";

const Jolt = await initJolt();

const vec = ([x, y, z]) => new Jolt.Vec3(x, y, z);
const rvec = ([x, y, z]) => new Jolt.RVec3(x, y, z);
const list = (v) => [v.GetX(), v.GetY(), v.GetZ()];
const kStanding = 0, kMoving = 1;

function joltOf() {
  const settings = new Jolt.JoltSettings(), pairs = new Jolt.ObjectLayerPairFilterTable(2);
  pairs.EnableCollision(kStanding, kMoving), pairs.EnableCollision(kMoving, kMoving);
  const layers = new Jolt.BroadPhaseLayerInterfaceTable(2, 2);
  for (const layer of [kStanding, kMoving]) layers.MapObjectToBroadPhaseLayer(layer, new Jolt.BroadPhaseLayer(layer));
  settings.mObjectLayerPairFilter = pairs, settings.mBroadPhaseLayerInterface = layers;
  settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(layers, 2, pairs, 2);
  settings.mMaxWorkerThreads = 0;
  return new Jolt.JoltInterface(settings);
}

// Capsules lie along y in Jolt, along z here; a sharp box has no rounded edges.
function shapeOf(shape) {
  switch (shape?.type) {
    case "box": return new Jolt.BoxShape(vec(shape.size.map((edge) => edge / 2)), 0);
    case "capsule":
      return new Jolt.RotatedTranslatedShapeSettings(vec([0, 0, 0]), new Jolt.Quat(Math.SQRT1_2, 0, 0, Math.SQRT1_2),
        new Jolt.CapsuleShapeSettings(shape.length / 2, shape.radius)).Create().Get();
    case "plane": return new Jolt.PlaneShape(new Jolt.Plane(vec(shape.normal), -shape.offset), null, 1e3);
    default: return new Jolt.SphereShape(shape?.radius ?? 0.5);
  }
}

function bodyOf(bodies, body, law, matched) {
  const { x, q } = pose({ body: [body] }, body.name), [w, i, j, k] = q;
  const settings = new Jolt.BodyCreationSettings(shapeOf(body.shape), rvec(x), new Jolt.Quat(i, j, k, w),
    body.fixed ? Jolt.EMotionType_Static : Jolt.EMotionType_Dynamic, body.fixed ? kStanding : kMoving);
  settings.mFriction = law.friction, settings.mRestitution = law.restitution;
  if (!body.collides) settings.mIsSensor = true; // is felt by nothing
  if (!body.fixed) {
    const [xx, yy, zz, xy, xz, yz] = body.inertia, inertia = settings.mMassPropertiesOverride.mInertia;
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].forEach((column, n) => inertia.SetColumn3(n, vec(column)));
    settings.mMassPropertiesOverride.mMass = body.mass, settings.mMassPropertiesOverride.mInertia = inertia;
    settings.mOverrideMassProperties = Jolt.EOverrideMassProperties_MassAndInertiaProvided;
    settings.mLinearVelocity = vec(body.velocity), settings.mAngularVelocity = vec(body.angular_velocity);
    settings.mApplyGyroscopicForce = true;
  }
  if (matched) {
    settings.mLinearDamping = settings.mAngularDamping = 0, settings.mAllowSleeping = false;
    settings.mMaxAngularVelocity = settings.mMaxLinearVelocity = 1e6;
  }
  const made = bodies.CreateBody(settings);
  bodies.AddBody(made.GetID(), Jolt.EActivation_Activate);
  return made;
}

function addJoint(system, scene, joint, bodies) {
  const world = Jolt.JoltInterface.prototype.sGetFixedToWorldBody();
  const of = (name) => (name === "world" ? world : bodies[scene.body.findIndex((body) => body.name === name)]);
  const settings = joint.type === "ball" ? new Jolt.PointConstraintSettings() : new Jolt.HingeConstraintSettings();
  settings.mSpace = Jolt.EConstraintSpace_WorldSpace;
  settings.mPoint1 = settings.mPoint2 = rvec(joint.anchor);
  if (joint.type === "hinge") {
    const [x, y, z] = joint.axis, [a, b, c] = Math.abs(x) < 0.6 ? [0, z, -y] : [-z, 0, x], size = Math.hypot(a, b, c);
    settings.mHingeAxis1 = settings.mHingeAxis2 = vec(joint.axis);
    settings.mNormalAxis1 = settings.mNormalAxis2 = vec([a / size, b / size, c / size]);
  }
  system.AddConstraint(settings.Create(of(joint.a), of(joint.b)));
}

serve({
  info: {
    name: "jolt", version: "1.1.0", precision: "single", columns: "f64le", calls: ["run"],
    features: ["wrench", "fixed-body", "joint:ball", "joint:hinge", "joints-with-contacts", "restitution", "friction:none",
               "friction:coulomb", "friction:infinite", "contact:plane-sphere", "contact:box-plane", "contact:capsule-plane",
               "contact:sphere-sphere", "contact:box-sphere", "contact:box-box", "contact:capsule-sphere", "contact:box-capsule",
               "contact:capsule-capsule"],
    methods: [{ name: "euler", summary: "semi-implicit Euler, gyroscopic term by one Newton step", order: 1, leapfrog_stagger: 0.5 }],
  },
  load(scene, { track }) {
    const matched = track === "matched", jolt = joltOf(), system = jolt.GetPhysicsSystem(), made = system.GetBodyInterface();
    system.SetGravity(vec(scene.gravity));
    const law = oneLaw(scene);
    if (matched) {
      const settings = system.GetPhysicsSettings();
      settings.mMinVelocityForRestitution = 0, system.SetPhysicsSettings(settings);
    }
    const bodies = scene.body.map((body) => bodyOf(made, body, law, matched));
    for (const joint of scene.joint ?? []) addJoint(system, scene, joint, bodies);
    return {
      settings: { gyroscopic: "on", sleeping: matched ? "off" : "on", damping: matched ? "none" : "as shipped" },
      step(dt, wrenches) {
        wrenches?.forEach((wrench, i) => {
          if (scene.body[i].fixed) return;
          bodies[i].AddForce(vec(wrench.slice(0, 3))), bodies[i].AddTorque(vec(wrench.slice(3)));
        });
        jolt.Step(dt, 1);
      },
      rows: () => bodies.map((body) => {
        const q = body.GetRotation(), still = body.IsStatic();
        return [...list(body.GetCenterOfMassPosition()), q.GetW(), q.GetX(), q.GetY(), q.GetZ(),
                ...(still ? [0, 0, 0] : list(body.GetLinearVelocity())), ...(still ? [0, 0, 0] : list(body.GetAngularVelocity()))];
      }),
      free: () => Jolt.destroy(jolt),
    };
  },
});
