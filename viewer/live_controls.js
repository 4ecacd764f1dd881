// The controls of a live run: connection state, the integrator, a slider for each parameter, drag mode, saving.

import { button, element } from './dom.js';
import { number } from './format.js';

const STEPS = 1000;

// The group and label of a scene key: `body.0.initial_velocity.0` is `velocity x` in the group of that body.
export function label(key, bodyNames) {
  const parts = key.split('.');
  const axis = 'xyz'[parts.at(-1)];
  const last = axis ? `${parts.at(-2)} ${axis}` : parts.at(-1);
  const name = last.replace(/^initial_/, '').replaceAll('_', ' ');
  if (parts[0] === 'box') return { group: 'box', name };
  if ((parts[0] !== 'body' && parts[0] !== 'wall') || parts.length < 3) return { group: '', name };
  const index = Number(parts[1]);
  const bodyName = parts[0] === 'body' ? bodyNames[index] : undefined;
  return { group: `${parts[0]} ${bodyName ?? index + 1}`, name };
}

export class LiveControls {
  // `actions`: set(key, value), save(), toggleDragMode()
  constructor(parent, actions) {
    this.actions = actions;
    this.sliders = new Map();
    this.state = element('span', { className: 'state', id: 'connection', role: 'status' });
    this.rate = element('span', { className: 'muted' });
    this.error = element('p', { className: 'error', role: 'alert', hidden: true });
    this.integrator = element('select', { id: 'integrator', on: { change: () => this.chooseIntegrator() } });
    this.integratorRow = element('label', { className: 'choice', title: 'integrator: time goes on from the present state, with the step that suits it' }, element('span', {}, 'integrator'), this.integrator);
    this.list = element('div', { className: 'parameters' });
    this.dragButton = button('Drag bodies with the mouse (G, or hold Shift)', 'Drag bodies', () => actions.toggleDragMode(), 'Drag bodies');
    this.dragButton.setAttribute('aria-pressed', 'false');
    this.dragButton.id = 'drag';
    const save = button('Save the present state as a scene file (S)', 'Save scene', () => actions.save(), 'Save scene');
    save.id = 'save';
    parent.replaceChildren(
      element('div', { className: 'top' }, this.state, this.rate),
      this.error,
      this.integratorRow,
      this.list,
      element('div', { className: 'row-of-buttons' }, this.dragButton, save),
    );
  }

  connection(state, seconds) {
    const text = { connecting: 'Connecting …', open: 'Connected', closed: `No connection; retrying in ${number(seconds, 2)} s` }[state];
    this.state.textContent = text;
    this.state.dataset.state = state;
  }

  status({ steps_per_second: rate, pending, error, playing }) {
    this.rate.textContent = playing && rate > 0 ? `${number(rate)} steps/s` : '';
    this.error.hidden = !error;
    this.error.textContent = error ?? '';
    for (const [key, { row, applies }] of this.sliders) {
      const waits = (pending ?? []).includes(key);
      row.dataset.pending = String(waits);
      applies.textContent = waits ? 'waiting for reset' : applies.dataset.text;
    }
  }

  // shows the integrators that the scene can have; each is listed with the step that comes with it
  integrators(choices, present) {
    this.present = present;
    this.integratorRow.hidden = choices.length < 2;
    const options = choices.map(({ name, dt }) => element('option', { value: name }, name === present ? name : `${name}, dt = ${number(dt)} s`));
    this.integrator.replaceChildren(...options);
    this.integrator.value = present;
  }

  chooseIntegrator() {
    this.actions.set('integrator', this.integrator.value);
  }

  // builds the sliders, or updates their values if the list of keys has not changed
  parameters(list, bodies) {
    const keys = list.map(({ key }) => key).join('\n');
    if (keys !== this.keys) {
      this.keys = keys;
      this.sliders.clear();
      // with copies there are more bodies than [[body]] tables, and groups are numbered by table
      const tables = new Set(list.map(({ key }) => key.match(/^body\.(\d+)\./)?.[1]).filter(Boolean));
      this.list.replaceChildren(...this.groups(list, tables.size === bodies.length ? bodies.map(({ name }) => name) : []));
    }
    for (const parameter of list) {
      const slider = this.sliders.get(parameter.key);
      if (slider && (this.restoring || document.activeElement !== slider.input)) slider.show(parameter.value);
    }
  }

  // sets all controls to the values of the server after it has refused a change
  restore(list, bodies) {
    this.restoring = true;
    this.integrator.value = this.present;
    this.parameters(list, bodies);
  }

  // the sliders of each body, wall and the box are in a collapsed section
  groups(list, bodyNames) {
    const nodes = [];
    const sections = new Map();
    for (const parameter of list) {
      const { group, name } = label(parameter.key, bodyNames);
      const row = this.slider(parameter, group, name);
      if (!group) {
        nodes.push(row);
        continue;
      }
      if (!sections.has(group)) {
        const section = element('details', { className: 'group' }, element('summary', {}, group));
        sections.set(group, section);
        nodes.push(section);
      }
      sections.get(group).append(row);
    }
    return nodes;
  }

  slider(parameter, group, name) {
    const { key, unit, applies: when, log, min, max } = parameter;
    const useLog = log && min > 0;
    const toFraction = (v) => (useLog ? Math.log(v / min) / Math.log(max / min) : (v - min) / (max - min));
    const toValue = (p) => (useLog ? min * (max / min) ** p : min + p * (max - min));
    const fullName = `${group} ${name}`.trim();
    const input = element('input', { type: 'range', min: '0', max: String(STEPS), step: '1', 'aria-label': unit ? `${fullName} in ${unit}` : fullName });
    const value = element('output', {});
    const show = (v) => {
      input.value = String(STEPS * Math.min(Math.max(toFraction(v), 0), 1));
      write(v);
    };
    const write = (v) => {
      value.textContent = `${number(v)} ${unit}`.trim();
      input.setAttribute('aria-valuetext', value.textContent);
    };
    input.addEventListener('input', () => {
      const v = Number(toValue(Number(input.value) / STEPS).toPrecision(3));
      write(v);
      this.restoring = false;
      this.actions.set(key, v);
    });
    const applies = element('small', { className: 'applies' });
    applies.dataset.text = when === 'at reset' ? 'applies at reset' : '';
    applies.textContent = applies.dataset.text;
    const row = element('label', { className: 'slider parameter', title: key }, element('span', {}, name, ' ', applies), value, input);
    this.sliders.set(key, { row, input, show, applies });
    return row;
  }
}
