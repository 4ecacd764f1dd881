// The picture: which parts are drawn in which order, how large shadows are, what to do when it is slow.

import { Arrows } from './arrows.js';
import { Bodies } from './bodies.js';
import { attribute, buffer, freeShadowMap, program, setView, shadowMap } from './gl.js';
import { Lines } from './lines.js';
import { add, cross, dot, length, multiply, normalize, rotate, scale, sub, viewOf } from './math.js';
import { Room } from './room.js';
import { SKY_FRAGMENT, SKY_VERTEX } from './shaders.js';

// from fine to coarse: pixels for each CSS pixel, size of the shadow map, looks into it
const LEVELS = [
  { ratio: 2, shadow: 2048, taps: 20 },
  { ratio: 1.5, shadow: 2048, taps: 12 },
  { ratio: 1, shadow: 1024, taps: 10 },
  { ratio: 0.75, shadow: 512, taps: 6 },
  { ratio: 0.5, shadow: 256, taps: 0 },
];
// of so many triangles a slow machine draws rough bodies
const HEAVY = 150000;
// a picture that stands still is at least this fine
const STILL = 2;
const SLOW = 40; // ms
const PATIENCE = 10; // frames

const places = ({ bodies }) => {
  const list = [];
  for (let at = 0; at < bodies.length; at += 22) {
    const p = Array.from(bodies.subarray(at, at + 3));
    if (p.every(Number.isFinite)) list.push(p);
  }
  return list;
};

// the ball about the box that holds these places
function ball(points, margin) {
  const low = [0, 1, 2].map((k) => points.reduce((m, p) => Math.min(m, p[k]), Infinity));
  const high = [0, 1, 2].map((k) => points.reduce((m, p) => Math.max(m, p[k]), -Infinity));
  return { centre: scale(add(low, high), 0.5), radius: 0.5 * length(sub(high, low)) + margin };
}

const largest = (head) => head.shapes.reduce((most, shape) => Math.max(most, shape.radius), 1e-6);

// the ball that holds another one, the bodies of a frame and, if wanted, where they have been
export function everything(head, film, frame, bounds, withPaths) {
  const size = 1.2 * largest(head);
  const { centre, radius } = bounds;
  const step = Math.max(1, Math.floor(film.length / 400));
  const past = withPaths ? film.frames.filter((_, i) => i % step === 0) : [];
  const points = [...past, frame].flatMap(places);
  const seen = ({ centre: c, radius: r }) => points.every((p) => length(sub(p, c)) + size <= r);
  if (!points.length || seen(bounds)) return bounds;
  // a ball has no corners: its ends along the axes stand for it
  const ends = [0, 1, 2].flatMap((k) => [-1, 1].map((sign) => centre.map((x, i) => (i === k ? x + sign * (radius - size) : x))));
  const all = ball([...points, ...(head.box ? ends : [])], size);
  // what is nearer to the eye than the middle looks larger
  return { centre: all.centre, radius: 1.2 * all.radius };
}

// The ball of a live view: it goes along with the bodies that leave it, and grows when they part. While
// bodies are in the box, those that have left it are let go.
export function keepInSight(head, frame, bounds) {
  const size = 1.2 * largest(head);
  let points = places(frame);
  if (head.box) {
    const inside = points.filter((p) => length(sub(p, bounds.centre)) < 1.6 * bounds.radius);
    if (inside.length) points = inside;
  }
  if (!points.length) return bounds;
  const now = ball(points, size);
  const radius = Math.max(bounds.radius, now.radius);
  const way = sub(now.centre, bounds.centre);
  const off = length(way) + now.radius - radius;
  if (off <= 0) return radius > bounds.radius ? { centre: now.centre, radius } : bounds;
  return { centre: add(bounds.centre, scale(way, Math.min(off / length(way), 1))), radius };
}

