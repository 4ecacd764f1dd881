// The GLSL shaders.

const PREAMBLE = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2DShadow;
`;

const ROTATE = `
vec3 rotate(vec4 q, vec3 v) {
  vec3 t = 2.0 * cross(q.yzw, v);
  return v + q.x * t + cross(q.yzw, t);
}
`;

// sunlight at a point, from 0 in shadow to 1, by percentage-closer filtering of the shadow map
const SHADOW = `
uniform mat4 lightMatrix;
uniform sampler2DShadow shadowMap;
uniform int taps;
uniform float softness;
uniform float texel;
float sunlight(vec3 position, vec3 normal, vec3 sun) {
  if (taps == 0) return 1.0;
  float slant = 1.0 - max(dot(normal, sun), 0.0);
  vec4 at = lightMatrix * vec4(position + normal * texel * (1.0 + 2.5 * slant), 1.0);
  vec3 p = 0.5 * at.xyz / at.w + 0.5;
  if (any(lessThan(p.xy, vec2(0.0))) || any(greaterThan(p.xy, vec2(1.0))) || p.z > 1.0) return 1.0;
  float sum = 0.0;
  // the sampling pattern is rotated by a different angle in each pixel: noise instead of bands
  float start = 6.2832 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  for (int i = 0; i < 32; i++) {
    if (i >= taps) break;
    float r = sqrt((float(i) + 0.5) / float(taps));
    float a = start + 2.399963 * float(i);
    sum += texture(shadowMap, vec3(p.xy + softness * r * vec2(cos(a), sin(a)), p.z));
  }
  return sum / float(taps);
}
`;

const LIGHT = `
uniform vec3 eye;
uniform vec3 up;
uniform vec3 sun;
uniform vec3 skyColour;
uniform vec3 groundColour;
uniform vec3 sunColour;
vec3 shade(vec3 colour, vec3 position, vec3 n, float light) {
  vec3 base = pow(colour, vec3(2.2));
  vec3 toEye = normalize(eye - position);
  float facing = max(dot(n, sun), 0.0);
  vec3 ambient = mix(groundColour, skyColour, 0.5 + 0.5 * dot(n, up));
  vec3 halfway = normalize(sun + toEye);
  float shine = pow(max(dot(n, halfway), 0.0), 48.0) * facing;
  float rim = pow(1.0 - max(dot(n, toEye), 0.0), 4.0);
  vec3 sum = base * (ambient + sunColour * facing * light * 1.25) + 0.16 * shine * light + 0.07 * rim * skyColour;
  return pow(sum, vec3(1.0 / 2.2));
}
`;

const POSE = `
layout(location = 4) in vec4 bodyPosition;     // w: highlight, from 0 to 1
layout(location = 5) in vec4 bodyOrientation;  // quaternion w x y z
layout(location = 6) in vec4 bodyColour;       // w: 1 with markings, 2 if fixed or prescribed
`;

export const BODY_VERTEX = `${PREAMBLE}${ROTATE}${POSE}
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 viewProjection;
out vec3 worldPosition;
out vec3 localPosition;
out vec3 worldNormal;
flat out vec4 surfaceColour;
flat out float highlight;
void main() {
  localPosition = position;
  worldPosition = bodyPosition.xyz + rotate(bodyOrientation, position);
  worldNormal = rotate(bodyOrientation, normal);
  surfaceColour = bodyColour;
  highlight = bodyPosition.w;
  gl_Position = viewProjection * vec4(worldPosition, 1.0);
}`;

export const BODY_FRAGMENT = `${PREAMBLE}${SHADOW}${LIGHT}
in vec3 worldPosition;
in vec3 localPosition;
in vec3 worldNormal;
flat in vec4 surfaceColour;
flat in float highlight;
uniform float prescribedPass; // 1: draw fixed and prescribed bodies, transparent; 0: draw all others
out vec4 result;
float side(float x) {
  return clamp(x / max(fwidth(x), 1e-6), -1.0, 1.0);
}
void main() {
  bool isPrescribed = surfaceColour.a > 1.5;
  if (isPrescribed != (prescribedPass > 0.5)) discard;
  vec3 n = normalize(gl_FrontFacing ? worldNormal : -worldNormal);
  // markings: every second octant is darker
  float octant = side(localPosition.x) * side(localPosition.y) * side(localPosition.z);
  vec3 colour = surfaceColour.rgb * (1.0 - (isPrescribed ? 0.0 : surfaceColour.a) * (0.13 - 0.13 * octant));
  float light = sunlight(worldPosition, n, sun);
  vec3 lit = shade(colour, worldPosition, n, light);
  float rim = pow(1.0 - max(dot(n, normalize(eye - worldPosition)), 0.0), 2.0);
  vec3 shown = mix(lit, vec3(1.0), highlight * (0.06 + 0.5 * rim));
  // like glass: transparent where seen frontally, opaque at grazing angles
  float alpha = isPrescribed ? 0.16 + 0.4 * rim : 1.0;
  result = vec4(alpha * shown, alpha);
}`;

// transparent bodies cast no shadow
export const DEPTH_FRAGMENT = `${PREAMBLE}
flat in vec4 surfaceColour;
void main() { if (surfaceColour.a > 1.5) discard; }`;

export const EDGE_VERTEX = `${PREAMBLE}${ROTATE}${POSE}
layout(location = 0) in vec3 position;
uniform mat4 viewProjection;
void main() {
  gl_Position = viewProjection * vec4(bodyPosition.xyz + rotate(bodyOrientation, position), 1.0);
  gl_Position.z -= 2e-4 * gl_Position.w;
}`;

export const EDGE_FRAGMENT = `${PREAMBLE}
uniform vec4 ink;
out vec4 result;
void main() { result = ink; }`;

// Particles as small spheres, coloured by the force k δ if they are behind a wall.
export const PARTICLE_VERTEX = `${PREAMBLE}${ROTATE}${POSE}
layout(location = 0) in vec3 position;
uniform mat4 viewProjection;
uniform vec4 walls[32];      // normal, offset
uniform float stiffness[32];
uniform int wallCount;
uniform float maxForce;
uniform float radius;
uniform vec2 viewport;
uniform float zoom;
uniform vec3 freeColour;
uniform int ownColour;
flat out vec3 surfaceColour;
void main() {
  vec3 at = bodyPosition.xyz + rotate(bodyOrientation, position);
  float force = 0.0;
  for (int i = 0; i < 32; i++) {
    if (i >= wallCount) break;
    force = max(force, stiffness[i] * (walls[i].w - dot(walls[i].xyz, at)));
  }
  float t = clamp(sqrt(force / maxForce), 0.0, 1.0);
  vec3 ramp = t < 0.5 ? mix(vec3(0.96, 0.78, 0.26), vec3(0.88, 0.42, 0.1), 2.0 * t)
                      : mix(vec3(0.88, 0.42, 0.1), vec3(0.62, 0.06, 0.24), 2.0 * t - 1.0);
  surfaceColour = force > 0.0 ? ramp : ownColour == 1 ? bodyColour.rgb : freeColour;
  gl_Position = viewProjection * vec4(at, 1.0);
  float size = (force > 0.0 ? 1.5 : 1.0) * radius * zoom * viewport.y / gl_Position.w;
  gl_PointSize = clamp(size, force > 0.0 ? 4.0 : 2.0, 64.0);
  gl_Position.z -= (force > 0.0 ? 2e-3 : 5e-4) * gl_Position.w;
}`;

export const PARTICLE_FRAGMENT = `${PREAMBLE}
flat in vec3 surfaceColour;
out vec4 result;
void main() {
  vec2 p = 2.0 * gl_PointCoord - 1.0;
  float r = dot(p, p);
  if (r > 1.0) discard;
  float light = 0.72 + 0.36 * dot(vec3(p.x, -p.y, sqrt(1.0 - r)), vec3(-0.35, 0.6, 0.72));
  result = vec4(surfaceColour * light, 1.0);
}`;

// One face of the box, or a plane that fades out with distance.
export const WALL_VERTEX = `${PREAMBLE}
layout(location = 0) in vec2 corner;
uniform mat4 viewProjection;
uniform vec3 middle;
uniform vec3 across;
uniform vec3 along;
out vec3 worldPosition;
out vec2 onWall;
out vec2 onFace;
uniform vec2 shift;
void main() {
  onFace = corner;
  onWall = vec2(corner.x * length(across), corner.y * length(along)) + shift;
  worldPosition = middle + corner.x * across + corner.y * along;
  gl_Position = viewProjection * vec4(worldPosition, 1.0);
}`;

export const WALL_FRAGMENT = `${PREAMBLE}${SHADOW}
uniform vec3 normal;
uniform vec3 sun;
uniform vec3 floorColour;
uniform vec3 gridColour;
uniform float opacity;
uniform float shade;
uniform float gridSize;
uniform float gridInk;
uniform float fade;
uniform vec3 eye;
in vec3 worldPosition;
in vec2 onWall;
in vec2 onFace;
out vec4 result;
float lines(vec2 p) {
  vec2 width = max(fwidth(p), 1e-6);
  vec2 near = abs(fract(p - 0.5) - 0.5) / width;
  vec2 line = clamp(1.0 - near * 0.9, 0.0, 1.0) * clamp(1.2 - 3.0 * width, 0.0, 1.0);
  return max(line.x, line.y);
}
void main() {
  float open = dot(normal, sun) > 0.02 ? sunlight(worldPosition, normal, sun) : 1.0;
  float dark = shade * (1.0 - open);
  float ink = gridInk * max(0.55 * lines(onWall / gridSize), lines(onWall / (5.0 * gridSize)));
  float far = length(onFace);
  float edge = fade > 0.0 ? 1.0 - smoothstep(0.15, 1.0, far) : 1.0;
  // the floor, the grid lines on it, and the shadow over both
  vec3 colour = mix(floorColour, gridColour, ink / max(opacity + ink, 1e-4));
  float cover = opacity + (1.0 - opacity) * ink;
  float all = cover + (1.0 - cover) * dark;
  colour = mix(colour, colour * (1.0 - dark), opacity);
  colour = mix(colour, vec3(0.0), (1.0 - opacity) * dark / max(all, 1e-4));
  result = vec4(colour * all, all) * edge;
}`;

// A thick line from a to b, straight on the screen.
export const LINE_VERTEX = `${PREAMBLE}
layout(location = 0) in vec2 corner;
layout(location = 1) in vec3 from;
layout(location = 2) in vec3 to;
uniform mat4 viewProjection;
uniform vec2 viewport;
uniform float width;
uniform float first;
uniform float count;
out float across;
out float age;
void main() {
  vec4 a = viewProjection * vec4(from, 1.0);
  vec4 b = viewProjection * vec4(to, 1.0);
  // clip the ends behind the eye
  float near = 1e-3;
  if (a.w < near && b.w > near) a = mix(a, b, (near - a.w) / (b.w - a.w));
  if (b.w < near && a.w > near) b = mix(b, a, (near - b.w) / (a.w - b.w));
  vec2 p = a.xy / a.w * viewport;
  vec2 q = b.xy / b.w * viewport;
  vec2 d = q - p;
  float l = length(d);
  vec2 n = l > 1e-4 ? vec2(-d.y, d.x) / l : vec2(0.0, 1.0);
  vec4 at = corner.x < 0.5 ? a : b;
  float w = width + 1.0;
  vec2 cap = l > 1e-4 ? d / l * (corner.x - 0.5) * width : vec2(0.0);
  at.xy += (n * corner.y * w + cap) / viewport * at.w;
  at.z -= 1e-4 * at.w;
  across = corner.y * w;
  age = count > 0.0 ? (first + float(gl_InstanceID) + corner.x) / count : 1.0;
  gl_Position = a.w < near && b.w < near ? vec4(2.0, 2.0, 2.0, 1.0) : at;
}`;

export const LINE_FRAGMENT = `${PREAMBLE}
uniform vec4 ink;
uniform float width;
in float across;
in float age;
out vec4 result;
void main() {
  float soft = clamp(width + 0.5 - abs(across), 0.0, 1.0);
  float a = ink.a * soft * mix(0.18, 1.0, age * age);
  result = vec4(ink.rgb * a, a);
}`;

export const ARROW_VERTEX = `${PREAMBLE}
layout(location = 0) in vec4 profile;   // x, along the shaft, z, along the head
layout(location = 1) in vec3 normal;
layout(location = 4) in vec4 origin;    // w: length of the arrow
layout(location = 5) in vec4 direction; // w: radius of the shaft
layout(location = 6) in vec4 colour;
uniform mat4 viewProjection;
uniform float headed;                   // 1: arrows, 0: rods
out vec3 worldPosition;
out vec3 worldNormal;
out vec4 surfaceColour;
void main() {
  vec3 d = direction.xyz;
  vec3 other = abs(d.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 u = normalize(cross(other, d));
  vec3 v = cross(d, u);
  float thick = direction.w;
  float head = headed * min(7.0 * thick, 0.6 * origin.w);
  float slim = mix(1.0, head / (7.0 * thick), headed);
  float along = profile.y * (origin.w - head) + profile.w * mix(thick, head, headed);
  worldPosition = origin.xyz + thick * slim * (profile.x * u + profile.z * v) + along * d;
  worldNormal = normal.x * u + normal.y * d + normal.z * v;
  surfaceColour = colour;
  gl_Position = viewProjection * vec4(worldPosition, 1.0);
}`;

export const ARROW_FRAGMENT = `${PREAMBLE}${LIGHT}
uniform float strength;
in vec3 worldPosition;
in vec3 worldNormal;
in vec4 surfaceColour;
out vec4 result;
void main() {
  vec3 n = normalize(worldNormal);
  float light = 0.74 + 0.38 * dot(n, normalize(sun + 0.5 * normalize(eye - worldPosition)));
  float a = surfaceColour.a * strength;
  result = vec4(surfaceColour.rgb * light * a, a);
}`;

export const ELLIPSOID_VERTEX = `${PREAMBLE}${ROTATE}
layout(location = 0) in vec3 position;
uniform mat4 viewProjection;
uniform vec3 centre;
uniform vec4 orientation;
uniform vec3 axes;
out vec3 worldPosition;
out vec3 worldNormal;
out vec3 onSphere;
void main() {
  onSphere = position;
  worldPosition = centre + rotate(orientation, axes * position);
  worldNormal = rotate(orientation, position / axes);
  gl_Position = viewProjection * vec4(worldPosition, 1.0);
}`;

export const ELLIPSOID_FRAGMENT = `${PREAMBLE}${LIGHT}
uniform vec3 tint;
in vec3 worldPosition;
in vec3 worldNormal;
in vec3 onSphere;
out vec4 result;
void main() {
  vec3 n = normalize(worldNormal);
  float rim = 1.0 - abs(dot(n, normalize(eye - worldPosition)));
  // lines where the planes of the principal axes cut the surface
  vec3 near = abs(onSphere) / max(fwidth(onSphere), vec3(1e-5));
  float line = 1.0 - clamp(min(near.x, min(near.y, near.z)) - 0.4, 0.0, 1.0);
  float a = 0.10 + 0.45 * rim * rim + 0.45 * line;
  result = vec4(tint * a, a);
}`;

export const SKY_VERTEX = `${PREAMBLE}
layout(location = 0) in vec2 corner;
out float height;
void main() {
  height = 0.5 * corner.y + 0.5;
  gl_Position = vec4(corner, 1.0, 1.0);
}`;

export const SKY_FRAGMENT = `${PREAMBLE}
uniform vec3 top;
uniform vec3 bottom;
in float height;
out vec4 result;
void main() {
  // noise against banding with eight bits per colour
  float grain = fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.0671, 0.00584)))) - 0.5;
  result = vec4(mix(bottom, top, smoothstep(0.0, 1.0, height)) + grain / 255.0, 1.0);
}`;
