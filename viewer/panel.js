// The panel at the side: what is shown, the arrows and what they say, the bodies.

import { AT } from './data.js';
import { button, element } from './dom.js';
import { count, number, quantity, vector } from './format.js';
import { length } from './math.js';
import { QUANTITIES } from './overlays.js';

const SHOWN = [
  { key: 'meshes', label: 'Surfaces', letter: 'M' },
  { key: 'edges', label: 'Edges', letter: 'E' },
  { key: 'particles', label: 'Particles', letter: 'P' },
  { key: 'paths', label: 'Paths', letter: 'H' },
  { key: 'walls', label: 'Walls', letter: 'W' },
];

export class Panel {
  // `app`: shows, overlays, head, scene, table, select, follow, changed
  constructor(parent, app) {
    this.app = app;
    this.boxes = new Map();
    this.values = new Map();
    this.live = element('section', { id: 'live', hidden: !app.head.live });
    this.detail = element('div', { id: 'detail' });
    parent.replaceChildren(this.live, this.showSection(), this.arrowSection(), this.bodySection(), this.about());
  }

  section(id, title, open, ...children) {
    return element('details', { id, open }, element('summary', {}, element('h2', {}, title)), ...children);
  }

  check(key, label, letter, isOn, set) {
    const box = element('input', { type: 'checkbox', id: `show-${key}`, checked: isOn(), on: { change: () => set(box.checked) } });
    this.boxes.set(key, { box, isOn });
    return element('label', { className: 'check', title: `${label} (${letter})` }, box, element('span', {}, label), element('kbd', {}, letter));
  }

  showSection() {
    const { app } = this;
    const rows = SHOWN.map(({ key, label, letter }) =>
      this.check(key, label, letter, () => app.shows[key], (on) => {
        app.shows[key] = on;
        app.changed();
      }),
    );
    this.ramp = element('div', { className: 'ramp', hidden: true }, element('span', {}, 'force on a particle'), element('i', {}), element('span', {}));
    return this.section('show', 'Show', true, element('div', { className: 'checks' }, ...rows), this.ramp);
  }

  arrowSection() {
    const { app } = this;
    const { overlays } = app;
    const rows = QUANTITIES.map((quantity, index) => {
      const { key, label, symbol } = quantity;
      const box = element('input', { type: 'checkbox', id: `arrow-${key}`, checked: overlays.shown.has(key), on: { change: () => app.setArrow(key, box.checked) } });
      this.boxes.set(key, { box, isOn: () => overlays.shown.has(key) });
      const value = element('span', { className: 'value' });
      this.values.set(key, value);
      return element('label', { className: 'check arrow', title: `${label} (${index + 1})`, 'data-key': key }, box, element('i', { className: 'stroke' }), element('span', {}, label, ' ', element('var', {}, symbol)), value, element('kbd', {}, String(index + 1)));
    });
    const ellipsoid = this.check('ellipsoid', 'Inertia ellipsoid', 'I', () => overlays.ellipsoid, (on) => {
      overlays.ellipsoid = on;
      app.changed();
    });
    const size = element('input', { type: 'range', id: 'arrow-size', min: '-2', max: '2', step: '0.05', value: '0', 'aria-label': 'Size of arrows', on: { input: () => app.setArrowSize(2 ** Number(size.value)) } });
    this.size = size;
    this.carrier = element('p', { className: 'muted' });
    return this.section('arrows', 'Arrows', true, this.carrier, element('div', { className: 'list' }, ...rows, ellipsoid), element('label', { className: 'slider' }, element('span', {}, 'Arrow size'), size));
  }

  bodySection() {
    const { app } = this;
    this.follow = button('Keep the selected body in the middle (C)', 'Follow', () => app.follow(), 'Follow');
    this.follow.setAttribute('aria-pressed', 'false');
    return this.section('bodies', app.head.bodies.length === 1 ? 'Body' : `${count(app.head.bodies.length)} bodies`, true, app.table.scroll, this.detail);
  }

