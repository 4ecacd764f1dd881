// The energy ledger over time: stacked areas of stored and dissipated energy, and their sum.

import { element } from './dom.js';
import { quantity } from './format.js';
import { LEDGER } from './palette.js';
import { BOTTOM, LEFT, RIGHT, TOP, TimePlot } from './time_plot.js';

// indices into the ledger of a frame; the last two values are derived
const GRAVITATIONAL = 1;
const TOTAL = 9;
const RESIDUAL = 10;
const MOUSE_WORK = 11;
const PRESCRIBED_WORK = 12;

export class EnergyPlot extends TimePlot {
  constructor(parent, player) {
    super(player, 'Energy over time');
    this.legend = element('div', { className: 'legend' });
    parent.replaceChildren(this.legend, this.area);
  }

  // the values of all areas at one frame
  bands(frame) {
    return LEDGER.map((_, k) => frame.ledger[k] - (k === GRAVITATIONAL ? this.zero : 0));
  }

  // The zero of gravitational energy in the plot: its minimum in a finished run, its value at the start in a live
  // run, where the minimum is not known yet.
  gravitationalZero() {
    const { recording, live } = this.player;
    if (live) return recording.first.ledger[GRAVITATIONAL];
    return recording.frames.reduce((low, f) => Math.min(low, f.ledger[GRAVITATIONAL]), Infinity);
  }

  // Energy added since the start by the mouse spring and by changed parameters (J). It is not in the residual. Zero if
  // it is within rounding.
  mouseWork(frame) {
    const start = ({ ledger }) => ledger[TOTAL] - ledger[RESIDUAL];
    const work = start(frame) - start(this.player.recording.first);
    const size = frame.ledger.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    return Math.abs(work) > 1e-9 * size ? work : 0;
  }

  // Work done by prescribed bodies (J): the sum of the parts minus the total. Zero if it is within rounding.
  prescribedWork(frame) {
    const work = LEDGER.reduce((sum, _, k) => sum + frame.ledger[k], 0) - frame.ledger[TOTAL];
    const size = frame.ledger.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    return Math.abs(work) > 1e-9 * size ? work : 0;
  }

  paint() {
    const { recording } = this.player;
    const pen = this.startPainting();
    this.zero = this.gravitationalZero();
    // at most two frames per pixel
    const step = Math.max(1, Math.floor(recording.length / (2 * this.width)));
    const frames = recording.frames.filter((_, i) => i % step === 0 || i === recording.length - 1);
    const rows = frames.map((frame) => this.bands(frame));
    const totals = frames.map((frame) => frame.ledger[TOTAL] - this.zero);
    const used = LEDGER.map((_, k) => frames.some((frame) => Math.abs(frame.ledger[k]) > 0));
    const sum = (row, sign) => row.reduce((all, x) => all + Math.max(sign * x, 0), 0);
    let top = Math.max(0, ...rows.map((row) => sum(row, 1)), ...totals);
    const low = Math.min(0, ...rows.map((row) => -sum(row, -1)), ...totals);
    // at the start all values may be equal: scale the axis by the total energy
    const size = frames.reduce((most, { ledger }) => Math.max(most, Math.abs(ledger[TOTAL])), 0);
    if (!(top - low > 1e-9 * size)) top = size || 1;
    this.scaleY = (this.height - TOP - BOTTOM) / (1.06 * (top - low));
    const y = (value) => this.height - BOTTOM - (value - 1.06 * low) * this.scaleY;
    const style = getComputedStyle(this.area);
    this.axes(pen, [1.06 * low, 1.06 * top], 'J', y, style);
    this.fill(pen, frames, rows, used, y);
    this.line(pen, frames, totals, y, style.getPropertyValue('--ink'));
    if (used[GRAVITATIONAL]) this.labelZero(pen, style);
    this.writeLegend(used, this.mouseWork(recording.frames.at(-1)) !== 0);
  }

  // stacks positive values above the axis and negative values below it
  fill(pen, frames, rows, used, y) {
    for (const sign of [1, -1]) {
      const base = new Float64Array(frames.length);
      LEDGER.forEach(({ colour }, k) => {
        const part = (i) => sign * Math.max(sign * rows[i][k], 0);
        if (!used[k] || !rows.some((_, i) => part(i) !== 0)) return;
        pen.beginPath();
        frames.forEach((frame, i) => pen.lineTo(this.xOf(frame.time), y(base[i])));
        for (let i = frames.length - 1; i >= 0; i--) pen.lineTo(this.xOf(frames[i].time), y(base[i] + part(i)));
        frames.forEach((_, i) => (base[i] += part(i)));
        pen.fillStyle = colour;
        pen.globalAlpha = 0.82;
        pen.fill();
        pen.globalAlpha = 1;
      });
    }
  }

