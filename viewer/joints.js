// Joints and loads: where they are at a time, and what they do to the bodies.

import { add, cross, dot, length, rotate, scale, sub } from './math.js';
import { OFFSET, jointOf } from './recording.js';

// the kinds that keep or pull two points at a length
export const HAS_LENGTH = new Set(['distance', 'rope', 'spring']);

// Poses of bodies for the functions below: as displayed, between two frames, or at the earlier frame, where the forces
// are known.
export const displayedPoses = (snapshot) => (body) => ({ position: snapshot.position(body), orientation: snapshot.orientation(body) });
const framePoses = (snapshot) => (body) => ({ position: snapshot.vector(body, OFFSET.position), orientation: snapshot.frameOrientation(body) });

// the points of a joint on both bodies, and its axes, in world axes
export function placeOf(joint, poseOf) {
  const poses = joint.bodies.map((body) => (body === null ? null : poseOf(body)));
  const points = joint.anchors.map((anchor, side) => (poses[side] ? add(poses[side].position, rotate(poses[side].orientation, anchor)) : anchor));
  const axes = joint.axes?.map((axis, side) => (poses[side] ? rotate(poses[side].orientation, axis) : axis)) ?? null;
  return { points, axes };
}

export const hasLetGo = ({ until }, time) => until !== null && time >= until;

// unit of the coordinate of a joint: a ball joint and a hinge turn, a weld has none
export function coordinateUnit({ kind }) {
  if (kind === 'weld') return null;
  return kind === 'ball' || kind === 'hinge' ? 'rad' : 'm';
}

// Whether a rope hangs loose: it does not pull, and its points are nearer than its length. The tolerance covers single
// precision.
export function isSlack(joint, points, { force }) {
  return joint.kind === 'rope' && length(force) === 0 && length(sub(points[0], points[1])) < 0.9995 * joint.length;
}

// force and torque of a load at a time, in world axes, and the point where the force acts
export function loadAt(load, poseOf, time) {
  const { position, orientation } = poseOf(load.body);
  const turned = (v) => (load.in_body_axes ? rotate(orientation, v) : v);
  const factor = load.periodic ? Math.sin(2 * Math.PI * load.periodic[0] * time + load.periodic[1]) : 1;
  const force = load.table ? tableAt(load.table, time) : scale(load.force, factor);
  const arm = rotate(orientation, load.at);
  return { force: turned(force), torque: turned(scale(load.torque, factor)), arm, position, point: add(position, arm) };
}

// the force of a table of times and forces: linear in between, constant outside
function tableAt(rows, time) {
  const next = rows.findIndex(([t]) => t > time);
  if (next === 0) return rows[0].slice(1);
  if (next < 0) return rows.at(-1).slice(1);
  const [a, b] = [rows[next - 1], rows[next]];
  const part = (time - a[0]) / (b[0] - a[0]);
  return [1, 2, 3].map((k) => a[k] + part * (b[k] - a[k]));
}

// The force of all joints and loads on a body, and their torque about its centre of mass, at the frame of `snapshot`.
export function jointsAndLoads(body, snapshot, header) {
  let sum = { force: [0, 0, 0], torque: [0, 0, 0] };
  const include = (force, torque, arm) => {
    sum = { force: add(sum.force, force), torque: add(sum.torque, add(torque, cross(arm, force))) };
  };
  const poseOf = framePoses(snapshot);
  for (const index of header.jointsOf[body]) {
    const joint = header.joints[index];
    const { force, torque } = jointOf(snapshot.frame, index);
    // both bodies feel the opposite about the same point, which is that of the first body
    const sign = joint.bodies[0] === body ? 1 : -1;
    const arm = sub(placeOf(joint, poseOf).points[0], poseOf(body).position);
    include(scale(force, sign), scale(torque, sign), arm);
  }
  for (const index of header.loadsOf[body]) {
    const { force, torque, arm } = loadAt(header.loads[index], poseOf, snapshot.frame.time);
    include(force, torque, arm);
  }
  return sum;
}

// The direction of all hinges, if they are parallel: a mechanism in a plane is seen best along it. Otherwise null.
export function hingeDirection(header, snapshot) {
  const axes = header.joints.filter(({ kind }) => kind === 'hinge').map((joint) => placeOf(joint, displayedPoses(snapshot)).axes[0]);
  return axes.length && axes.every((axis) => Math.abs(dot(axis, axes[0])) > 0.999) ? axes[0] : null;
}

// whether there is something to draw, and what it is called
export const hasJointLayer = ({ joints, loads }) => joints.length + loads.length > 0;
export const jointLayerLabel = ({ joints, loads }) => (!loads.length ? 'Joints' : joints.length ? 'Joints, loads' : 'Loads');
