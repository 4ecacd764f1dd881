// Draws the walls: the faces of the box, and planes that fade out with distance. Shadows fall on them.

import { add, cross, dot, length, normalize, perpendicular, rotate, scale, sub } from './math.js';
import { attribute, buffer, program, useProgram } from './gl.js';
import { WALL_FRAGMENT, WALL_VERTEX } from './shaders.js';
import { round125 } from './format.js';

export class Walls {
  constructor(gl, header, bounds) {
    this.gl = gl;
    this.wall = program(gl, WALL_VERTEX, WALL_FRAGMENT);
    this.square = gl.createVertexArray();
    gl.bindVertexArray(this.square);
    buffer(gl, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]));
    attribute(gl, 0, 2, 8, 0);
    gl.bindVertexArray(null);
    this.setBounds(header, bounds);
  }

  setBounds(header, bounds) {
    this.faces = [...boxFaces(header), ...planes(header, bounds)];
  }

  // to be called before the bodies are drawn; walls seen from behind are left out
  draw(view) {
    const { gl } = this;
    const { at } = this.wall;
    useProgram(gl, this.wall, view);
    gl.bindVertexArray(this.square);
    gl.depthMask(false);
    for (const face of this.faces) {
      if (dot(face.normal, sub(view.eye, face.middle)) <= 0) continue;
      const isFloor = dot(face.normal, view.up) > 0.5;
      gl.uniform3fv(at.middle, face.middle);
      gl.uniform3fv(at.across, face.across);
      gl.uniform3fv(at.along, face.along);
      gl.uniform2fv(at.shift, face.shift);
      gl.uniform3fv(at.normal, face.normal);
      gl.uniform3fv(at.floorColour, view.theme.floor);
      gl.uniform3fv(at.gridColour, view.theme.grid);
      gl.uniform1f(at.opacity, isFloor ? 0.85 : 0.22);
      gl.uniform1f(at.shade, view.theme.shadow * (isFloor ? 1 : 0.55));
      gl.uniform1f(at.gridSize, face.grid);
      gl.uniform1f(at.gridInk, isFloor ? 0.34 : 0.2);
      gl.uniform1f(at.fade, face.fade);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
    gl.depthMask(true);
  }
}

// the edges of the box, as pairs of points
export function boxEdges(box) {
  const corner = (i) => rotate(box.orientation, [0, 1, 2].map((k) => ((i >> k) & 1 ? box.max[k] : box.min[k])));
  const ends = [];
  for (let i = 0; i < 8; i++) {
    for (let k = 0; k < 3; k++) {
      if (!((i >> k) & 1)) ends.push(corner(i), corner(i | (1 << k)));
    }
  }
  return ends;
}

const FACES = ['-x', '+x', '-y', '+y', '-z', '+z'];

function boxFaces(header) {
  const { box } = header;
  if (!box) return [];
  const size = sub(box.max, box.min);
  const middle = scale(add(box.min, box.max), 0.5);
  const grid = round125(Math.max(...size) / 20);
  const axis = (k, l) => [0, 1, 2].map((i) => (i === k ? l : 0));
  return FACES.flatMap((name, face) => {
    if (box.open.includes(name)) return [];
    const k = face >> 1;
    const [i, j] = [(k + 1) % 3, (k + 2) % 3];
    const at = middle.slice();
    at[k] = face % 2 ? box.max[k] : box.min[k];
    return [
      {
        middle: rotate(box.orientation, at),
        normal: rotate(box.orientation, axis(k, face % 2 ? -1 : 1)),
        across: rotate(box.orientation, axis(i, size[i] / 2)),
        along: rotate(box.orientation, axis(j, size[j] / 2)),
        // grid lines lie at multiples of the spacing in the coordinates of the box
        shift: [middle[i], middle[j]],
        grid,
        fade: 0,
      },
    ];
  });
}

// walls that are not faces of the box, drawn around the bounding sphere of the scene
function planes(header, { centre, radius }) {
  const grid = round125(radius / 10);
  return header.walls.slice(header.boxPlanes.length).map(({ normal, offset }) => {
    const n = normalize(normal);
    const middle = add(centre, scale(n, offset / (length(normal) || 1) - dot(n, centre)));
    const horizontal = cross(n, header.up);
    const across = length(horizontal) > 1e-6 ? normalize(horizontal) : perpendicular(n);
    const along = cross(n, across);
    const halfSize = 3.4 * radius;
    return {
      middle,
      normal: n,
      across: scale(across, halfSize),
      along: scale(along, halfSize),
      shift: [dot(middle, across), dot(middle, along)],
      grid,
      fade: 1,
    };
  });
}
