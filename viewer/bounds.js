// Bounding spheres { centre, radius } of the scene, for camera, light and walls. That of a mechanism has the points in it, too:
// the camera can come nearer to a flat one.

import { boundingBox } from './geometry.js';
import { hasLetGo } from './joints.js';
import { add, length, rotate, scale, sub } from './math.js';
import { BODY_SIZE } from './recording.js';

// the bodies that joints hold at a time
function heldBodies({ joints }, time) {
  const holding = joints.filter((joint) => !hasLetGo(joint, time));
  return new Set(holding.flatMap((joint) => joint.bodies).filter((body) => body !== null));
}

// the finite positions of bodies in a frame
function positions({ bodies }, isCounted = () => true) {
  const list = [];
  for (let at = 0; at < bodies.length; at += BODY_SIZE) {
    if (!isCounted(at / BODY_SIZE)) continue;
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
  const cornersOf = cornersIn(header);
  const list = joints.flatMap(({ bodies: pair, anchors }) => anchors.filter((_, side) => pair[side] === null));
  for (const frame of sampled(recording)) {
    heldBodies(header, frame.time).forEach((body) => list.push(...cornersOf(frame, body)));
  }
  if (!list.length) return [];
  // what lies around it is shown too, if it is not much larger
  const { centre, radius } = sphereAround(list, 0);
  const around = recording.length ? bodies.map((_, body) => cornersOf(recording.frames[0], body)) : [];
  return [...list, ...around.filter((corners) => corners.every((p) => length(sub(p, centre)) < 2 * radius)).flat()];
}

// the finite corners of the box around a body in a frame
function cornersIn({ shapes, bodies }) {
  const boxes = shapes.map(boundingBox);
  return ({ bodies: floats }, body) => {
    const at = BODY_SIZE * body;
    const position = Array.from(floats.subarray(at, at + 3));
    const orientation = Array.from(floats.subarray(at + 3, at + 7));
    const { centre, half } = boxes[bodies[body].shape];
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => centre.map((x, k) => x + ((i >> k) & 1 ? half[k] : -half[k])));
    return corners.map((corner) => add(position, rotate(orientation, corner))).filter((point) => point.every(Number.isFinite));
  };
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
    const sphere = sphereAround(held, 0);
    // at the start of a live run nothing has moved yet: leave some space
    return header.live ? { ...sphere, radius: 1.5 * sphere.radius } : { ...sphere, points: held };
  }
  const points = [...corners, ...sampled(recording).flatMap((frame) => positions(frame)).filter(isNear)];
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
  const points = [...past, frame].flatMap((one) => positions(one));
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
  // what a mechanism throws away does not count
  const held = heldBodies(header, frame.time);
  let points = positions(frame, (body) => held.size === 0 || held.has(body));
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
