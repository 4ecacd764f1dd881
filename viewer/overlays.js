// What the arrows mean: quantities, colours, scales, and which bodies carry them.

import { AT, BODY_SIZE } from './data.js';
import { add, conjugate, cross, dot, isFiniteVector, length, multiplyQuaternions, rotate, scale } from './math.js';
import { rgb } from './palette.js';

// `colour` for light and dark; `value(body, moment, head)` in world axes
export const QUANTITIES = [
  {
    key: 'gravity', scale: 'force', label: 'Weight', symbol: 'mg', unit: 'N', colour: { light: '#c27c00', dark: '#f0b53a' },
    value: (body, moment, head) => scale(head.gravity, head.bodies[body].mass),
  },
  {
    key: 'contact', scale: 'force', label: 'Contact force', symbol: 'Fᶜ', unit: 'N', colour: { light: '#008a64', dark: '#2cc79a' },
    value: (body, moment) => moment.vector(body, AT.force),
  },
  {
    key: 'force', scale: 'force', label: 'Total force', symbol: 'F', unit: 'N', colour: { light: '#2b3036', dark: '#f2f4f6' },
    value: (body, moment, head) => {
      const weight = scale(head.gravity, head.bodies[body].mass);
      return add(add(weight, moment.vector(body, AT.force)), drag(body, moment, head).force);
    },
  },
  {
    key: 'torque', label: 'Total torque', symbol: 'τ', unit: 'N·m', colour: { light: '#b0568d', dark: '#dd94c0' },
    value: (body, moment, head) => add(moment.vector(body, AT.torque), drag(body, moment, head).torque),
  },
  {
    key: 'velocity', label: 'Velocity', symbol: 'v', unit: 'm/s', colour: { light: '#3d9ad1', dark: '#6fc3f2' },
    value: (body, moment) => moment.vector(body, AT.velocity),
  },
  {
    key: 'momentum', label: 'Angular momentum', symbol: 'L', unit: 'kg·m²/s', colour: { light: '#0063a0', dark: '#4aa3e0' },
    value: (body, moment) => moment.vector(body, AT.momentum),
  },
  {
    key: 'spin', label: 'Angular velocity', symbol: 'ω', unit: 'rad/s', colour: { light: '#cf5500', dark: '#f58a3c' },
    value: (body, moment) => moment.vector(body, AT.spin),
  },
];

const NONE = { force: [0, 0, 0], torque: [0, 0, 0] };

// What the medium does: the sum of −c v over all particles, about the centre of mass.
function drag(body, moment, head) {
  const c = head.velocity_damping_stiffness ?? 0;
  if (c === 0) return NONE;
  const { shape, particle_mass: mass } = head.bodies[body];
  const { particle_count: count, first, second } = head.shapes[shape];
  const v = moment.vector(body, AT.velocity);
  // equal particles that carry the mass: both momenta fade at one rate
  if (!second) return { force: scale(v, -c * count), torque: scale(moment.vector(body, AT.momentum), -c / mass) };
  const q = moment.turnOf(body);
  const spin = moment.vector(body, AT.spin);
  const arm = rotate(q, first);
  const own = rotate(conjugate(q), spin);
  const turned = rotate(q, [0, 3, 6].map((row) => dot(second.slice(row, row + 3), own)));
  return {
    force: scale(add(scale(v, count), cross(spin, arm)), -c),
    torque: scale(add(turned, cross(arm, v)), -c),
  };
}

// no arrow is longer than this part of the scene's size
const LONGEST = 1;

// with so many bodies only the selected one carries arrows
const FEW = 6;

export class Overlays {
  constructor(head, size) {
    this.head = head;
    this.size = size;
    this.shown = new Set();
    this.ellipsoid = false;
    this.factor = 1;
    // the largest length of each quantity so far, by body: its arrow is then half of the scene's size
    this.largest = Object.fromEntries(QUANTITIES.map(({ key }) => [key, new Float64Array(head.bodies.length)]));
    this.hardest = null;
    this.most = 0;
  }