// the ball that holds what there is to see: the box, or where the bodies go
export function extent(head, film) {
  const points = [];
  const { box } = head;
  if (box) {
    for (let i = 0; i < 8; i++) {
      points.push(rotate(box.orientation, [0, 1, 2].map((k) => ((i >> k) & 1 ? box.max[k] : box.min[k]))));
    }
  }
  const size = largest(head);
  const reach = box ? 0.5 * length(sub(box.max, box.min)) : Infinity;
  const middle = box ? scale(points.reduce(add), 1 / 8) : [0, 0, 0];
  const step = Math.max(1, Math.floor(film.length / 400));
  for (let i = 0; i < film.length; i += step) {
    const { bodies } = film.frames[i];
    for (let at = 0; at < bodies.length; at += 22) {
      const p = Array.from(bodies.subarray(at, at + 3));
      // one that has left the box for good is not worth a smaller picture
      if (p.every(Number.isFinite) && length(sub(p, middle)) < 1.6 * reach) points.push(p);
    }
  }
  if (!points.length) return { centre: [0, 0, 0], radius: 2 * size };
  const all = ball(points, 0);
  if (box) return { centre: all.centre, radius: Math.max(all.radius, size) };
  // bodies that have not moved yet will want some room
  return { centre: all.centre, radius: Math.max(all.radius + 1.2 * size, head.live ? 3 * size : 0) };
}

export class Scene {
  constructor(canvas, head, film, software) {
    this.canvas = canvas;
    this.head = head;
    this.level = 0;
    this.software = software;
    this.gl = canvas.getContext('webgl2', { antialias: !software, alpha: false, powerPreference: 'high-performance' });
    this.extent = extent(head, film);
    this.slow = 0;
    this.timed = 0;
    this.fine = false;
    this.build();
  }

  build() {
    const { gl, head } = this;
    // of a context that was lost and came back, nothing is left
    this.shadows = new Map();
    this.bodies = new Bodies(gl, head);
    this.room = new Room(gl, head, this.extent);
    this.lines = new Lines(gl, head);
    this.arrows = new Arrows(gl);
    this.sky = program(gl, SKY_VERTEX, SKY_FRAGMENT);
    this.screen = gl.createVertexArray();
    gl.bindVertexArray(this.screen);
    buffer(gl, new Float32Array([-1, -1, 3, -1, -1, 3]));
    attribute(gl, 0, 2, 8, 0);
    gl.bindVertexArray(null);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    // a picture in software is drawn with fewer pixels from the start
    if (this.software) this.level = Math.max(this.level, this.bodies.triangleCount > HEAVY ? LEVELS.length - 1 : 2);
  }

  // before another scene takes the canvas; the browser frees what nothing holds any more
  dispose() {
    for (const map of this.shadows.values()) freeShadowMap(this.gl, map);
    this.shadows.clear();
  }

  // the map of the level that is drawn now, made when it is first needed
  get shadow() {
    const { shadow: size } = LEVELS[this.now];
    if (!this.shadows.has(size)) this.shadows.set(size, shadowMap(this.gl, size));
    return this.shadows.get(size);
  }

  // the level of the picture that is drawn now
  get now() {
    return this.fine ? Math.min(this.level, STILL) : this.level;
  }

  // whether a picture that stands still could be finer
  get isCoarse() {
    return (this.software || this.level > STILL) && this.bodies.triangleCount <= HEAVY;
  }

  setExtent(bounds) {
    this.extent = bounds;
    this.room.setExtent(this.head, bounds);
  }

  // milliseconds between two frames that followed each other at once
  time(milliseconds) {
    // the first few pay for what the browser compiles
    this.timed += 1;
    if (this.timed < 6) return;
    // one that is very slow counts for several
    this.slow = Math.max(this.slow + (milliseconds > SLOW ? Math.min(milliseconds / SLOW, 0.35 * PATIENCE) : -0.5), -PATIENCE);
    if (this.slow < PATIENCE || this.level === LEVELS.length - 1) return;
    this.level += 1;
    this.slow = 0;
  }

  get ratio() {
    // without smooth edges of its own the picture is drawn larger and shown smaller
    if (this.fine && this.software) return Math.max(window.devicePixelRatio || 1, 1.5);
    return Math.min(window.devicePixelRatio || 1, LEVELS[this.now].ratio);
  }

