// Bounding spheres { centre, radius } of the scene, for camera, light and walls. That of a mechanism has the points in it, too:
// the camera can come nearer to a flat one.

import { boundingBox } from './geometry.js';
import { hasLetGo } from './joints.js';
import { add, length, rotate, scale, sub } from './math.js';
import { BODY_SIZE } from './recording.js';

// the finite positions of all bodies in a frame; with `header`, those held by joints if there are joints
function positions({ bodies, time }, header = null) {
  const held = header?.joints.length ? new Set(header.joints.filter((joint) => !hasLetGo(joint, time)).flatMap((joint) => joint.bodies)) : null;
  const list = [];
  for (let at = 0; at < bodies.length; at += BODY_SIZE) {
    if (held && !held.has(at / BODY_SIZE)) continue;
    const p = Array.from(bodies.subarray(at, at + 3));
    if (p.every(Number.isFinite)) list.push(p);
  }
  return list;
}

// the sphere around the axis-aligned box of some points
function sphereAround(points, margin) {
  const low = [0, 1, 2].map((k) => points.reduce((m, p) => Math.min(m, p[k]), Infinity));
  const high = [0, 1, 2].map((k) => points.reduce((m, p) => Math.max(m, p[k]), -Infinity));
  return { centre: scale(add(low, high), 0.5), radius: 0.5 * length(sub(high, low)) + margin };
}

const largestRadius = (header) => header.shapes.reduce((max, shape) => Math.max(max, shape.radius), 1e-6);

// every n-th frame, about 400 in all
const sampled = (recording) => {
  const step = Math.max(1, Math.floor(recording.length / 400));
  return recording.frames.filter((_, i) => i % step === 0);
};

// The corners of all bodies that joints hold, and the points where joints hold to the world. A mechanism stays where it
// is; a body that it throws may fly far away. Empty without joints or with many bodies.
function mechanism(header, recording) {
  const { bodies, joints } = header;
  if (!joints.length || bodies.length > 200) return [];
  const boxes = header.shapes.map(boundingBox);
  const list = joints.flatMap(({ bodies: pair, anchors }) => anchors.filter((_, side) => pair[side] === null));
  for (const { bodies: floats, time } of sampled(recording)) {
    const holding = joints.filter((joint) => !hasLetGo(joint, time));
    for (const body of new Set(holding.flatMap((joint) => joint.bodies))) {
      if (body === null) continue;
      const at = BODY_SIZE * body;
      const position = Array.from(floats.subarray(at, at + 3));
      const orientation = Array.from(floats.subarray(at + 3, at + 7));
      const { centre, half } = boxes[bodies[body].shape];
      for (let i = 0; i < 8; i++) {
        const corner = centre.map((x, k) => x + ((i >> k) & 1 ? half[k] : -half[k]));
        list.push(add(position, rotate(orientation, corner)));
      }
    }
  }
  return list.filter((point) => point.every(Number.isFinite));
}

// The initial bounds: the box; without a box the mechanism, if there is one, or all positions of the bodies.
export function initialBounds(header, recording) {
  const { box } = header;
  const corners = [];
  if (box) {
    for (let i = 0; i < 8; i++) {
      corners.push(rotate(box.orientation, [0, 1, 2].map((k) => ((i >> k) & 1 ? box.max[k] : box.min[k]))));
    }
  }
  const size = largestRadius(header);
  const boxRadius = box ? 0.5 * length(sub(box.max, box.min)) : Infinity;
  const boxCentre = box ? scale(corners.reduce(add), 1 / 8) : [0, 0, 0];
  // a body that has left the box is ignored: it would make everything else small
  const isNear = (p) => length(sub(p, boxCentre)) < 1.6 * boxRadius;
  const held = box ? [] : mechanism(header, recording);
  if (held.length) {
    // what lies around the mechanism is shown too
    const inner = sphereAround(held, 0);
    const around = recording.length ? positions(recording.frames[0]).filter((p) => length(sub(p, inner.centre)) < 1.6 * inner.radius) : [];
    const points = [...held, ...around];
    return { ...sphereAround(points, 0), points };
  }
  const points = [...corners, ...sampled(recording).flatMap(positions).filter(isNear)];
  if (!points.length) return { centre: [0, 0, 0], radius: 2 * size };
  const all = sphereAround(points, 0);
  if (box) return { centre: all.centre, radius: Math.max(all.radius, size) };
  // at the start of a live run the bodies have not moved yet: leave some space
  return { centre: all.centre, radius: Math.max(all.radius + 1.2 * size, header.live ? 3 * size : 0) };
}

// Bounds extended to the bodies of a frame and, with `withPaths`, to their earlier positions.
export function boundsOfAll(header, recording, frame, bounds, withPaths) {
  const size = 1.2 * largestRadius(header);
  const { centre, radius } = bounds;
  const past = withPaths ? sampled(recording) : [];
  const points = [...past, frame].flatMap(positions);
  const contains = ({ centre: c, radius: r }) => points.every((p) => length(sub(p, c)) + size <= r);
  if (!points.length || contains(bounds)) return bounds;
  // the old sphere is represented by its ends along the axes
  const ends = [0, 1, 2].flatMap((k) => [-1, 1].map((sign) => centre.map((x, i) => (i === k ? x + sign * (radius - size) : x))));
  const all = sphereAround([...points, ...(header.box ? ends : [])], size);
  // in perspective, what is in front of the centre looks larger
  return { centre: all.centre, radius: 1.2 * all.radius };
}

// Bounds moved, and enlarged if need be, to contain the bodies of a live frame. If some bodies are in the box, those
// that have left it are ignored.
export function boundsFollowing(header, frame, bounds) {
  const size = 1.2 * largestRadius(header);
  let points = positions(frame, header);
  if (header.box) {
    const inside = points.filter((p) => length(sub(p, bounds.centre)) < 1.6 * bounds.radius);
    if (inside.length) points = inside;
  }
  if (!points.length) return bounds;
  const present = sphereAround(points, size);
  const radius = Math.max(bounds.radius, present.radius);
  const displacement = sub(present.centre, bounds.centre);
  const excess = length(displacement) + present.radius - radius;
  if (excess <= 0) return radius > bounds.radius ? { centre: present.centre, radius } : bounds;
  return { centre: add(bounds.centre, scale(displacement, Math.min(excess / length(displacement), 1))), radius };
}
