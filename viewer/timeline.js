// The playback buttons, the time slider and the speed menu.

import { button, element, icon } from './dom.js';
import { number, time } from './format.js';
import { SPEEDS } from './player.js';

const ICONS = {
  play: 'M6 3.5v13l10-6.5z',
  pause: 'M5.5 4h3v12h-3zM11.5 4h3v12h-3z',
  back: 'M13.5 4.5 7 10l6.5 5.5M4.5 4.5v11',
  forward: 'M6.5 4.5 13 10l-6.5 5.5M15.5 4.5v11',
  first: 'M16 4.5 10.5 10l5.5 5.5M9.5 4.5 4 10l5.5 5.5',
  loop: 'M4 9V8a3 3 0 0 1 3-3h8M12.5 2.5 15 5l-2.5 2.5M16 11v1a3 3 0 0 1-3 3H5M7.5 17.5 5 15l2.5-2.5',
  reset: 'M4.5 10a5.5 5.5 0 1 0 1.8-4.1M6.8 2.6 6 6.1l3.5.7',
};

export class Timeline {
  // `actions`: play, step(n), reset (live), speed(value)
  constructor(parent, player, header, actions) {
    this.player = player;
    this.header = header;
    this.actions = actions;
    this.playButton = button('Play or pause (Space)', 'Play', actions.play, icon(ICONS.play, true));
    this.playButton.id = 'play';
    this.loopButton = button('Loop (L)', 'Loop', () => this.toggleLoop(), icon(ICONS.loop));
    this.loopButton.id = 'loop';
    this.latestButton = button('Go to the latest frame (N)', 'Latest frame', () => player.toLatest());
    this.latestButton.textContent = 'Latest';
    this.latestButton.id = 'latest';
    this.slider = element('input', {
      type: 'range', id: 'slider', min: '0', max: '1000', step: 'any', value: '0', 'aria-label': 'Time',
      on: { input: () => this.scrub() },
    });
    this.clock = element('span', {});
    this.end = element('span', { className: 'end' });
    this.readout = element('output', { id: 'readout', htmlFor: 'slider' }, this.clock, this.end, ' s');
    this.speed = element('select', { id: 'speed', title: 'Speed relative to real time (+ and −)', 'aria-label': 'Speed', on: { change: () => actions.speed(this.selectedSpeed()) } });
    for (const s of SPEEDS) this.speed.append(new Option(`${s} ×`, String(s)));
    if (header.live) this.speed.append(new Option('max', 'null'));
    this.speed.value = '1';
    parent.replaceChildren(element('div', { className: 'buttons' }, ...this.buttons()), this.slider, this.readout, element('div', { className: 'buttons' }, this.speed, ...(header.live ? [this.latestButton] : [this.loopButton])));
    player.addEventListener('change', () => this.update());
    this.update();
  }

  buttons() {
    const { actions } = this;
    const first = this.header.live
      ? button('Reset to t = 0 (R)', 'Reset', actions.reset, icon(ICONS.reset))
      : button('Go to the start (Home)', 'Go to the start', () => this.player.seek(-Infinity), icon(ICONS.first));
    first.id = 'first';
    const back = button('One frame back (←)', 'Back', () => actions.step(-1), icon(ICONS.back));
    back.id = 'back';
    const forward = button(this.header.live ? 'One step forward (→)' : 'One frame forward (→)', 'Forward', () => actions.step(1), icon(ICONS.forward));
    forward.id = 'forward';
    return [first, back, this.playButton, forward];
  }

  // the selected speed; null: as fast as possible
  selectedSpeed() {
    return this.speed.value === 'null' ? null : Number(this.speed.value);
  }

  // the speed reported by the server
  showSpeed(value) {
    const text = String(value);
    if (document.activeElement !== this.speed && [...this.speed.options].some((option) => option.value === text)) this.speed.value = text;
  }

  toggleLoop() {
    this.player.loop = !this.player.loop;
    this.player.changed();
  }

  scrub() {
    const { recording } = this.player;
    const fraction = Number(this.slider.value) / 1000;
    this.player.playing = false;
    // snap to the nearest frame, where the state is computed and not interpolated
    const at = recording.start + fraction * (recording.end - recording.start);
    const index = recording.indexAt(at);
    const frames = recording.frames.slice(index, index + 2);
    if (!frames.length) return;
    const nearest = frames.length > 1 && at - frames[0].time > frames[1].time - at ? frames[1] : frames[0];
    this.player.seek(nearest.time);
  }

  // updates buttons and menu
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
    this.latestButton.setAttribute('aria-pressed', String(player.followsLatest));
    if (!player.live) this.speed.value = String(player.speed);
    this.tick();
  }

  // updates slider and clock
  tick() {
    const { recording, time: now } = this.player;
    const span = recording.end - recording.start;
    const fraction = span > 0 ? (now - recording.start) / span : 0;
    if (document.activeElement !== this.slider || this.player.playing || this.player.live) this.slider.value = String(1000 * fraction);
    else if (Math.abs(Number(this.slider.value) - 1000 * fraction) > 1e-6) this.slider.value = String(1000 * fraction);
    this.slider.style.setProperty('--part', `${100 * fraction}%`);
    // while paused the clock shows single steps
    const isPaused = this.header.live && !this.actions.isRunning();
    const shown = time(now, isPaused ? Math.min(this.header.interval, this.header.dt) : this.header.interval);
    if (this.written === shown) return;
    this.written = shown;
    this.clock.textContent = shown;
    this.end.textContent = this.header.live ? '' : ` / ${time(recording.end, this.header.interval)}`;
    this.slider.setAttribute('aria-valuetext', `${number(now, 4)} seconds`);
  }
}
