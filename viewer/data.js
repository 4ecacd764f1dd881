// The data of a run: the head (JSON) and the frames (binary records).

import { slerp } from './math.js';

const LEDGER_SIZE = 10; // doubles: time, step, eight columns of the ledger
export const BODY_SIZE = 22; // floats a body

// where each quantity of a body begins in its floats
export const AT = { position: 0, orientation: 3, velocity: 7, spin: 10, momentum: 13, force: 16, torque: 19 };

export function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  // in parts: a string of all bytes at once may be too long
  const clean = text.trim();
  const bytes = new Uint8Array(Math.floor((clean.length * 3) / 4));
  let at = 0;
  for (let from = 0; from < clean.length; from += 1 << 16) {
    const part = atob(clean.slice(from, from + (1 << 16)));
    for (let i = 0; i < part.length; i++) bytes[at++] = part.charCodeAt(i);
  }
  return bytes.subarray(0, at);
}

const floats = (text) => new Float32Array(bytesOfBase64(text).slice().buffer);
const indices = (text) => new Uint32Array(bytesOfBase64(text).slice().buffer);

// the head with its shapes decoded
export function decodeHead(head) {
  const shapes = head.shapes.map((shape) => {
    const vertices = floats(shape.vertices);
    const particles = shape.particles === null ? vertices : floats(shape.particles);
    return { ...shape, vertices, triangles: indices(shape.triangles), particles };
  });
  return { ...head, shapes, boxPlanes: head.box ? boxPlanes(head) : [] };
}

// which walls are faces of the box: they come first, in the order of the faces that are there
function boxPlanes(head) {
  return head.walls.slice(0, 6 - head.box.open.length);
}

// one record as views into its bytes
export function decodeFrame(buffer, offset, bodyCount) {
  const head = new Float64Array(buffer, offset, LEDGER_SIZE);
  return {
    time: head[0],
    step: head[1],
    ledger: head.subarray(2),
    bodies: new Float32Array(buffer, offset + 8 * LEDGER_SIZE, BODY_SIZE * bodyCount),
  };
}

export const frameSize = (bodyCount) => 8 * LEDGER_SIZE + 4 * BODY_SIZE * bodyCount;

// the frames of a run, or what a live one has sent so far
export class Film {
  constructor(bodyCount) {
    this.bodyCount = bodyCount;
    this.frames = [];
    // where it began, though a live film may have dropped it since
    this.first = null;
    // a live run goes on for ever: keep what fits into some tens of megabytes
    this.most = Math.max(64, Math.min(20000, Math.floor(4e7 / frameSize(bodyCount))));
    this.dropped = 0;
  }

  static ofBytes(bytes, bodyCount) {
    const film = new Film(bodyCount);
    const size = frameSize(bodyCount);
    const buffer = bytes.slice().buffer;
    for (let offset = 0; offset + size <= buffer.byteLength; offset += size) {
      film.frames.push(decodeFrame(buffer, offset, bodyCount));
    }
    film.first = film.frames[0] ?? null;
    return film;
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

  // one more live frame; false if it is none
  push(buffer) {
    if (buffer.byteLength !== frameSize(this.bodyCount)) return false;
    const frame = decodeFrame(buffer, 0, this.bodyCount);
    if (this.length && frame.time < this.end) this.clear();
    // the same moment once more (a pause): the newer one counts
    if (this.length && frame.time === this.end) this.frames.pop();
    if (!this.length) this.first = frame;
    this.frames.push(frame);
    if (this.length > this.most) {
      const count = this.most >> 2;
      this.frames.splice(0, count);
      this.dropped += count;
    }
    return true;
  }

  clear() {
    this.frames.length = 0;
    this.dropped = 0;
  }

  // the last frame at or before a time
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

// The bodies at one time: places and turns between two frames, all else from the frame before.
export class Moment {
  constructor(bodyCount) {
    this.bodyCount = bodyCount;
    this.pose = new Float32Array(7 * bodyCount);
    this.frame = null;
    this.index = 0;
    this.time = 0;
  }

  set(film, time) {
    if (!film.length) {
      this.frame = null;
      return;
    }
    const index = film.indexAt(time);
    const a = film.frames[index];
    const b = film.frames[Math.min(index + 1, film.length - 1)];
    const span = b.time - a.time;
    const t = span > 0 ? Math.min(Math.max((time - a.time) / span, 0), 1) : 0;
    this.frame = a;
    this.index = index;
    this.time = time;
    for (let body = 0; body < this.bodyCount; body++) {
      this.blend(body, a.bodies, b.bodies, t);
    }
  }

  blend(body, a, b, t) {
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

  // a vector of the frame: AT.velocity, AT.force, …
  vector(body, at) {
    const from = BODY_SIZE * body + at;
    return Array.from(this.frame.bodies.subarray(from, from + 3));
  }

  // orientation at the frame before
  turnOf(body) {
    const from = BODY_SIZE * body + AT.orientation;
    return Array.from(this.frame.bodies.subarray(from, from + 4));
  }
}
