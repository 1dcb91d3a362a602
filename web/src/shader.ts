// The sky in a shader. Directions are those of `directions.ts`, the table's coordinates those of `welkin.h` (the
// comment above its baked skies), colours and tone curves those of `welkin render`.

import { HOSEK_SHADER } from "./hosek";
import { SPACE_SHADER } from "./space";
import { DISC_SHADER } from "./disc";
import { TERRAIN_SHADER } from "./terrain";

export const VERTEX = `#version 300 es
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}`;

const UNIFORMS = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D roots, degrees, moon_roots, moon_degrees;
uniform vec2 size;
uniform int projection; // up, side, lat-long, perspective
uniform mat3 axes;      // right, above, ahead
uniform float half_field;
// Of sun and moon: dip, height above the horizon, coordinates of it and of half of it.
uniform vec4 sun_horizon, moon_horizon;
uniform vec3 sun_ends, moon_ends;           // coordinates of zenith, nadir and the azimuth opposite to the light
uniform ivec3 sun_intervals, moon_intervals; // none: the light is not there
uniform vec2 sun_azimuth, moon_azimuth;     // cosine and sine
uniform int quantity;   // radiance, degree of polarisation
uniform float polariser; // rad
uniform bool has_polariser;
uniform float white;    // cd m^-2
uniform int tone;       // linear, filmic, ACES; -1 leaves light as it is
uniform bool is_daylight;
out vec4 colour;
const float PI = 3.14159265358979;
`;

const DIRECTIONS = `
// Of a place in pixels.
bool look(vec2 pixel, out vec3 local) {
  vec2 place = pixel / size * 2.0 - 1.0;
  if (projection == 2) {
    vec2 angle = vec2(place.x * PI, place.y * 0.5 * PI);
    local = vec3(cos(angle.y) * sin(angle.x), sin(angle.y), cos(angle.y) * cos(angle.x));
    return true;
  }
  if (projection == 3) {
    local = normalize(vec3(place.x * half_field * 1.5, place.y * half_field, 1.0));
    return true;
  }
  float radius = length(place);
  float angle = radius * 0.5 * PI;
  local = vec3(place * (radius > 0.0 ? sin(angle) / radius : 0.0), cos(angle));
  return radius < 1.0;
}
`;

const TABLE = `
const float HEIGHT_SCALE = 0.06;
const float AZIMUTH_SCALE = 0.8;

float from_horizon(float angle) {
  float x = angle / HEIGHT_SCALE;
  return log(1.0 + 2.0 * x + 2.0 * sqrt(x * (x + 1.0)));
}

float arsinh(float x) { return sign(x) * log(abs(x) + sqrt(x * x + 1.0)); }

float up_coordinate(float height, vec4 horizon) {
  if (height < 0.5 * horizon.y) return from_horizon(height);
  return horizon.z + arsinh((height - horizon.y) / HEIGHT_SCALE);
}

// Weights of four neighbours, and where the first stands. Slopes are those of parabolas, or 0 at ends that are level.
vec4 between(float coordinate, int count, bool is_level, out int first_node) {
  int cell = min(int(coordinate), count - 1);
  float t = coordinate - float(cell);
  float first = t * (1.0 - t) * (1.0 - t), second = t * t * (t - 1.0);
  float rise = t * t * (3.0 - 2.0 * t);
  vec4 w = vec4(0.0, 1.0 - rise, rise, 0.0);
  if (cell > 0) w += first * vec4(-0.5, 0.0, 0.5, 0.0);
  else if (!is_level) w += first * vec4(0.0, -1.5, 2.0, -0.5);
  if (cell + 1 < count) w += second * vec4(0.0, -0.5, 0.0, 0.5);
  else if (!is_level) w += second * vec4(0.5, -2.0, 1.5, 0.0);
  first_node = cell - 1;
  return w;
}

// Stokes components of X, Y and Z; the frame is the vertical one.
struct Light { vec3 xyz, q, u; };

struct Table {
  vec4 horizon;
  vec3 ends;
  ivec3 intervals;
  vec2 azimuth;
};

