// The landscape in the picture: `wasm/terrain.h` and `wasm/air.h` have its tables.

/** Of the tables of ridges, around the camera and away from it, and of the squares that have shadows. */
export const COLUMNS = 1536;
export const RINGS = 512;
export const CELLS = 512;
const FIRST = 20;
const LAST = 1.2e6;
const CELL = 250;
/** Of the tables of air: floats of the header, distances, and what follows from it. */
export const AIR_HEADER = 24;
export const AIR_DISTANCES = 48;
export const SUNLIGHT_COLUMNS = 65;
export const SUNLIGHT_ROWS = 12;
/** Where the height of the eye begins, m: it does not lie on the ground. */
export const EYE = 2;

/** Rows and columns of the air while something moves, and when it rests. */
export type AirSize = readonly [rows: number, columns: number];
export const COARSE_AIR: AirSize = [16, 7];
export const FINE_AIR: AirSize = [40, 13];

export interface Air {
  header: Float32Array;
  table: Float32Array;
  sunlight: Float32Array;
}

/** What changed of the landscape. */
export interface Land {
  normals: Float32Array | null;
  slopes: Float32Array | null;
  shadows: Float32Array | null;
}

const float = (value: number) => (Number.isInteger(value) ? value.toFixed(1) : `${value}`);

