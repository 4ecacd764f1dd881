// The side panel: layers, arrows with their values, tables of bodies and joints, facts about the run.

import { OFFSET } from './recording.js';
import { button, element } from './dom.js';
import { count, number, quantity, vector } from './format.js';
import { hasJointLayer, jointLayerLabel } from './joints.js';
import { length } from './math.js';
import { QUANTITIES } from './overlays.js';

const LAYERS = [
  { key: 'meshes', label: 'Surfaces', letter: 'M' },
  { key: 'edges', label: 'Edges', letter: 'E' },
  { key: 'particles', label: 'Particles', letter: 'P' },
  { key: 'paths', label: 'Paths', letter: 'H' },
  { key: 'walls', label: 'Walls', letter: 'W' },
];

// a longer list of joints is closed at first
const MAX_OPEN_JOINTS = 12;

export class Panel {
  constructor(parent, app) {
    this.app = app;
    this.boxes = new Map();
    this.values = new Map();
    this.live = element('section', { id: 'live', hidden: !app.header.live });
    this.detail = element('div', { id: 'detail' });
    const { joints } = app.header;
    parent.replaceChildren(this.live, this.showSection(), this.arrowSection(), this.bodySection(), ...(joints.length ? [this.jointSection()] : []), this.about());
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
    const layers = hasJointLayer(app.header) ? [...LAYERS, { key: 'joints', label: jointLayerLabel(app.header), letter: 'J' }] : LAYERS;
    const rows = layers.map(({ key, label, letter }) =>
      this.check(key, label, letter, () => app.layers[key], (on) => {
        app.layers[key] = on;
        app.changed();
      }),
    );
    this.ramp = element('div', { className: 'ramp', hidden: true }, element('span', {}, 'force on particle'), element('i', {}), element('span', {}));
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
    const size = element('input', { type: 'range', id: 'arrow-size', min: '-2', max: '2', step: '0.05', value: '0', 'aria-label': 'Arrow size', on: { input: () => app.setArrowSize(2 ** Number(size.value)) } });
    this.size = size;
    this.arrowHint = element('p', { className: 'muted' });
    return this.section('arrows', 'Arrows', true, this.arrowHint, element('div', { className: 'list' }, ...rows, ellipsoid), element('label', { className: 'slider' }, element('span', {}, 'Arrow size'), size));
  }

  bodySection() {
    const { app } = this;
    this.follow = button('Camera follows the selected body (C)', 'Follow', () => app.follow(), 'Follow');
    this.follow.setAttribute('aria-pressed', 'false');
    return this.section('bodies', app.header.bodies.length === 1 ? 'Body' : `${count(app.header.bodies.length)} bodies`, true, app.table.scroll, this.detail);
  }

  jointSection() {
    const { joints } = this.app.header;
    const { table, detail } = this.app.jointList;
    const title = joints.length === 1 ? 'One joint' : `${count(joints.length)} joints`;
    const section = this.section('joints', title, joints.length <= MAX_OPEN_JOINTS, table.scroll, detail);
    section.addEventListener('toggle', () => this.app.changed());
    return section;
  }

  about() {
    this.facts = element('dl', {});
    this.writeFacts();
    const section = this.section('about', 'About this run', false, this.facts, element('p', { className: 'muted' }, `tumble ${this.app.header.version}`));
    // the last section would open below the visible part of the panel
    section.addEventListener('toggle', () => section.open && section.scrollIntoView({ block: 'nearest' }));
    return section;
  }

