// Draws a snapshot: order of the layers, shadows, and quality levels for slow machines.

import { Arrows } from './arrows.js';
import { Bodies } from './bodies.js';
import { attribute, buffer, createShadowMap, deleteShadowMap, program, useProgram } from './gl.js';
import { Lines } from './lines.js';
import { add, cross, dot, multiply, normalize, scale, viewMatrix } from './math.js';
import { SKY_FRAGMENT, SKY_VERTEX } from './shaders.js';
import { Walls } from './walls.js';

// quality levels from high to low: pixels per CSS pixel, size of the shadow map, samples (taps) of it per pixel
const LEVELS = [
  { ratio: 2, shadow: 2048, taps: 20 },
  { ratio: 1.5, shadow: 2048, taps: 12 },
  { ratio: 1, shadow: 1024, taps: 10 },
  { ratio: 0.75, shadow: 512, taps: 6 },
  { ratio: 0.5, shadow: 256, taps: 0 },
];
// with more triangles a slow machine draws simplified bodies
const MANY_TRIANGLES = 150000;
// lowest quality level of a still image
const STILL_LEVEL = 2;
// frames longer than this are slow
const SLOW = 40; // ms
// the level is lowered after about this many slow frames
const MAX_SLOW_FRAMES = 10;

export class Renderer {
  constructor(canvas, header, bounds, isSoftware) {
    this.canvas = canvas;
    this.header = header;
    this.level = 0;
    this.isSoftware = isSoftware;
    this.gl = canvas.getContext('webgl2', { antialias: !isSoftware, alpha: false, powerPreference: 'high-performance' });
    this.bounds = bounds;
    this.slowFrames = 0;
    this.timedFrames = 0;
    // whether to draw a still image, at higher quality
    this.isStill = false;
    this.build();
  }

  build() {
    const { gl, header } = this;
    // also called after the WebGL context was lost: all resources are created again
    this.shadows = new Map();
    this.bodies = new Bodies(gl, header);
    this.walls = new Walls(gl, header, this.bounds);
    this.lines = new Lines(gl, header);
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
    // software rendering starts at a lower level
    if (this.isSoftware) this.level = Math.max(this.level, this.bodies.triangleCount > MANY_TRIANGLES ? LEVELS.length - 1 : 2);
  }

  // frees the shadow maps before another renderer takes the canvas; the browser frees the rest
  dispose() {
    for (const map of this.shadows.values()) deleteShadowMap(this.gl, map);
    this.shadows.clear();
  }

  // the shadow map of the present level, created at its first use
  get shadow() {
    const { shadow: size } = LEVELS[this.effectiveLevel];
    if (!this.shadows.has(size)) this.shadows.set(size, createShadowMap(this.gl, size));
    return this.shadows.get(size);
  }

  // the level of the present image
  get effectiveLevel() {
    return this.isStill ? Math.min(this.level, STILL_LEVEL) : this.level;
  }

  // whether a still image would have a higher quality
  get canRefine() {
    return (this.isSoftware || this.level > STILL_LEVEL) && this.bodies.triangleCount <= MANY_TRIANGLES;
  }

  setBounds(bounds) {
    this.bounds = bounds;
    this.walls.setBounds(this.header, bounds);
  }

  // records the time between two consecutive frames and lowers the level if frames are slow
  addFrameTime(milliseconds) {
    // the first frames include the compilation of shaders
    this.timedFrames += 1;
    if (this.timedFrames < 6) return;
    // a very slow frame counts as several
    this.slowFrames = Math.max(this.slowFrames + (milliseconds > SLOW ? Math.min(milliseconds / SLOW, 0.35 * MAX_SLOW_FRAMES) : -0.5), -MAX_SLOW_FRAMES);
    if (this.slowFrames < MAX_SLOW_FRAMES || this.level === LEVELS.length - 1) return;
    this.level += 1;
    this.slowFrames = 0;
  }

  // pixels per CSS pixel
  get ratio() {
    // software rendering has no antialiasing: a still image is supersampled instead
    if (this.isStill && this.isSoftware) return Math.max(window.devicePixelRatio || 1, 1.5);
    return Math.min(window.devicePixelRatio || 1, LEVELS[this.effectiveLevel].ratio);
  }

  resize(width, height) {
    const w = Math.max(Math.round(width * this.ratio), 1);
    const h = Math.max(Math.round(height * this.ratio), 1);
    if (this.canvas.width !== w || this.canvas.height !== h) {
      this.canvas.width = w;
      this.canvas.height = h;
    }
  }

