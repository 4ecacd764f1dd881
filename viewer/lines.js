// Draws thick lines: the edges of the box, the paths of the bodies, the mouse spring.

import { attribute, buffer, program, useProgram } from './gl.js';
import { BODY_SIZE } from './recording.js';
import { boxEdges } from './walls.js';
import { LINE_FRAGMENT, LINE_VERTEX } from './shaders.js';

const CORNERS = new Float32Array([0, -1, 1, -1, 0, 1, 1, 1]);
// most points of all paths together
const MAX_POINTS = 300000;

export class Lines {
  constructor(gl, header) {
    this.gl = gl;
    this.line = program(gl, LINE_VERTEX, LINE_FRAGMENT);
    this.corners = buffer(gl, CORNERS);
    this.boxLines = header.box ? this.pairs(boxEdges(header.box).flat()) : null;
    this.single = this.chain(new Float32Array(6), gl.DYNAMIC_DRAW);
    this.paths = null;
  }

  // separate segments, each between two points
  pairs(numbers) {
    return { ...this.array(new Float32Array(numbers), 24, this.gl.STATIC_DRAW), count: numbers.length / 6 };
  }

  // a polyline through all points
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
    this.setFirst(lines, 0);
    gl.bindVertexArray(null);
    return lines;
  }

  // the point at which drawing starts
  setFirst({ data, stride }, first) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, data);
    attribute(gl, 1, 3, stride, stride * first, true);
    attribute(gl, 2, 3, stride, stride * first + 12, true);
  }

  // Builds the paths of these bodies over the whole recording; a long recording is sampled.
  setPaths(recording, bodies) {
    const { gl } = this;
    if (this.paths) {
      gl.deleteBuffer(this.paths.data);
      gl.deleteVertexArray(this.paths.array);
    }
    const total = Math.max(recording.length * bodies.length, 1);
    const every = Math.max(Math.ceil(total / MAX_POINTS), 1);
    const pointCount = Math.floor((recording.length - 1) / every) + 1;
    const points = new Float32Array(3 * pointCount * bodies.length);
    bodies.forEach((body, b) => {
      for (let i = 0; i < pointCount; i++) {
        const { bodies: floats } = recording.frames[i * every];
        const at = BODY_SIZE * body;
        points.set(floats.subarray(at, at + 3), 3 * (b * pointCount + i));
      }
    });
    this.paths = { ...this.array(points, 12, gl.STATIC_DRAW), pointCount, every, bodies, frameCount: recording.length, dropped: recording.dropped };
  }

  begin(view, pixels) {
    const { gl, line } = this;
    useProgram(gl, line, view);
    gl.uniform2f(line.at.viewport, pixels[0], pixels[1]);
  }

  // `age`: index of the first point and number of points, for paths that fade out towards the past
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

  drawBox(view, ratio) {
    if (!this.boxLines) return;
    this.begin(view, [view.width * ratio, view.height * ratio]);
    this.stroke(this.boxLines, this.boxLines.count, [...view.theme.frame, 0.9], 1.1 * ratio, null);
  }

  // the paths up to the time of the snapshot
  drawPaths(view, ratio, snapshot, recording, colourOf) {
    const { gl, paths } = this;
    if (!paths || !snapshot.frame || paths.pointCount < 1) return;
    this.begin(view, [view.width * ratio, view.height * ratio]);
    const done = Math.min(Math.floor(snapshot.index / paths.every), paths.pointCount - 1);
    paths.bodies.forEach((body, b) => {
      const colour = colourOf(body);
      gl.bindVertexArray(paths.array);
      this.setFirst(paths, b * paths.pointCount);
      this.stroke(paths, done, colour, 1.2 * ratio, [0, done + 1]);
      // the segment from the last point to the present position
      const { bodies: floats } = recording.frames[Math.min(done * paths.every, recording.length - 1)];
      const last = floats.subarray(BODY_SIZE * body, BODY_SIZE * body + 3);
      this.segment(last, snapshot.position(body), colour, 1.2 * ratio);
    });
  }

  segment(a, b, colour, width) {
    const { gl, single } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, single.data);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, new Float32Array([...a, ...b]));
    this.stroke(single, 1, colour, width, null);
  }
}
