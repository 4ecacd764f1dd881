// Draws the bodies: one instanced draw call per shape.

import { attribute, buffer, program, useProgram } from './gl.js';
import { edges, simplify, withNormals } from './geometry.js';
import { BODY_COLOURS, PRESCRIBED_COLOUR } from './palette.js';
import { BODY_FRAGMENT, BODY_VERTEX, DEPTH_FRAGMENT, EDGE_FRAGMENT, EDGE_VERTEX } from './shaders.js';
import { PARTICLE_FRAGMENT, PARTICLE_VERTEX } from './shaders.js';

const FLOATS = 12; // per instance: position, highlight; orientation; colour, kind
const MAX_WALLS = 32;
// the edges of finer meshes would cover them and are not drawn
const MAX_EDGES = 60000;
// approximate number of triangles of all simplified bodies together
const SIMPLIFIED_TRIANGLES = 60000;

export class Bodies {
  constructor(gl, header) {
    this.gl = gl;
    this.header = header;
    this.body = program(gl, BODY_VERTEX, BODY_FRAGMENT);
    this.depth = program(gl, BODY_VERTEX, DEPTH_FRAGMENT);
    this.edge = program(gl, EDGE_VERTEX, EDGE_FRAGMENT);
    this.particle = program(gl, PARTICLE_VERTEX, PARTICLE_FRAGMENT);
    this.instances = new Float32Array(FLOATS * header.bodies.length);
    this.order = header.bodies.map((_, index) => index).sort((a, b) => header.bodies[a].shape - header.bodies[b].shape || a - b);
    this.colours = bodyColours(header);
    this.instanceBuffer = buffer(gl, this.instances, gl.ARRAY_BUFFER, gl.DYNAMIC_DRAW);
    this.groups = header.shapes.map((shape, index) => this.group(shape, index));
    this.fillColours();
    this.walls = new Float32Array(4 * MAX_WALLS);
    this.stiffness = new Float32Array(MAX_WALLS);
    this.setWalls();
    this.maxForce = 1; // N, the end of the colour scale of particles
    this.simplified = false;
  }

  setWalls() {
    this.header.walls.slice(0, MAX_WALLS).forEach((wall, i) => {
      this.walls.set([...wall.normal, wall.offset], 4 * i);
      this.stiffness[i] = wall.stiffness;
    });
  }

  // the part of the instances that does not change
  fillColours() {
    const { bodies } = this.header;
    this.order.forEach((body, slot) => {
      const { moments, shape } = bodies[body];
      // a body of revolution gets markings, so that its rotation is visible
      const { mesh } = this.groups[shape];
      const isRound = mesh && !mesh.fewFaces && moments[2] > 0 && (moments[1] - moments[0] < 0.02 * moments[2] || moments[2] - moments[1] < 0.02 * moments[2]);
      this.instances.set([...this.colours[body], bodies[body].driven ? 2 : isRound ? 1 : 0], FLOATS * slot + 8);
    });
  }

  group(shape, index) {
    const { gl } = this;
    const first = this.order.findIndex((body) => this.header.bodies[body].shape === index);
    const count = this.header.bodies.filter((body) => body.shape === index).length;
    const drawn = { first, count, shape, mesh: null, simplified: null, edgeArray: null, edgeCount: 0 };
    if (shape.triangles.length) drawn.mesh = this.mesh(first, shape.vertices, shape.triangles);
    drawn.points = this.array(first, () => {
      buffer(gl, shape.particles);
      attribute(gl, 0, 3, 12, 0);
    });
    drawn.pointCount = shape.particles.length / 3;
    // from the distance of the particles if they were spread over a sphere of the body's size
    drawn.pointRadius = 0.35 * shape.radius * Math.min(Math.sqrt(4 / Math.max(drawn.pointCount, 1)), 0.35);
    return drawn;
  }

  mesh(first, vertices, triangles) {
    const { gl } = this;
    const { data, index } = withNormals(vertices, triangles);
    const array = this.array(first, () => {
      buffer(gl, data);
      attribute(gl, 0, 3, 24, 0);
      attribute(gl, 1, 3, 24, 12);
      buffer(gl, index, gl.ELEMENT_ARRAY_BUFFER);
    });
    return { array, count: index.length, fewFaces: hasFewFaces(data) };
  }

  // the simplified mesh of a group, built at its first use
  simplifiedMesh(group) {
    if (!group.simplified) {
      const { vertices, triangles, radius } = group.shape;
      let mesh = { vertices, triangles };
      const maxTriangles = Math.max(SIMPLIFIED_TRIANGLES / this.header.bodies.length, 32);
      for (const fraction of [0.2, 0.28, 0.4, 0.55]) {
        if (mesh.triangles.length > 3 * maxTriangles) mesh = simplify(vertices, triangles, fraction * radius);
      }
      group.simplified = this.mesh(group.first, mesh.vertices, mesh.triangles);
    }
    return group.simplified;
  }

  // number of triangles of all bodies
  get triangleCount() {
    return this.groups.reduce((sum, { mesh, count }) => sum + (mesh ? (mesh.count / 3) * count : 0), 0);
  }

