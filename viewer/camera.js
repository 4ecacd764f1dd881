// An orbit camera, and the mouse and touch gestures that move it.

import { add, clamp, cross, dot, multiply, normalize, perpendicular, perspective, scale, sub, transform, viewMatrix } from './math.js';

// vertical field of view (rad)
const FOV = (36 * Math.PI) / 180;
const MAX_PITCH = 1.55; // rad
// CSS pixels at the top that hold name and description of the run
const TITLE = 60;

export class Camera {
  constructor(up) {
    this.up = normalize(up);
    // horizontal axes; x and z if y is up
    this.east = Math.abs(this.up[0]) < 0.9 ? normalize(cross(cross(this.up, [1, 0, 0]), this.up)) : perpendicular(this.up);
    this.north = cross(this.up, this.east);
    this.target = [0, 0, 0];
    this.distance = 5;
    this.yaw = 0.62;
    this.pitch = 0.36;
    this.size = [1, 1];
    // width of the borders covered by panels, in CSS pixels
    this.margin = { left: 0, right: 0, top: 0, bottom: 0 };
  }

  // looks across a slope, so that its inclination is visible
  faceSlope(normal) {
    const across = normalize(cross(normal, this.up));
    const front = scale(this.north, -1);
    const side = dot(across, front) < 0 ? scale(across, -1) : across;
    this.yaw = Math.atan2(dot(side, this.east), dot(side, front)) + 0.3;
    this.pitch = 0.2;
  }

  // looks along a horizontal axis, a little from the side and from above
  faceAlong(axis) {
    if (Math.abs(dot(axis, this.up)) > 0.5) return;
    const front = scale(this.north, -1);
    const toEye = dot(axis, front) < -1e-6 ? scale(axis, -1) : axis;
    this.yaw = Math.atan2(dot(toEye, this.east), dot(toEye, front)) + 0.3;
    this.pitch = 0.16;
  }

  // moves to a distance from which a sphere, or all given points in it, fit into the view
  fit({ centre, radius, points }) {
    this.target = centre;
    this.home = { centre, radius };
    const [w, h] = this.freeSize();
    const half = Math.tan(FOV / 2);
    const part = Math.min(h, w) / this.size[1];
    this.distance = (1.02 * radius) / Math.max(half * part, 0.05);
    if (points) this.distance = Math.min(this.distance, this.distanceFor(points, 0.9 * half));
  }

  // the distance from which all points are seen, at most at this slope from the middle of the free area and below the title
  distanceFor(points, half) {
    const { right, upward, back } = this.axes();
    const [w, h] = this.freeSize();
    const slope = (pixels) => Math.max((half * pixels) / this.size[1], 0.05);
    const [x, below, above] = [slope(w), slope(h), slope(h - 2 * TITLE)];
    return points.reduce((most, point) => {
      const d = sub(point, this.target);
      const [across, up] = [dot(d, right), dot(d, upward)];
      return Math.max(most, dot(d, back) + Math.max(Math.abs(across) / x, up > 0 ? up / above : -up / below));
    }, 0);
  }

  // size of the area not covered by panels
  freeSize() {
    const { left, right, top, bottom } = this.margin;
    return [Math.max(this.size[0] - left - right, 100), Math.max(this.size[1] - top - bottom, 100)];
  }

  // changes yaw and pitch by angles (rad)
  orbit(dx, dy) {
    this.yaw -= dx;
    this.pitch = clamp(this.pitch + dy, -MAX_PITCH, MAX_PITCH);
  }

  zoom(factor) {
    const { radius } = this.home ?? { radius: 1 };
    this.distance = clamp(this.distance * factor, 0.02 * radius, 60 * radius);
  }

  // moves the target parallel to the image plane, by CSS pixels
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

  // extent of the view at the target along the shorter side of the free area (m)
  viewExtent() {
    return (2 * this.distance * Math.tan(FOV / 2) * Math.min(...this.freeSize())) / this.size[1];
  }