  about() {
    const { head, film } = this.app;
    const rows = [
      ['Scheme', head.integrator === 'splitting' ? 'splitting: exact flight, kicks in contact' : `${head.integrator}: the basic scheme`],
      ['Step', quantity(head.dt, 's')],
      ['Gravity', quantity(length(head.gravity), 'm/s²')],
      ['Particles', count(head.bodies.reduce((n, b) => n + head.shapes[b.shape].particle_count, 0))],
    ];
    const tolerance = head.energy_tolerance ?? head.parameters?.find(({ key }) => key === 'energy_tolerance')?.value;
    if (tolerance) rows.splice(2, 0, ['Energy tolerance', number(tolerance)]);
    if (!head.live) rows.push(['Frames', thinned(head, film)]);
    const list = rows.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]);
    const section = this.section('about', 'About this run', false, element('dl', {}, ...list), element('p', { className: 'muted' }, `tumble ${head.version}`));
    // the last section opens below the edge of the panel
    section.addEventListener('toggle', () => section.open && section.scrollIntoView({ block: 'nearest' }));
    return section;
  }

  // boxes and captions follow what keys did
  update() {
    const { app } = this;
    for (const { box, isOn } of this.boxes.values()) box.checked = isOn();
    this.size.value = String(Math.log2(app.overlays.factor));
    const carriers = app.overlays.carriers(app.selected);
    this.carrier.textContent = carriers.length ? '' : 'Select a body: it will carry the arrows.';
    this.carrier.hidden = carriers.length > 0;
    for (const row of document.querySelectorAll('.check.arrow')) {
      const shown = QUANTITIES.find(({ key }) => key === row.dataset.key);
      const { colour, label, unit } = shown;
      row.style.setProperty('--c', colour[app.themeName]);
      const metres = app.overlays.metres(shown, carriers);
      row.title = metres > 0 ? `${label}: an arrow of 1 m stands for ${quantity(1 / metres, unit, 2)}` : `${label}: zero so far`;
    }
    this.ramp.hidden = !app.shows.particles || !app.head.walls.length;
    this.ramp.lastChild.textContent = quantity(app.scene?.bodies.strongest ?? 0, 'N', 2);
    this.follow.setAttribute('aria-pressed', String(app.following !== null));
  }

  // the numbers of a moment
  tick(moment) {
    const { app } = this;
    if (!moment.frame) return;
    // of several bodies the numbers would be unclear
    const carriers = app.overlays.carriers(app.selected);
    const first = carriers.length === 1 ? carriers[0] : undefined;
    for (const { key, value, unit } of QUANTITIES) {
      const node = this.values.get(key);
      const text = first === undefined || !app.overlays.shown.has(key) ? '' : quantity(length(value(first, moment, app.head)), unit);
      if (node.textContent !== text) node.textContent = text;
    }
    app.table.update(moment);
    this.tickDetail(moment);
  }

  tickDetail(moment) {
    const { app } = this;
    const body = app.selected ?? (app.head.bodies.length === 1 ? 0 : null);
    if (body === null) {
      this.detailOf = null;
      this.detail.replaceChildren();
      return;
    }
    if (this.detailOf !== body) this.buildDetail(body);
    this.cells.forEach(([node, at]) => (node.textContent = vector(moment.vector(body, at))));
  }

  buildDetail(body) {
    const { head } = this.app;
    const { name, mass, moments } = head.bodies[body];
    this.detailOf = body;
    const rows = [['Velocity', 'm/s', AT.velocity], ['ω', 'rad/s', AT.spin], ['L', 'kg·m²/s', AT.momentum], ['Contact force', 'N', AT.force]];
    this.cells = rows.map(([, , at]) => [element('dd', {}), at]);
    const parts = rows.flatMap(([label, unit], i) => [element('dt', {}, label, element('small', {}, unit)), this.cells[i][0]]);
    this.detail.replaceChildren(
      element('div', { className: 'top' }, element('b', {}, name), element('span', { className: 'muted' }, quantity(mass, 'kg')), this.follow),
      element('dl', {}, element('dt', {}, 'Moments', element('small', {}, 'kg·m²')), element('dd', {}, vector(moments)), ...parts),
    );
  }
}

function thinned(head, film) {
  const { frames_recorded: all, frame_count: kept } = head;
  if (!all || all === kept) return `${count(film.length)}, every ${quantity(head.interval, 's')}`;
  return `${count(kept)} of ${count(all)}: the page keeps what fits; trajectory.csv has them all`;
}
