// Bodies: one draw call for all that share a shape, each in its place by an instance buffer.

import { attribute, buffer, program, setView } from './gl.js';
import { coarse, corners, edges } from './geometry.js';
import { BODY_COLOURS, DRIVEN_COLOUR } from './palette.js';
import { BODY_FRAGMENT, BODY_VERTEX, DEPTH_FRAGMENT, EDGE_FRAGMENT, EDGE_VERTEX } from './shaders.js';
import { PARTICLE_FRAGMENT, PARTICLE_VERTEX } from './shaders.js';

const FLOATS = 12; // place, picked; turn; colour, markings
const MOST_WALLS = 32;
// a mesh of more edges than this is a grey mist, not a drawing
const MOST_EDGES = 60000;
// triangles of all bodies together that are drawn roughly, about
const ROUGH = 60000;

export class Bodies {
  constructor(gl, head) {
    this.gl = gl;
    this.head = head;
    this.body = program(gl, BODY_VERTEX, BODY_FRAGMENT);
    this.depth = program(gl, BODY_VERTEX, DEPTH_FRAGMENT);
    this.edge = program(gl, EDGE_VERTEX, EDGE_FRAGMENT);
    this.particle = program(gl, PARTICLE_VERTEX, PARTICLE_FRAGMENT);
    this.instances = new Float32Array(FLOATS * head.bodies.length);
    this.order = head.bodies.map((_, index) => index).sort((a, b) => head.bodies[a].shape - head.bodies[b].shape || a - b);
    this.colours = bodyColours(head);
    this.instanceBuffer = buffer(gl, this.instances, gl.ARRAY_BUFFER, gl.DYNAMIC_DRAW);
    this.groups = head.shapes.map((shape, index) => this.group(shape, index));
    this.fillConstant();
    this.walls = new Float32Array(4 * MOST_WALLS);
    this.stiffness = new Float32Array(MOST_WALLS);
    this.setWalls();
    this.strongest = 1;
    this.isRough = false;
  }

  setWalls() {
    this.head.walls.slice(0, MOST_WALLS).forEach((wall, i) => {
      this.walls.set([...wall.normal, wall.offset], 4 * i);
      this.stiffness[i] = wall.stiffness;
    });
  }

  fillConstant() {
    const { bodies } = this.head;
    this.order.forEach((body, slot) => {
      const { moments, shape } = bodies[body];
      // two equal moments and many faces: the body looks the same all around, so it gets markings
      const { mesh } = this.groups[shape];
      const round = mesh && !mesh.fewFaces && moments[2] > 0 && (moments[1] - moments[0] < 0.02 * moments[2] || moments[2] - moments[1] < 0.02 * moments[2]);
      this.instances.set([...this.colours[body], bodies[body].driven ? 2 : round ? 1 : 0], FLOATS * slot + 8);
    });
  }

  group(shape, index) {
    const { gl } = this;
    const first = this.order.findIndex((body) => this.head.bodies[body].shape === index);
    const count = this.head.bodies.filter((body) => body.shape === index).length;
    const drawn = { first, count, shape, mesh: null, rough: null, edgeArray: null, edgeCount: 0 };
    if (shape.triangles.length) drawn.mesh = this.mesh(first, shape.vertices, shape.triangles);
    drawn.points = this.array(first, () => {
      buffer(gl, shape.particles);
      attribute(gl, 0, 3, 12, 0);
    });
    drawn.pointCount = shape.particles.length / 3;
    // how far particles are apart, about: on a surface of the body's size
    drawn.pointRadius = 0.35 * shape.radius * Math.min(Math.sqrt(4 / Math.max(drawn.pointCount, 1)), 0.35);
    return drawn;
  }

  mesh(first, vertices, triangles) {
    const { gl } = this;
    const { data, index } = corners(vertices, triangles);
    const array = this.array(first, () => {
      buffer(gl, data);
      attribute(gl, 0, 3, 24, 0);
      attribute(gl, 1, 3, 24, 12);
      buffer(gl, index, gl.ELEMENT_ARRAY_BUFFER);
    });
    return { array, count: index.length, fewFaces: hasFewFaces(data) };
  }

  // of a shape with many triangles and many bodies
  roughMesh(group) {
    if (!group.rough) {
      const { vertices, triangles, radius } = group.shape;
      let less = { vertices, triangles };
      const most = Math.max(ROUGH / this.head.bodies.length, 32);
      for (const part of [0.2, 0.28, 0.4, 0.55]) {
        if (less.triangles.length > 3 * most) less = coarse(vertices, triangles, part * radius);
      }
      group.rough = this.mesh(group.first, less.vertices, less.triangles);
    }
    return group.rough;
  }