// Row and column of a direction; and 1 below the horizon.
vec3 place_in(Table of, vec3 v) {
  float height = atan(v.z, length(v.xy)) + of.horizon.x;
  float along = dot(v.xy, of.azimuth), across = v.y * of.azimuth.x - v.x * of.azimuth.y;
  bool up = height >= 0.0;
  int rows = up ? of.intervals.x : of.intervals.y;
  float end = up ? of.ends.x : of.ends.y;
  float coordinate = up ? up_coordinate(height, of.horizon) : from_horizon(-height);
  float row = clamp(float(rows) * coordinate / end, 0.0, float(rows));
  float azimuth = arsinh(atan(abs(across), along) / AZIMUTH_SCALE);
  float column = clamp(float(of.intervals.z) * azimuth / of.ends.z, 0.0, float(of.intervals.z));
  return vec3(row, column, up ? 0.0 : 1.0);
}
`;

/** The light of one of the tables: textures are no arguments in all dialects. */
const lightOf = (name: string, roots: string, degrees: string) => `
Light ${name}_light(vec3 v, bool has_degrees) {
  Light light = Light(vec3(0.0), vec3(0.0), vec3(0.0));
  ivec3 intervals = ${name}_intervals;
  if (intervals.z == 0) return light;
  vec3 there = place_in(Table(${name}_horizon, ${name}_ends, intervals, ${name}_azimuth), v);
  bool up = there.z == 0.0;
  int rows = up ? intervals.x : intervals.y;
  float row = there.x, column = there.y;
  int first_row, first_column;
  vec4 by_row = between(row, rows, false, first_row);
  vec4 by_column = between(column, intervals.z, true, first_column);
  vec3 root = vec3(0.0), q = vec3(0.0), u = vec3(0.0);
  for (int i = 0; i < 4; i++) {
    int y = clamp(first_row + i, 0, rows) + (up ? 0 : intervals.x + 1);
    for (int j = 0; j < 4; j++) {
      int x = clamp(first_column + j, 0, intervals.z);
      float weight = by_row[i] * by_column[j];
      root += weight * texelFetch(${roots}, ivec2(x, y), 0).rgb;
      if (has_degrees) {
        q += weight * texelFetch(${degrees}, ivec2(2 * x, y), 0).rgb;
        u += weight * texelFetch(${degrees}, ivec2(2 * x + 1, y), 0).rgb;
      }
    }
  }
  float across = (v.y * ${name}_azimuth.x - v.x * ${name}_azimuth.y) / max(length(v.xy), 1e-12);
  vec3 xyz = root * root;
  return Light(xyz, xyz * q, xyz * u * across);
}
`;

const LIGHTS = `${lightOf("sun", "roots", "degrees")}${lightOf("moon", "moon_roots", "moon_degrees")}
Light lights(vec3 v, bool has_degrees) {
  Light a = sun_light(v, has_degrees), b = moon_light(v, has_degrees);
  return Light(a.xyz + b.xyz, a.q + b.q, a.u + b.u);
}
`;

const POLARISATION = `
// Half of the light that is not polarised, and what passes of the rest.
vec3 pass(vec3 v, Light light) {
  float level = max(length(v.xy), 1e-6);
  vec3 e1 = vec3(-v.z * v.xy / level, level), e2 = vec3(v.y, -v.x, 0.0) / level;
  vec3 top = projection == 2 || projection == 1 ? vec3(0.0, 0.0, 1.0) : axes[1];
  float angle = atan(dot(e2, top), dot(e1, top)) + polariser;
  vec3 part = light.q * cos(2.0 * angle) + light.u * sin(2.0 * angle);
  return max(0.5 * (light.xyz + part), 0.0);
}

