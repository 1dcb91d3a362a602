/* A landscape by formula, and what a shader looks up of it. Heights of many sizes, each of which begins some of its sizes
 * away: wherever one looks from the origin, ridges stand behind ridges, from 1 km to 60 km, and the plain lies beyond.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef WELKIN_WEB_TERRAIN_H
#define WELKIN_WEB_TERRAIN_H

enum {
    TERRAIN_COLUMNS = 1536,
    TERRAIN_RINGS = 512,
    TERRAIN_NODES = TERRAIN_COLUMNS * TERRAIN_RINGS,
    SHADOW_CELLS = 512 /* along an edge */
};

static const double TERRAIN_FIRST = 20, TERRAIN_LAST = 1.2e6; /* distances of rings, m */
static const double TERRAIN_END = 60e3;
static const double SHADOW_CELL = 250; /* m */

static float *terrain_heights;  /* [ring][column] */
static float *terrain_normals;  /* [ring][column][x, y] */
static float *terrain_slopes;   /* [ring][column]: tangent of the highest elevation up to there, as a camera sees it */
static float *terrain_grid;     /* [y][x] of squares around the origin: heights above the plane through the origin */
static float *terrain_shadows;  /* [y][x]: up to which height above that plane the sun does not come */

/* Uniform in -1..1, of a place. */
static double terrain_random(int32_t i, int32_t j, uint32_t salt)
{
    uint32_t h = (uint32_t)i * 0x85ebca6bu ^ (uint32_t)j * 0xc2b2ae35u ^ salt * 0x27d4eb2fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return (double)(h ^ h >> 15) / 2147483647.5 - 1;
}

/* Gradient noise of about -1 to 1 with features of size 1. */
static double terrain_noise(double x, double y, uint32_t salt)
{
    int32_t i = (int32_t)floor(x), j = (int32_t)floor(y), a, b;
    double s = x - i, t = y - j, corner[2][2], low, high;
    double u = s * s * s * (s * (6 * s - 15) + 10), v = t * t * t * (t * (6 * t - 15) + 10);
    for (a = 0; a < 2; a++)
        for (b = 0; b < 2; b++)
            corner[a][b] = terrain_random(i + a, j + b, salt) * (s - a) + terrain_random(i + a, j + b, salt + 1) * (t - b);
    low = corner[0][0] + u * (corner[1][0] - corner[0][0]);
    high = corner[0][1] + u * (corner[1][1] - corner[0][1]);
    return 1.2 * (low + v * (high - low));
}

static double terrain_step(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0), 1);
    return t * t * (3 - 2 * t);
}

/* Height above the ground at distances from the origin, m. */
EXPORT(terrain_height) double terrain_height(double x, double y)
{
    double r = sqrt(x * x + y * y), size = 16e3, sum = 0, fade;
    uint32_t octave;
    if (r >= TERRAIN_END) return 0;
    fade = 1 - terrain_step(0.85 * TERRAIN_END, TERRAIN_END, r);
    for (octave = 0; octave < 6; octave++, size /= 2) {
        double begins = terrain_step(0.8 * size, 2.5 * size, r), ridge;
        if (begins <= 0) continue;
        /* Turned, so that no grid shows. */
        ridge = 1 - fabs(terrain_noise((0.8 * x - 0.6 * y) / size + octave, (0.6 * x + 0.8 * y) / size, 7 * octave));
        sum += 0.1 * size * begins * ridge * ridge;
    }
    return fade * sum;
}

static double terrain_distance(uint32_t ring)
{
    return TERRAIN_FIRST * exp(log(TERRAIN_LAST / TERRAIN_FIRST) * ring / (TERRAIN_RINGS - 1));
}

/* Height above the plane through the origin of what is so high above the ground. */
static double terrain_above_plane(double radius, double r, double height)
{
    return height - r * r / (radius + height + sqrt(fmax((radius + height) * (radius + height) - r * r, 0)));
}

static void terrain_fill_heights(void)
{
    uint32_t ring, column;
    for (ring = 0; ring < TERRAIN_RINGS; ring++)
        for (column = 0; column < TERRAIN_COLUMNS; column++) {
            double r = terrain_distance(ring), a = 2 * WELKIN__PI * column / TERRAIN_COLUMNS;
            terrain_heights[ring * TERRAIN_COLUMNS + column] = (float)terrain_height(r * cos(a), r * sin(a));
        }
}