  resize(width, height) {
    const w = Math.max(Math.round(width * this.ratio), 1);
    const h = Math.max(Math.round(height * this.ratio), 1);
    if (this.canvas.width !== w || this.canvas.height !== h) {
      this.canvas.width = w;
      this.canvas.height = h;
    }
  }

  // parallel light from above, over everything that may throw a shadow
  light(view) {
    const { centre, radius } = this.extent;
    const up = normalize(this.head.up);
    const side = normalize(cross(up, Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
    const front = cross(side, up);
    const sun = normalize(add(scale(up, 1), add(scale(front, 0.28), scale(side, -0.2))));
    const right = normalize(cross(up, sun));
    const upward = cross(sun, right);
    const reach = 1.15 * radius;
    const ortho = new Float32Array(16);
    ortho[0] = ortho[5] = 1 / reach;
    ortho[10] = -1 / (2 * reach);
    ortho[15] = 1;
    view.sun = sun;
    view.lightMatrix = multiply(ortho, viewOf(centre, right, upward, sun));
    view.taps = dot(up, up) > 0 ? LEVELS[this.now].taps : 0;
    view.softness = 0.0075;
    view.texel = (3.2 * reach) / this.shadow.size;
  }

  // everything once; `shows` says what
  draw(view, moment, film, shows) {
    const { gl, bodies } = this;
    this.light(view);
    bodies.isRough = this.now === LEVELS.length - 1 && bodies.triangleCount > HEAVY;
    view.theme = shows.theme;
    if (moment.frame) bodies.place(moment, shows.emphasis);
    this.drawShadow(view, moment);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.shadow.texture);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.drawSky(view);
    gl.enable(gl.BLEND);
    if (shows.walls) this.room.draw(view);
    gl.disable(gl.BLEND);
    if (moment.frame && shows.meshes) bodies.draw(view);
    gl.enable(gl.BLEND);
    if (moment.frame && shows.edges) bodies.drawEdges(view);
    const pixels = [this.canvas.width, this.canvas.height];
    if (moment.frame) bodies.drawParticles(view, shows.particles, pixels);
    if (moment.frame && shows.meshes) bodies.drawDriven(view);
    if (shows.walls) this.lines.drawFrame(view, this.ratio);
    if (shows.paths) this.lines.drawPaths(view, this.ratio, moment, film, shows.pathColour);
    if (shows.thread) {
      this.lines.begin(view, pixels);
      this.lines.segment(...shows.thread, [...view.theme.ink, 0.9], 1.2 * this.ratio);
    }
    this.arrows.drawEllipsoids(view, shows.ellipsoids, view.theme.ink);
    this.arrows.draw(view, shows.arrows, shows.thickness);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  drawShadow(view, moment) {
    const { gl, shadow } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, shadow.target);
    gl.viewport(0, 0, shadow.size, shadow.size);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    if (moment.frame && view.taps > 0) {
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(1.5, 3);
      this.bodies.drawDepth({ ...view, matrix: view.lightMatrix });
      gl.disable(gl.POLYGON_OFFSET_FILL);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  drawSky(view) {
    const { gl, sky } = this;
    setView(gl, sky, view);
    gl.uniform3fv(sky.at.top, view.theme.top);
    gl.uniform3fv(sky.at.bottom, view.theme.bottom);
    gl.bindVertexArray(this.screen);
    gl.disable(gl.DEPTH_TEST);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
  }

  // the colour of a CSS pixel of the picture that was just drawn
  pixel(x, y) {
    const { gl } = this;
    const out = new Uint8Array(4);
    gl.readPixels(Math.round(x * this.ratio), this.canvas.height - 1 - Math.round(y * this.ratio), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
    return Array.from(out);
  }
}

// Whether there is WebGL2 at all, and whether a graphics card does it: 'none', 'software' or 'card'.
export function support() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return 'none';
  let name = String(gl.getParameter(gl.RENDERER));
  // some browsers keep the name behind an extension, others complain when it is asked for
  if (name === 'WebKit WebGL') {
    const more = gl.getExtension('WEBGL_debug_renderer_info');
    if (more) name = String(gl.getParameter(more.UNMASKED_RENDERER_WEBGL));
  }
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name) ? 'software' : 'card';
}
