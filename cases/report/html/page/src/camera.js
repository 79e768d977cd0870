// A camera that circles a point; moved by mouse, pen and fingers. Both ways of drawing look through it.
import { cross, dot } from "./vectors.js";

export class Camera {
  constructor(up) {
    this.up = up;
    const side = Math.abs(up[1]) > 0.9 ? [0, 0, 1] : Math.abs(up[2]) > 0.9 ? [0, -1, 0] : [0, 1, 0];
    const along = side.map((s, k) => s - up[k] * dot(side, up)),
      length = Math.hypot(...along);
    this.front = along.map((v) => v / length);
    this.right = cross(up, this.front);
    (this.yaw = 0.6), (this.pitch = 0.35), (this.distance = 5), (this.target = [0, 0, 0]), (this.fov = 35);
  }

  frame(centre, radius) {
    (this.target = [...centre]), (this.radius = Math.max(radius, 1e-6));
    this.distance = (1.15 * this.radius) / Math.sin((this.fov * Math.PI) / 360);
    (this.yaw = 0.6), (this.pitch = 0.3);
  }

  // Unit vectors in W: to the eye's right, up and towards the eye.
  axes() {
    const c = Math.cos(this.pitch),
      s = Math.sin(this.pitch),
      cy = Math.cos(this.yaw),
      sy = Math.sin(this.yaw);
    const back = [0, 1, 2].map((k) => c * (cy * this.front[k] + sy * this.right[k]) + s * this.up[k]);
    const right = [0, 1, 2].map((k) => -sy * this.front[k] + cy * this.right[k]);
    return { right, up: cross(back, right), back };
  }
  eye() {
    const { back } = this.axes();
    return this.target.map((v, k) => v + this.distance * back[k]);
  }

  orbit(dx, dy) {
    this.yaw -= dx * 0.008;
    this.pitch = Math.min(1.5, Math.max(-1.5, this.pitch + dy * 0.008));
  }
  pan(dx, dy, height) {
    const { right, up } = this.axes(),
      scale = (2 * this.distance * Math.tan((this.fov * Math.PI) / 360)) / height;
    this.target = this.target.map((v, k) => v - scale * (dx * right[k] - dy * up[k]));
  }
  zoom(factor) {
    this.distance = Math.min(200 * this.radius, Math.max(0.05 * this.radius, this.distance * factor));
  }
}

export function moveByHand(camera, surface, onMove) {
  const down = new Map();
  surface.style.touchAction = "pan-y";
  surface.addEventListener("pointerdown", (event) => {
    down.set(event.pointerId, [event.clientX, event.clientY]);
    surface.setPointerCapture?.(event.pointerId);
  });
  surface.addEventListener("pointermove", (event) => {
    const before = down.get(event.pointerId);
    if (!before) return;
    const dx = event.clientX - before[0],
      dy = event.clientY - before[1];
    if (down.size === 2) {
      const [, other] = [...down].find(([id]) => id !== event.pointerId);
      const was = Math.hypot(before[0] - other[0], before[1] - other[1]),
        is = Math.hypot(event.clientX - other[0], event.clientY - other[1]);
      if (is > 0 && was > 0) camera.zoom(was / is);
      camera.pan(dx / 2, dy / 2, surface.clientHeight);
    } else if (event.shiftKey || event.buttons & 6) camera.pan(dx, dy, surface.clientHeight);
    else camera.orbit(dx, dy);
    down.set(event.pointerId, [event.clientX, event.clientY]);
    onMove();
  });
  for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
    surface.addEventListener(end, (event) => down.delete(event.pointerId));
  surface.addEventListener("contextmenu", (event) => event.preventDefault());
  surface.addEventListener(
    "wheel",
    (event) => {
      if (!event.ctrlKey && document.activeElement !== surface) return; // the page scrolls on until the picture is clicked
      event.preventDefault();
      camera.zoom(Math.exp(event.deltaY * 0.0015));
      onMove();
    },
    { passive: false },
  );
}
