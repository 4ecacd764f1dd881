// The application: owns recording, player, camera, renderer and panels, and connects them.

import { bodyColours } from './bodies.js';
import { BodyTable } from './body_table.js';
import { boundsFollowing, boundsOfAll, initialBounds } from './bounds.js';
import { Camera, listenToPointers } from './camera.js';
import { byId, element } from './dom.js';
import { EnergyPlot } from './energy_plot.js';
import { count, quantity } from './format.js';
import { JointList } from './joint_list.js';
import { JointShapes } from './joint_shapes.js';
import { hingeDirection } from './joints.js';
import { helpDialog } from './keyboard.js';
import { dot, isFiniteVector } from './math.js';
import { Overlays } from './overlays.js';
import { THEMES } from './palette.js';
import { Panel } from './panel.js';
import { pickBody } from './picking.js';
import { Player } from './player.js';
import { Recording, Snapshot, decodeHeader } from './recording.js';
import { Renderer, webglSupport } from './renderer.js';
import { Timeline } from './timeline.js';

// with more bodies only the path of the selected one is drawn
const MAX_PATHS = 64;

export class App {
  constructor() {
    this.layers = { meshes: true, edges: false, particles: false, paths: true, walls: true, joints: true };
    this.selected = null;
    this.following = null;
    this.hovered = null;
    // of a live run: the connection to the server and the mouse spring, set by main.js
    this.connection = null;
    this.isConnected = true;
    this.mouseSpring = null;
    this.canvas = byId('canvas');
    this.webgl = webglSupport();
    this.reducedMotion = matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.initTheme();
    this.labels = [];
  }

  // builds the page for a run with this header; `recording` is null for a live run
  build(rawHeader, recording) {
    const header = decodeHeader(rawHeader);
    this.header = header;
    this.recording = recording ?? new Recording(header.bodies.length, header.joints.length);
    this.snapshot = new Snapshot(header.bodies.length);
    this.snapshot.set(this.recording, this.recording.start);
    this.selected = null;
    this.selectedJoint = null;
    this.following = null;
    this.player = new Player(this.recording, header.live);
    this.player.addEventListener('change', () => this.changed());
    this.writeTitle();
    this.startRendering();
    const { shown } = this.overlays ?? {};
    this.overlays = new Overlays(header, this.bounds.radius);
    // the chosen arrows stay when a live run changes
    if (shown) this.overlays.shown = shown;
    this.overlays.scan(this.recording, this.snapshot);
    this.updateForceScale();
    this.table = new BodyTable(header, bodyColours(header), (body) => this.select(body));
    this.jointShapes = new JointShapes(header);
    this.recording.frames.forEach((frame) => this.jointShapes.extend(frame));
    this.jointList = new JointList(header, this.player, (joint) => this.selectJoint(joint));
    this.panel = new Panel(byId('panel'), this);
    this.plot = new EnergyPlot(byId('plot'), this.player);
    this.timeline = new Timeline(byId('timeline'), this.player, header, this.timelineActions());
    helpDialog(byId('help'), this);
    this.userView = false;
    this.layout();
    this.changed();
  }

  timelineActions() {
    return {
      play: () => this.play(),
      step: (n) => this.step(n),
      reset: () => this.reset(),
      speed: (value) => this.setSpeed(value),
      isRunning: () => this.connection?.status.playing ?? false,
    };
  }

  writeTitle() {
    const { name, description, duration, live, bodies } = this.header;
    byId('name').textContent = name;
    byId('description').textContent = description ?? '';
    const bodyCount = bodies.length === 1 ? 'one body' : `${count(bodies.length)} bodies`;
    const { frames_recorded: all, frame_count: kept } = this.header;
    const thinned = all > kept ? `, ${count(kept)} of ${count(all)} frames` : '';
    this.facts = live ? `${bodyCount}, ` : `${bodyCount}, ${quantity(this.recording.end || duration, 's')}${thinned}`;
    this.writeFacts();
    document.title = `${name} – tumble`;
  }