vec3 sequential(float x) {
  vec3 stops[6] = vec3[6](vec3(0.0, 0.0, 0.02), vec3(0.25, 0.05, 0.42), vec3(0.58, 0.15, 0.40),
                          vec3(0.87, 0.31, 0.22), vec3(0.98, 0.62, 0.12), vec3(0.98, 0.99, 0.66));
  float u = clamp(x, 0.0, 1.0) * 5.0;
  int i = min(int(u), 4);
  return mix(stops[i], stops[i + 1], u - float(i));
}
`;

const COLOURS = `
vec3 linear_srgb(vec3 c) {
  return vec3(dot(vec3(3.24097, -1.5373832, -0.49861076), c), dot(vec3(-0.96924365, 1.8759675, 0.04155506), c),
              dot(vec3(0.05563008, -0.20397696, 1.0569715), c));
}
`;

const FILM = `
vec3 into_gamut(vec3 rgb) {
  float least = min(min(rgb.r, rgb.g), min(rgb.b, 0.0));
  float luminance = dot(rgb, vec3(0.2126, 0.7152, 0.0722));
  if (least == 0.0) return rgb;
  if (luminance <= 0.0) return vec3(0.0);
  return max(luminance + luminance / (luminance - least) * (rgb - luminance), 0.0);
}

vec3 hable(vec3 x) {
  return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
}

vec3 aces(vec3 v) {
  return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.432951) + 0.238081);
}

vec3 develop(vec3 rgb) {
  vec3 scene = rgb / white;
  if (is_daylight) {
    scene = vec3(dot(vec3(0.963048, -0.055734, -0.01005), scene), dot(vec3(0.002642, 1.013428, -0.003697), scene),
                 dot(vec3(0.004656, 0.01677, 1.188038), scene));
  }
  scene = min(into_gamut(scene), 1e4);
  if (tone == 1) scene = hable(min(2.927523 * scene, 11.2)) / hable(vec3(11.2));
  if (tone == 2) {
    vec3 s = 1.461926 * scene;
    s = aces(vec3(dot(vec3(0.59719, 0.35458, 0.04823), s), dot(vec3(0.076, 0.90834, 0.01566), s),
                  dot(vec3(0.0284, 0.13383, 0.83777), s)));
    scene = vec3(dot(vec3(1.60475, -0.53108, -0.07367), s), dot(vec3(-0.10208, 1.10813, -0.00605), s),
                 dot(vec3(-0.00327, -0.07276, 1.07602), s));
  }
  scene = clamp(scene, 0.0, 1.0);
  return mix(1.055 * pow(scene, vec3(1.0 / 2.4)) - 0.055, 12.92 * scene, lessThanEqual(scene, vec3(0.0031308)));
}
`;

const MAIN = `
void main() {
  vec3 local;
  if (!look(gl_FragCoord.xy, local)) {
    colour = vec4(0.0, 0.0, 0.0, 1.0);
    return;
  }
  vec3 v = axes * local;
  bool is_other = gl_FragCoord.x > divider * size.x;
  Light light = Light(vec3(0.0), vec3(0.0), vec3(0.0));
  if (is_beyond) light.xyz = beyond(v);
  else if (!is_other) light = lights(v, has_polariser || quantity == 1);
  if (quantity == 1) {
    float degree = light.xyz.y > 0.0 ? length(vec2(light.q.y, light.u.y)) / light.xyz.y : 0.0;
    colour = vec4(sequential(min(degree, 1.0)), 1.0);
    return;
  }
  float half_of = has_polariser ? 0.5 : 1.0;
  if (is_other) {
    vec3 rgb = half_of * hosek_wilkie(v);
    colour = vec4(tone < 0 ? rgb : develop(rgb), 1.0);
    return;
  }
  vec3 land_rgb, disc_xyz = disc_mean();
  float sky = sky_share(v, land_rgb);
  vec3 rgb = sky * linear_srgb(has_polariser ? pass(v, light) : light.xyz);
  rgb += half_of * (linear_srgb(disc_xyz) + land_rgb);
  colour = vec4(tone < 0 ? rgb : develop(rgb), 1.0);
}
`;

export const FRAGMENT = [
  UNIFORMS, DIRECTIONS, TABLE, LIGHTS, SPACE_SHADER, HOSEK_SHADER, POLARISATION, COLOURS, TERRAIN_SHADER, DISC_SHADER, FILM, MAIN,
].join("");
