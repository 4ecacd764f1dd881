// The shapes that show joints: rods and arrows, as lists for arrows.js.

import { boundingBox } from './geometry.js';
import { HAS_LENGTH, displayedPoses, hasLetGo, isSlack, placeOf } from './joints.js';
import { add, clamp, conjugate, cross, dot, length, normalize, perpendicular, rotate, scale, sub } from './math.js';
import { JOINT_COLOURS, rgb } from './palette.js';
import { jointOf } from './recording.js';

// radius of a pin, relative to the extent of the view: thick enough to be seen, thin enough to hide little
const THINNEST = 0.0035;
const THICKEST = 0.011;
// least radii of motor arrows, rods and ropes, relative to the extent of the view
const MOTOR = 0.008;
const ROD = 0.0016;
const ROPE = 0.0012;
const COILS = 9;
const DASHES = 24;

export class JointShapes {
  constructor(header) {
    this.header = header;
    this.boxes = header.shapes.map(boundingBox);
    // least and largest coordinate of each joint so far: a slider's rail has their length
    this.reach = header.joints.map(() => [0, 0]);
    // a direction across each spring, which turns as little as possible from image to image
    this.across = [];
  }

  // extends the rails of sliders to a frame
  extend(frame) {
    this.header.joints.forEach(({ kind }, index) => {
      if (kind !== 'slider') return;
      const { coordinate } = jointOf(frame, index);
      const reach = this.reach[index];
      if (coordinate < reach[0]) reach[0] = coordinate;
      if (coordinate > reach[1]) reach[1] = coordinate;
    });
  }

  // All rods and arrows at a snapshot. `view` has the axes of the camera, `extent` is that of the view (m).
  list(snapshot, selected, themeName, view, extent) {
    this.rods = [];
    this.arrows = [];
    this.poseOf = displayedPoses(snapshot);
    this.header.joints.forEach((joint, index) => {
      if (hasLetGo(joint, snapshot.time)) return;
      this.index = index;
      const isSelected = index === selected;
      this.colour = rgb(JOINT_COLOURS[isSelected ? 'selected' : 'joint'][themeName]);
      this.motorColour = rgb(JOINT_COLOURS[isSelected ? 'selected' : 'motor'][themeName]);
      this.extent = extent;
      this.size = this.sizeOf(joint, extent) * (isSelected ? 1.35 : 1);
      this.motorSize = Math.max(this.size, MOTOR * extent);
      this.back = view.back;
      const place = placeOf(joint, this.poseOf);
      this.arms(joint, place.points);
      if (HAS_LENGTH.has(joint.kind)) this.line(joint, place.points, jointOf(snapshot.frame, index));
      else this[joint.kind](joint, place, jointOf(snapshot.frame, index));
    });
    return { rods: this.rods, arrows: this.arrows };
  }

  // radius of the pin of a joint: a part of the thinner body
  sizeOf({ bodies, kind, length: natural }, extent) {
    const thinnest = bodies.reduce((min, body) => (body === null ? min : Math.min(min, this.boxOf(body).least)), Infinity);
    const size = clamp(0.6 * thinnest, THINNEST * extent, THICKEST * extent);
    // the links of a chain are shorter than its beads are wide
    return HAS_LENGTH.has(kind) && natural > 0 ? Math.min(size, 0.15 * natural) : size;
  }

  boxOf(body) {
    return this.boxes[this.header.bodies[body].shape];
  }

  rod(a, b, thickness, more = {}) {
    const d = sub(b, a);
    const l = length(d);
    this.rods.push({ origin: a, direction: l > 0 ? scale(d, 1 / l) : [0, 1, 0], length: l, colour: this.colour, thickness, ...more });
  }

  dot(point, radius) {
    this.rod(point, point, radius);
  }

  // a rod from the centre of a body to a point of a joint outside of it, which would else float in the air
  arms({ bodies, anchors }, points) {
    bodies.forEach((body, side) => {
      if (body === null || !isOutside(this.boxOf(body), anchors[side], this.size)) return;
      this.rod(this.poseOf(body).position, points[side], 0.45 * this.size);
    });
  }

  ball(joint, { points }) {
    this.dot(points[0], 1.7 * this.size);
  }

  weld(joint, { points }) {
    const orientation = joint.bodies[0] === null ? [1, 0, 0, 0] : this.poseOf(joint.bodies[0]).orientation;
    for (const arm of [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [1, 1, -1]]) {
      const half = rotate(orientation, scale(arm, 1.3 * this.size));
      this.rod(sub(points[0], half), add(points[0], half), 0.5 * this.size);
    }
  }

  // a bolt through both bodies
  hinge(joint, { points, axes }, { rate }) {
    const [axis, { size }] = [axes[0], this];
    const [low, high] = this.throughBodies(joint, axis, points[0], 2 * size);
    const ends = [add(points[0], scale(axis, low)), add(points[0], scale(axis, high))];
    this.rod(...ends, size, { isFlat: true });
    ends.forEach((end, k) => this.rod(end, add(end, scale(axis, (k ? 0.7 : -0.7) * size)), 1.7 * size, { isFlat: true }));
    if (joint.motor) this.turningArrow(joint, axis, dot(axis, this.back) > 0 ? ends[1] : ends[0], rate);
  }

