// What can be changed in a live run: the link, sliders for its numbers, dragging, saving.

import { button, element } from './dom.js';
import { number } from './format.js';

const STEPS = 1000;

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
  parameters(list) {
    const keys = list.map(({ key }) => key).join('\n');
    if (keys !== this.keys) {
      this.keys = keys;
      this.sliders.clear();
      this.list.replaceChildren(...list.map((parameter) => this.slider(parameter)));
    }
    for (const parameter of list) {
      const slider = this.sliders.get(parameter.key);
      if (slider && document.activeElement !== slider.input) slider.show(parameter.value);
    }
  }

  slider(parameter) {
    const { key, unit, applies: when, log, min, max } = parameter;
    const useLog = log && min > 0;
    const toPart = (v) => (useLog ? Math.log(v / min) / Math.log(max / min) : (v - min) / (max - min));
    const toValue = (p) => (useLog ? min * (max / min) ** p : min + p * (max - min));
    const parts = key.split('.');
    const axis = 'xyz'[parts.at(-1)];
    const name = (axis ? `${parts.at(-2)} ${axis}` : parts.at(-1)).replaceAll('_', ' ');
    const label = parts[0] === 'body' ? `body ${Number(parts[1]) + 1}: ${name}` : name;
    const input = element('input', { type: 'range', min: '0', max: String(STEPS), step: '1', 'aria-label': `${label} in ${unit || 'plain numbers'}` });
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
      this.actions.set(key, v);
    });
    const applies = element('small', { className: 'applies' });
    applies.dataset.text = when === 'at reset' ? 'from the next start' : '';
    applies.textContent = applies.dataset.text;
    const row = element('label', { className: 'slider parameter', title: key }, element('span', {}, label, ' ', applies), value, input);
    this.sliders.set(key, { row, input, show, applies });
    return row;
  }
}
