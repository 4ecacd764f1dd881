// The data of a run: header (JSON), frames (binary records), and the state at a time between two frames.

import { slerp } from './math.js';

const LEDGER_SIZE = 13; // doubles per frame: time, step, eleven columns of the energy ledger
export const BODY_SIZE = 22; // floats per body
const JOINT_SIZE = 8; // floats per joint: force and torque on its first body, coordinate, rate

// offset of each quantity in the floats of a body
export const OFFSET = { position: 0, orientation: 3, velocity: 7, angularVelocity: 10, angularMomentum: 13, force: 16, torque: 19 };

export function decodeBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  // in blocks, since a string of all bytes could exceed the maximum string length
  const clean = text.trim();
  const bytes = new Uint8Array(Math.floor((clean.length * 3) / 4));
  let offset = 0;
  for (let start = 0; start < clean.length; start += 1 << 16) {
    const block = atob(clean.slice(start, start + (1 << 16)));
    for (let i = 0; i < block.length; i++) bytes[offset++] = block.charCodeAt(i);
  }
  return bytes.subarray(0, offset);
}

const floats = (text) => new Float32Array(decodeBase64(text).slice().buffer);
const indices = (text) => new Uint32Array(decodeBase64(text).slice().buffer);

// the header with decoded shapes, and the indices of the joints and loads of each body
export function decodeHeader(header) {
  const shapes = header.shapes.map((shape) => {
    const vertices = floats(shape.vertices);
    const particles = shape.particles === null ? vertices : floats(shape.particles);
    return { ...shape, vertices, triangles: indices(shape.triangles), particles };
  });
  const jointsOf = header.bodies.map(() => []);
  const loadsOf = header.bodies.map(() => []);
  header.joints.forEach(({ bodies }, joint) => bodies.forEach((body) => jointsOf[body]?.push(joint)));
  header.loads.forEach(({ body }, load) => loadsOf[body].push(load));
  return { ...header, shapes, jointsOf, loadsOf, boxPlanes: header.box ? boxPlanes(header) : [] };
}

// the walls that are faces of the box: they come first
function boxPlanes(header) {
  return header.walls.slice(0, 6 - header.box.open.length);
}

// a frame as typed-array views into the buffer
export function decodeFrame(buffer, offset, bodyCount, jointCount) {
  const numbers = new Float64Array(buffer, offset, LEDGER_SIZE);
  const bodies = offset + 8 * LEDGER_SIZE;
  return {
    time: numbers[0],
    step: numbers[1],
    ledger: numbers.subarray(2),
    bodies: new Float32Array(buffer, bodies, BODY_SIZE * bodyCount),
    joints: new Float32Array(buffer, bodies + 4 * BODY_SIZE * bodyCount, JOINT_SIZE * jointCount),
  };
}

// bytes of one frame: a multiple of eight, as the doubles of the next frame require
export const frameSize = (bodyCount, jointCount) => 8 * LEDGER_SIZE + 4 * BODY_SIZE * bodyCount + 4 * JOINT_SIZE * jointCount;

// what a joint did in the step before a frame
export function jointOf(frame, joint) {
  const [fx, fy, fz, tx, ty, tz, coordinate, rate] = frame.joints.subarray(JOINT_SIZE * joint, JOINT_SIZE * (joint + 1));
  return { force: [fx, fy, fz], torque: [tx, ty, tz], coordinate, rate };
}

// The frames of a finished run, or those received from a live run so far.
export class Recording {
  constructor(bodyCount, jointCount) {
    this.bodyCount = bodyCount;
    this.jointCount = jointCount;
    this.frames = [];
    // the first frame, which is kept when it is dropped from `frames`
    this.first = null;
    // a live run has no end: keep about 40 MB
    this.maxFrames = Math.max(64, Math.min(20000, Math.floor(4e7 / frameSize(bodyCount, jointCount))));
    this.dropped = 0;
  }

  static fromBytes(bytes, bodyCount, jointCount) {
    const recording = new Recording(bodyCount, jointCount);
    const size = frameSize(bodyCount, jointCount);
    const buffer = bytes.slice().buffer;
    for (let offset = 0; offset + size <= buffer.byteLength; offset += size) {
      recording.frames.push(decodeFrame(buffer, offset, bodyCount, jointCount));
    }
    recording.first = recording.frames[0] ?? null;
    return recording;
  }

  get length() {
    return this.frames.length;
  }

  get start() {
    return this.length ? this.frames[0].time : 0;
  }

  get end() {
    return this.length ? this.frames[this.length - 1].time : 0;
  }

  // adds a frame of a live run; returns false if its size is wrong
  push(buffer) {
    if (buffer.byteLength !== frameSize(this.bodyCount, this.jointCount)) return false;
    const frame = decodeFrame(buffer, 0, this.bodyCount, this.jointCount);
    if (this.length && frame.time < this.end) this.clear();
    // a frame of the same time replaces the last one
    if (this.length && frame.time === this.end) this.frames.pop();
    if (!this.length) this.first = frame;
    this.frames.push(frame);
    if (this.length > this.maxFrames) {
      const count = this.maxFrames >> 2;
      this.frames.splice(0, count);
      this.dropped += count;
    }
    return true;
  }

  clear() {
    this.frames.length = 0;
    this.dropped = 0;
  }

  // index of the last frame at or before a time
  indexAt(time) {
    let low = 0;
    let high = this.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.frames[middle].time <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }
}

// The bodies at one time. Poses are interpolated between two frames; all else is from the earlier frame.
export class Snapshot {
  constructor(bodyCount) {
    this.bodyCount = bodyCount;
    this.pose = new Float32Array(7 * bodyCount);
    this.frame = null;
    this.index = 0;
    this.time = 0;
  }

  set(recording, time) {
    if (!recording.length) {
      this.frame = null;
      return;
    }
    const index = recording.indexAt(time);
    const a = recording.frames[index];
    const b = recording.frames[Math.min(index + 1, recording.length - 1)];
    const span = b.time - a.time;
    const t = span > 0 ? Math.min(Math.max((time - a.time) / span, 0), 1) : 0;
    this.frame = a;
    this.index = index;
    this.time = time;
    for (let body = 0; body < this.bodyCount; body++) {
      this.interpolate(body, a.bodies, b.bodies, t);
    }
  }

  interpolate(body, a, b, t) {
    const from = BODY_SIZE * body;
    const to = 7 * body;
    if (t < 1e-6) {
      for (let i = 0; i < 7; i++) this.pose[to + i] = a[from + i];
      return;
    }
    for (let i = 0; i < 3; i++) this.pose[to + i] = a[from + i] + t * (b[from + i] - a[from + i]);
    const q = slerp(a.subarray(from + 3, from + 7), b.subarray(from + 3, from + 7), t);
    this.pose.set(q, to + 3);
  }

  position(body) {
    return Array.from(this.pose.subarray(7 * body, 7 * body + 3));
  }

  orientation(body) {
    return Array.from(this.pose.subarray(7 * body + 3, 7 * body + 7));
  }

  // a vector of the earlier frame, such as OFFSET.velocity
  vector(body, offset) {
    const from = BODY_SIZE * body + offset;
    return Array.from(this.frame.bodies.subarray(from, from + 3));
  }

  // orientation at the earlier frame
  frameOrientation(body) {
    const from = BODY_SIZE * body + OFFSET.orientation;
    return Array.from(this.frame.bodies.subarray(from, from + 4));
  }
}
