// Vectors [x, y, z], quaternions [w, x, y, z] and 4×4 matrices (Float32Array, column by column).

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
export const isFiniteVector = (a) => Number.isFinite(a[0] + a[1] + a[2]);

export function normalize(a) {
  const l = length(a);
  return l > 0 ? scale(a, 1 / l) : [0, 0, 0];
}

// a unit vector perpendicular to `a`
export function perpendicular(a) {
  const [x, y, z] = a.map(Math.abs);
  const other = x <= y && x <= z ? [1, 0, 0] : y <= z ? [0, 1, 0] : [0, 0, 1];
  return normalize(cross(a, other));
}

// the vector `v` rotated by the quaternion `q`
export function rotate(q, v) {
  const [w, x, y, z] = q;
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [
    v[0] + w * t[0] + y * t[2] - z * t[1],
    v[1] + w * t[1] + z * t[0] - x * t[2],
    v[2] + w * t[2] + x * t[1] - y * t[0],
  ];
}

export const conjugate = (q) => [q[0], -q[1], -q[2], -q[3]];

export function multiplyQuaternions(a, b) {
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
    a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
    a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
  ];
}

// spherical linear interpolation from `a` (t = 0) to `b` (t = 1) along the shorter arc
export function slerp(a, b, t) {
  let d = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const sign = d < 0 ? -1 : 1;
  d = Math.abs(d);
  let s = 1 - t;
  let r = t;
  if (d < 0.995) {
    const angle = Math.acos(d);
    s = Math.sin(s * angle) / Math.sin(angle);
    r = Math.sin(t * angle) / Math.sin(angle);
  }
  const q = [0, 1, 2, 3].map((i) => s * a[i] + sign * r * b[i]);
  const l = Math.hypot(...q) || 1;
  return q.map((x) => x / l);
}

export function multiply(a, b) {
  const m = new Float32Array(16);
  for (let c = 0; c < 4; c++) {
    for (let r = 0; r < 4; r++) {
      let sum = 0;
      for (let k = 0; k < 4; k++) sum += a[4 * k + r] * b[4 * c + k];
      m[4 * c + r] = sum;
    }
  }
  return m;
}

// a perspective projection; `fov` is the vertical field of view (rad)
export function perspective(fov, aspect, near, far) {
  const f = 1 / Math.tan(fov / 2);
  const m = new Float32Array(16);
  m[0] = f / aspect;
  m[5] = f;
  m[10] = (far + near) / (near - far);
  m[11] = -1;
  m[14] = (2 * far * near) / (near - far);
  return m;
}

// the view matrix of a camera at `eye` with these axes
export function viewMatrix(eye, right, up, back) {
  const m = new Float32Array(16);
  [right, up, back].forEach((axis, row) => {
    for (let c = 0; c < 3; c++) m[4 * c + row] = axis[c];
    m[12 + row] = -dot(axis, eye);
  });
  m[15] = 1;
  return m;
}

// the clip coordinates [x, y, z, w] of the point `p`
export function transform(m, p) {
  return [0, 1, 2, 3].map((r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]);
}
