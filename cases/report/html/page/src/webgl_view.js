// Draws the stage with three.js. Bodies of one kind are instances of one mesh, so a thousand bodies need only a few
// calls.
import * as THREE from "three";
import { mostSegments } from "./force_model.js";
import { coil, pointOf } from "./scene_model.js";
import { colour, isDark } from "./theme.js";

export class WebglView {
  // Throws where there is no WebGL, or with `onlyWithGpu` none but a slow one.
  constructor(canvas, context, { onlyWithGpu = false } = {}) {
    (this.kind = "webgl"), (this.context = context), (this.ratio = Math.min(devicePixelRatio || 1, 2));
    const quiet = console.error;
    console.error = () => {}; // three.js would also log the errors that it throws
    try {
      this.renderer = new THREE.WebGLRenderer({
        canvas,
        antialias: true,
        alpha: true,
        powerPreference: "high-performance",
        failIfMajorPerformanceCaveat: onlyWithGpu, // not all browsers heed it, so the name tells, too
      });
    } finally {
      console.error = quiet;
    }
    if (onlyWithGpu && isSoftware(this.renderer.getContext())) {
      this.renderer.dispose(), this.renderer.forceContextLoss();
      throw new Error("WebGL without a GPU");
    }
    this.renderer.setScissorTest(true);
    this.scene = new THREE.Scene();
    this.eye = new THREE.PerspectiveCamera(context.camera.fov, 1, 0.01, 1000);
    (this.sky = new THREE.HemisphereLight(0xffffff, 0x999999, 2.2)),
      (this.sun = new THREE.DirectionalLight(0xffffff, 1.6));
    this.scene.add(this.sky, this.sun);
    this.ground();
    this.groups = new Map(context.layers.map((layer) => [layer.name, this.group(layer)]));
    this.recolour();
  }
  close() {
    this.scene.traverse((object) => (object.geometry?.dispose?.(), object.material?.dispose?.()));
    this.renderer.dispose();
    this.renderer.forceContextLoss?.();
  }

