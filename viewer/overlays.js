// The arrows and ellipsoids at bodies: quantities, colours, scales, and the bodies that have them. Arrows of loads and joints.

import { OFFSET, BODY_SIZE, jointOf } from './recording.js';
import { displayedPoses, hasLetGo, jointsAndLoads, loadAt, placeOf } from './joints.js';
import { add, conjugate, cross, dot, isFiniteVector, length, multiplyQuaternions, rotate, scale } from './math.js';
import { JOINT_COLOURS, rgb } from './palette.js';

// `value(body, snapshot, header)` is in world axes; quantities with the same `scale` share one length scale
export const QUANTITIES = [
  {
    key: 'gravity', scale: 'force', label: 'Weight', symbol: 'mg', unit: 'N', colour: { light: '#c27c00', dark: '#f0b53a' },
    value: (body, snapshot, header) => scale(header.gravity, header.bodies[body].mass),
  },
  {
    key: 'contact', scale: 'force', label: 'Contact force', symbol: 'Fᶜ', unit: 'N', colour: { light: '#008a64', dark: '#2cc79a' },
    value: (body, snapshot) => snapshot.vector(body, OFFSET.force),
  },
  {
    key: 'force', scale: 'force', label: 'Total force', symbol: 'F', unit: 'N', colour: { light: '#2b3036', dark: '#f2f4f6' },
    value: (body, snapshot, header) => {
      const weight = scale(header.gravity, header.bodies[body].mass);
      const others = add(drag(body, snapshot, header).force, jointsAndLoads(body, snapshot, header).force);
      return add(add(weight, snapshot.vector(body, OFFSET.force)), others);
    },
  },
  {
    key: 'torque', label: 'Total torque', symbol: 'τ', unit: 'N·m', colour: { light: '#b0568d', dark: '#dd94c0' },
    value: (body, snapshot, header) => {
      const others = add(drag(body, snapshot, header).torque, jointsAndLoads(body, snapshot, header).torque);
      return add(snapshot.vector(body, OFFSET.torque), others);
    },
  },
  {
    key: 'velocity', label: 'Velocity', symbol: 'v', unit: 'm/s', colour: { light: '#3d9ad1', dark: '#6fc3f2' },
    value: (body, snapshot) => snapshot.vector(body, OFFSET.velocity),
  },
  {
    key: 'angularMomentum', label: 'Angular momentum', symbol: 'L', unit: 'kg·m²/s', colour: { light: '#0063a0', dark: '#4aa3e0' },
    value: (body, snapshot) => snapshot.vector(body, OFFSET.angularMomentum),
  },
  {
    key: 'angularVelocity', label: 'Angular velocity', symbol: 'ω', unit: 'rad/s', colour: { light: '#cf5500', dark: '#f58a3c' },
    value: (body, snapshot) => snapshot.vector(body, OFFSET.angularVelocity),
  },
];

const NONE = { force: [0, 0, 0], torque: [0, 0, 0] };

// Drag: the sum of −c v over all particles, and its torque about the centre of mass.
function drag(body, snapshot, header) {
  const c = header.velocity_damping_stiffness ?? 0;
  if (c === 0) return NONE;
  const { shape, particle_mass: mass } = header.bodies[body];
  const { particle_count: count, first, second } = header.shapes[shape];
  const v = snapshot.vector(body, OFFSET.velocity);
  // equal particles that carry the whole mass: force and torque follow from the momenta
  if (!second) return { force: scale(v, -c * count), torque: scale(snapshot.vector(body, OFFSET.angularMomentum), -c / mass) };
  const q = snapshot.frameOrientation(body);
  const angularVelocity = snapshot.vector(body, OFFSET.angularVelocity);
  const arm = rotate(q, first);
  const local = rotate(conjugate(q), angularVelocity);
  const product = rotate(q, [0, 3, 6].map((row) => dot(second.slice(row, row + 3), local)));
  return {
    force: scale(add(scale(v, count), cross(angularVelocity, arm)), -c),
    torque: scale(add(product, cross(arm, v)), -c),
  };
}

// longest arrow, relative to the radius of the scene
const MAX_LENGTH = 1.3;

// with more bodies only the selected one has arrows
const MAX_BODIES = 6;

export class Overlays {
  constructor(header, radius) {
    this.header = header;
    this.radius = radius;
    this.shown = new Set();
    this.ellipsoid = false;
    this.factor = 1;
    // the largest magnitude of each quantity so far, for each body
    this.largest = Object.fromEntries(QUANTITIES.map(({ key }) => [key, new Float64Array(header.bodies.length)]));
    // body and frame of the largest contact force so far
    this.strongestContact = null;
    this.maxContactForce = 0;
  }

  // the maxima over a recording; a long one is sampled
  scan(recording, snapshot) {
    const step = Math.max(1, Math.floor((recording.length * this.header.bodies.length) / 40000));
    for (let i = 0; i < recording.length; i += step) this.updateMaxima(recording.frames[i], snapshot);
  }

  updateMaxima(frame, snapshot) {
    const source = { frame, vector: snapshot.vector, frameOrientation: snapshot.frameOrientation };
    for (const quantity of QUANTITIES) {
      for (let body = 0; body < this.header.bodies.length; body++) {
        const l = length(quantity.value(body, source, this.header));
        if (!(l > this.largest[quantity.key][body] && Number.isFinite(l))) continue;
        this.largest[quantity.key][body] = l;
        if (quantity.key === 'contact' && l > this.maxContactForce) {
          this.maxContactForce = l;
          this.strongestContact = { body, frame };
        }
      }
    }
  }