  // looks over a film for the scales; a long one is sampled
  scan(film, moment) {
    const step = Math.max(1, Math.floor((film.length * this.head.bodies.length) / 40000));
    for (let i = 0; i < film.length; i += step) this.learn(film.frames[i], moment);
  }

  learn(frame, moment) {
    const look = { frame, vector: moment.vector, turnOf: moment.turnOf };
    for (const quantity of QUANTITIES) {
      for (let body = 0; body < this.head.bodies.length; body++) {
        const l = length(quantity.value(body, look, this.head));
        if (!(l > this.largest[quantity.key][body] && Number.isFinite(l))) continue;
        this.largest[quantity.key][body] = l;
        if (quantity.key === 'contact' && l > this.most) {
          this.most = l;
          this.hardest = { body, frame };
        }
      }
    }
  }

  // Metres of arrow for one unit of a quantity, on these bodies. Forces share one scale, so that they can
  // be compared: that of the weight, or of the strongest force where there is none.
  metres({ key, scale: family }, carriers) {
    const largest = (of) => carriers.reduce((most, body) => Math.max(most, this.largest[of][body]), 0);
    const weight = family === 'force' ? largest('gravity') : 0;
    if (weight > 0) return (this.factor * 0.2 * this.size) / weight;
    const most = largest(family ?? key);
    return most > 0 ? (this.factor * 0.5 * this.size) / most : 0;
  }

  // the largest force k δ on one particle in the hardest contact so far (N)
  strongestOnParticle() {
    if (!this.hardest) return 0;
    const { body, frame } = this.hardest;
    const at = BODY_SIZE * body;
    const place = Array.from(frame.bodies.subarray(at, at + 3));
    const turn = Array.from(frame.bodies.subarray(at + 3, at + 7));
    const { particles } = this.head.shapes[this.head.bodies[body].shape];
    const step = 3 * Math.max(1, Math.floor(particles.length / 60000));
    let most = 0;
    for (const { normal, offset, stiffness } of this.head.walls) {
      const own = rotate(conjugate(turn), normal);
      const distance = offset - dot(normal, place);
      for (let i = 0; i < particles.length; i += step) {
        const depth = distance - own[0] * particles[i] - own[1] * particles[i + 1] - own[2] * particles[i + 2];
        most = Math.max(most, stiffness * depth);
      }
    }
    return most;
  }

  carriers(selected) {
    const { bodies } = this.head;
    if (selected !== null) return [selected];
    return bodies.length <= FEW ? bodies.map((_, index) => index) : [];
  }

  // all arrows at a moment
  arrows(moment, selected, themeName) {
    const list = [];
    const carriers = this.carriers(selected);
    for (const quantity of QUANTITIES.filter(({ key }) => this.shown.has(key))) {
      const metres = this.metres(quantity, carriers);
      for (const body of carriers) {
        const value = quantity.value(body, moment, this.head);
        const l = length(value);
        const whole = l * metres;
        // a blow is many times the weight: its arrow is cut, and says so
        const drawn = Math.min(whole, LONGEST * this.size);
        if (!(drawn > 1e-3 * this.size) || !isFiniteVector(value)) continue;
        const direction = scale(value, 1 / l);
        const origin = moment.position(body);
        list.push({
          origin, direction, length: drawn, colour: rgb(quantity.colour[themeName]),
          tip: add(origin, scale(direction, drawn)), symbol: quantity.symbol + (drawn < whole ? ' (cut)' : ''), css: quantity.colour[themeName],
        });
      }
    }
    return list;
  }

  // Poinsot's ellipsoid: far from the centre where the body turns easily
  ellipsoids(moment, selected) {
    if (!this.ellipsoid) return [];
    return this.carriers(selected).flatMap((body) => {
      const { moments, axes, shape } = this.head.bodies[body];
      if (!(moments[0] > 0)) return [];
      const half = moments.map((m) => 1 / Math.sqrt(m));
      const mean = Math.cbrt(half[0] * half[1] * half[2]);
      const radius = 0.8 * this.head.shapes[shape].radius;
      const turn = multiplyQuaternions(moment.orientation(body), axes);
      return [{ centre: moment.position(body), turn, axes: half.map((h) => (radius * h) / mean) }];
    });
  }
}