  ground() {
    const { shapes, size } = this.context;
    this.planes = [];
    for (const plane of shapes.filter((s) => s.type === "plane"))
      this.planes.push(this.grid(plane.normal, plane.offset, plane.normal));
    if (!this.planes.length) {
      const { up: direction } = this.context.camera;
      const lowest = Math.min(
        ...[0, 1].map((i) => (i ? (size.high ?? size.low) : size.low).reduce((sum, v, k) => sum + v * direction[k], 0)),
      );
      this.planes.push(this.grid(direction, lowest - 0.05 * size.radius, direction));
    }
  }
  grid(normal, offset) {
    const { size } = this.context,
      cell = 10 ** Math.floor(Math.log10(size.radius)),
      half = Math.ceil((4 * size.radius) / cell);
    const grid = new THREE.GridHelper(2 * half * cell, Math.min(2 * half, 80));
    grid.material.transparent = true;
    const n = new THREE.Vector3(...normal);
    grid.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), n);
    const centre = new THREE.Vector3(...size.centre);
    grid.position.copy(centre.sub(n.clone().multiplyScalar(centre.dot(n) - offset)));
    this.scene.add(grid);
    return grid;
  }

  group(layer) {
    const group = new THREE.Group(),
      ghost = layer.name === "truth",
      { shapes, springs } = this.context;
    const material = new THREE.MeshLambertMaterial({
      vertexColors: true,
      transparent: ghost,
      opacity: ghost ? 0.3 : 1,
      depthWrite: !ghost,
    });
    const kinds = new Map();
    for (const shape of shapes) {
      if (shape.type === "plane") continue;
      const key = keyOf(shape);
      kinds.set(key, [...(kinds.get(key) ?? []), shape]);
    }
    const meshes = [...kinds.values()].map((members) => {
      const mesh = new THREE.InstancedMesh(geometryOf(members[0], members.length), material, members.length);
      mesh.frustumCulled = false;
      group.add(mesh);
      return { mesh, members };
    });
    const lines = new THREE.LineBasicMaterial({ transparent: ghost, opacity: ghost ? 0.4 : 0.9 });
    const coils = new THREE.LineSegments(new THREE.BufferGeometry(), lines);
    coils.frustumCulled = false;
    coils.geometry.setAttribute(
      "position",
      new THREE.BufferAttribute(new Float32Array(3 * 2 * 80 * Math.max(1, springs.length)), 3),
    );
    // A cross and up to two axes for each joint, and its gap.
    const seenThrough = new THREE.LineBasicMaterial({ transparent: ghost, opacity: ghost ? 0.4 : 1, depthTest: false });
    const marks = segments(5 * Math.max(1, this.context.joints.length), seenThrough),
      gaps = segments(Math.max(1, this.context.joints.length), new THREE.LineBasicMaterial({ depthTest: false }));
    const most = mostSegments(layer.forces?.length ?? 0),
      arrows = segments(most.arrows, new THREE.LineBasicMaterial({ depthTest: false })),
      cones = segments(most.cones, new THREE.LineBasicMaterial({ transparent: true, opacity: 0.6, depthTest: false }));
    const touching = new THREE.Points(
      new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ size: 4, sizeAttenuation: false, depthTest: false }),
    );
    touching.frustumCulled = false;
    touching.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * 400), 3));
    const trails = ghost ? [] : this.trails(layer);
    group.add(coils, marks, gaps, arrows, cones, touching, ...trails);
    this.scene.add(group);
    return { layer, group, material, lines, meshes, coils, marks, gaps, arrows, cones, touching, trails };
  }

  // Each body's path so far. Paths of many bodies are not shown, because they would hide each other.
  trails(layer) {
    const { motion } = layer,
      moving = this.context.shapes.filter(
        (s, k, all) => !s.fixed && s.type !== "plane" && all.findIndex((other) => other.index === s.index) === k,
      );
    if (moving.length > 30) return [];
    return moving.map((shape) => {
      const points = new Float32Array(3 * (motion.times.length + 1));
      motion.times.forEach((_, key) =>
        points.set(
          motion.values.subarray(7 * (key * motion.bodies + shape.index), 7 * (key * motion.bodies + shape.index) + 3),
          3 * key,
        ),
      );
      const line = new THREE.Line(
        new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(points, 3)),
        new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 }),
      );
      line.frustumCulled = false;
      line.userData.body = shape.index;
      return line;
    });
  }

  recolour() {
    for (const { layer, material, lines, marks, gaps, arrows, cones, touching, trails } of this.groups.values()) {
      const tint = new THREE.Color(layer.engine ? layer.engine.hex[isDark() ? 1 : 0] : colour("--truth-solid"));
      material.color.copy(tint), lines.color.copy(tint), touching.material.color.set(colour("--bad-solid"));
      gaps.material.color.set(colour("--bad-solid")), marks.material.color.copy(tint);
      arrows.material.color.copy(tint), cones.material.color.set(colour("--ink-2"));
      trails.forEach((line) => line.material.color.copy(tint));
    }
    for (const grid of this.planes)
      (grid.material.opacity = isDark() ? 0.28 : 0.32), grid.material.color.set(isDark() ? 0x8899aa : 0xffffff);
  }

  // Bodies of a run that has failed by now are red.
  tint(layer) {
    const { material } = this.groups.get(layer.name);
    material.color.set(layer.hasFailed ? colour("--bad-solid") : layer.engine ? layer.engine.hex[isDark() ? 1 : 0] : colour("--truth-solid"));
  }

  draw(panes, { trails, width, height }) {
    const { renderer, eye } = this,
      { camera } = this.context;
    renderer.setPixelRatio(this.ratio);
    renderer.setSize(width, height, false);
    const layers = new Set(panes.flatMap((p) => p.layers));
    for (const layer of layers) this.place(this.groups.get(layer.name), trails), this.tint(layer);
    eye.position.set(...camera.eye());
    eye.up.set(...camera.axes().up);
    eye.lookAt(...camera.target);
    (eye.near = camera.distance / 200), (eye.far = camera.distance * 50 + 20 * camera.radius);
    this.sun.position.copy(eye.position).addScaledVector(new THREE.Vector3(...camera.up), camera.distance);
    this.seeThrough(panes);
    for (const pane of panes) {
      for (const [, { group, layer }] of this.groups) group.visible = pane.layers.includes(layer) && !layer.isGone;
      const bottom = height - pane.y - pane.height;
      renderer.setViewport(pane.x, bottom, pane.width, pane.height),
        renderer.setScissor(pane.x, bottom, pane.width, pane.height);
      eye.aspect = pane.width / pane.height;
      eye.fov =
        eye.aspect < 1
          ? ((2 * 180) / Math.PI) * Math.atan(Math.tan((camera.fov * Math.PI) / 360) / eye.aspect)
          : camera.fov;
      eye.updateProjectionMatrix();
      renderer.render(this.scene, eye);
    }
  }

  // Several engines on top of one another: each lets the others be seen.
  seeThrough(panes) {
    const isCrowded = panes.some((p) => p.layers.filter((l) => l.engine).length > 1);
    for (const { layer, material } of this.groups.values()) {
      if (!layer.engine || material.transparent === isCrowded) continue;
      (material.transparent = isCrowded), (material.opacity = isCrowded ? 0.55 : 1), (material.depthWrite = !isCrowded);
      material.needsUpdate = true;
    }
  }

  // The time per picture, in ms: a slow machine gets fewer pixels.
  keepPace(took) {
    this.pace = 0.8 * (this.pace ?? 16) + 0.2 * took;
    if (this.pace > 40 && this.ratio > 0.5) (this.ratio = Math.max(0.5, this.ratio * 0.8)), (this.pace = 20);
  }

  place({ layer, meshes, coils, marks, gaps, arrows, cones, touching, trails }, showTrails) {
    const { poses } = layer;
    for (const { mesh, members } of meshes) {
      members.forEach((shape, i) => mesh.setMatrixAt(i, matrixOf(poses, shape)));
      mesh.instanceMatrix.needsUpdate = true;
    }
    this.placeCoils(coils, poses);
    putSegments(marks, layer.jointed.marks), putSegments(gaps, layer.jointed.gaps);
    putSegments(arrows, layer.forceful.arrows), putSegments(cones, layer.forceful.cones);
    const spots = touching.geometry.attributes.position;
    layer.contacts.slice(0, 400).forEach((p, i) => spots.setXYZ(i, ...p));
    spots.needsUpdate = true;
    touching.geometry.setDrawRange(0, Math.min(400, layer.contacts.length));
    for (const line of trails) {
      line.visible = showTrails;
      const points = line.geometry.attributes.position,
        o = 7 * line.userData.body,
        motion = layer.motion,
        from = 7 * motion.bodies;
      for (let k = Math.max(0, layer.key - 1); k <= Math.min(layer.key + 1, motion.times.length - 1); ++k)
        points.setXYZ(k, ...motion.values.subarray(k * from + o, k * from + o + 3));
      points.setXYZ(layer.key + 1, poses[o], poses[o + 1], poses[o + 2]); // to where it is now
      points.needsUpdate = true;
      line.geometry.setDrawRange(0, layer.key + 2);
      if (layer.key < line.userData.shown - 1 || layer.key > line.userData.shown + 1)
        restore(points, motion, line.userData.body, layer.key + 1);
      line.userData.shown = layer.key;
    }
  }

  placeCoils(coils, poses) {
    const spots = coils.geometry.attributes.position,
      { springs, size } = this.context;
    let at = 0;
    for (const spring of springs) {
      const a = pointOf(poses, spring.a, spring.pointA),
        b = pointOf(poses, spring.b, spring.pointB);
      const points = spring.coil ? coil(a, b, 0.025 * size.radius) : [a, b];
      for (let i = 0; i + 1 < points.length; ++i)
        spots.setXYZ(at++, ...points[i]), spots.setXYZ(at++, ...points[i + 1]);
    }
    spots.needsUpdate = true;
    coils.geometry.setDrawRange(0, at);
  }
}

