// What the arrows mean: quantities, colours, scales, and which bodies carry them.

import { AT } from './data.js';
import { add, isFiniteVector, length, multiplyQuaternions, scale } from './math.js';
import { rgb } from './palette.js';

// `colour` for light and dark; `value(body, moment, head)` in world axes
export const QUANTITIES = [
  {
    key: 'gravity', label: 'Weight', symbol: 'mg', unit: 'N', colour: { light: '#c27c00', dark: '#f0b53a' },
    value: (body, moment, head) => scale(head.gravity, head.bodies[body].mass),
  },
  {
    key: 'contact', label: 'Contact force', symbol: 'Fᶜ', unit: 'N', colour: { light: '#008a64', dark: '#2cc79a' },
    value: (body, moment) => moment.vector(body, AT.force),
  },
  {
    key: 'force', label: 'Weight + contact', symbol: 'F', unit: 'N', colour: { light: '#2b3036', dark: '#f2f4f6' },
    value: (body, moment, head) => add(scale(head.gravity, head.bodies[body].mass), moment.vector(body, AT.force)),
  },
  {
    key: 'torque', label: 'Contact torque', symbol: 'τ', unit: 'N·m', colour: { light: '#b0568d', dark: '#dd94c0' },
    value: (body, moment) => moment.vector(body, AT.torque),
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

// with so many bodies only the selected one carries arrows
const FEW = 6;

export class Overlays {
  constructor(head, size) {
    this.head = head;
    this.size = size;
    this.shown = new Set();
    this.ellipsoid = false;
    this.factor = 1;
    // the largest length of each quantity so far: its arrow is then half of the scene's size
    this.largest = Object.fromEntries(QUANTITIES.map(({ key }) => [key, 0]));
  }

  // looks over a film for the scales; a long one is sampled
  scan(film, moment) {
    const step = Math.max(1, Math.floor((film.length * this.head.bodies.length) / 40000));
    for (let i = 0; i < film.length; i += step) this.learn(film.frames[i], moment);
  }

  learn(frame, moment) {
    const look = { frame, vector: moment.vector };
    for (const quantity of QUANTITIES) {
      for (let body = 0; body < this.head.bodies.length; body++) {
        const l = length(quantity.value(body, look, this.head));
        if (l > this.largest[quantity.key] && Number.isFinite(l)) this.largest[quantity.key] = l;
      }
    }
  }

  // metres of arrow for one unit of a quantity
  metres(key) {
    const largest = this.largest[key];
    return largest > 0 ? (this.factor * 0.5 * this.size) / largest : 0;
  }

  carriers(selected) {
    const { bodies } = this.head;
    if (selected !== null) return [selected];
    return bodies.length <= FEW ? bodies.map((_, index) => index) : [];
  }

  // all arrows at a moment
  arrows(moment, selected, themeName) {
    const list = [];
    for (const body of this.carriers(selected)) {
      for (const quantity of QUANTITIES) {
        if (!this.shown.has(quantity.key)) continue;
        const value = quantity.value(body, moment, this.head);
        const l = length(value);
        const drawn = l * this.metres(quantity.key);
        if (!(drawn > 1e-3 * this.size) || !isFiniteVector(value)) continue;
        const direction = scale(value, 1 / l);
        const origin = moment.position(body);
        list.push({
          origin, direction, length: drawn, colour: rgb(quantity.colour[themeName]),
          tip: add(origin, scale(direction, drawn)), symbol: quantity.symbol, css: quantity.colour[themeName],
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
