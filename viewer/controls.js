// What can be changed in a live run: the link, sliders for its numbers, dragging, saving.

import { button, element } from './dom.js';
import { number } from './format.js';

const STEPS = 1000;

// Where a key belongs and what it is called there: of `body.0.initial_velocity.0` the body and `velocity x`.
export function naming(key, bodyNames) {
  const parts = key.split('.');
  const axis = 'xyz'[parts.at(-1)];
  const last = axis ? `${parts.at(-2)} ${axis}` : parts.at(-1);
  const name = last.replace(/^initial_/, '').replaceAll('_', ' ');
  if (parts[0] === 'box') return { group: 'box', name };
  if ((parts[0] !== 'body' && parts[0] !== 'wall') || parts.length < 3) return { group: '', name };
  const index = Number(parts[1]);
  const own = parts[0] === 'body' ? bodyNames[index] : undefined;
  return { group: `${parts[0]} ${own ?? index + 1}`, name };
}

export class Controls {
  // `actions`: set(key, value), save(), grab(on)
  constructor(parent, actions) {
    this.actions = actions;
    this.sliders = new Map();
    this.state = element('span', { className: 'state', id: 'link', role: 'status' });
    this.rate = element('span', { className: 'muted' });
    this.error = element('p', { className: 'error', role: 'alert', hidden: true });
    this.list = element('div', { className: 'parameters' });
    this.grabButton = button('Drag bodies with the mouse (G, or hold Shift)', 'Drag bodies', () => actions.grab(), 'Drag bodies');
    this.grabButton.setAttribute('aria-pressed', 'false');
    this.grabButton.id = 'grab';
    const save = button('Save the scene as it is now (S)', 'Save scene', () => actions.save(), 'Save scene');
    save.id = 'save';
    parent.replaceChildren(
      element('div', { className: 'top' }, this.state, this.rate),
      this.error,
      this.list,
      element('div', { className: 'row-of-buttons' }, this.grabButton, save),
    );
  }

  link(state, seconds) {
    const text = { connecting: 'Connecting …', open: 'Connected', closed: `No connection; trying again in ${number(seconds, 2)} s` }[state];
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
      applies.textContent = waits ? 'waits for the next start' : applies.dataset.text;
    }
  }

  // sliders for these numbers; those that are there already are only set
  parameters(list, bodies) {
    const keys = list.map(({ key }) => key).join('\n');
    if (keys !== this.keys) {
      this.keys = keys;
      this.sliders.clear();
      // copies make more bodies than there are tables of them: then a number says which table
      const tables = new Set(list.map(({ key }) => key.match(/^body\.(\d+)\./)?.[1]).filter(Boolean));
      this.list.replaceChildren(...this.groups(list, tables.size === bodies.length ? bodies.map(({ name }) => name) : []));
    }
    for (const parameter of list) {
      const slider = this.sliders.get(parameter.key);
      if (slider && (this.settling || document.activeElement !== slider.input)) slider.show(parameter.value);
    }
  }

  // back to the numbers of the server, which has refused another
  settle(list, bodies) {
    this.settling = true;
    this.parameters(list, bodies);
  }

  // what belongs to a body, a wall or the box is folded away under its name
  groups(list, bodyNames) {
    const nodes = [];
    const folds = new Map();
    for (const parameter of list) {
      const { group, name } = naming(parameter.key, bodyNames);
      const row = this.slider(parameter, group, name);
      if (!group) {
        nodes.push(row);
        continue;
      }
      if (!folds.has(group)) {
        const fold = element('details', { className: 'group' }, element('summary', {}, group));
        folds.set(group, fold);
        nodes.push(fold);
      }
      folds.get(group).append(row);
    }
    return nodes;
  }

  slider(parameter, group, name) {
    const { key, unit, applies: when, log, min, max } = parameter;
    const useLog = log && min > 0;
    const toPart = (v) => (useLog ? Math.log(v / min) / Math.log(max / min) : (v - min) / (max - min));
    const toValue = (p) => (useLog ? min * (max / min) ** p : min + p * (max - min));
    const whole = `${group} ${name}`.trim();
    const input = element('input', { type: 'range', min: '0', max: String(STEPS), step: '1', 'aria-label': unit ? `${whole} in ${unit}` : whole });
    const value = element('output', {});
    const show = (v) => {
      input.value = String(STEPS * Math.min(Math.max(toPart(v), 0), 1));
      write(v);
    };
    const write = (v) => {
      value.textContent = `${number(v)} ${unit}`.trim();
      input.setAttribute('aria-valuetext', value.textContent);
    };
    input.addEventListener('input', () => {
      const v = Number(toValue(Number(input.value) / STEPS).toPrecision(3));
      write(v);
      this.settling = false;
      this.actions.set(key, v);
    });
    const applies = element('small', { className: 'applies' });
    applies.dataset.text = when === 'at reset' ? 'from the next start' : '';
    applies.textContent = applies.dataset.text;
    const row = element('label', { className: 'slider parameter', title: key }, element('span', {}, name, ' ', applies), value, input);
    this.sliders.set(key, { row, input, show, applies });
    return row;
  }
}
