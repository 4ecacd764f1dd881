// The page as one thing: what is shown, at which time, seen from where, and what happens next.

import { Film, Moment, decodeHead } from './data.js';
import { Camera, steer } from './camera.js';
import { Overlays } from './overlays.js';
import { Panel } from './panel.js';
import { Player } from './player.js';
import { Plot } from './plot.js';
import { Scene, everything, extent, keepInSight, support } from './scene.js';
import { THEMES } from './palette.js';
import { Table } from './table.js';
import { Timeline } from './timeline.js';
import { bodyColours } from './bodies.js';
import { byId, element } from './dom.js';
import { helpDialog } from './keys.js';
import { dot, isFiniteVector } from './math.js';
import { pickBody } from './pick.js';
import { count, quantity } from './format.js';

// of more bodies only the selected one leaves a path
const MANY_PATHS = 64;

export class App {
  constructor() {
    this.shows = { meshes: true, edges: false, particles: false, paths: true, walls: true };
    this.selected = null;
    this.following = null;
    this.hovered = null;
    this.link = null;
    this.connected = true;
    this.grab = null;
    this.canvas = byId('canvas');
    this.support = support();
    this.calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.initTheme();
    this.labels = [];
  }

  // everything for a run of these bodies
  build(rawHead, film) {
    const head = decodeHead(rawHead);
    this.head = head;
    this.film = film ?? new Film(head.bodies.length);
    this.moment = new Moment(head.bodies.length);
    this.moment.set(this.film, this.film.start);
    this.selected = null;
    this.following = null;
    this.player = new Player(this.film, head.live);
    this.player.addEventListener('change', () => this.changed());
    this.writeTitle();
    this.startPicture();
    const { shown } = this.overlays ?? {};
    this.overlays = new Overlays(head, this.bounds.radius);
    // another run in the same page: the same arrows
    if (shown) this.overlays.shown = shown;
    this.overlays.scan(this.film, this.moment);
    this.learnForces();
    this.table = new Table(head, bodyColours(head), (body) => this.select(body));
    this.panel = new Panel(byId('panel'), this);
    this.plot = new Plot(byId('plot'), this.player);
    this.timeline = new Timeline(byId('timeline'), this.player, head, this.timelineActions());
    helpDialog(byId('help'), this);
    this.ownView = false;
    this.layout();
    this.changed();
  }

  timelineActions() {
    return {
      play: () => this.play(),
      step: (n) => this.step(n),
      reset: () => this.reset(),
      speed: (value) => this.setSpeed(value),
      isRunning: () => this.link?.status.playing ?? false,
    };
  }

  writeTitle() {
    const { name, description, duration, live, bodies } = this.head;
    byId('name').textContent = name;
    byId('description').textContent = description ?? '';
    const many = bodies.length === 1 ? 'one body' : `${count(bodies.length)} bodies`;
    const { frames_recorded: all, frame_count: kept } = this.head;
    const thinned = all > kept ? `, ${count(kept)} of ${count(all)} frames` : '';
    this.facts = live ? `${many}, ` : `${many}, ${quantity(this.film.end || duration, 's')}${thinned}`;
    this.writeFacts();
    document.title = `${name} – tumble`;
  }

  // of a live run: whether it goes on
  writeFacts() {
    const { live, duration } = this.head;
    let text = this.facts;
    if (live && !this.connected) text += 'not connected';
    else if (live) {
      text += this.link?.status.playing ? 'running now' : 'paused';
      if (this.film.end > duration + 1e-9) text += `, past its duration of ${quantity(duration, 's')}`;
    }
    if (byId('facts').textContent !== text) byId('facts').textContent = text;
  }

  setConnected(on) {
    this.connected = on;
    if (this.head) this.writeFacts();
  }

  startPicture() {
    const { head, film } = this;
    this.bounds = extent(head, film);
    this.sight = this.bounds;
    this.camera = new Camera(head.up);
    const slope = head.walls.find(({ normal }) => dot(normal, head.up) > 0.1 && dot(normal, head.up) < 0.995);
    if (slope) this.camera.faceSlope(slope.normal);
    if (this.support === 'none') {
      this.scene = null;
      const text = 'This browser has no WebGL2, so the bodies cannot be drawn here. The energy and the numbers of the bodies are shown all the same.';
      byId('missing').textContent = text;
      byId('missing').hidden = false;
      return;
    }
    if (this.scene) this.scene.dispose();
    this.scene = new Scene(this.canvas, head, film, this.support === 'software');
  }