  // Where both bodies lie along an axis through a point: a bolt is as long as they are thick, up to a limit.
  throughBodies({ bodies }, axis, point, margin) {
    let [low, high] = [-margin, margin];
    for (const body of bodies) {
      if (body === null) continue;
      const { position, orientation } = this.poseOf(body);
      const { centre, half } = this.boxOf(body);
      const local = rotate(conjugate(orientation), axis);
      const middle = dot(axis, sub(add(position, rotate(orientation, centre)), point));
      const reach = Math.abs(local[0]) * half[0] + Math.abs(local[1]) * half[1] + Math.abs(local[2]) * half[2];
      low = Math.min(low, middle - reach);
      high = Math.max(high, middle + reach);
    }
    const longest = 9 * this.size;
    return [Math.max(low, -longest), Math.min(high, longest)];
  }

  // an arc with a head around an axis: the way a motor turns, or both ways if it holds a position
  turningArrow({ motor }, axis, centre, rate) {
    const radius = 4.2 * this.motorSize;
    const u = normalize(cross(axis, Math.abs(dot(axis, this.back)) > 0.95 ? perpendicular(this.back) : this.back));
    const v = cross(axis, u);
    const sense = rate < 0 ? -1 : 1;
    const at = (a) => add(centre, add(scale(u, radius * Math.cos(sense * a)), scale(v, radius * Math.sin(sense * a))));
    const steps = 18;
    const span = 4.6; // rad
    const look = { colour: this.motorColour };
    for (let i = 0; i < steps; i++) this.rod(at((span * i) / steps), at((span * (i + 1)) / steps), 0.42 * this.motorSize, look);
    this.head(at(span), sub(at(span + 0.1), at(span - 0.1)));
    if (motor === 'position') this.head(at(0), sub(at(-0.1), at(0.1)));
  }

  // the head of an arrow at a point
  head(point, direction) {
    // an arrow of this length is mostly head
    this.arrows.push({ origin: point, direction: normalize(direction), length: 4 * this.motorSize, colour: this.motorColour, thickness: 0.55 * this.motorSize });
  }

  // a rail along the way, and a sleeve on it
  slider(joint, { points, axes }, { rate }) {
    const [axis, { size }] = [axes[1], this];
    const [low, high] = this.reach[this.index];
    const margin = 6 * size;
    // the coordinate is 0 at the start, where both points may differ: count it from the present place
    const place = dot(axis, sub(points[0], points[1]));
    const at = (s) => add(points[1], scale(axis, s));
    this.rod(at(Math.min(low, place) - margin), at(Math.max(high, place) + margin), 0.36 * size);
    this.rod(add(points[0], scale(axis, -2.6 * size)), add(points[0], scale(axis, 2.6 * size)), 1.7 * size, { isFlat: true });
    if (joint.motor) this.slidingArrow(joint, axis, points[0], rate);
  }

  slidingArrow({ motor }, axis, point, rate) {
    const side = normalize(cross(this.back, axis));
    const middle = add(point, scale(length(side) > 0 ? side : perpendicular(axis), 3.6 * this.motorSize));
    const way = scale(axis, rate < 0 ? -1 : 1);
    const [from, to] = [-5, 5].map((s) => add(middle, scale(way, s * this.motorSize)));
    this.rod(from, to, 0.42 * this.motorSize, { colour: this.motorColour });
    this.head(to, way);
    if (motor === 'position') this.head(from, scale(way, -1));
  }

  // a rod, rope or spring between two points
  line(joint, points, state) {
    const [a, b] = points;
    if (joint.kind === 'distance') {
      const radius = Math.max(0.35 * this.size, Math.min(ROD * this.extent, 0.08 * length(sub(a, b))));
      this.rod(a, b, radius);
      points.forEach((point) => this.dot(point, 1.7 * radius));
    } else if (joint.kind === 'spring') {
      this.spring(a, b);
    } else {
      this.rope(joint, points, state);
    }
  }

  rope(joint, points, state) {
    const [a, b] = points;
    const rope = Math.max(0.16 * this.size, ROPE * this.extent);
    // the points where a rope hangs in the world
    points.forEach((point, side) => joint.bodies[side] === null && this.dot(point, 2.4 * rope));
    if (!isSlack(joint, points, state)) {
      this.rod(a, b, rope);
    } else {
      const at = (part) => add(a, scale(sub(b, a), part));
      for (let i = 0; i < DASHES; i++) this.rod(at(i / DASHES), at((i + 0.5) / DASHES), 0.8 * rope, { opacity: 0.7 });
    }
  }

  // a coil with straight ends
  spring(a, b) {
    const d = sub(b, a);
    const direction = normalize(d);
    const before = this.across[this.index] ?? perpendicular(direction);
    const flat = sub(before, scale(direction, dot(before, direction)));
    const u = length(flat) > 0.05 ? normalize(flat) : perpendicular(direction);
    this.across[this.index] = u;
    const v = cross(direction, u);
    const radius = Math.min(2.2 * this.size, 0.25 * length(d));
    const wire = 0.32 * this.size;
    // many springs get a coil of fewer pieces
    const pieces = COILS * (this.header.joints.length > 50 ? 6 : 14);
    const at = (i) => {
      const angle = (2 * Math.PI * COILS * i) / pieces;
      const along = add(a, scale(d, 0.1 + (0.8 * i) / pieces));
      return add(along, add(scale(u, radius * Math.cos(angle)), scale(v, radius * Math.sin(angle))));
    };
    this.rod(a, at(0), wire);
    for (let i = 0; i < pieces; i++) this.rod(at(i), at(i + 1), wire);
    this.rod(at(pieces), b, wire);
    [a, b].forEach((point) => this.dot(point, 0.85 * this.size));
  }
}

const isOutside = ({ centre, half }, point, margin) => point.some((x, k) => Math.abs(x - centre[k]) > half[k] + margin);
