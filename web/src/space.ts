// The air from outside: where rays enter it, as the library's `Place::entry` has it, and the same in the shader.

import type { Vector } from "./directions";

const dot = (a: Vector, b: Vector) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** How far away (rad, at the planet's centre) rays enter a sphere at most; radii of it and of the observer. */
export function reach(top: number, eye: number): number {
  return Math.acos(Math.min(top / eye, 1));
}

/** Where a ray from `eye` (of the radius of the sphere, above it) enters it: the local elevation of the sun, and the
 * ray, from the sun's azimuth on; null where it passes by. */
export function entry(eye: number, ray: Vector, sun: Vector): { elevation: number; direction: Vector } | null {
  const nearest = eye * Math.hypot(ray[0], ray[1]);
  if (ray[2] >= 0 || nearest > 1) return null;
  const half = Math.sqrt((1 - nearest) * (1 + nearest));
  const distance = ((eye - 1) * (eye + 1)) / (half - eye * ray[2]);
  const from: Vector = [distance * ray[0], distance * ray[1], eye + distance * ray[2]];
  const length = Math.hypot(...from);
  const up = from.map((v) => v / length) as Vector;
  const sine = dot(up, sun);
  const level = (v: Vector, height: number) => v.map((part, i) => part - height * up[i]!) as Vector;
  const [own, light] = [level(ray, dot(ray, up)), level(sun, sine)];
  const cross: Vector = [
    own[1] * light[2] - own[2] * light[1],
    own[2] * light[0] - own[0] * light[2],
    own[0] * light[1] - own[1] * light[0],
  ];
  // Skies are the same on both sides of the sun.
  const azimuth = Math.atan2(Math.hypot(...cross), dot(own, light));
  const direction: Vector = [nearest * Math.cos(azimuth), nearest * Math.sin(azimuth), -half];
  return { elevation: Math.asin(Math.min(Math.max(sine, -1), 1)), direction };
}

export const SPACE_SHADER = `
uniform sampler2D space_roots;
uniform bool is_beyond;
uniform float eye;          // distance from the planet's centre, of that of where rays enter
uniform vec3 space_sun;     // towards the sun
uniform vec4 space_ends;    // dip, coordinates of the horizontal, nadir and the azimuth opposite to the sun
uniform vec2 space_layers;  // coordinate of the first, and their distance
uniform ivec3 space_counts; // intervals: layers, up, down
uniform int space_columns;
const float DEEPEST = -0.2095; // rad, below which a model has no sun

vec3 beyond(vec3 direction) {
  // Devices take sines and cosines lightly, and grazing rays do not forgive that.
  vec3 v = direction / length(direction);
  float nearest = eye * length(v.xy);
  if (v.z >= 0.0 || nearest >= 1.0) return vec3(0.0);
  float half_chord = sqrt((1.0 - nearest) * (1.0 + nearest));
  float distance = (eye - 1.0) * (eye + 1.0) / (half_chord - eye * v.z);
  vec3 up = normalize(vec3(distance * v.xy, eye + distance * v.z));
  float sine = clamp(dot(up, space_sun), -1.0, 1.0), elevation = asin(sine);
  if (elevation < DEEPEST) return vec3(0.0);
  vec3 own = v - dot(v, up) * up, light = space_sun - sine * up;
  float azimuth = atan(length(cross(own, light)) + 1e-20, dot(own, light));
  float height = space_ends.x - atan(half_chord, nearest);
  bool above = height >= 0.0;
  int rows = above ? space_counts.y : space_counts.z;
  float end = above ? space_ends.y : space_ends.z;
  float layer = (arsinh((elevation - radians(-2.0)) / radians(6.0)) - space_layers.x) / space_layers.y;
  int first_layer, first_row, first_column;
  vec4 by_layer = between(clamp(layer, 0.0, float(space_counts.x)), space_counts.x, false, first_layer);
  vec4 by_row = between(clamp(float(rows) * from_horizon(abs(height)) / end, 0.0, float(rows)), rows, false, first_row);
  float column = float(space_columns) * arsinh(azimuth / AZIMUTH_SCALE) / space_ends.w;
  vec4 by_column = between(clamp(column, 0.0, float(space_columns)), space_columns, true, first_column);
  vec3 root = vec3(0.0);
  for (int i = 0; i < 4; i++) {
    int z = clamp(first_layer + i, 0, space_counts.x) * (space_counts.y + space_counts.z + 2);
    for (int j = 0; j < 4; j++) {
      int y = z + clamp(first_row + j, 0, rows) + (above ? 0 : space_counts.y + 1);
      for (int k = 0; k < 4; k++) {
        int x = clamp(first_column + k, 0, space_columns);
        root += by_layer[i] * by_row[j] * by_column[k] * texelFetch(space_roots, ivec2(x, y), 0).rgb;
      }
    }
  }
  return root * root;
}
`;