  // once: the canvas and the window
  listen() {
    const { canvas } = this;
    const pointers = steer(canvas, this.cameraProxy(), {
      changed: () => this.moved(),
      panned: () => this.unfollow(),
      hover: (at) => this.hover(at),
      click: (at) => this.click(at),
      down: (at, event) => this.grabAt(at, event),
      drag: (at) => this.grab?.move(this.rayAt(at)),
      up: () => this.grab?.end(),
    });
    this.isHeld = pointers.isHeld;
    canvas.addEventListener('dblclick', () => this.whole());
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => {
      this.scene?.build();
      this.hardest = null;
      this.learnForces();
      this.changed();
    });
    new ResizeObserver(() => this.layout()).observe(byId('stage'));
    new ResizeObserver(() => this.layout()).observe(byId('dock'));
    byId('whole').addEventListener('click', () => this.whole());
    byId('theme').addEventListener('click', () => this.switchTheme());
    byId('help-open').addEventListener('click', () => this.help());
    byId('panel-toggle').addEventListener('click', () => this.togglePanel());
    byId('help').addEventListener('click', (event) => event.target === byId('help') && byId('help').close());
    if (matchMedia('(max-width: 760px)').matches) this.togglePanel();
  }

  // the camera of the moment, which a new run replaces
  cameraProxy() {
    return { turn: (...d) => this.camera.turn(...d), zoom: (f) => this.camera.zoom(f), pan: (...d) => this.camera.pan(...d) };
  }

  // how much of the window panels cover
  layout() {
    if (!this.camera) return;
    const stage = byId('stage').getBoundingClientRect();
    const panel = byId('panel').getBoundingClientRect();
    const dock = byId('dock').getBoundingClientRect();
    const beside = panel.width > 0 && panel.width < 0.6 * stage.width;
    const covered = beside ? stage.right - panel.left : 0;
    const below = panel.width > 0 && !beside ? Math.min(dock.top, panel.top) : dock.top;
    this.camera.margin = { left: 0, right: covered, top: stage.width < 760 ? 40 : 0, bottom: Math.max(stage.bottom - below, 0) };
    this.camera.size = [stage.width, stage.height];
    this.scene?.resize(stage.width, stage.height);
    if (!this.ownView) this.camera.fit(this.sight.centre, this.sight.radius);
    this.changed();
  }

  view() {
    const [width, height] = this.camera.size;
    return this.camera.view(width, height);
  }

  rayAt(at) {
    return this.camera.ray(this.view(), ...at);
  }

  // something is to be drawn
  changed() {
    this.dirty = true;
    this.stale = true;
    this.request();
  }

  // the view alone is another
  moved() {
    this.ownView = true;
    this.dirty = true;
    this.request();
  }

  request() {
    if (this.asked) return;
    this.asked = requestAnimationFrame((now) => this.frame(now));
  }

  frame(now) {
    this.asked = 0;
    const since = this.last ? now - this.last : 0;
    const seconds = Math.min(since, 250) / 1000;
    if (this.player.advance(seconds)) this.dirty = true;
    if (this.dirty) {
      this.dirty = false;
      this.show();
    }
    const goesOn = this.player.playing || (this.link?.status.playing ?? false);
    clearTimeout(this.still);
    if (!goesOn && this.scene?.isCoarse) this.still = setTimeout(() => this.drawFine(), 350);
    if (goesOn && since) this.scene?.time(since);
    this.last = goesOn ? now : 0;
    if (goesOn || this.dirty) this.request();
  }

  // draws the moment and writes its numbers
  show() {
    const { moment, player, film } = this;
    moment.set(film, player.time);
    // the hand and a camera that follows what it pulls would chase each other
    if (this.following !== null && moment.frame && !this.grab?.held) {
      const place = moment.position(this.following);
      if (isFiniteVector(place)) this.camera.target = place;
    }
    if (this.stale) {
      this.stale = false;
      this.panel.update();
      this.timeline.update();
    }
    this.draw();
    this.timeline.tick();
    this.plot.update(this.themeName);
    // numbers that change sixty times a second cannot be read
    const now = performance.now();
    if (!player.playing || now - (this.written ?? 0) > 90) {
      this.written = now;
      this.plot.tick(moment.frame);
      this.panel.tick(moment);
    }
  }

  draw() {
    const { moment, overlays, scene } = this;
    const view = this.view();
    const arrows = moment.frame ? overlays.arrows(moment, this.selected, this.themeName) : [];
    this.writeLabels(view, arrows);
    if (!scene) return;
    scene.resize(...this.camera.size);
    if (this.shows.paths) this.updatePaths();
    const [width, height] = this.camera.size;
    const alpha = this.head.bodies.length > 8 ? 0.4 : 0.85;
    scene.draw({ ...view, width, height }, moment, this.film, {
      ...this.shows,
      theme: THEMES[this.themeName],
      emphasis: (body) => (body === this.selected ? 1 : body === this.hovered ? 0.5 : 0),
      pathColour: (body) => [...scene.bodies.colours[body], body === this.selected ? 1 : alpha],
      arrows,
      ellipsoids: moment.frame ? overlays.ellipsoids(moment, this.selected) : [],
      thickness: 0.0062 * this.camera.breadth(),
      thread: this.grab?.thread(this.head, moment) ?? null,
    });
  }

  // a picture that stands still may take its time
  drawFine() {
    if (this.asked || this.isHeld()) return;
    this.scene.fine = true;
    this.draw();
    this.scene.fine = false;
  }

  updatePaths() {
    const { film, scene } = this;
    const { bodies } = this.head;
    const wanted = bodies.length <= MANY_PATHS ? bodies.map((_, i) => i) : this.selected === null ? [] : [this.selected];
    const made = scene.lines.paths;
    const key = `${wanted.length} ${wanted[0]} ${film.length} ${film.end} ${film.dropped}`;
    if (made && made.key === key) return;
    const now = performance.now();
    if (made && this.head.live && now - made.at < 200 && made.film === film && made.made > 1 && film.length >= made.made) return;
    scene.lines.setPaths(film, wanted);
    Object.assign(scene.lines.paths, { key, at: now, film });
  }

  writeLabels(view, arrows) {
    const parent = byId('labels');
    while (this.labels.length < arrows.length) {
      const label = element('span', {});
      this.labels.push(label);
      parent.append(label);
    }
    const taken = [];
    this.labels.forEach((label, i) => {
      const at = arrows[i] && this.camera.project(view, arrows[i].tip);
      label.hidden = !at;
      if (!at) return;
      // of arrows that end at one place the letters stand side by side
      while (taken.some(([x, y]) => Math.abs(x - at[0]) < 18 && Math.abs(y - at[1]) < 14)) at[0] += 18;
      taken.push(at);
      if (label.textContent !== arrows[i].symbol) label.textContent = arrows[i].symbol;
      label.style.color = arrows[i].css;
      label.style.transform = `translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px)`;
    });
  }

  // a live run: the same bodies, other numbers
  softHead(rawHead) {
    const head = decodeHead(rawHead);
    this.head = head;
    for (const part of [this.overlays, this.table, this.timeline, this.scene?.bodies]) if (part) part.head = head;
    this.scene?.bodies.setWalls();
    this.panel.detailOf = null;
    this.writeTitle();
    this.changed();
  }

  liveFrame(buffer) {
    const { film } = this;
    if (!film.push(buffer)) return;
    // begun again: what was looked back at is gone
    if (film.length === 1) this.player.toNow();
    // of a crowd a look now and then will do
    if (this.head.bodies.length < 200 || film.length % 10 === 1) this.overlays.learn(film.frames.at(-1), this.moment);
    this.learnForces();
    if (film.length === 1 && !this.ownView) this.seeAround();
    else if (!this.grab?.held) this.lookAfter(film.frames.at(-1));
    this.writeFacts();
    this.dirty = true;
    this.request();
  }

  // the view of the start, fitted to where the bodies are
  seeAround() {
    this.bounds = extent(this.head, this.film);
    this.sight = this.bounds;
    this.scene?.setExtent(this.bounds);
    this.overlays.size = this.bounds.radius;
    this.camera.fit(this.bounds.centre, this.bounds.radius);
  }

  // floor, light and, until somebody moves it, the camera go along with the bodies
  lookAfter(frame) {
    const bounds = keepInSight(this.head, frame, this.bounds);
    if (bounds !== this.bounds) {
      this.bounds = bounds;
      this.scene?.setExtent(bounds);
    }
    if (this.ownView || this.following !== null || !this.player.follow) return;
    const sight = keepInSight(this.head, frame, this.sight);
    if (sight === this.sight) return;
    this.sight = sight;
    this.camera.fit(sight.centre, sight.radius);
  }

  liveStatus({ speed }) {
    this.timeline.showSpeed(speed);
    this.writeFacts();
    this.stale = true;
    this.dirty = true;
    this.request();
  }

  // the scale of the particles' colours
  learnForces() {
    if (!this.scene || (this.hardest && this.hardest === this.overlays.hardest)) return;
    this.hardest = this.overlays.hardest;
    this.scene.bodies.strongest = Math.max(this.overlays.strongestOnParticle(), 1e-9);
  }

  // what keys and buttons do

  play() {
    if (this.link) this.link.toggle();
    else this.player.toggle();
  }

  step(count) {
    if (this.link && count > 0 && this.player.follow) this.link.send({ type: 'step' });
    else this.player.step(count);
  }

  setSpeed(value) {
    if (this.link) this.link.send({ type: 'speed', value });
    else this.player.setSpeed(value);
  }

  faster(by) {
    if (!this.link) {
      this.player.faster(by);
      return;
    }
    const { speed } = this.timeline;
    speed.selectedIndex = Math.min(Math.max(speed.selectedIndex + by, 0), speed.options.length - 1);
    this.setSpeed(this.timeline.chosen());
  }

  loop() {
    this.timeline.toggleLoop();
  }

  reset() {
    this.link?.send({ type: 'reset' });
  }

  save() {
    this.link?.send({ type: 'save' });
  }

  grabMode() {
    if (!this.grab) return;
    this.grab.mode = !this.grab.mode;
    byId('grab').setAttribute('aria-pressed', String(this.grab.mode));
    this.canvas.dataset.grab = String(this.grab.mode);
  }

  grabAt(at, event) {
    if (!this.grab || !(this.grab.mode || event.shiftKey)) return false;
    return this.grab.begin(this.rayAt(at), this.view().back, this.head, this.moment);
  }

  hover(at) {
    const hit = this.moment?.frame && this.head.bodies.length > 1 ? pickBody(this.rayAt(at), this.head, this.moment) : null;
    const body = hit?.body ?? null;
    this.canvas.style.cursor = hit ? 'pointer' : '';
    if (body === this.hovered) return;
    this.hovered = body;
    this.dirty = true;
    this.request();
  }

  click(at) {
    const hit = this.moment.frame ? pickBody(this.rayAt(at), this.head, this.moment) : null;
    this.select(hit && hit.body !== this.selected ? hit.body : null);
  }

  select(body) {
    this.selected = body;
    if (this.following !== null && body !== null) this.following = body;
    this.table.setSelected(body);
    this.changed();
  }

  selectNext(by) {
    const { length: all } = this.head.bodies;
    const from = this.selected ?? (by > 0 ? -1 : 0);
    this.select((from + by + all) % all);
  }

  follow() {
    if (this.following !== null) this.following = null;
    else this.following = this.selected ?? 0;
    this.ownView = true;
    this.changed();
  }

  unfollow() {
    if (this.following === null) return;
    this.following = null;
    this.stale = true;
  }

  whole() {
    this.following = null;
    this.ownView = false;
    const { frame } = this.moment;
    this.sight = frame ? everything(this.head, this.film, frame, this.bounds, this.shows.paths) : this.bounds;
    this.camera.fit(this.sight.centre, this.sight.radius);
    this.changed();
  }

  turnView(...d) {
    this.camera.turn(...d);
    this.moved();
  }

  zoomView(factor) {
    this.camera.zoom(factor);
    this.moved();
  }

  setArrow(key, on) {
    if (on) this.overlays.shown.add(key);
    else this.overlays.shown.delete(key);
    this.changed();
  }

  setArrowSize(factor) {
    this.overlays.factor = Math.min(Math.max(factor, 0.25), 4);
    this.changed();
  }

  toggleEllipsoid() {
    this.overlays.ellipsoid = !this.overlays.ellipsoid;
    this.changed();
  }

  togglePanel() {
    const hidden = document.body.classList.toggle('no-panel');
    byId('panel-toggle').setAttribute('aria-expanded', String(!hidden));
    this.layout();
  }

  help() {
    byId('help').showModal();
  }

  initTheme() {
    const dark = matchMedia('(prefers-color-scheme: dark)');
    const set = (name) => {
      this.themeName = name;
      document.documentElement.dataset.theme = name;
      if (this.player) this.changed();
    };
    set(dark.matches ? 'dark' : 'light');
    dark.addEventListener('change', () => set(dark.matches ? 'dark' : 'light'));
    this.setTheme = set;
  }

  switchTheme() {
    this.setTheme(this.themeName === 'dark' ? 'light' : 'dark');
  }

  // what tests and the curious may ask
  api() {
    const now = () => {
      this.moment.set(this.film, this.player.time);
      return this.moment;
    };
    return {
      seek: (time) => this.player.seek(time),
      position: (body) => now().position(body),
      project: (body) => this.camera.project(this.view(), now().position(body)),
      // red, green, blue, alpha of the picture at a place in CSS pixels
      pixel: (x, y) => {
        now();
        this.draw();
        return this.scene?.pixel(x, y) ?? null;
      },
      app: this,
    };
  }
}