// Room for so many of two points each.
function segments(count, material) {
  const lines = new THREE.LineSegments(new THREE.BufferGeometry(), material);
  lines.frustumCulled = false;
  lines.geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * 2 * count), 3));
  return lines;
}

function putSegments(lines, ends) {
  const spots = lines.geometry.attributes.position;
  ends.flat().forEach((p, i) => spots.setXYZ(i, ...p));
  spots.needsUpdate = true;
  lines.geometry.setDrawRange(0, 2 * ends.length);
}

function isSoftware(gl) {
  const told = gl.getExtension("WEBGL_debug_renderer_info");
  const name = gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

function restore(points, motion, body, now) {
  for (let key = 0; key < motion.times.length; ++key) {
    if (key !== now)
      points.setXYZ(
        key,
        ...motion.values.subarray(7 * (key * motion.bodies + body), 7 * (key * motion.bodies + body) + 3),
      );
  }
}

const matrix = new THREE.Matrix4(),
  place = new THREE.Vector3(),
  rotation = new THREE.Quaternion(),
  size = new THREE.Vector3();
function matrixOf(poses, shape) {
  const o = 7 * shape.index;
  place.set(poses[o], poses[o + 1], poses[o + 2]);
  rotation.set(poses[o + 4], poses[o + 5], poses[o + 6], poses[o + 3]);
  if (shape.type === "sphere") size.setScalar(shape.radius);
  else if (shape.type === "box") size.set(...shape.size);
  else if (shape.type === "cylinder") size.set(shape.radius, shape.radius, shape.length);
  else if (shape.type === "ellipsoid") size.set(...shape.radii);
  else size.setScalar(1);
  if (shape.at) {
    const [w, x, y, z] = shape.at.turn;
    place.add(new THREE.Vector3(...shape.at.position).applyQuaternion(rotation));
    rotation.multiply(new THREE.Quaternion(x, y, z, w));
  }
  return matrix.compose(place, rotation, size);
}

// Shapes with the same key share one mesh, which is scaled to each.
function keyOf(shape) {
  if (shape.type === "capsule") return `capsule ${shape.radius} ${shape.length}`;
  if (shape.triangles) return `${shape.type} ${shape.points}`;
  return shape.type === "ellipsoid" ? "sphere" : shape.type;
}

function hullOf(shape) {
  const corners = shape.triangles.flat().flatMap((k) => shape.points[k]);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners), 3));
  geometry.computeVertexNormals();
  return patched(geometry);
}