/* From the heights of neighbours; level where there are none. */
static void terrain_fill_normals(void)
{
    uint32_t ring, column;
    memset(terrain_normals, 0, 2 * TERRAIN_NODES * sizeof *terrain_normals);
    for (ring = 1; ring + 1 < TERRAIN_RINGS; ring++)
        for (column = 0; column < TERRAIN_COLUMNS; column++) {
            const float *row = terrain_heights + ring * TERRAIN_COLUMNS;
            double r = terrain_distance(ring), turn = 2 * WELKIN__PI / TERRAIN_COLUMNS, a = turn * column;
            double along = (double)(row[TERRAIN_COLUMNS + column] - row[(int)column - TERRAIN_COLUMNS]);
            double across = (double)(row[(column + 1) % TERRAIN_COLUMNS] - row[(column + TERRAIN_COLUMNS - 1) % TERRAIN_COLUMNS]);
            double x, y, length;
            along /= terrain_distance(ring + 1) - terrain_distance(ring - 1);
            across /= 2 * turn * r;
            x = along * cos(a) - across * sin(a), y = along * sin(a) + across * cos(a);
            length = sqrt(1 + x * x + y * y);
            terrain_normals[2 * (ring * TERRAIN_COLUMNS + column)] = (float)(-x / length);
            terrain_normals[2 * (ring * TERRAIN_COLUMNS + column) + 1] = (float)(-y / length);
        }
}

static void terrain_fill_grid(double radius)
{
    int i, j;
    for (j = 0; j < SHADOW_CELLS; j++)
        for (i = 0; i < SHADOW_CELLS; i++) {
            double x = (i - (SHADOW_CELLS - 1) / 2.0) * SHADOW_CELL, y = (j - (SHADOW_CELLS - 1) / 2.0) * SHADOW_CELL;
            terrain_grid[j * SHADOW_CELLS + i] = (float)terrain_above_plane(radius, sqrt(x * x + y * y), terrain_height(x, y));
        }
}

/* All that does not change, once; whether there is memory for it. */
EXPORT(terrain_open) int terrain_open(uint32_t index)
{
    const size_t cells = SHADOW_CELLS * SHADOW_CELLS;
    float *memory;
    if (terrain_heights) return 1;
    memory = malloc((4 * TERRAIN_NODES + 2 * cells) * sizeof *memory);
    if (!memory) return 0;
    terrain_heights = memory, terrain_normals = memory + TERRAIN_NODES, terrain_slopes = memory + 3 * TERRAIN_NODES;
    terrain_grid = memory + 4 * TERRAIN_NODES, terrain_shadows = terrain_grid + cells;
    terrain_fill_heights();
    terrain_fill_normals();
    terrain_fill_grid(slots[index].file.planet_radius);
    return 1;
}

/* How high up ridges stand for a camera above the origin, so high above the ground; returns the highest tangent. */
EXPORT(terrain_look) double terrain_look(uint32_t index, double camera)
{
    double radius = slots[index].file.planet_radius, most = -1e9;
    uint32_t ring, column;
    for (ring = 0; ring < TERRAIN_RINGS; ring++) {
        double r = terrain_distance(ring);
        for (column = 0; column < TERRAIN_COLUMNS; column++) {
            size_t node = (size_t)ring * TERRAIN_COLUMNS + column;
            double slope = (terrain_above_plane(radius, r, (double)terrain_heights[node]) - camera) / r;
            terrain_slopes[node] = ring > 0 ? fmaxf((float)slope, terrain_slopes[node - TERRAIN_COLUMNS]) : (float)slope;
            most = fmax(most, (double)terrain_slopes[node]);
        }
    }
    return most;
}

/* Where the sun comes, row by row away from it: a shadow falls by the tangent of the sun's elevation. */
EXPORT(terrain_shade) void terrain_shade(double elevation, double azimuth)
{
    double c = cos(azimuth), s = sin(azimuth), fall, shift;
    int across = fabs(s) > fabs(c), n = SHADOW_CELLS, k, i, back = (across ? s : c) > 0 ? -1 : 1;
    double main = across ? s : c, other = across ? c : s;
    size_t row = across ? (size_t)n : 1, column = across ? 1 : (size_t)n;
    shift = other / fabs(main);
    fall = tan(fmin(fmax(elevation, -0.5), 1.57)) * SHADOW_CELL * sqrt(1 + shift * shift);
    for (k = 0; k < n; k++) {
        int at = back > 0 ? k : n - 1 - k, toward = at - back;
        for (i = 0; i < n; i++) {
            double u = fmin(fmax(i + shift, 0), n - 1.0), t, high = -1e4;
            int j = (int)fmin(floor(u), n - 2);
            size_t low = 0;
            t = u - j;
            if (toward >= 0 && toward < n) {
                const float *g = terrain_grid + (size_t)toward * row, *h = terrain_shadows + (size_t)toward * row;
                double p, q;
                low = (size_t)j * column;
                p = fmax((double)g[low], (double)h[low]), q = fmax((double)g[low + column], (double)h[low + column]);
                high = p + t * (q - p) - fall;
            }
            terrain_shadows[(size_t)at * row + (size_t)i * column] = (float)high;
        }
    }
}

EXPORT(terrain_normals_at) float *terrain_normals_at(void) { return terrain_normals; }
EXPORT(terrain_slopes_at) float *terrain_slopes_at(void) { return terrain_slopes; }
EXPORT(terrain_shadows_at) float *terrain_shadows_at(void) { return terrain_shadows; }

#endif