  // states the zero of gravitational energy, which differs from that of the numbers
  labelZero(pen, style) {
    const { live, recording } = this.player;
    const where = live ? `value at ${Number(recording.first.time.toPrecision(4))} s` : 'minimum';
    const text = `gravitational zero in the plot: ${where}, ${quantity(this.zero, 'J', 4)}`;
    pen.font = `10.5px ${style.fontFamily}`;
    pen.textAlign = 'right';
    pen.textBaseline = 'top';
    const width = pen.measureText(text).width;
    if (width > this.width - LEFT - RIGHT) return;
    pen.fillStyle = style.getPropertyValue('--solid');
    pen.globalAlpha = 0.75;
    pen.fillRect(this.width - RIGHT - width - 6, TOP - 6, width + 6, 15);
    pen.globalAlpha = 1;
    pen.fillStyle = style.getPropertyValue('--muted');
    pen.fillText(text, this.width - RIGHT - 3, TOP - 4);
  }

  // the sum, and a dotted line at its value at the start
  line(pen, frames, totals, y, ink) {
    pen.strokeStyle = ink;
    pen.lineWidth = 1.6;
    pen.lineJoin = 'round';
    pen.beginPath();
    frames.forEach((frame, i) => pen.lineTo(this.xOf(frame.time), y(totals[i])));
    pen.stroke();
    pen.setLineDash([2, 4]);
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(LEFT, y(totals[0]));
    pen.lineTo(this.width - RIGHT, y(totals[0]));
    pen.stroke();
    pen.setLineDash([]);
  }

  writeLegend(used, hasMouseWork) {
    const hasPrescribedWork = this.player.recording.frames.some((frame) => this.prescribedWork(frame) !== 0);
    const shown = [...used, hasMouseWork, hasPrescribedWork].map(Number).join('');
    if (shown === this.legendKey) return;
    this.legendKey = shown;
    this.values = new Map();
    const item = (key, label, css, note = '') => {
      const value = element('span', { className: 'value' });
      this.values.set(key, value);
      return element('div', { className: 'item', title: note }, element('i', { className: key === TOTAL ? 'swatch line' : 'swatch', css: { '--c': css } }), element('span', {}, label), value);
    };
    const parts = LEDGER.map((part, k) => (used[k] ? item(k, part.label, part.colour, part.note) : null)).filter(Boolean);
    const rest = [item(RESIDUAL, 'Residual (integrator error)', 'transparent', 'change of the total since the start, without mouse and edits')];
    if (hasPrescribedWork) rest.push(item(PRESCRIBED_WORK, 'Work put in', 'transparent', 'work done by prescribed bodies, loads and motors since the start; the total is the sum of the parts minus this'));
    if (hasMouseWork) rest.push(item(MOUSE_WORK, 'Mouse and edits', 'transparent', 'energy added by dragging and by changed parameters since the start'));
    this.legend.replaceChildren(element('h2', {}, 'Energy'), ...parts, item(TOTAL, 'Total', 'var(--ink)'), ...rest);
    const last = this.player.recording.frames.at(-1);
    const drift = quantity(last.ledger[RESIDUAL], 'J', 2);
    this.canvas.setAttribute('aria-label', `Energy over time, from ${this.player.recording.start} to ${last.time} seconds. The total has changed by ${drift} since the start.`);
  }

  // writes the values of a frame into the legend, as in energy.csv
  tick(frame) {
    if (!this.values || !frame) return;
    for (const [key, node] of this.values) {
      node.textContent = quantity(key === MOUSE_WORK ? this.mouseWork(frame) : key === PRESCRIBED_WORK ? this.prescribedWork(frame) : frame.ledger[key], 'J', 4);
    }
  }

  // shows the values at the pointer; null hides them
  showTip(x) {
    const frame = this.frameUnder(x);
    if (!frame) return;
    const rows = LEDGER.map((part, k) => [part, frame.ledger[k]]).filter((_, k) => this.values?.has(k));
    this.tip.replaceChildren(
      element('b', {}, `${Number(frame.time.toPrecision(6))} s`),
      ...rows.map(([part, value]) => element('div', {}, element('i', { className: 'swatch', css: { '--c': part.colour } }), `${part.label} ${quantity(value, 'J', 4)}`)),
      element('div', {}, `Total ${quantity(frame.ledger[TOTAL], 'J', 5)}`),
      element('div', { className: 'muted' }, `Residual ${quantity(frame.ledger[RESIDUAL], 'J', 2)}`),
      ...(this.mouseWork(frame) ? [element('div', { className: 'muted' }, `Mouse and edits ${quantity(this.mouseWork(frame), 'J', 4)}`)] : []),
    );
  }
}
