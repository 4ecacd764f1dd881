// Thick lines: the frame of the box, the paths of the bodies.

import { attribute, buffer, program, setView } from './gl.js';
import { BODY_SIZE } from './data.js';
import { frameOf } from './room.js';
import { LINE_FRAGMENT, LINE_VERTEX } from './shaders.js';

const CORNERS = new Float32Array([0, -1, 1, -1, 0, 1, 1, 1]);
// points of all paths together
const MOST_POINTS = 300000;

export class Lines {
  constructor(gl, head) {
    this.gl = gl;
    this.line = program(gl, LINE_VERTEX, LINE_FRAGMENT);
    this.corners = buffer(gl, CORNERS);
    this.frame = head.box ? this.pairs(frameOf(head.box).flat()) : null;
    this.extra = this.chain(new Float32Array(6), gl.DYNAMIC_DRAW);
    this.paths = null;
  }

  pairs(numbers) {
    return { ...this.array(new Float32Array(numbers), 24, this.gl.STATIC_DRAW), count: numbers.length / 6 };
  }

  // a line through all points: the segment from each to the next
  chain(points, usage) {
    return { ...this.array(points, 12, usage), count: Math.max(points.length / 3 - 1, 0) };
  }

  array(points, stride, usage) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    attribute(gl, 0, 2, 8, 0);
    const data = buffer(gl, points, gl.ARRAY_BUFFER, usage);
    const lines = { array, data, stride };
    this.aim(lines, 0);
    gl.bindVertexArray(null);
    return lines;
  }

  // begins at the point of that number
  aim({ data, stride }, first) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, data);
    attribute(gl, 1, 3, stride, stride * first, true);
    attribute(gl, 2, 3, stride, stride * first + 12, true);
  }

  // The paths of these bodies over a whole film. A long film is followed in longer steps.
  setPaths(film, bodies) {
    const { gl } = this;
    if (this.paths) {
      gl.deleteBuffer(this.paths.data);
      gl.deleteVertexArray(this.paths.array);
    }
    const total = Math.max(film.length * bodies.length, 1);
    const every = Math.max(Math.ceil(total / MOST_POINTS), 1);
    const each = Math.floor((film.length - 1) / every) + 1;
    const points = new Float32Array(3 * each * bodies.length);
    bodies.forEach((body, b) => {
      for (let i = 0; i < each; i++) {
        const { bodies: floats } = film.frames[i * every];
        const at = BODY_SIZE * body;
        points.set(floats.subarray(at, at + 3), 3 * (b * each + i));
      }
    });
    this.paths = { ...this.array(points, 12, gl.STATIC_DRAW), each, every, bodies, made: film.length, dropped: film.dropped };
  }

  begin(view, pixels) {
    const { gl, line } = this;
    setView(gl, line, view);
    gl.uniform2f(line.at.viewport, pixels[0], pixels[1]);
  }

  stroke(lines, count, colour, width, age) {
    const { gl, line } = this;
    if (count <= 0) return;
    gl.bindVertexArray(lines.array);
    gl.uniform4fv(line.at.ink, colour);
    gl.uniform1f(line.at.width, width);
    gl.uniform1f(line.at.first, age ? age[0] : 0);
    gl.uniform1f(line.at.count, age ? age[1] : 0);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  }

  drawFrame(view, ratio) {
    if (!this.frame) return;
    this.begin(view, [view.width * ratio, view.height * ratio]);
    this.stroke(this.frame, this.frame.count, [...view.theme.frame, 0.9], 1.1 * ratio, null);
  }

  // up to the moment that is shown
  drawPaths(view, ratio, moment, film, colourOf) {
    const { gl, paths } = this;
    if (!paths || !moment.frame || paths.each < 1) return;
    this.begin(view, [view.width * ratio, view.height * ratio]);
    const done = Math.min(Math.floor(moment.index / paths.every), paths.each - 1);
    paths.bodies.forEach((body, b) => {
      const colour = colourOf(body);
      gl.bindVertexArray(paths.array);
      this.aim(paths, b * paths.each);
      this.stroke(paths, done, colour, 1.2 * ratio, [0, done + 1]);
      // and from the last point to where the body is now
      const { bodies: floats } = film.frames[Math.min(done * paths.every, film.length - 1)];
      const last = floats.subarray(BODY_SIZE * body, BODY_SIZE * body + 3);
      this.segment(last, moment.position(body), colour, 1.2 * ratio);
    });
  }

  segment(a, b, colour, width) {
    const { gl, extra } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, extra.data);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, new Float32Array([...a, ...b]));
    this.stroke(extra, 1, colour, width, null);
  }
}
