// A plot over time with a cursor at the displayed time; a click or drag goes to a time.

import { element } from './dom.js';
import { quantity, round125 } from './format.js';

// margins in CSS pixels
export const LEFT = 58;
export const RIGHT = 10;
export const TOP = 8;
export const BOTTOM = 18;

// A subclass has the methods paint(), which draws into `this.canvas`, and showTip(x).
export class TimePlot {
  constructor(player, label) {
    this.player = player;
    this.canvas = element('canvas', { role: 'img', 'aria-label': label });
    this.cursor = element('div', { className: 'cursor' });
    this.hover = element('div', { className: 'cursor hover', hidden: true });
    this.tip = element('div', { className: 'tip', hidden: true });
    this.area = element('div', { className: 'area' }, this.canvas, this.cursor, this.hover, this.tip);
    this.key = '';
    this.listen();
  }

  listen() {
    const { area } = this;
    let isDown = false;
    const seek = (event) => {
      this.player.playing = false;
      // the layout may have changed since the last drawing
      const box = area.getBoundingClientRect();
      this.width = box.width;
      const t = this.timeAt(event.clientX - box.left);
      const { recording } = this.player;
      const i = recording.indexAt(t);
      const next = recording.frames[Math.min(i + 1, recording.length - 1)];
      if (recording.length) this.player.seek(next.time - t < t - recording.frames[i].time ? next.time : recording.frames[i].time);
    };
    area.addEventListener('pointerdown', (event) => {
      isDown = true;
      area.setPointerCapture(event.pointerId);
      seek(event);
    });
    area.addEventListener('pointermove', (event) => {
      if (isDown) seek(event);
      this.showTip(event.offsetX);
    });
    area.addEventListener('pointerup', () => (isDown = false));
    area.addEventListener('pointercancel', () => (isDown = false));
    area.addEventListener('pointerleave', () => this.showTip(null));
  }

  span() {
    const { recording } = this.player;
    return [recording.start, recording.end > recording.start ? recording.end : recording.start + 1];
  }

  timeAt(x) {
    const [start, end] = this.span();
    const part = (x - LEFT) / Math.max(this.width - LEFT - RIGHT, 1);
    return start + Math.min(Math.max(part, 0), 1) * (end - start);
  }

  xOf(t) {
    const [start, end] = this.span();
    return LEFT + ((t - start) / (end - start)) * (this.width - LEFT - RIGHT);
  }

  // redraws if size, theme, recording or `content` have changed, and moves the cursor
  update(themeName, content = '') {
    const { recording } = this.player;
    const box = this.area.getBoundingClientRect();
    if (box.width < 40 || !recording.length) return;
    this.width = box.width;
    this.height = box.height;
    const look = `${box.width} ${box.height} ${themeName} ${content}`;
    const key = `${look} ${recording.length} ${recording.end} ${recording.dropped}`;
    const now = performance.now();
    // a live recording changes with every frame: redraw a few times per second
    if (key !== this.key && (!this.player.live || look !== this.look || now - (this.drawn ?? 0) > 150)) {
      this.key = key;
      this.look = look;
      this.drawn = now;
      this.paint();
    }
    this.cursor.style.transform = `translateX(${this.xOf(this.player.time)}px)`;
  }

  // an empty canvas of the present size, to draw on in CSS pixels
  startPainting() {
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    const pen = this.canvas.getContext('2d');
    pen.scale(ratio, ratio);
    return pen;
  }

  // the frame at the pointer, with the dashed line at it; null hides line and tip
  frameUnder(x) {
    const { recording } = this.player;
    const off = x === null || !recording.length || !this.width;
    this.hover.hidden = off;
    this.tip.hidden = off;
    if (off) return null;
    const frame = recording.frames[recording.indexAt(this.timeAt(x))];
    const at = this.xOf(frame.time);
    this.hover.style.transform = `translateX(${at}px)`;
    const right = at > this.width / 2;
    this.tip.style.left = right ? '' : `${at + 10}px`;
    this.tip.style.right = right ? `${this.width - at + 10}px` : '';
    return frame;
  }

  axes(pen, [low, top], unit, y, style) {
    const muted = style.getPropertyValue('--muted');
    const hair = style.getPropertyValue('--hair');
    pen.font = `11px ${style.fontFamily}`;
    pen.fillStyle = muted;
    pen.strokeStyle = hair;
    pen.lineWidth = 1;
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    const count = Math.max(Math.min(Math.floor(this.height / 34), 5), 2);
    const step = round125((top - low) / count);
    for (let k = Math.ceil(low / step); k * step <= top; k++) {
      const value = k * step;
      pen.beginPath();
      pen.moveTo(LEFT, Math.round(y(value)) + 0.5);
      pen.lineTo(this.width - RIGHT, Math.round(y(value)) + 0.5);
      pen.stroke();
      pen.fillText(quantity(value, unit, 2), LEFT - 6, y(value));
    }
    pen.textBaseline = 'top';
    pen.textAlign = 'center';
    const [start, end] = this.span();
    const every = round125((end - start) / Math.max(this.width / 90, 2));
    for (let t = Math.ceil(start / every) * every; t <= end + 1e-9 * every; t += every) {
      const x = Math.min(Math.max(this.xOf(t), LEFT + 8), this.width - RIGHT - 12);
      pen.fillText(`${Number(t.toPrecision(6))} s`, x, this.height - BOTTOM + 4);
    }
  }
}