  // the line below the title; in a live run it includes the state of the simulation
  writeFacts() {
    const { live, duration } = this.header;
    let text = this.facts;
    if (live && !this.isConnected) text += 'not connected';
    else if (live) {
      text += this.connection?.status.playing ? 'running' : 'paused';
      if (this.recording.end > duration + 1e-9) text += `, beyond its duration of ${quantity(duration, 's')}`;
    }
    if (byId('facts').textContent !== text) byId('facts').textContent = text;
  }

  setConnected(on) {
    this.isConnected = on;
    if (this.header) this.writeFacts();
  }

  startRendering() {
    const { header, recording } = this;
    this.bounds = initialBounds(header, recording);
    this.fittedBounds = this.bounds;
    this.camera = new Camera(header.up);
    this.faceScene();
    if (this.webgl === 'none') {
      this.renderer = null;
      const text = 'This browser does not support WebGL2, so the bodies cannot be drawn. Energies and numbers are still shown.';
      byId('message').textContent = text;
      byId('message').hidden = false;
      return;
    }
    if (this.renderer) this.renderer.dispose();
    this.renderer = new Renderer(this.canvas, header, this.bounds, this.webgl === 'software');
  }

  // turns the camera so that the inclination of a slope, or the motion of a plane mechanism, is visible
  faceScene() {
    const { header, snapshot, camera } = this;
    const slope = header.walls.find(({ normal }) => dot(normal, header.up) > 0.1 && dot(normal, header.up) < 0.995);
    const hinges = snapshot.frame ? hingeDirection(header, snapshot) : null;
    if (slope) camera.faceSlope(slope.normal);
    else if (hinges) camera.faceAlong(hinges);
  }

