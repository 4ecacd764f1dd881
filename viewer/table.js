// The table of bodies: only the rows in sight exist, so a thousand bodies cost no more than ten.

import { AT } from './data.js';
import { element } from './dom.js';
import { number } from './format.js';
import { dot, length } from './math.js';

const ROW = 30;

export function kinetic(head, moment, body) {
  const v = moment.vector(body, AT.velocity);
  return 0.5 * head.bodies[body].mass * dot(v, v) + 0.5 * dot(moment.vector(body, AT.spin), moment.vector(body, AT.momentum));
}

export class Table {
  constructor(head, colours, select) {
    this.head = head;
    this.colours = colours;
    this.select = select;
    this.selected = null;
    this.pool = new Map();
    this.rows = element('div', { className: 'rows', css: { height: `${ROW * head.bodies.length}px` } });
    this.scroll = element('div', {
      className: 'scroll', tabIndex: 0, role: 'grid', 'aria-label': 'Bodies: up and down select, Escape selects none',
      'aria-rowcount': String(head.bodies.length + 1),
      on: { scroll: () => this.update(this.moment), keydown: (event) => this.key(event) },
    }, this.header(), this.rows);
    this.scroll.style.setProperty('--rows', String(Math.min(head.bodies.length, 8)));
  }

  header() {
    const cell = (text, unit) => element('span', { role: 'columnheader' }, text, element('small', {}, unit));
    return element('div', { className: 'row head', role: 'row' }, cell('Body', ''), cell('x, y, z', 'm'), cell('Speed', 'm/s'), cell('|ω|', 'rad/s'), cell('Kinetic', 'J'));
  }

  key(event) {
    const { length: count } = this.head.bodies;
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
    this.update(this.moment);
  }

  row(body) {
    const cells = [0, 1, 2, 3].map(() => element('span', { role: 'gridcell' }));
    const [r, g, b] = this.colours[body].map((c) => Math.round(255 * c));
    const name = element('span', { role: 'rowheader', title: this.head.bodies[body].name }, element('i', { className: 'swatch', css: { '--c': `rgb(${r} ${g} ${b})` } }), this.head.bodies[body].name);
    const node = element('div', {
      className: 'row', role: 'row', id: `body-${body}`, 'aria-rowindex': String(body + 2), css: { top: `${ROW * body}px` },
      on: { click: () => this.select(this.selected === body ? null : body) },
    }, name, ...cells);
    return { node, cells };
  }

  update(moment) {
    this.moment = moment;
    const { scrollTop, clientHeight } = this.scroll;
    if (!moment?.frame || !clientHeight) return;
    const first = Math.max(Math.floor(scrollTop / ROW) - 1, 0);
    const last = Math.min(first + Math.ceil(clientHeight / ROW) + 2, this.head.bodies.length);
    for (const [body, { node }] of this.pool) {
      if (body >= first && body < last) continue;
      node.remove();
      this.pool.delete(body);
    }
    for (let body = first; body < last; body++) {
      let row = this.pool.get(body);
      if (!row) {
        row = this.row(body);
        this.pool.set(body, row);
        this.rows.append(row.node);
      }
      this.write(row, body, moment);
    }
  }

  write({ node, cells }, body, moment) {
    const p = moment.position(body);
    const texts = [
      p.map((x) => (Math.abs(x) < 1000 ? x.toFixed(2).replace('-', '−') : number(x, 2))).join(' '),
      number(length(moment.vector(body, AT.velocity))),
      number(length(moment.vector(body, AT.spin))),
      number(kinetic(this.head, moment, body)),
    ];
    texts.forEach((text, i) => {
      if (cells[i].textContent !== text) cells[i].textContent = text;
    });
    const chosen = String(body === this.selected);
    if (node.getAttribute('aria-selected') !== chosen) node.setAttribute('aria-selected', chosen);
  }
}
