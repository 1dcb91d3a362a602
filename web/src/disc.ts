// The sun's disc in the picture: where it is, and how much of its light each pixel gets.

import { cameraAxes, place, type Vector } from "./directions";
import type { View } from "./view";

export const DISC_TERMS = 6;
export const DISC_ROWS = 65;

const RADIANS = Math.PI / 180;
/** Points on the limb whose places bound the disc in the picture. */
const LIMB = 48;
/** rad; a little more than the limb, for what a box of points leaves out. */
const RADIUS = 0.004654793 * 1.003;

export type Box = [left: number, below: number, right: number, above: number];

export function sunDirection({ sunElevation, sunAzimuth }: View, elevation = sunElevation * RADIANS): Vector {
  const level = Math.cos(elevation);
  return [level * Math.cos(sunAzimuth * RADIANS), level * Math.sin(sunAzimuth * RADIANS), Math.sin(elevation)];
}

/** Where the picture may show the disc of a sun, both coordinates −1 to 1 to the right and upwards; empty if nowhere. */
export function discBox(view: View, sun: Vector): Box {
  const box: Box = [Infinity, Infinity, -Infinity, -Infinity];
  const axes = cameraAxes(view);
  const level = Math.hypot(sun[0], sun[1]);
  const left: Vector = level > 0 ? [-sun[1] / level, sun[0] / level, 0] : [0, 1, 0];
  const up: Vector = [sun[1] * left[2] - sun[2] * left[1], sun[2] * left[0] - sun[0] * left[2], sun[0] * left[1] - sun[1] * left[0]];
  for (let i = 0; i < LIMB; i++) {
    const [s, c] = [Math.sin((2 * Math.PI * i) / LIMB), Math.cos((2 * Math.PI * i) / LIMB)];
    const point = sun.map((v, k) => v + RADIUS * (c * left[k]! + s * up[k]!)) as Vector;
    const at = place(view, axes, point);
    if (!at) continue;
    box[0] = Math.min(box[0], at[0]);
    box[1] = Math.min(box[1], at[1]);
    box[2] = Math.max(box[2], at[0]);
    box[3] = Math.max(box[3], at[1]);
  }
  return view.projection === "lat-long" ? aroundTheSphere(box, Math.asin(sun[2])) : box;
}

/** Across the edge of the map, and around its poles, the disc is in several places. */
function aroundTheSphere([left, below, right, above]: Box, elevation: number): Box {
  if (elevation + RADIUS > Math.PI / 2) return [-1, below, 1, 1];
  return right - left > 1 ? [-1, below, 1, above] : [left, below, right, above];
}

/** Parts of a box along each side, for a pixel that it covers: enough for a disc of 48 of them. */
export function discParts(box: Box, width: number, height: number): number {
  const pixels = Math.min(((box[2] - box[0]) / 2) * width, ((box[3] - box[1]) / 2) * height);
  return Math.min(Math.max(Math.ceil(48 / Math.max(pixels, 1e-3)), 4), 48);
}

export const DISC_SHADER = `
uniform sampler2D disc;
uniform vec4 disc_axis; // elevation of its first row, rows per radian, elevation of the horizon, chord of its radius
uniform vec3 disc_sun;
uniform vec4 disc_box;  // where it may be, in pixels
uniform int disc_parts;

vec3 disc_light(vec3 v) {
  vec3 way = (v - disc_sun) / disc_axis.w;
  float square = dot(way, way), elevation = atan(v.z, length(v.xy));
  if (square > 1.0 || elevation < disc_axis.z) return vec3(0.0);
  float mu = sqrt(1.0 - square);
  float u = clamp((elevation - disc_axis.x) * disc_axis.y, 0.0, ${(DISC_ROWS - 1).toFixed(1)});
  int row = min(int(u), ${DISC_ROWS - 2});
  vec3 sum = vec3(0.0);
  for (int k = ${DISC_TERMS - 1}; k >= 0; k--) {
    sum = sum * mu + mix(texelFetch(disc, ivec2(k, row), 0).rgb, texelFetch(disc, ivec2(k, row + 1), 0).rgb, u - float(row));
  }
  return max(sum, 0.0);
}

// Solid angle of a part of the picture, but for a factor.
float spread(vec3 local) {
  if (projection == 2) return length(local.xz);
  if (projection == 3) return local.z * local.z * local.z;
  float angle = acos(clamp(local.z, -1.0, 1.0));
  return angle > 1e-3 ? sin(angle) / angle : 1.0;
}

// The mean over the pixel. What the box leaves of it is divided into parts.
vec3 disc_mean() {
  vec2 low = max(gl_FragCoord.xy - 0.5, disc_box.xy), step = min(gl_FragCoord.xy + 0.5, disc_box.zw) - low;
  if (disc_axis.y <= 0.0 || step.x <= 0.0 || step.y <= 0.0) return vec3(0.0);
  vec3 sum = vec3(0.0), local;
  float whole = 0.0;
  for (int i = 0; i < 9; i++) {
    if (look(gl_FragCoord.xy + (vec2(i % 3, i / 3) - 1.0) / 3.0, local)) whole += spread(local) / 9.0;
  }
  step /= float(disc_parts);
  for (int i = 0; i < disc_parts; i++) {
    for (int j = 0; j < disc_parts; j++) {
      if (!look(low + step * (vec2(i, j) + 0.5), local)) continue;
      vec3 v = axes * local;
      if (is_open(v)) sum += spread(local) * disc_light(v);
    }
  }
  return whole > 0.0 ? sum * step.x * step.y / whole : vec3(0.0);
}
`;