  // writes the facts about the run, which change with the parameters of a live run
  writeFacts() {
    const { header, recording } = this.app;
    const rows = [
      ['Integrator', header.integrator],
      ['Time step', quantity(header.dt, 's')],
      ['Gravity', quantity(length(header.gravity), 'm/s²')],
      ['Particles', count(header.bodies.reduce((n, b) => n + header.shapes[b.shape].particle_count, 0))],
    ];
    const tolerance = header.energy_tolerance ?? header.parameters?.find(({ key }) => key === 'energy_tolerance')?.value;
    if (tolerance) rows.splice(2, 0, ['Energy tolerance', number(tolerance)]);
    if (!header.live) rows.push(['Frames', frameCounts(header, recording)]);
    this.facts.replaceChildren(...rows.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]));
  }

  // updates check boxes and captions, which keys can change too
  update() {
    const { app } = this;
    for (const { box, isOn } of this.boxes.values()) box.checked = isOn();
    this.size.value = String(Math.log2(app.overlays.factor));
    const bodies = app.overlays.bodiesWithArrows(app.selected);
    this.arrowHint.textContent = bodies.length ? '' : 'Select a body to show its arrows.';
    this.arrowHint.hidden = bodies.length > 0;
    for (const row of document.querySelectorAll('.check.arrow')) {
      const shown = QUANTITIES.find(({ key }) => key === row.dataset.key);
      const { colour, label, unit } = shown;
      row.style.setProperty('--c', colour[app.themeName]);
      const metres = app.overlays.metresPerUnit(shown, bodies);
      row.title = metres > 0 ? `${label}: an arrow 1 m long is ${quantity(1 / metres, unit, 2)}` : `${label}: zero so far`;
    }
    this.ramp.hidden = !app.layers.particles || !app.header.walls.length;
    this.ramp.lastChild.textContent = quantity(app.renderer?.bodies.maxForce ?? 0, 'N', 2);
    this.follow.setAttribute('aria-pressed', String(app.following !== null));
  }

  // updates the numbers
  tick(snapshot) {
    const { app } = this;
    if (!snapshot.frame) return;
    // values are shown for a single body only
    const bodies = app.overlays.bodiesWithArrows(app.selected);
    const only = bodies.length === 1 ? bodies[0] : undefined;
    for (const { key, value, unit } of QUANTITIES) {
      const node = this.values.get(key);
      const text = only === undefined || !app.overlays.shown.has(key) ? '' : quantity(length(value(only, snapshot, app.header)), unit);
      if (node.textContent !== text) node.textContent = text;
    }
    app.table.update(snapshot);
    app.jointList.tick(snapshot);
    this.tickDetail(snapshot);
  }

  tickDetail(snapshot) {
    const { app } = this;
    const body = app.selected ?? (app.header.bodies.length === 1 ? 0 : null);
    if (body === null) {
      this.detailOf = null;
      this.detail.replaceChildren();
      return;
    }
    if (this.detailOf !== body) this.buildDetail(body);
    this.cells.forEach(([node, offset]) => (node.textContent = vector(snapshot.vector(body, offset))));
  }

  buildDetail(body) {
    const { header } = this.app;
    const { name, mass, moments } = header.bodies[body];
    this.detailOf = body;
    const rows = [['Velocity', 'm/s', OFFSET.velocity], ['ω', 'rad/s', OFFSET.angularVelocity], ['L', 'kg·m²/s', OFFSET.angularMomentum], ['Contact force', 'N', OFFSET.force]];
    this.cells = rows.map(([, , offset]) => [element('dd', {}), offset]);
    const parts = rows.flatMap(([label, unit], i) => [element('dt', {}, label, element('small', {}, unit)), this.cells[i][0]]);
    this.detail.replaceChildren(
      element('div', { className: 'top' }, element('b', {}, name), element('span', { className: 'muted' }, quantity(mass, 'kg')), this.follow),
      element('dl', {}, element('dt', {}, 'Moments', element('small', {}, 'kg·m²')), element('dd', {}, vector(moments)), ...parts),
    );
  }
}

// the number of frames in the page and in the run
function frameCounts(header, recording) {
  const { frames_recorded: all, frame_count: kept } = header;
  if (!all || all === kept) return `${count(recording.length)}, every ${quantity(header.interval, 's')}`;
  return `${count(kept)} of ${count(all)} (all are in trajectory.csv)`;
}
