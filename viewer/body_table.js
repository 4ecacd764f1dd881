// The table of bodies.

import { OFFSET } from './recording.js';
import { element } from './dom.js';
import { number } from './format.js';
import { dot, length } from './math.js';
import { Table } from './table.js';

// kinetic energy of a body (J)
export function kinetic(header, snapshot, body) {
  const v = snapshot.vector(body, OFFSET.velocity);
  return 0.5 * header.bodies[body].mass * dot(v, v) + 0.5 * dot(snapshot.vector(body, OFFSET.angularVelocity), snapshot.vector(body, OFFSET.angularMomentum));
}

export class BodyTable extends Table {
  constructor(header, colours, select) {
    const columns = [['Body', ''], ['x, y, z', 'm'], ['Speed', 'm/s'], ['|ω|', 'rad/s'], ['Kinetic', 'J']];
    super(header.bodies.map(({ name }) => name), columns, 'body', 'Bodies', select);
    this.header = header;
    this.colours = colours;
  }

  name(body) {
    const [r, g, b] = this.colours[body].map((c) => Math.round(255 * c));
    return [element('i', { className: 'swatch', css: { '--c': `rgb(${r} ${g} ${b})` } }), this.names[body]];
  }

  texts(body, snapshot) {
    const p = snapshot.position(body);
    return [
      p.map((x) => (Math.abs(x) < 1000 ? x.toFixed(2).replace('-', '−') : number(x, 2))).join(' '),
      number(length(snapshot.vector(body, OFFSET.velocity))),
      number(length(snapshot.vector(body, OFFSET.angularVelocity))),
      number(kinetic(this.header, snapshot, body)),
    ];
  }
}
