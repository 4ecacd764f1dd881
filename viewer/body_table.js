// The table of bodies. Only the visible rows exist as elements.

import { OFFSET } from './recording.js';
import { element } from './dom.js';
import { number } from './format.js';
import { dot, length } from './math.js';

const ROW = 30; // row height in CSS pixels

// kinetic energy of a body (J)
export function kinetic(header, snapshot, body) {
  const v = snapshot.vector(body, OFFSET.velocity);
  return 0.5 * header.bodies[body].mass * dot(v, v) + 0.5 * dot(snapshot.vector(body, OFFSET.angularVelocity), snapshot.vector(body, OFFSET.angularMomentum));
}

export class BodyTable {
  constructor(header, colours, select) {
    this.header = header;
    this.colours = colours;
    this.select = select;
    this.selected = null;
    this.visibleRows = new Map();
    this.rows = element('div', { className: 'rows', css: { height: `${ROW * header.bodies.length}px` } });
    this.scroll = element('div', {
      className: 'scroll', tabIndex: 0, role: 'grid', 'aria-label': 'Bodies. Up and down arrow keys select a body, Escape clears the selection.',
      'aria-rowcount': String(header.bodies.length + 1),
      on: { scroll: () => this.update(this.snapshot), keydown: (event) => this.key(event) },
    }, this.columnHeaders(), this.rows);
    this.scroll.style.setProperty('--rows', String(Math.min(header.bodies.length, 8)));
  }

  columnHeaders() {
    const cell = (text, unit) => element('span', { role: 'columnheader' }, text, element('small', {}, unit));
    return element('div', { className: 'row head', role: 'row' }, cell('Body', ''), cell('x, y, z', 'm'), cell('Speed', 'm/s'), cell('|ω|', 'rad/s'), cell('Kinetic', 'J'));
  }

  key(event) {
    const { length: count } = this.header.bodies;
    const page = Math.max(Math.floor(this.scroll.clientHeight / ROW) - 2, 1);
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page }[event.key];
    if (by === undefined && event.key !== 'Home' && event.key !== 'End') return;
    event.preventDefault();
    event.stopPropagation();
    const from = this.selected ?? (by > 0 ? -1 : count);
    const to = event.key === 'Home' ? 0 : event.key === 'End' ? count - 1 : from + by;
    this.select(Math.min(Math.max(to, 0), count - 1));
  }

  setSelected(body) {
    this.selected = body;
    if (body !== null) {
      const { scrollTop, clientHeight } = this.scroll;
      const y = ROW * body;
      if (y < scrollTop) this.scroll.scrollTop = y;
      else if (y + 2 * ROW > scrollTop + clientHeight) this.scroll.scrollTop = y + 2 * ROW - clientHeight;
      this.scroll.setAttribute('aria-activedescendant', `body-${body}`);
    } else {
      this.scroll.removeAttribute('aria-activedescendant');
    }
    this.update(this.snapshot);
  }

  row(body) {
    const cells = [0, 1, 2, 3].map(() => element('span', { role: 'gridcell' }));
    const [r, g, b] = this.colours[body].map((c) => Math.round(255 * c));
    const name = element('span', { role: 'rowheader', title: this.header.bodies[body].name }, element('i', { className: 'swatch', css: { '--c': `rgb(${r} ${g} ${b})` } }), this.header.bodies[body].name);
    const node = element('div', {
      className: 'row', role: 'row', id: `body-${body}`, 'aria-rowindex': String(body + 2), css: { top: `${ROW * body}px` },
      on: { click: () => this.select(this.selected === body ? null : body) },
    }, name, ...cells);
    return { node, cells };
  }

  update(snapshot) {
    this.snapshot = snapshot;
    const { scrollTop, clientHeight } = this.scroll;
    if (!snapshot?.frame || !clientHeight) return;
    const first = Math.max(Math.floor(scrollTop / ROW) - 1, 0);
    const last = Math.min(first + Math.ceil(clientHeight / ROW) + 2, this.header.bodies.length);
    for (const [body, { node }] of this.visibleRows) {
      if (body >= first && body < last) continue;
      node.remove();
      this.visibleRows.delete(body);
    }
    for (let body = first; body < last; body++) {
      let row = this.visibleRows.get(body);
      if (!row) {
        row = this.row(body);
        this.visibleRows.set(body, row);
        this.rows.append(row.node);
      }
      this.write(row, body, snapshot);
    }
  }

  write({ node, cells }, body, snapshot) {
    const p = snapshot.position(body);
    const texts = [
      p.map((x) => (Math.abs(x) < 1000 ? x.toFixed(2).replace('-', '−') : number(x, 2))).join(' '),
      number(length(snapshot.vector(body, OFFSET.velocity))),
      number(length(snapshot.vector(body, OFFSET.angularVelocity))),
      number(kinetic(this.header, snapshot, body)),
    ];
    texts.forEach((text, i) => {
      if (cells[i].textContent !== text) cells[i].textContent = text;
    });
    const isSelected = String(body === this.selected);
    if (node.getAttribute('aria-selected') !== isSelected) node.setAttribute('aria-selected', isSelected);
  }
}