  // matrix, eye and axes for a view of this size in CSS pixels
  view(width, height) {
    this.size = [width, height];
    const { right, upward, back } = this.axes();
    const eye = add(this.target, scale(back, this.distance));
    const near = Math.max(this.distance - 3 * (this.home?.radius ?? 1), 0.01 * this.distance);
    const far = this.distance + 40 * (this.home?.radius ?? 1);
    const projection = perspective(FOV, width / height, near, far);
    // the target is in the centre of the area not covered by panels
    const { left, right: covered, top, bottom } = this.margin;
    projection[8] = (covered - left) / width;
    projection[9] = (top - bottom) / height;
    const matrix = multiply(projection, viewMatrix(eye, right, upward, back));
    return { matrix, eye, right, upward, back, up: this.up, zoom: projection[5], width, height };
  }

  // projects a point to CSS pixels; null behind the eye
  project(view, point) {
    const [x, y, , w] = transform(view.matrix, point);
    if (!(w > 0)) return null;
    return [(0.5 + (0.5 * x) / w) * view.width, (0.5 - (0.5 * y) / w) * view.height];
  }

  // the ray from the eye through a CSS pixel, with unit direction
  ray(view, x, y) {
    const half = Math.tan(FOV / 2);
    const { left, right: covered, top, bottom } = this.margin;
    const px = ((2 * x) / view.width - 1 + (covered - left) / view.width) * half * (view.width / view.height);
    const py = (1 - (2 * y) / view.height + (top - bottom) / view.height) * half;
    const forward = scale(view.back, -1);
    return { origin: view.eye, direction: normalize(add(forward, add(scale(view.right, px), scale(view.upward, py)))) };
  }
}

// Mouse and touch gestures on the canvas. One pointer orbits, or pans with the right button or Ctrl; two pointers
// zoom and pan. `hooks.down` may claim a gesture by returning true; it then gets `drag` and `up`.
export function listenToPointers(canvas, camera, hooks) {
  const pointers = new Map();
  let moved = 0;
  let claimed = false;
  const position = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    const at = position(event);
    if (pointers.size === 0) {
      moved = 0;
      claimed = event.button === 0 && hooks.down(at, event);
    }
    pointers.set(event.pointerId, { at, button: event.button });
  });
  canvas.addEventListener('pointermove', (event) => {
    const pointer = pointers.get(event.pointerId);
    const at = position(event);
    if (!pointer) {
      hooks.hover(at, event);
      return;
    }
    const d = [at[0] - pointer.at[0], at[1] - pointer.at[1]];
    moved += Math.hypot(...d);
    if (claimed) hooks.drag(at, event);
    else if (pointers.size === 1) dragOne(d, pointer.button, event);
    else dragTwo(event.pointerId, pointer, at, d);
    pointer.at = at;
    hooks.changed();
  });
  function dragOne(d, button, event) {
    if (button === 0 && !event.ctrlKey) {
      camera.orbit(d[0] * 0.0065, d[1] * 0.0065);
    } else {
      hooks.panned();
      camera.pan(...d);
    }
  }
  function dragTwo(id, pointer, at, d) {
    const other = [...pointers].find(([key]) => key !== id)[1];
    const distance = (p) => Math.hypot(p[0] - other.at[0], p[1] - other.at[1]);
    camera.zoom(distance(pointer.at) / Math.max(distance(at), 1));
    hooks.panned();
    camera.pan(d[0] / 2, d[1] / 2);
  }
  const end = (event) => {
    const pointer = pointers.get(event.pointerId);
    pointers.delete(event.pointerId);
    if (!pointer) return;
    if (claimed) {
      hooks.up(position(event));
      claimed = false;
    } else if (moved < 5 && pointers.size === 0 && event.type === 'pointerup') {
      hooks.click(position(event), event);
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
  return { isDown: () => pointers.size > 0 };
}