export const TERRAIN_SHADER = `
uniform sampler2D slopes, normals, shadows, air, sunlight;
uniform vec4 land[6]; // the header of the air; what is left of the last but one: whether there is a landscape, whether it is lit
uniform vec3 land_sun;

// Columns to both sides of an azimuth, and where between them.
ivec2 columns_at(vec3 v, out float t) {
  float u = atan(v.y, v.x) * ${float(COLUMNS / 2)} / PI;
  u = u < 0.0 ? u + ${float(COLUMNS)} : u;
  int first = int(u);
  t = u - float(first);
  return ivec2(first % ${COLUMNS}, (first + 1) % ${COLUMNS});
}

float slope_of(ivec2 columns, float t, int ring) {
  return mix(texelFetch(slopes, ivec2(columns.x, ring), 0).r, texelFetch(slopes, ivec2(columns.y, ring), 0).r, t);
}

// Where a line of sight meets the landscape: m, 0 in the sky; and the ring. Slopes never fall from ring to ring.
float meet(vec3 v, out float ring) {
  float t, level = max(length(v.xy), 1e-9), slope = v.z / level;
  ivec2 columns = columns_at(v, t);
  int near = 0, far = ${RINGS - 1};
  ring = 0.0;
  float below = slope_of(columns, t, near), above = slope_of(columns, t, far);
  if (above < slope) return 0.0;
  if (below >= slope) return min(land[1].w / max(-v.z, 1e-6), ${float(FIRST)} / level);
  while (far - near > 1) {
    int middle = (near + far) / 2;
    float here = slope_of(columns, t, middle);
    if (here < slope) { near = middle; below = here; }
    else { far = middle; above = here; }
  }
  ring = float(near) + (slope - below) / max(above - below, 1e-9);
  return ${float(FIRST)} * exp(${float(Math.log(LAST / FIRST) / (RINGS - 1))} * ring) / level;
}

vec3 normal_at(vec3 v, float ring) {
  float t;
  ivec2 columns = columns_at(v, t);
  int near = min(int(ring), ${RINGS - 2});
  vec2 first = mix(texelFetch(normals, ivec2(columns.x, near), 0).rg, texelFetch(normals, ivec2(columns.y, near), 0).rg, t);
  vec2 second = mix(texelFetch(normals, ivec2(columns.x, near + 1), 0).rg, texelFetch(normals, ivec2(columns.y, near + 1), 0).rg, t);
  vec2 level = mix(first, second, ring - float(near));
  return vec3(level, sqrt(max(1.0 - dot(level, level), 0.0)));
}

// The share of the sun that is seen from a point; shadows lie in squares around the origin.
float sunlit(vec3 point) {
  vec2 u = point.xy / ${float(CELL)} + ${float((CELLS - 1) / 2)};
  if (min(u.x, u.y) < 0.0 || max(u.x, u.y) >= ${float(CELLS - 1)}) return 1.0;
  ivec2 cell = ivec2(u);
  vec2 t = u - vec2(cell);
  float low = mix(texelFetch(shadows, cell, 0).r, texelFetch(shadows, cell + ivec2(1, 0), 0).r, t.x);
  float high = mix(texelFetch(shadows, cell + ivec2(0, 1), 0).r, texelFetch(shadows, cell + ivec2(1, 1), 0).r, t.x);
  return clamp((point.z - mix(low, high, t.y)) / 20.0 + 0.5, 0.0, 1.0);
}

// Irradiance of what faces the sun, linear sRGB, at an altitude where the sun has this elevation.
vec3 sunlight_at(float altitude, float elevation, float here) {
  float turn = clamp((elevation - here) / 0.19, -1.0, 1.0);
  float u = (sign(turn) * sqrt(abs(turn)) + 1.0) * ${float((SUNLIGHT_COLUMNS - 1) / 2)};
  float w = sqrt(clamp(altitude / 4000.0, 0.0, 1.0)) * ${float(SUNLIGHT_ROWS - 1)};
  ivec2 node = min(ivec2(u, w), ivec2(${SUNLIGHT_COLUMNS - 2}, ${SUNLIGHT_ROWS - 2}));
  vec2 t = vec2(u, w) - vec2(node);
  vec3 low = mix(texelFetch(sunlight, node, 0).rgb, texelFetch(sunlight, node + ivec2(1, 0), 0).rgb, t.x);
  vec3 high = mix(texelFetch(sunlight, node + ivec2(0, 1), 0).rgb, texelFetch(sunlight, node + ivec2(1, 1), 0).rgb, t.x);
  return max(linear_srgb(exp2(mix(low, high, t.y))), 0.0);
}

// Meadows, woods, rock where it is steep or high, snow above.
vec3 cover(float altitude, float level) {
  vec3 colour = mix(vec3(0.09, 0.12, 0.05), vec3(0.03, 0.045, 0.02), clamp(min((0.995 - level) / 0.02, (1400.0 - altitude) / 200.0), 0.0, 1.0));
  colour = mix(colour, vec3(0.19, 0.17, 0.15), clamp(max((0.85 - level) / 0.08, (altitude - 1500.0) / 400.0), 0.0, 1.0));
  return mix(colour, vec3(0.75, 0.77, 0.8), clamp((altitude - 1900.0) / 150.0, 0.0, 1.0));
}

// Radiance of the ground where a line of sight ends, linear sRGB.
vec3 surface(vec3 v, float distance, float ring) {
  float radius = land[2].w;
  vec3 point = vec3(distance * v.xy, land[1].w + distance * v.z), up = normalize(point + vec3(0.0, 0.0, radius));
  float way = point.z + dot(point, point) / (2.0 * radius);
  float altitude = 2.0 * way / (1.0 + sqrt(max(1.0 + 2.0 * way / radius, 0.0)));
  // Tilted as the plain is there.
  vec3 normal = normalize(normal_at(v, ring) + vec3(up.xy, 0.0));
  float sun = asin(clamp(dot(up, land_sun), -1.0, 1.0));
  float facing = max(dot(normal, land_sun), 0.0) * sunlit(point + vec3(0.0, 0.0, 3.0));
  vec3 direct = facing > 0.0 ? facing * sunlight_at(altitude, sun, asin(clamp(land_sun.z, -1.0, 1.0))) : vec3(0.0);
  vec3 sky = (0.5 + 0.5 * normal.z) * vec3(land[3].w, land[4].xy);
  return cover(altitude, normal.z) / PI * (direct + sky);
}

float lobe(float weight, float g, float cosine) {
  float x = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - cosine);
  return weight * (1.0 - g * g) / (x * sqrt(x));
}

// What the light of the air was divided by.
float shape(vec3 v) {
  vec3 way = v - land_sun;
  float cosine = 1.0 - 0.5 * dot(way, way);
  return land[1].y + land[1].z * 0.75 * (1.0 + cosine * cosine) + lobe(land[2].x, land[3].x, cosine)
       + lobe(land[2].y, land[3].y, cosine) + lobe(land[2].z, land[3].z, cosine);
}

// X, Y and Z of the light of the air before a distance, and factors of linear sRGB of what is behind.
vec3 air_before(vec3 v, float distance, out vec3 factors) {
  int rows = int(land[0].w), columns = int(land[1].x), first_row;
  float level = max(length(v.xy), 1e-9);
  float cosine = clamp(dot(v.xy, land_sun.xy) / (level * max(length(land_sun.xy), 1e-9)), -1.0, 1.0);
  float column = acos(cosine) / PI * float(columns - 1);
  int first = min(int(column), columns - 2);
  float row = (arsinh((atan(v.z, level) + land[0].x) / 0.04) - land[0].y) * land[0].z;
  vec4 by_row = between(clamp(row, 0.0, float(rows - 1)), rows - 1, false, first_row);
  float far = clamp(log(distance / land[5].x) * land[5].y, 0.0, ${float(AIR_DISTANCES - 1)});
  int first_slice;
  vec4 by_slice = between(far, ${AIR_DISTANCES - 1}, false, first_slice);
  vec3 light = vec3(0.0), depth = vec3(0.0);
  for (int k = 0; k < 4; k++) {
    int slice = clamp(first_slice + k, 0, ${AIR_DISTANCES - 1});
    for (int i = 0; i < 4; i++) {
      int y = slice * rows + clamp(first_row + i, 0, rows - 1);
      for (int j = 0; j < 2; j++) {
        float along = column - float(first);
        float weight = by_slice[k] * by_row[i] * (j == 0 ? 1.0 - along : along);
        light += weight * texelFetch(air, ivec2(2 * (first + j), y), 0).rgb;
        depth += weight * texelFetch(air, ivec2(2 * (first + j) + 1, y), 0).rgb;
      }
    }
  }
  factors = exp(-distance * max(depth, 0.0));
  return exp2(light) * distance * shape(v);
}

vec3 land_light(vec3 v, float distance, float ring) {
  vec3 factors, light = linear_srgb(air_before(v, distance, factors));
  return light + (land[4].w > 0.5 ? factors * surface(v, distance, ring) : vec3(0.0));
}

// The share of sky in the pixel, and the light of the rest of it. Outlines are as smooth as their parts.
float sky_share(vec3 v, out vec3 light) {
  light = vec3(0.0);
  if (land[4].z < 0.5) return 1.0;
  float ring, here = meet(v, ring), around = here, nearest = here > 0.0 ? here : 1e9, farthest = here > 0.0 ? here : 1e9;
  vec3 local;
  for (int i = 0; i < 4; i++) {
    vec2 corner = vec2(i % 2, i / 2) - 0.5;
    float ignored;
    if (!look(gl_FragCoord.xy + corner, local)) continue;
    around = meet(axes * local, ignored);
    around = around > 0.0 ? around : 1e9;
    nearest = min(nearest, around);
    farthest = max(farthest, around);
  }
  if (farthest <= 1.1 * nearest) {
    if (here > 0.0) light = land_light(v, here, ring);
    return here > 0.0 ? 0.0 : 1.0;
  }
  float sky = 0.0;
  for (int i = 0; i < 8; i++) {
    vec2 corner = vec2((float(i) + 0.5) / 8.0, fract((float(i) + 0.5) * 0.625 + 0.125)) - 0.5;
    if (!look(gl_FragCoord.xy + corner, local)) continue;
    vec3 way = axes * local;
    float distance = meet(way, ring);
    if (distance > 0.0) light += land_light(way, distance, ring) / 8.0;
    else sky += 0.125;
  }
  return sky;
}

// Whether nothing stands before the sky.
bool is_open(vec3 v) {
  float t;
  ivec2 columns = columns_at(v, t);
  return land[4].z < 0.5 || slope_of(columns, t, ${RINGS - 1}) < v.z / max(length(v.xy), 1e-9);
}
`;