// One face, or every other patch, is darker, so that a turn can be seen.
function geometryOf(shape, count) {
  const fine = count > 200 ? 12 : count > 40 ? 16 : 24;
  let geometry;
  if (shape.triangles) return hullOf(shape);
  if (shape.type === "cylinder") geometry = new THREE.CylinderGeometry(1, 1, 1, fine).rotateX(Math.PI / 2);
  else if (shape.type === "sphere" || shape.type === "ellipsoid") geometry = new THREE.SphereGeometry(1, fine, fine / 2);
  else if (shape.type === "capsule")
    geometry = new THREE.CapsuleGeometry(shape.radius, shape.length, 6, fine).rotateX(Math.PI / 2);
  else geometry = new THREE.BoxGeometry(1, 1, 1);
  const { position } = geometry.attributes,
    colours = new Float32Array(3 * position.count);
  if (geometry.index && shape.type !== "box") {
    geometry = geometry.toNonIndexed();
    return patched(geometry);
  }
  for (let i = 0; i < position.count; ++i) colours.fill(Math.floor(i / 4) === 0 ? 0.55 : 1, 3 * i, 3 * i + 3);
  geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  return geometry;
}

function patched(geometry) {
  const { position } = geometry.attributes,
    colours = new Float32Array(3 * position.count);
  for (let i = 0; i < position.count; i += 3) {
    const middle = (get) => get(i) + get(i + 1) + get(i + 2);
    const sign =
      Math.sign(middle((k) => position.getX(k))) *
      Math.sign(middle((k) => position.getY(k))) *
      Math.sign(middle((k) => position.getZ(k)) + 1e-9);
    colours.fill(sign < 0 ? 0.62 : 1, 3 * i, 3 * i + 9);
  }
  geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  return geometry;
}