  // how many triangles a picture has
  get triangleCount() {
    return this.groups.reduce((sum, { mesh, count }) => sum + (mesh ? (mesh.count / 3) * count : 0), 0);
  }

  // a vertex array with the instances from `first` on
  array(first, fill) {
    const { gl } = this;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    fill();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instanceBuffer);
    [4, 5, 6].forEach((index, k) => attribute(gl, index, 4, 4 * FLOATS, 4 * FLOATS * Math.max(first, 0) + 16 * k, true));
    gl.bindVertexArray(null);
    return array;
  }

  edgesOf(group) {
    if (group.edgeArray || !group.mesh) return;
    const { gl } = this;
    const list = group.shape.triangles.length > 3 * MOST_EDGES ? new Uint32Array(0) : edges(group.shape.triangles);
    group.edgeArray = this.array(group.first, () => {
      buffer(gl, group.shape.vertices);
      attribute(gl, 0, 3, 12, 0);
      buffer(gl, list, gl.ELEMENT_ARRAY_BUFFER);
    });
    group.edgeCount = list.length;
  }

  // places for the next frames; `emphasis(body)` is 0 to 1
  place(moment, emphasis) {
    const { gl, instances } = this;
    const { pose } = moment;
    for (let slot = 0; slot < this.order.length; slot++) {
      const body = this.order[slot];
      const to = FLOATS * slot;
      const from = 7 * body;
      for (let i = 0; i < 3; i++) instances[to + i] = pose[from + i];
      instances[to + 3] = emphasis(body);
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

  // bodies that something other than forces moves, over all others: a drum must not hide what is in it
  drawDriven(view) {
    if (!this.head.bodies.some((body) => body.driven)) return;
    this.gl.depthMask(false);
    this.drawMeshes(this.body, view, 1);
    this.gl.depthMask(true);
  }

  drawMeshes(how, view, ghosts = 0) {
    const { gl } = this;
    setView(gl, how, view);
    if (how.at.ghosts) gl.uniform1f(how.at.ghosts, ghosts);
    for (const group of this.groups) {
      if (!group.mesh || !group.count) continue;
      const { array, count } = this.isRough ? this.roughMesh(group) : group.mesh;
      gl.bindVertexArray(array);
      gl.drawElementsInstanced(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0, group.count);
    }
  }

  drawEdges(view) {
    const { gl } = this;
    setView(gl, this.edge, view);
    gl.uniform4fv(this.edge.at.ink, view.theme.edge);
    for (const group of this.groups) {
      this.edgesOf(group);
      if (!group.edgeCount || !group.count) continue;
      gl.bindVertexArray(group.edgeArray);
      gl.drawElementsInstanced(gl.LINES, group.edgeCount, gl.UNSIGNED_INT, 0, group.count);
    }
  }

  // all particles, or those of bodies without a surface alone
  drawParticles(view, all, pixels) {
    const { gl } = this;
    const { handle, at } = this.particle;
    setView(gl, { handle, at }, view);
    gl.uniform4fv(at.walls, this.walls);
    gl.uniform1fv(at.stiffness, this.stiffness);
    gl.uniform1i(at.wallCount, Math.min(this.head.walls.length, MOST_WALLS));
    gl.uniform1f(at.strongest, this.strongest);
    gl.uniform2f(at.viewport, pixels[0], pixels[1]);
    gl.uniform1f(at.zoom, view.zoom);
    gl.uniform3fv(at.plain, view.theme.path);
    for (const group of this.groups) {
      const bare = !group.mesh;
      if (!group.count || !(all || bare)) continue;
      gl.uniform1f(at.radius, bare ? 0.08 * (group.shape.radius || 1) + 0.4 * group.pointRadius : group.pointRadius);
      gl.uniform1i(at.ownColour, bare ? 1 : 0);
      gl.bindVertexArray(group.points);
      gl.drawArraysInstanced(gl.POINTS, 0, group.pointCount, group.count);
    }
  }
}

// whether all corners face one of a few directions, as those of a box do
function hasFewFaces(data) {
  const directions = new Set();
  for (let at = 3; at < data.length && directions.size <= 14; at += 6) {
    directions.add(Array.from(data.subarray(at, at + 3), (x) => Math.round(20 * x)).join(','));
  }
  return directions.size <= 14;
}

// A colour for each body; where there are many, one for each shape, in slightly different tones.
export function bodyColours(head) {
  const many = head.bodies.length > BODY_COLOURS.length && head.shapes.length > 1;
  const count = BODY_COLOURS.length;
  return head.bodies.map((body, index) => {
    if (body.driven) return DRIVEN_COLOUR;
    const base = BODY_COLOURS[(many ? body.shape : index) % count];
    const tone = many || index >= count ? 1 + 0.12 * Math.sin(2.4 * index) : 1;
    return base.map((c) => Math.min(c * tone, 1));
  });
}