  // adds sun and shadow map to a view: parallel light from above that covers the bounds
  addLight(view) {
    const { centre, radius } = this.bounds;
    const up = normalize(this.header.up);
    const side = normalize(cross(up, Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]));
    const front = cross(side, up);
    const sun = normalize(add(scale(up, 1), add(scale(front, 0.28), scale(side, -0.2))));
    const right = normalize(cross(up, sun));
    const upward = cross(sun, right);
    const halfSize = 1.15 * radius;
    const ortho = new Float32Array(16);
    ortho[0] = ortho[5] = 1 / halfSize;
    ortho[10] = -1 / (2 * halfSize);
    ortho[15] = 1;
    view.sun = sun;
    view.lightMatrix = multiply(ortho, viewMatrix(centre, right, upward, sun));
    view.taps = dot(up, up) > 0 ? LEVELS[this.effectiveLevel].taps : 0;
    view.softness = 0.0075;
    view.texel = (3.2 * halfSize) / this.shadow.size;
  }

  // Draws a snapshot. `options`: layers (meshes, edges, particles, paths, walls), theme, highlight(body),
  // pathColour(body), rods, arrows, ellipsoids, thickness of arrows, mouseSpring (two points or null).
  draw(view, snapshot, recording, options) {
    const { gl, bodies } = this;
    this.addLight(view);
    bodies.simplified = this.effectiveLevel === LEVELS.length - 1 && bodies.triangleCount > MANY_TRIANGLES;
    view.theme = options.theme;
    if (snapshot.frame) bodies.update(snapshot, options.highlight);
    this.drawShadow(view, snapshot);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.shadow.texture);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    this.drawSky(view);
    gl.enable(gl.BLEND);
    if (options.walls) this.walls.draw(view);
    gl.disable(gl.BLEND);
    if (snapshot.frame && options.meshes) bodies.draw(view);
    gl.enable(gl.BLEND);
    if (snapshot.frame && options.edges) bodies.drawEdges(view);
    const pixels = [this.canvas.width, this.canvas.height];
    if (snapshot.frame) bodies.drawParticles(view, options.particles, pixels);
    if (snapshot.frame && options.meshes) bodies.drawPrescribed(view);
    if (options.walls) this.lines.drawBox(view, this.ratio);
    if (options.paths) this.lines.drawPaths(view, this.ratio, snapshot, recording, options.pathColour);
    if (options.mouseSpring) {
      this.lines.begin(view, pixels);
      this.lines.segment(...options.mouseSpring, [...view.theme.ink, 0.9], 1.2 * this.ratio);
    }
    this.arrows.drawEllipsoids(view, options.ellipsoids, view.theme.ink);
    this.arrows.drawRods(view, options.rods);
    this.arrows.draw(view, options.arrows, options.thickness);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  drawShadow(view, snapshot) {
    const { gl, shadow } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, shadow.framebuffer);
    gl.viewport(0, 0, shadow.size, shadow.size);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    if (snapshot.frame && view.taps > 0) {
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(1.5, 3);
      this.bodies.drawDepth({ ...view, matrix: view.lightMatrix });
      gl.disable(gl.POLYGON_OFFSET_FILL);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  drawSky(view) {
    const { gl, sky } = this;
    useProgram(gl, sky, view);
    gl.uniform3fv(sky.at.top, view.theme.top);
    gl.uniform3fv(sky.at.bottom, view.theme.bottom);
    gl.bindVertexArray(this.screen);
    gl.disable(gl.DEPTH_TEST);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
  }

  // the colour (RGBA) at a CSS pixel, immediately after drawing
  pixel(x, y) {
    const { gl } = this;
    const out = new Uint8Array(4);
    gl.readPixels(Math.round(x * this.ratio), this.canvas.height - 1 - Math.round(y * this.ratio), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
    return Array.from(out);
  }
}

// How WebGL2 is rendered: 'none' if it is not supported, 'software' or 'hardware'.
export function webglSupport() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return 'none';
  let name = String(gl.getParameter(gl.RENDERER));
  // WebKit masks the name unless an extension is enabled; other browsers warn about the extension
  if (name === 'WebKit WebGL') {
    const more = gl.getExtension('WEBGL_debug_renderer_info');
    if (more) name = String(gl.getParameter(more.UNMASKED_RENDERER_WEBGL));
  }
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name) ? 'software' : 'hardware';
}