  // a vertex array whose instances start at `first`; `bindVertices` sets up the rest
  array(first, bindVertices) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    bindVertices();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instanceBuffer);
    [4, 5, 6].forEach((index, k) => attribute(gl, index, 4, 4 * FLOATS, 4 * FLOATS * Math.max(first, 0) + 16 * k, true));
    gl.bindVertexArray(null);
    return array;
  }

  // builds the edges of a group at their first use
  buildEdges(group) {
    if (group.edgeArray || !group.mesh) return;
    const { gl } = this;
    const list = group.shape.triangles.length > 3 * MAX_EDGES ? new Uint32Array(0) : edges(group.shape.triangles);
    group.edgeArray = this.array(group.first, () => {
      buffer(gl, group.shape.vertices);
      attribute(gl, 0, 3, 12, 0);
      buffer(gl, list, gl.ELEMENT_ARRAY_BUFFER);
    });
    group.edgeCount = list.length;
  }

  // updates poses and highlights; `highlight(body)` is from 0 to 1
  update(snapshot, highlight) {
    const { gl, instances } = this;
    const { pose } = snapshot;
    for (let slot = 0; slot < this.order.length; slot++) {
      const body = this.order[slot];
      const to = FLOATS * slot;
      const from = 7 * body;
      for (let i = 0; i < 3; i++) instances[to + i] = pose[from + i];
      instances[to + 3] = highlight(body);
      for (let i = 0; i < 4; i++) instances[to + 4 + i] = pose[from + 3 + i];
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instanceBuffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, instances);
  }

  drawDepth(view) {
    this.drawMeshes(this.depth, view);
  }

  draw(view) {
    this.drawMeshes(this.body, view, 0);
  }

  // fixed and prescribed bodies, transparent over all others: a drum must not hide its contents
  drawPrescribed(view) {
    if (!this.header.bodies.some((body) => body.driven)) return;
    this.gl.depthMask(false);
    this.drawMeshes(this.body, view, 1);
    this.gl.depthMask(true);
  }

  drawMeshes(shader, view, prescribedPass = 0) {
    const { gl } = this;
    useProgram(gl, shader, view);
    if (shader.at.prescribedPass) gl.uniform1f(shader.at.prescribedPass, prescribedPass);
    for (const group of this.groups) {
      if (!group.mesh || !group.count) continue;
      const { array, count } = this.simplified ? this.simplifiedMesh(group) : group.mesh;
      gl.bindVertexArray(array);
      gl.drawElementsInstanced(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0, group.count);
    }
  }

  drawEdges(view) {
    const { gl } = this;
    useProgram(gl, this.edge, view);
    gl.uniform4fv(this.edge.at.ink, view.theme.edge);
    for (const group of this.groups) {
      this.buildEdges(group);
      if (!group.edgeCount || !group.count) continue;
      gl.bindVertexArray(group.edgeArray);
      gl.drawElementsInstanced(gl.LINES, group.edgeCount, gl.UNSIGNED_INT, 0, group.count);
    }
  }

  // all particles, or only those of bodies without a mesh
  drawParticles(view, all, pixels) {
    const { gl } = this;
    const { handle, at } = this.particle;
    useProgram(gl, { handle, at }, view);
    gl.uniform4fv(at.walls, this.walls);
    gl.uniform1fv(at.stiffness, this.stiffness);
    gl.uniform1i(at.wallCount, Math.min(this.header.walls.length, MAX_WALLS));
    gl.uniform1f(at.maxForce, this.maxForce);
    gl.uniform2f(at.viewport, pixels[0], pixels[1]);
    gl.uniform1f(at.zoom, view.zoom);
    gl.uniform3fv(at.freeColour, view.theme.path);
    for (const group of this.groups) {
      const isBare = !group.mesh;
      if (!group.count || !(all || isBare)) continue;
      gl.uniform1f(at.radius, isBare ? 0.08 * (group.shape.radius || 1) + 0.4 * group.pointRadius : group.pointRadius);
      gl.uniform1i(at.ownColour, isBare ? 1 : 0);
      gl.bindVertexArray(group.points);
      gl.drawArraysInstanced(gl.POINTS, 0, group.pointCount, group.count);
    }
  }
}

// whether the normals have at most 14 directions, as those of a box
function hasFewFaces(data) {
  const directions = new Set();
  for (let at = 3; at < data.length && directions.size <= 14; at += 6) {
    directions.add(Array.from(data.subarray(at, at + 3), (x) => Math.round(20 * x)).join(','));
  }
  return directions.size <= 14;
}

// A colour for each body. Many bodies of several shapes have a colour per shape, with slightly different tones.
export function bodyColours(header) {
  const byShape = header.bodies.length > BODY_COLOURS.length && header.shapes.length > 1;
  const count = BODY_COLOURS.length;
  return header.bodies.map((body, index) => {
    if (body.driven) return PRESCRIBED_COLOUR;
    const base = BODY_COLOURS[(byShape ? body.shape : index) % count];
    const tone = byShape || index >= count ? 1 + 0.12 * Math.sin(2.4 * index) : 1;
    return base.map((c) => Math.min(c * tone, 1));
  });
}
