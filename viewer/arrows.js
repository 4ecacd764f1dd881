// Draws arrows, rods and inertia ellipsoids.

import { attribute, buffer, program, useProgram } from './gl.js';
import { arrow, rod, sphere } from './geometry.js';
import { ARROW_FRAGMENT, ARROW_VERTEX, ELLIPSOID_FRAGMENT, ELLIPSOID_VERTEX } from './shaders.js';

const FLOATS = 12; // per arrow or rod: origin, length; direction, radius; colour, opacity

export class Arrows {
  constructor(gl) {
    this.gl = gl;
    this.arrow = program(gl, ARROW_VERTEX, ARROW_FRAGMENT);
    this.ellipsoid = program(gl, ELLIPSOID_VERTEX, ELLIPSOID_FRAGMENT);
    this.instances = gl.createBuffer();
    this.arrows = this.mesh(arrow());
    this.roundRods = this.mesh(rod(true));
    this.flatRods = this.mesh(rod(false));
    const unitSphere = sphere();
    this.sphereCount = unitSphere.length / 6;
    this.sphereArray = gl.createVertexArray();
    gl.bindVertexArray(this.sphereArray);
    buffer(gl, unitSphere);
    attribute(gl, 0, 3, 24, 0);
    gl.bindVertexArray(null);
  }

  mesh(shape) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    buffer(gl, shape);
    attribute(gl, 0, 4, 28, 0);
    attribute(gl, 1, 3, 28, 16);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    [4, 5, 6].forEach((index, k) => attribute(gl, index, 4, 4 * FLOATS, 16 * k, true));
    return { array, cornerCount: shape.length / 7 };
  }

  // `list`: { origin, direction, length, colour, thickness, opacity }; `thickness`: radius (m) of those without their own
  draw(view, list, thickness) {
    this.drawMesh(view, this.arrows, list, thickness, 1);
  }

  // `list`: as arrows, and isFlat: whether the ends are flat or round; a round rod of length zero is a sphere
  drawRods(view, list) {
    this.drawMesh(view, this.roundRods, list.filter(({ isFlat }) => !isFlat), 0, 0);
    this.drawMesh(view, this.flatRods, list.filter(({ isFlat }) => isFlat), 0, 0);
  }

  drawMesh(view, { array, cornerCount }, list, thickness, headed) {
    if (!list.length) return;
    const { gl } = this;
    const { at } = this.arrow;
    const data = new Float32Array(FLOATS * list.length);
    list.forEach(({ origin, direction, length, colour, thickness: own, opacity }, i) => {
      data.set([...origin, length, ...direction, own ?? thickness, ...colour, opacity ?? 1], FLOATS * i);
    });
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    useProgram(gl, this.arrow, view);
    gl.uniform1f(at.headed, headed);
    gl.bindVertexArray(array);
    // the parts hidden by bodies are drawn faintly
    gl.depthMask(false);
    gl.depthFunc(gl.GREATER);
    gl.uniform1f(at.strength, 0.42);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, cornerCount, list.length);
    gl.depthMask(true);
    gl.depthFunc(gl.LEQUAL);
    gl.uniform1f(at.strength, 1);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, cornerCount, list.length);
  }

  // `list`: { centre, orientation, axes }
  drawEllipsoids(view, list, tint) {
    if (!list.length) return;
    const { gl } = this;
    const { at } = this.ellipsoid;
    useProgram(gl, this.ellipsoid, view);
    gl.uniform3fv(at.tint, tint);
    gl.bindVertexArray(this.sphereArray);
    gl.depthMask(false);
    for (const { centre, orientation, axes } of list) {
      gl.uniform3fv(at.centre, centre);
      gl.uniform4fv(at.orientation, orientation);
      gl.uniform3fv(at.axes, axes);
      gl.drawArrays(gl.TRIANGLES, 0, this.sphereCount);
    }
    gl.depthMask(true);
  }
}
