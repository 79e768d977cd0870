// The drawing of joints: the joint's point on each of its two bodies, its axis, and the gap between the points.
import { pointOf, turn } from "./scene_model.js";
import { moved } from "./vectors.js";

const world = { position: [0, 0, 0], orientation_wxyz: [1, 0, 0, 0] };

// With points and axes in the bodies' own frames; a distance joint is drawn as a rod (springsOf).
export function jointsOf(scene) {
  const index = new Map(scene.bodies.map((b, i) => [b.name, i]));
  return scene.joints.map((joint) => {
    const a = index.get(joint.a) ?? -1,
      b = index.get(joint.b) ?? -1,
      [bodyA, bodyB] = [a, b].map((i) => (i < 0 ? world : scene.bodies[i]));
    if (joint.type === "distance") return { a, b, pointA: joint.point_a, pointB: joint.point_b, axes: [], isRod: true };
    const series = joint.axes ?? [],
      anchor = joint.anchor ?? series.find((one) => one.anchor)?.anchor ?? bodyB.position,
      axis = joint.axis ?? joint.normal,
      axes = [axis && [a, turned(bodyA, axis)], joint.axis2 && [b, turned(bodyB, joint.axis2)]].concat(
        series.map((one) => [a, turned(bodyA, one.axis)]),
      );
    return {
      a,
      b,
      pointA: within(bodyA, anchor),
      pointB: within(bodyB, anchor),
      axes: axes.filter(Boolean),
      slides: ["cylindrical", "screw", "slider"].includes(joint.type),
      isLoose: ["compound", "planar"].includes(joint.type), // its points move apart in more ways than one
    };
  });
}

const back = ([w, x, y, z]) => [w, -x, -y, -z];
const turned = (body, v) => turn(back(body.orientation_wxyz), v);
const within = (body, p) =>
  turned(
    body,
    p.map((v, k) => v - body.position[k]),
  );

const identity = new Float32Array([0, 0, 0, 1, 0, 0, 0]);
const poseOf = (poses, body) => (body < 0 ? identity : poses.subarray(7 * body, 7 * body + 7));

// `marks`: a cross at each joint and its axes; `gaps`: from one body's point to the other's, wider than `seen`. Segments
// of two points each; `size` is that of a cross.
export function jointSegments(joints, poses, size, seen) {
  const marks = [],
    gaps = [];
  for (const joint of joints) {
    const p = pointOf(poses, joint.a, joint.pointA),
      q = pointOf(poses, joint.b, joint.pointB),
      axes = joint.axes.map(([body, axis]) => turn([...poseOf(poses, body).subarray(3, 7)], axis));
    for (const k of [0, 1, 2]) {
      const way = [0, 1, 2].map((i) => (i === k ? 1 : 0));
      marks.push([moved(q, way, -size / 2), moved(q, way, size / 2)]);
    }
    for (const axis of axes) marks.push([moved(q, axis, -2.5 * size), moved(q, axis, 2.5 * size)]);
    const between = q.map((v, k) => v - p[k]);
    const along = joint.slides ? axes[0].reduce((sum, v, k) => sum + v * between[k], 0) : 0;
    const from = joint.slides ? moved(p, axes[0], along) : p; // motion along a free axis is no gap
    if (!joint.isRod && !joint.isLoose && Math.hypot(...q.map((v, k) => v - from[k])) > seen) gaps.push([from, q]);
  }
  return { marks, gaps };
}