  // Arrow length (m) per unit of a quantity, at these bodies. The largest value so far gets half of the scene's
  // radius. All forces share one scale, which is that of the weight if there is gravity.
  metresPerUnit({ key, scale: family }, bodies) {
    const largest = (of) => bodies.reduce((max, body) => Math.max(max, this.largest[of][body]), 0);
    const weight = family === 'force' ? largest('gravity') : 0;
    if (weight > 0) return (this.factor * 0.27 * this.radius) / weight;
    const max = largest(family ?? key);
    return max > 0 ? (this.factor * 0.5 * this.radius) / max : 0;
  }

  // the largest force k δ on one particle in the strongest contact so far (N)
  maxParticleForce() {
    if (!this.strongestContact) return 0;
    const { body, frame } = this.strongestContact;
    const at = BODY_SIZE * body;
    const position = Array.from(frame.bodies.subarray(at, at + 3));
    const orientation = Array.from(frame.bodies.subarray(at + 3, at + 7));
    const { particles } = this.header.shapes[this.header.bodies[body].shape];
    const step = 3 * Math.max(1, Math.floor(particles.length / 60000));
    let max = 0;
    for (const { normal, offset, stiffness } of this.header.walls) {
      const local = rotate(conjugate(orientation), normal);
      const distance = offset - dot(normal, position);
      for (let i = 0; i < particles.length; i += step) {
        const depth = distance - local[0] * particles[i] - local[1] * particles[i + 1] - local[2] * particles[i + 2];
        max = Math.max(max, stiffness * depth);
      }
    }
    return max;
  }

  // the bodies that have arrows
  bodiesWithArrows(selected) {
    const { bodies } = this.header;
    if (selected !== null) return [selected];
    return bodies.length <= MAX_BODIES ? bodies.map((_, index) => index) : [];
  }

  // all arrows of a snapshot
  arrows(snapshot, selected, themeName) {
    const list = [];
    const bodies = this.bodiesWithArrows(selected);
    for (const quantity of QUANTITIES.filter(({ key }) => this.shown.has(key))) {
      const perUnit = this.metresPerUnit(quantity, bodies);
      for (const body of bodies) {
        const value = quantity.value(body, snapshot, this.header);
        list.push(...this.arrow(snapshot.position(body), value, perUnit, quantity.symbol, quantity.colour[themeName]));
      }
    }
    return list;
  }

  // an arrow for a vector, or none if it would be too small to be seen
  arrow(origin, value, perUnit, symbol, css) {
    const l = length(value);
    const fullLength = l * perUnit;
    // the force of an impact is many times the weight: its arrow is cut off and labelled
    const drawn = Math.min(fullLength, MAX_LENGTH * this.radius);
    if (!(drawn > 1e-3 * this.radius) || !isFiniteVector(value)) return [];
    const direction = scale(value, 1 / l);
    return [{ origin, direction, length: drawn, colour: rgb(css), tip: add(origin, scale(direction, drawn)), symbol: symbol + (drawn < fullLength ? ' (cut)' : ''), css }];
  }

  // the arrows of the loads, and of the force of the selected joint on its first body
  jointArrows(snapshot, selectedJoint, themeName) {
    const { joints, loads, bodies } = this.header;
    const poseOf = displayedPoses(snapshot);
    const perUnit = (key, body) => this.metresPerUnit(QUANTITIES.find((q) => q.key === key), body === null ? bodies.map((_, i) => i) : [body]);
    const list = loads.flatMap((load) => {
      const { force, torque, point, position } = loadAt(load, poseOf, snapshot.time);
      const css = JOINT_COLOURS.load[themeName];
      return [...this.arrow(point, force, perUnit('force', load.body), 'Fˡ', css), ...this.arrow(position, torque, perUnit('torque', load.body), 'τˡ', css)];
    });
    if (selectedJoint === null || hasLetGo(joints[selectedJoint], snapshot.time)) return list;
    const { points } = placeOf(joints[selectedJoint], poseOf);
    const { force } = jointOf(snapshot.frame, selectedJoint);
    return [...list, ...this.arrow(points[0], force, perUnit('force', joints[selectedJoint].bodies[0]), 'Fʲ', JOINT_COLOURS.selected[themeName])];
  }

  // Poinsot's inertia ellipsoid: semi-axes proportional to 1/√I
  ellipsoids(snapshot, selected) {
    if (!this.ellipsoid) return [];
    return this.bodiesWithArrows(selected).flatMap((body) => {
      const { moments, axes, shape } = this.header.bodies[body];
      if (!(moments[0] > 0)) return [];
      const half = moments.map((m) => 1 / Math.sqrt(m));
      const mean = Math.cbrt(half[0] * half[1] * half[2]);
      const radius = 0.8 * this.header.shapes[shape].radius;
      const orientation = multiplyQuaternions(snapshot.orientation(body), axes);
      return [{ centre: snapshot.position(body), orientation, axes: half.map((h) => (radius * h) / mean) }];
    });
  }
}
