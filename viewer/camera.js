// The camera turns about a target; mouse, touch and keys move it.

import { add, clamp, cross, multiply, normalize, perpendicular, perspective, scale, transform, viewOf } from './math.js';

const FOV = (36 * Math.PI) / 180;
const STEEPEST = 1.55;

export class Camera {
  constructor(up) {
    this.up = normalize(up);
    // horizontal axes: for y up these are x and z
    this.east = Math.abs(this.up[0]) < 0.9 ? normalize(cross(cross(this.up, [1, 0, 0]), this.up)) : perpendicular(this.up);
    this.north = cross(this.up, this.east);
    this.target = [0, 0, 0];
    this.distance = 5;
    this.yaw = 0.62;
    this.pitch = 0.36;
    this.size = [1, 1];
    // part of the picture that panels cover, in CSS pixels
    this.margin = { left: 0, right: 0, top: 0, bottom: 0 };
  }

  // looks at a ball of that radius from where it fits into the picture
  fit(centre, radius) {
    this.target = centre;
    this.home = { centre, radius };
    const [w, h] = this.free();
    const half = Math.tan(FOV / 2);
    const part = Math.min(h, w) / this.size[1];
    this.distance = (1.02 * radius) / Math.max(half * part, 0.05);
    this.radius = radius;
  }

  free() {
    const { left, right, top, bottom } = this.margin;
    return [Math.max(this.size[0] - left - right, 100), Math.max(this.size[1] - top - bottom, 100)];
  }

  turn(dx, dy) {
    this.yaw -= dx;
    this.pitch = clamp(this.pitch + dy, -STEEPEST, STEEPEST);
  }

  zoom(factor) {
    const { radius } = this.home ?? { radius: 1 };
    this.distance = clamp(this.distance * factor, 0.02 * radius, 60 * radius);
  }

  // moves the target along the picture by pixels
  pan(dx, dy) {
    const { right, upward } = this.axes();
    const perPixel = (2 * this.distance * Math.tan(FOV / 2)) / this.size[1];
    this.target = add(this.target, add(scale(right, -dx * perPixel), scale(upward, dy * perPixel)));
  }

  axes() {
    const flat = add(scale(this.east, Math.sin(this.yaw)), scale(this.north, -Math.cos(this.yaw)));
    // `back` points from the target to the eye
    const back = add(scale(flat, Math.cos(this.pitch)), scale(this.up, Math.sin(this.pitch)));
    const right = normalize(cross(this.up, back));
    return { right, upward: cross(back, right), back };
  }

  // how much of the world the picture shows at the target, along its shorter side (m)
  breadth() {
    return (2 * this.distance * Math.tan(FOV / 2) * Math.min(...this.free())) / this.size[1];
  }

  // what a frame needs of it, for a picture of so many CSS pixels
  view(width, height) {
    this.size = [width, height];
    const { right, upward, back } = this.axes();
    const eye = add(this.target, scale(back, this.distance));
    const near = Math.max(this.distance - 3 * (this.home?.radius ?? 1), 0.01 * this.distance);
    const far = this.distance + 40 * (this.home?.radius ?? 1);
    const projection = perspective(FOV, width / height, near, far);
    // what panels leave free has the target in its middle
    const { left, right: covered, top, bottom } = this.margin;
    projection[8] = (covered - left) / width;
    projection[9] = (top - bottom) / height;
    const matrix = multiply(projection, viewOf(eye, right, upward, back));
    return { matrix, eye, right, upward, back, up: this.up, zoom: projection[5], width, height };
  }

  // where a place is in the picture, in CSS pixels; null behind the eye
  project(view, place) {
    const [x, y, , w] = transform(view.matrix, place);
    if (!(w > 0)) return null;
    return [(0.5 + (0.5 * x) / w) * view.width, (0.5 - (0.5 * y) / w) * view.height];
  }

  // the ray through a pixel: from the eye, of unit length
  ray(view, x, y) {
    const half = Math.tan(FOV / 2);
    const { left, right: covered, top, bottom } = this.margin;
    const px = ((2 * x) / view.width - 1 + (covered - left) / view.width) * half * (view.width / view.height);
    const py = (1 - (2 * y) / view.height + (top - bottom) / view.height) * half;
    const forward = scale(view.back, -1);
    return { from: view.eye, along: normalize(add(forward, add(scale(view.right, px), scale(view.upward, py)))) };
  }
}

// Pointers on the canvas: one turns, two pinch and pan; `hooks` may take a gesture over.
export function steer(canvas, camera, hooks) {
  const pointers = new Map();
  let moved = 0;
  let taken = false;
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    const at = place(event);
    if (pointers.size === 0) {
      moved = 0;
      taken = event.button === 0 && hooks.down(at, event);
    }
    pointers.set(event.pointerId, { at, button: event.button });
  });
  canvas.addEventListener('pointermove', (event) => {
    const own = pointers.get(event.pointerId);
    const at = place(event);
    if (!own) {
      hooks.hover(at, event);
      return;
    }
    const d = [at[0] - own.at[0], at[1] - own.at[1]];
    moved += Math.hypot(...d);
    if (taken) hooks.drag(at, event);
    else if (pointers.size === 1) one(d, own.button, event);
    else two(event.pointerId, own, at, d);
    own.at = at;
    hooks.changed();
  });
  function one(d, button, event) {
    if (button === 0 && !event.ctrlKey) {
      camera.turn(d[0] * 0.0065, d[1] * 0.0065);
    } else {
      hooks.panned();
      camera.pan(...d);
    }
  }
  function two(id, own, at, d) {
    const other = [...pointers].find(([key]) => key !== id)[1];
    const apart = (p) => Math.hypot(p[0] - other.at[0], p[1] - other.at[1]);
    camera.zoom(apart(own.at) / Math.max(apart(at), 1));
    hooks.panned();
    camera.pan(d[0] / 2, d[1] / 2);
  }
  const end = (event) => {
    const own = pointers.get(event.pointerId);
    pointers.delete(event.pointerId);
    if (!own) return;
    if (taken) {
      hooks.up(place(event));
      taken = false;
    } else if (moved < 5 && pointers.size === 0 && event.type === 'pointerup') {
      hooks.click(place(event), event);
    }
  };
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);
  canvas.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 30 : 1;
      camera.zoom(Math.exp(clamp(event.deltaY * lines, -240, 240) * 0.0014));
      hooks.changed();
    },
    { passive: false },
  );
  return { isHeld: () => pointers.size > 0 };
}
