// Which body is under the pointer, and which of its particles: on the processor, by rays.

import { add, conjugate, cross, dot, length, normalize, rotate, scale, sub } from './math.js';

// the nearest hit: { body, point, distance }, or null; a driven body only where no other is hit
export function pickBody(ray, head, moment) {
  return pickOf(ray, head, moment, (body) => !body.driven) ?? pickOf(ray, head, moment, (body) => body.driven);
}

function pickOf(ray, head, moment, isMeant) {
  let best = null;
  for (let body = 0; body < head.bodies.length; body++) {
    if (!isMeant(head.bodies[body])) continue;
    const shape = head.shapes[head.bodies[body].shape];
    const centre = moment.position(body);
    const along = dot(sub(centre, ray.from), ray.along);
    const off = length(sub(sub(centre, ray.from), scale(ray.along, along)));
    // bare particles are easier to hit than they look
    if (!(off < 1.05 * shape.radius + 1e-9) || along < -shape.radius) continue;
    if (best && along - shape.radius > best.distance) continue;
    const q = conjugate(moment.orientation(body));
    const own = { from: rotate(q, sub(ray.from, centre)), along: rotate(q, ray.along) };
    const distance = shape.triangles.length ? hitMesh(own, shape) : along;
    if (distance < (best ? best.distance : Infinity)) {
      best = { body, distance, point: add(ray.from, scale(ray.along, distance)) };
    }
  }
  return best;
}

// Möller and Trumbore, J. Graphics Tools 2 (1997) 21
function hitMesh({ from, along }, { vertices, triangles }) {
  let best = Infinity;
  const at = (index) => [vertices[3 * index], vertices[3 * index + 1], vertices[3 * index + 2]];
  for (let t = 0; t < triangles.length; t += 3) {
    const a = at(triangles[t]);
    const e = sub(at(triangles[t + 1]), a);
    const f = sub(at(triangles[t + 2]), a);
    const p = cross(along, f);
    const d = dot(e, p);
    if (d === 0) continue;
    const s = sub(from, a);
    const u = dot(s, p) / d;
    if (u < 0 || u > 1) continue;
    const q = cross(s, e);
    const v = dot(along, q) / d;
    if (v < 0 || u + v > 1) continue;
    const distance = dot(f, q) / d;
    if (distance > 0 && distance < best) best = distance;
  }
  return best;
}

// the particle of a body that is nearest to a place: { particle, place }
export function nearestParticle(head, moment, body, place) {
  const { particles } = head.shapes[head.bodies[body].shape];
  const centre = moment.position(body);
  const q = moment.orientation(body);
  const own = rotate(conjugate(q), sub(place, centre));
  let best = 0;
  let least = Infinity;
  for (let i = 0; i < particles.length; i += 3) {
    const d = (particles[i] - own[0]) ** 2 + (particles[i + 1] - own[1]) ** 2 + (particles[i + 2] - own[2]) ** 2;
    if (d < least) {
      least = d;
      best = i / 3;
    }
  }
  return { particle: best, place: particlePlace(head, moment, body, best) };
}

// where a particle is now
export function particlePlace(head, moment, body, particle) {
  const { particles } = head.shapes[head.bodies[body].shape];
  const own = Array.from(particles.subarray(3 * particle, 3 * particle + 3));
  return add(moment.position(body), rotate(moment.orientation(body), own));
}

// where a ray meets the plane through `place` that faces the eye
export function onPlane(ray, place, back) {
  const slope = dot(ray.along, back);
  if (Math.abs(slope) < 1e-6) return place;
  const distance = dot(sub(place, ray.from), normalize(back)) / slope;
  return add(ray.from, scale(ray.along, Math.max(distance, 0)));
}
