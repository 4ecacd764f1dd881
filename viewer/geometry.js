// Meshes for drawing: vertices with normals, simplified meshes, edges, spheres, arrows.

// edges with a larger angle between their faces are drawn sharp
const CREASE = Math.cos((38 * Math.PI) / 180);
// bodies with at most this many triangles are flat shaded
const FLAT = 200;

// the box of a shape along its axes, and its smallest half width
export function boundingBox({ vertices, radius, particle_radius: own }) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  vertices.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  const isEmpty = vertices.length === 0;
  const half = isEmpty ? [radius, radius, radius] : [0, 1, 2].map((k) => 0.5 * (high[k] - low[k]) + (own ?? 0));
  const centre = isEmpty ? [0, 0, 0] : [0, 1, 2].map((k) => 0.5 * (high[k] + low[k]));
  return { centre, half, least: Math.min(...half) || radius };
}

// Vertices with normals (six floats each: position, normal) and three indices per triangle. A vertex is split where
// the normals of its triangles differ.
export function withNormals(vertices, triangles) {
  const faces = faceNormals(vertices, triangles);
  const adjacent = triangles.length / 3 > FLAT ? adjacentFaces(vertices, triangles) : null;
  const out = [];
  const index = new Uint32Array(triangles.length);
  const known = new Map();
  triangles.forEach((vertex, i) => {
    const t = Math.floor(i / 3);
    const n = adjacent ? smoothNormal(faces, adjacent, t, vertex) : faces.unit.subarray(3 * t, 3 * t + 3);
    const split = known.get(vertex);
    const same = split?.find((corner) => Math.abs(out[6 * corner + 3] - n[0]) + Math.abs(out[6 * corner + 4] - n[1]) + Math.abs(out[6 * corner + 5] - n[2]) < 1e-3);
    if (same !== undefined) {
      index[i] = same;
      return;
    }
    index[i] = out.length / 6;
    out.push(vertices[3 * vertex], vertices[3 * vertex + 1], vertices[3 * vertex + 2], n[0], n[1], n[2]);
    if (split) split.push(index[i]);
    else known.set(vertex, [index[i]]);
  });
  return { data: new Float32Array(out), index };
}

// unit normals and (twice) the areas of all triangles
function faceNormals(vertices, triangles) {
  const count = triangles.length / 3;
  const unit = new Float32Array(3 * count);
  const area = new Float32Array(count);
  for (let t = 0; t < count; t++) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[3 * t + k]);
    const ux = vertices[b] - vertices[a];
    const uy = vertices[b + 1] - vertices[a + 1];
    const uz = vertices[b + 2] - vertices[a + 2];
    const vx = vertices[c] - vertices[a];
    const vy = vertices[c + 1] - vertices[a + 1];
    const vz = vertices[c + 2] - vertices[a + 2];
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const l = Math.hypot(n[0], n[1], n[2]);
    area[t] = l;
    if (l > 0) unit.set([n[0] / l, n[1] / l, n[2] / l], 3 * t);
  }
  return { unit, area };
}

// The triangles at each vertex: those of vertex v are list[starts[g]] to list[starts[g + 1] - 1], where g = group[v].
function adjacentFaces(vertices, triangles) {
  const group = weld(vertices);
  const starts = new Uint32Array(vertices.length / 3 + 1);
  for (const vertex of triangles) starts[group[vertex] + 1]++;
  for (let i = 1; i < starts.length; i++) starts[i] += starts[i - 1];
  const list = new Uint32Array(triangles.length);
  const next = starts.slice();
  triangles.forEach((vertex, i) => {
    list[next[group[vertex]]++] = Math.floor(i / 3);
  });
  return { group, starts, list };
}

// the first vertex with the same coordinates, for each vertex
function weld(vertices) {
  const bits = new Uint32Array(vertices.buffer, vertices.byteOffset, vertices.length);
  const seen = new Map();
  const group = new Uint32Array(vertices.length / 3);
  for (let v = 0; v < group.length; v++) {
    const key = `${bits[3 * v]},${bits[3 * v + 1]},${bits[3 * v + 2]}`;
    const first = seen.get(key);
    if (first === undefined) seen.set(key, v);
    group[v] = first ?? v;
  }
  return group;
}

// the area-weighted mean of the normals around a vertex, without faces beyond a crease
function smoothNormal({ unit, area }, { group, starts, list }, t, vertex) {
  let x = 0;
  let y = 0;
  let z = 0;
  const g = group[vertex];
  const [nx, ny, nz] = unit.subarray(3 * t, 3 * t + 3);
  for (let i = starts[g]; i < starts[g + 1]; i++) {
    const f = list[i];
    const cosine = unit[3 * f] * nx + unit[3 * f + 1] * ny + unit[3 * f + 2] * nz;
    if (cosine < CREASE) continue;
    x += area[f] * unit[3 * f];
    y += area[f] * unit[3 * f + 1];
    z += area[f] * unit[3 * f + 2];
  }
  const l = Math.hypot(x, y, z);
  return l > 0 ? [x / l, y / l, z / l] : [nx, ny, nz];
}

