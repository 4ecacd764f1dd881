// Picking: the body and particle under the pointer, by ray casting.

import { add, conjugate, cross, dot, length, normalize, rotate, scale, sub } from './math.js';

// The nearest hit { body, point, distance }, or null. Free bodies have priority over fixed and prescribed ones.
export function pickBody(ray, header, snapshot) {
  return pickWhere(ray, header, snapshot, (body) => !body.driven) ?? pickWhere(ray, header, snapshot, (body) => body.driven);
}

function pickWhere(ray, header, snapshot, matches) {
  let best = null;
  for (let body = 0; body < header.bodies.length; body++) {
    if (!matches(header.bodies[body])) continue;
    const shape = header.shapes[header.bodies[body].shape];
    const centre = snapshot.position(body);
    const along = dot(sub(centre, ray.origin), ray.direction);
    const offset = length(sub(sub(centre, ray.origin), scale(ray.direction, along)));
    // a body without a mesh is hit within its whole bounding sphere
    if (!(offset < 1.05 * shape.radius + 1e-9) || along < -shape.radius) continue;
    if (best && along - shape.radius > best.distance) continue;
    const q = conjugate(snapshot.orientation(body));
    const local = { origin: rotate(q, sub(ray.origin, centre)), direction: rotate(q, ray.direction) };
    const distance = shape.triangles.length ? intersectMesh(local, shape) : along;
    if (distance < (best ? best.distance : Infinity)) {
      best = { body, distance, point: add(ray.origin, scale(ray.direction, distance)) };
    }
  }
  return best;
}

// distance along the ray to the nearest triangle; Möller and Trumbore, J. Graphics Tools 2 (1997) 21
function intersectMesh({ origin, direction }, { vertices, triangles }) {
  let best = Infinity;
  const at = (index) => [vertices[3 * index], vertices[3 * index + 1], vertices[3 * index + 2]];
  for (let t = 0; t < triangles.length; t += 3) {
    const a = at(triangles[t]);
    const e = sub(at(triangles[t + 1]), a);
    const f = sub(at(triangles[t + 2]), a);
    const p = cross(direction, f);
    const d = dot(e, p);
    if (d === 0) continue;
    const s = sub(origin, a);
    const u = dot(s, p) / d;
    if (u < 0 || u > 1) continue;
    const q = cross(s, e);
    const v = dot(direction, q) / d;
    if (v < 0 || u + v > 1) continue;
    const distance = dot(f, q) / d;
    if (distance > 0 && distance < best) best = distance;
  }
  return best;
}

// the particle of a body that is nearest to a point: { particle, position }
export function nearestParticle(header, snapshot, body, point) {
  const { particles } = header.shapes[header.bodies[body].shape];
  const centre = snapshot.position(body);
  const q = snapshot.orientation(body);
  const local = rotate(conjugate(q), sub(point, centre));
  let best = 0;
  let least = Infinity;
  for (let i = 0; i < particles.length; i += 3) {
    const d = (particles[i] - local[0]) ** 2 + (particles[i + 1] - local[1]) ** 2 + (particles[i + 2] - local[2]) ** 2;
    if (d < least) {
      least = d;
      best = i / 3;
    }
  }
  return { particle: best, position: particlePosition(header, snapshot, body, best) };
}

// the position of a particle, in world axes
export function particlePosition(header, snapshot, body, particle) {
  const { particles } = header.shapes[header.bodies[body].shape];
  const local = Array.from(particles.subarray(3 * particle, 3 * particle + 3));
  return add(snapshot.position(body), rotate(snapshot.orientation(body), local));
}

// the intersection of a ray with the plane through `point` with normal `normal`
export function intersectPlane(ray, point, normal) {
  const slope = dot(ray.direction, normal);
  if (Math.abs(slope) < 1e-6) return point;
  const distance = dot(sub(point, ray.origin), normalize(normal)) / slope;
  return add(ray.origin, scale(ray.direction, Math.max(distance, 0)));
}