  // registers the event listeners of canvas and buttons; to be called once
  listen() {
    const { canvas } = this;
    const pointers = listenToPointers(canvas, this.cameraProxy(), {
      changed: () => this.cameraMoved(),
      panned: () => this.stopFollowing(),
      hover: (at) => this.hover(at),
      click: (at) => this.click(at),
      down: (at, event) => this.attachSpring(at, event),
      drag: (at) => this.mouseSpring?.move(this.rayAt(at)),
      up: () => this.mouseSpring?.release(),
    });
    this.isPointerDown = pointers.isDown;
    canvas.addEventListener('dblclick', () => this.showAll());
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => {
      this.renderer?.build();
      this.strongestContact = null;
      this.updateForceScale();
      this.changed();
    });
    new ResizeObserver(() => this.layout()).observe(byId('viewport'));
    new ResizeObserver(() => this.layout()).observe(byId('dock'));
    byId('show-all').addEventListener('click', () => this.showAll());
    byId('theme').addEventListener('click', () => this.switchTheme());
    byId('help-open').addEventListener('click', () => this.help());
    byId('panel-toggle').addEventListener('click', () => this.togglePanel());
    byId('help').addEventListener('click', (event) => event.target === byId('help') && byId('help').close());
    if (matchMedia('(max-width: 760px)').matches) this.togglePanel();
  }

  // forwards to the present camera, which a new run replaces
  cameraProxy() {
    return { orbit: (...d) => this.camera.orbit(...d), zoom: (f) => this.camera.zoom(f), pan: (...d) => this.camera.pan(...d) };
  }

  // updates the camera to the size of the window and the borders covered by panels
  layout() {
    if (!this.camera) return;
    const viewport = byId('viewport').getBoundingClientRect();
    const panel = byId('panel').getBoundingClientRect();
    const dock = byId('dock').getBoundingClientRect();
    const isBeside = panel.width > 0 && panel.width < 0.6 * viewport.width;
    const covered = isBeside ? viewport.right - panel.left : 0;
    const below = panel.width > 0 && !isBeside ? Math.min(dock.top, panel.top) : dock.top;
    this.camera.margin = { left: 0, right: covered, top: viewport.width < 760 ? 40 : 0, bottom: Math.max(viewport.bottom - below, 0) };
    this.camera.size = [viewport.width, viewport.height];
    this.renderer?.resize(viewport.width, viewport.height);
    if (!this.userView) this.camera.fit(this.fittedBounds);
    this.changed();
  }

  view() {
    const [width, height] = this.camera.size;
    return this.camera.view(width, height);
  }

  rayAt(at) {
    return this.camera.ray(this.view(), ...at);
  }

  // to be called when anything that is shown has changed
  changed() {
    this.needsDraw = true;
    this.needsUpdate = true;
    this.request();
  }

  // to be called when the user has moved the camera
  cameraMoved() {
    this.userView = true;
    this.needsDraw = true;
    this.request();
  }

  request() {
    if (this.frameRequest) return;
    this.frameRequest = requestAnimationFrame((now) => this.frame(now));
  }

  frame(now) {
    this.frameRequest = 0;
    const since = this.last ? now - this.last : 0;
    const seconds = Math.min(since, 250) / 1000;
    if (this.player.advance(seconds)) this.needsDraw = true;
    if (this.needsDraw) {
      this.needsDraw = false;
      this.show();
    }
    const isMoving = this.player.playing || (this.connection?.status.playing ?? false);
    clearTimeout(this.refineTimer);
    if (!isMoving && this.renderer?.canRefine) this.refineTimer = setTimeout(() => this.drawStill(), 350);
    if (isMoving && since) this.renderer?.addFrameTime(since);
    this.last = isMoving ? now : 0;
    if (isMoving || this.needsDraw) this.request();
  }

  // draws the present time and updates the numbers
  show() {
    const { snapshot, player, recording } = this;
    snapshot.set(recording, player.time);
    // a camera that follows the dragged body would move the target of the mouse spring in turn
    if (this.following !== null && snapshot.frame && !this.mouseSpring?.attached) {
      const position = snapshot.position(this.following);
      if (isFiniteVector(position)) this.camera.target = position;
    }
    if (this.needsUpdate) {
      this.needsUpdate = false;
      this.panel.update();
      this.timeline.update();
    }
    this.draw();
    this.timeline.tick();
    this.plot.update(this.themeName);
    this.jointList.updatePlot(this.themeName);
    // numbers are updated at a readable rate
    const now = performance.now();
    if (!player.playing || now - (this.written ?? 0) > 90) {
      this.written = now;
      this.plot.tick(snapshot.frame);
      // longer numbers in the legend make the plot narrower
      this.plot.update(this.themeName);
      this.panel.tick(snapshot);
    }
  }

  draw() {
    const { snapshot, overlays, renderer } = this;
    const view = this.view();
    const arrows = snapshot.frame ? overlays.arrows(snapshot, this.selected, this.themeName) : [];
    const joints = this.layers.joints && snapshot.frame ? this.jointShapes.list(snapshot, this.selectedJoint, this.themeName, view, this.camera.viewExtent()) : { rods: [], arrows: [] };
    if (this.layers.joints && snapshot.frame) arrows.push(...overlays.jointArrows(snapshot, this.selectedJoint, this.themeName));
    this.writeLabels(view, arrows);
    if (!renderer) return;
    renderer.resize(...this.camera.size);
    if (this.layers.paths) this.updatePaths();
    const [width, height] = this.camera.size;
    const alpha = this.header.bodies.length > 8 ? 0.4 : 0.85;
    renderer.draw({ ...view, width, height }, snapshot, this.recording, {
      ...this.layers,
      theme: THEMES[this.themeName],
      highlight: (body) => (body === this.selected ? 1 : body === this.hovered ? 0.5 : 0),
      pathColour: (body) => [...renderer.bodies.colours[body], body === this.selected ? 1 : alpha],
      rods: joints.rods,
      arrows: [...arrows, ...joints.arrows],
      ellipsoids: snapshot.frame ? overlays.ellipsoids(snapshot, this.selected) : [],
      thickness: 0.0062 * this.camera.viewExtent(),
      mouseSpring: this.mouseSpring?.ends(this.header, snapshot) ?? null,
    });
  }

  // draws a still image at higher quality
  drawStill() {
    if (this.frameRequest || this.isPointerDown()) return;
    this.renderer.isStill = true;
    this.draw();
    this.renderer.isStill = false;
  }

  updatePaths() {
    const { recording, renderer } = this;
    const { bodies } = this.header;
    const wanted = bodies.length <= MAX_PATHS ? bodies.map((_, i) => i) : this.selected === null ? [] : [this.selected];
    const built = renderer.lines.paths;
    const key = `${wanted.length} ${wanted[0]} ${recording.length} ${recording.end} ${recording.dropped}`;
    if (built && built.key === key) return;
    const now = performance.now();
    if (built && this.header.live && now - built.at < 200 && built.recording === recording && built.frameCount > 1 && recording.length >= built.frameCount) return;
    renderer.lines.setPaths(recording, wanted);
    Object.assign(renderer.lines.paths, { key, at: now, recording });
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
      // labels at the same position are put side by side
      while (taken.some(([x, y]) => Math.abs(x - at[0]) < 18 && Math.abs(y - at[1]) < 14)) at[0] += 18;
      taken.push(at);
      if (label.textContent !== arrows[i].symbol) label.textContent = arrows[i].symbol;
      label.style.color = arrows[i].css;
      label.style.transform = `translate(${at[0].toFixed(1)}px, ${at[1].toFixed(1)}px)`;
    });
  }

  // replaces the header of a live run whose bodies, walls and box have not changed
  updateHeader(rawHeader) {
    const header = decodeHeader(rawHeader);
    this.header = header;
    for (const part of [this.overlays, this.table, this.timeline, this.jointShapes, this.jointList, this.renderer?.bodies]) if (part) part.header = header;
    this.renderer?.bodies.setWalls();
    this.panel.detailOf = null;
    this.panel.writeFacts();
    this.writeTitle();
    this.changed();
  }

  // adds a frame of a live run
  addFrame(buffer) {
    const { recording } = this;
    if (!recording.push(buffer)) return;
    // the simulation was reset: earlier frames are gone
    if (recording.length === 1) this.player.toLatest();
    // with many bodies the maxima are sampled
    if (this.header.bodies.length < 200 || recording.length % 10 === 1) this.overlays.updateMaxima(recording.frames.at(-1), this.snapshot);
    this.jointShapes.extend(recording.frames.at(-1));
    this.updateForceScale();
    if (recording.length === 1 && !this.userView) this.resetBounds();
    else if (!this.mouseSpring?.attached) this.updateBounds(recording.frames.at(-1));
    this.writeFacts();
    this.needsDraw = true;
    this.request();
  }

  // fits the view to the first frame of a live run
  resetBounds() {
    this.bounds = initialBounds(this.header, this.recording);
    this.fittedBounds = this.bounds;
    this.renderer?.setBounds(this.bounds);
    this.overlays.radius = this.bounds.radius;
    this.snapshot.set(this.recording, this.recording.start);
    this.faceScene();
    this.camera.fit(this.bounds);
  }

  // floor and light follow the bodies, and so does the camera until the user moves it
  updateBounds(frame) {
    const bounds = boundsFollowing(this.header, frame, this.bounds);
    if (bounds !== this.bounds) {
      this.bounds = bounds;
      this.renderer?.setBounds(bounds);
    }
    if (this.userView || this.following !== null || !this.player.followsLatest) return;
    const fittedBounds = boundsFollowing(this.header, frame, this.fittedBounds);
    if (fittedBounds === this.fittedBounds) return;
    this.fittedBounds = fittedBounds;
    this.camera.fit(fittedBounds);
  }

  // the status of a live run has changed
  updateStatus({ speed }) {
    this.timeline.showSpeed(speed);
    this.writeFacts();
    this.needsUpdate = true;
    this.needsDraw = true;
    this.request();
  }

  // the colour scale of the particles
  updateForceScale() {
    if (!this.renderer || (this.strongestContact && this.strongestContact === this.overlays.strongestContact)) return;
    this.strongestContact = this.overlays.strongestContact;
    this.renderer.bodies.maxForce = Math.max(this.overlays.maxParticleForce(), 1e-9);
  }

  // actions of keys and buttons

  play() {
    if (this.connection) this.connection.toggle();
    else this.player.toggle();
  }

  step(count) {
    if (this.connection && count > 0 && this.player.followsLatest) this.connection.send({ type: 'step' });
    else this.player.step(count);
  }

  setSpeed(value) {
    if (this.connection) this.connection.send({ type: 'speed', value });
    else this.player.setSpeed(value);
  }

  // selects a neighbouring speed
  changeSpeed(by) {
    if (!this.connection) {
      this.player.changeSpeed(by);
      return;
    }
    const { speed } = this.timeline;
    speed.selectedIndex = Math.min(Math.max(speed.selectedIndex + by, 0), speed.options.length - 1);
    this.setSpeed(this.timeline.selectedSpeed());
  }

  loop() {
    this.timeline.toggleLoop();
  }

  reset() {
    this.connection?.send({ type: 'reset' });
  }

  save() {
    this.connection?.send({ type: 'save' });
  }

  toggleDragMode() {
    const { mouseSpring } = this;
    if (!mouseSpring) return;
    mouseSpring.dragMode = !mouseSpring.dragMode;
    byId('drag').setAttribute('aria-pressed', String(mouseSpring.dragMode));
    this.canvas.dataset.drag = String(mouseSpring.dragMode);
  }

  attachSpring(at, event) {
    // a drag with Shift, or in drag mode, attaches the mouse spring; returns whether it has
    if (!this.mouseSpring || !(this.mouseSpring.dragMode || event.shiftKey)) return false;
    return this.mouseSpring.attach(this.rayAt(at), this.view().back, this.header, this.snapshot);
  }

  hover(at) {
    const hit = this.snapshot?.frame && this.header.bodies.length > 1 ? pickBody(this.rayAt(at), this.header, this.snapshot) : null;
    const body = hit?.body ?? null;
    this.canvas.style.cursor = hit ? 'pointer' : '';
    if (body === this.hovered) return;
    this.hovered = body;
    this.needsDraw = true;
    this.request();
  }

  click(at) {
    const hit = this.snapshot.frame ? pickBody(this.rayAt(at), this.header, this.snapshot) : null;
    this.select(hit && hit.body !== this.selected ? hit.body : null);
  }

  select(body) {
    this.selected = body;
    if (this.following !== null && body !== null) this.following = body;
    this.table.setSelected(body);
    this.changed();
  }

  selectJoint(joint) {
    this.selectedJoint = joint;
    this.jointList.setSelected(joint);
    this.changed();
  }

  clearSelection() {
    this.selectJoint(null);
    this.select(null);
  }

  selectNext(by) {
    const { length: bodyCount } = this.header.bodies;
    const from = this.selected ?? (by > 0 ? -1 : 0);
    this.select((from + by + bodyCount) % bodyCount);
  }

  follow() {
    if (this.following !== null) this.following = null;
    else this.following = this.selected ?? 0;
    this.userView = true;
    this.changed();
  }

  stopFollowing() {
    if (this.following === null) return;
    this.following = null;
    this.needsUpdate = true;
  }

  showAll() {
    this.following = null;
    this.userView = false;
    const { frame } = this.snapshot;
    this.fittedBounds = frame ? boundsOfAll(this.header, this.recording, frame, this.bounds, this.layers.paths) : this.bounds;
    this.camera.fit(this.fittedBounds);
    this.changed();
  }

  orbitView(...d) {
    this.camera.orbit(...d);
    this.cameraMoved();
  }

  zoomView(factor) {
    this.camera.zoom(factor);
    this.cameraMoved();
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

  // the interface for tests and the browser console, as `window.tumble`
  api() {
    const current = () => {
      this.snapshot.set(this.recording, this.player.time);
      return this.snapshot;
    };
    return {
      seek: (time) => this.player.seek(time),
      position: (body) => current().position(body),
      project: (body) => this.camera.project(this.view(), current().position(body)),
      // colour (RGBA) at a CSS pixel
      pixel: (x, y) => {
        current();
        this.draw();
        return this.renderer?.pixel(x, y) ?? null;
      },
      app: this,
    };
  }
}
