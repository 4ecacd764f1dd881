// The row of buttons and the slider of time.

import { button, element, icon } from './dom.js';
import { number, time } from './format.js';
import { SPEEDS } from './player.js';

const ICONS = {
  play: 'M6 3.5v13l10-6.5z',
  pause: 'M5.5 4h3v12h-3zM11.5 4h3v12h-3z',
  back: 'M13.5 4.5 7 10l6.5 5.5M4.5 4.5v11',
  on: 'M6.5 4.5 13 10l-6.5 5.5M15.5 4.5v11',
  first: 'M16 4.5 10.5 10l5.5 5.5M9.5 4.5 4 10l5.5 5.5',
  loop: 'M4 9V8a3 3 0 0 1 3-3h8M12.5 2.5 15 5l-2.5 2.5M16 11v1a3 3 0 0 1-3 3H5M7.5 17.5 5 15l2.5-2.5',
  reset: 'M4.5 10a5.5 5.5 0 1 0 1.8-4.1M6.8 2.6 6 6.1l3.5.7',
};

export class Timeline {
  // `actions`: play, step(n), reset (live), speed(value)
  constructor(parent, player, head, actions) {
    this.player = player;
    this.head = head;
    this.actions = actions;
    this.playButton = button('Play or pause (Space)', 'Play', actions.play, icon(ICONS.play, true));
    this.playButton.id = 'play';
    this.loopButton = button('Loop (L)', 'Loop', () => this.toggleLoop(), icon(ICONS.loop));
    this.loopButton.id = 'loop';
    this.nowButton = button('Back to the newest frame (N)', 'Now', () => player.toNow());
    this.nowButton.textContent = 'Now';
    this.nowButton.id = 'now';
    this.slider = element('input', {
      type: 'range', id: 'slider', min: '0', max: '1000', step: 'any', value: '0', 'aria-label': 'Time',
      on: { input: () => this.scrub() },
    });
    this.clock = element('span', {});
    this.end = element('span', { className: 'end' });
    this.readout = element('output', { id: 'readout', htmlFor: 'slider' }, this.clock, this.end, ' s');
    this.speed = element('select', { id: 'speed', title: 'Speed: simulated seconds a second (+ and −)', 'aria-label': 'Speed', on: { change: () => actions.speed(this.chosen()) } });
    for (const s of SPEEDS) this.speed.append(new Option(`${s} ×`, String(s)));
    if (head.live) this.speed.append(new Option('fastest', 'null'));
    this.speed.value = '1';
    parent.replaceChildren(element('div', { className: 'buttons' }, ...this.buttons()), this.slider, this.readout, element('div', { className: 'buttons' }, this.speed, ...(head.live ? [this.nowButton] : [this.loopButton])));
    player.addEventListener('change', () => this.update());
    this.update();
  }

  buttons() {
    const { actions } = this;
    const first = this.head.live
      ? button('Start again (R)', 'Start again', actions.reset, icon(ICONS.reset))
      : button('To the start (Home)', 'To the start', () => this.player.seek(-Infinity), icon(ICONS.first));
    first.id = 'first';
    const back = button('One frame back (←)', 'One frame back', () => actions.step(-1), icon(ICONS.back));
    back.id = 'back';
    const on = button(this.head.live ? 'One step (→)' : 'One frame on (→)', 'One frame on', () => actions.step(1), icon(ICONS.on));
    on.id = 'on';
    return [first, back, this.playButton, on];
  }

  chosen() {
    return this.speed.value === 'null' ? null : Number(this.speed.value);
  }

  // what the server of a live run says
  showSpeed(value) {
    const text = String(value);
    if (document.activeElement !== this.speed && [...this.speed.options].some((option) => option.value === text)) this.speed.value = text;
  }

  toggleLoop() {
    this.player.loop = !this.player.loop;
    this.player.changed();
  }

  scrub() {
    const { film } = this.player;
    const part = Number(this.slider.value) / 1000;
    this.player.playing = false;
    // at a frame: what is shown is what was computed
    const at = film.start + part * (film.end - film.start);
    const index = film.indexAt(at);
    const frames = film.frames.slice(index, index + 2);
    if (!frames.length) return;
    const nearest = frames.length > 1 && at - frames[0].time > frames[1].time - at ? frames[1] : frames[0];
    this.player.seek(nearest.time);
  }

  // whether it plays, looped, at which speed
  update() {
    const { player } = this;
    const playing = player.live ? this.actions.isRunning() : player.playing;
    const shown = playing ? 'pause' : 'play';
    if (this.shown !== shown) {
      this.shown = shown;
      this.playButton.replaceChildren(icon(ICONS[shown], true));
      this.playButton.setAttribute('aria-label', playing ? 'Pause' : 'Play');
    }
    this.loopButton.setAttribute('aria-pressed', String(player.loop));
    this.nowButton.setAttribute('aria-pressed', String(player.follow));
    if (!player.live) this.speed.value = String(player.speed);
    this.tick();
  }

  // the time
  tick() {
    const { film, time: now } = this.player;
    const span = film.end - film.start;
    const part = span > 0 ? (now - film.start) / span : 0;
    if (document.activeElement !== this.slider || this.player.playing || this.player.live) this.slider.value = String(1000 * part);
    else if (Math.abs(Number(this.slider.value) - 1000 * part) > 1e-6) this.slider.value = String(1000 * part);
    this.slider.style.setProperty('--part', `${100 * part}%`);
    // a single step of a run that stands still is to be seen
    const still = this.head.live && !this.actions.isRunning();
    const shown = time(now, still ? Math.min(this.head.interval, this.head.dt) : this.head.interval);
    if (this.written === shown) return;
    this.written = shown;
    this.clock.textContent = shown;
    this.end.textContent = this.head.live ? '' : ` / ${time(film.end, this.head.interval)}`;
    this.slider.setAttribute('aria-valuetext', `${number(now, 4)} seconds`);
  }
}