// A mesh with fewer triangles: vertices in one cell of a grid are merged (vertex clustering).
export function simplify(vertices, triangles, cell) {
  const cells = new Map();
  const points = [];
  const group = new Uint32Array(vertices.length / 3);
  for (let v = 0; v < group.length; v++) {
    const p = vertices.subarray(3 * v, 3 * v + 3);
    const key = Array.from(p, (x) => Math.round(x / cell)).join(',');
    if (!cells.has(key)) {
      cells.set(key, points.length / 3);
      points.push(...p);
    }
    group[v] = cells.get(key);
  }
  const kept = [];
  const seen = new Set();
  for (let t = 0; t < triangles.length; t += 3) {
    const corner = [group[triangles[t]], group[triangles[t + 1]], group[triangles[t + 2]]];
    const key = corner.slice().sort((a, b) => a - b).join(',');
    if (new Set(corner).size < 3 || seen.has(key)) continue;
    seen.add(key);
    kept.push(...corner);
  }
  return { vertices: new Float32Array(points), triangles: new Uint32Array(kept) };
}

// pairs of vertex indices, each edge once
export function edges(triangles) {
  const seen = new Set();
  const list = [];
  for (let i = 0; i < triangles.length; i += 3) {
    for (let k = 0; k < 3; k++) {
      const a = triangles[i + k];
      const b = triangles[i + ((k + 1) % 3)];
      const key = Math.min(a, b) * 4294967296 + Math.max(a, b);
      if (!seen.has(key)) {
        seen.add(key);
        list.push(a, b);
      }
    }
  }
  return new Uint32Array(list);
}

// a unit sphere: position and normal of each triangle corner
export function sphere(rings = 20, segments = 36) {
  const at = (i, j) => {
    const a = (Math.PI * i) / rings;
    const b = (2 * Math.PI * j) / segments;
    return [Math.sin(a) * Math.cos(b), Math.cos(a), Math.sin(a) * Math.sin(b)];
  };
  const out = [];
  for (let i = 0; i < rings; i++) {
    for (let j = 0; j < segments; j++) {
      const [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
      for (const p of [a, b, c, a, c, d]) out.push(...p, ...p);
    }
  }
  return new Float32Array(out);
}

// A rod along +y with round ends, or with flat ones: as `arrow`, but its ends do not depend on the length; `z` is in
// radii of the rod.
export function rod(isRound, segments = 16) {
  const quarter = [0, 1, 2, 3, 4].map((i) => (Math.PI / 8) * i);
  const end = isRound ? quarter.map((a) => ({ r: Math.cos(a), head: Math.sin(a) })) : [{ r: 1, head: 0 }, { r: 0, head: 0 }];
  const start = end.map(({ r, head }) => ({ r, y: 0, head: -head })).reverse();
  const profile = [...start, ...end.map((point) => ({ ...point, y: 1 }))];
  return revolve(isRound ? [profile] : [profile.slice(0, 2), profile.slice(1, 3), profile.slice(2)], segments);
}

// An arrow along +y: profile (x, position along the shaft, z, position along the head) and normal of each triangle
// corner. The shader scales shaft and head separately.
export function arrow(segments = 20) {
  // `y` runs from 0 to 1 along the shaft, `head` from 0 to 1 along the head
  const shaft = [{ r: 0, y: 0, head: 0 }, { r: 1, y: 0, head: 0 }, { r: 1, y: 1, head: 0 }];
  const head = [{ r: 1, y: 1, head: 0 }, { r: 2.6, y: 1, head: 0 }, { r: 0, y: 1, head: 1 }];
  return revolve([shaft, head], segments);
}

// surfaces of revolution about y through these profiles
function revolve(profiles, segments) {
  const out = [];
  const ring = (profile) => {
    for (let s = 0; s < profile.length - 1; s++) {
      const [p, q] = [profile[s], profile[s + 1]];
      const slope = Math.atan2(p.r - q.r, q.y - p.y + (q.head - p.head));
      for (let j = 0; j < segments; j++) {
        const corner = (end, k) => {
          const b = (2 * Math.PI * (j + k)) / segments;
          out.push(end.r * Math.cos(b), end.y, end.r * Math.sin(b), end.head);
          out.push(Math.cos(b) * Math.cos(slope), Math.sin(slope), Math.sin(b) * Math.cos(slope));
        };
        [[p, 0], [q, 0], [q, 1], [p, 0], [q, 1], [p, 1]].forEach(([end, k]) => corner(end, k));
      }
    }
  };
  profiles.forEach(ring);
  return new Float32Array(out);
}
