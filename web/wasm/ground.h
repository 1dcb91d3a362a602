/* The lit ground under a sky: Lambertian, of the albedo of the conditions, in the light of sun and sky at the place that
 * is seen, through the air before it. The same as `welkin render --ground`, with a coarser quadrature.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef WELKIN_WEB_GROUND_H
#define WELKIN_WEB_GROUND_H

#include <stdlib.h>

enum { GROUND_SUNS = 80, GROUND_RINGS = 20, GROUND_SPOKES = 16 };

typedef struct ground {
    welkin_transmittance_profile air;
    const welkin_file *file;
    double altitude, sun[3], lowest, step;
    uint32_t suns;
    float logarithm[GROUND_SUNS][WELKIN_MAX_WAVELENGTHS]; /* of the relative radiance of the ground */
} ground;

/* Irradiance of a level plane by a sky, per unit of solar irradiance. Even in elevation, as much of the light of a low
 * sun comes from near the horizon; denser towards the sun. */
static welkin_error ground_skylight(const welkin_sky *sky, double *sums)
{
    uint32_t ring, spoke, w, nw = sky->file->wavelengths;
    float radiance[WELKIN_MAX_WAVELENGTHS];
    for (ring = 0; ring < GROUND_RINGS; ring++) {
        double middle = WELKIN__HALF_PI * (ring + 0.5) / GROUND_RINGS;
        double low = sin(WELKIN__HALF_PI * ring / GROUND_RINGS), high = sin(WELKIN__HALF_PI * (ring + 1) / GROUND_RINGS);
        for (spoke = 0; spoke < GROUND_SPOKES; spoke++) {
            double u = (spoke + 0.5) / GROUND_SPOKES, phi = WELKIN__PI * u * u;
            double weight = WELKIN__PI * (high * high - low * low) * 2 * u / GROUND_SPOKES;
            double direction[3] = {cos(middle) * cos(phi), cos(middle) * sin(phi), sin(middle)};
            welkin_error error = welkin_radiance(sky, direction, radiance);
            if (error) return error;
            for (w = 0; w < nw; w++) sums[w] += weight * (double)radiance[w];
        }
    }
    return WELKIN_OK;
}

/* Under a sun at this elevation. */
static welkin_error ground_row(ground *g, const welkin_conditions *c, float *scratch, size_t floats, float *logarithm)
{
    double sums[WELKIN_MAX_WAVELENGTHS] = {0};
    float through[WELKIN_MAX_WAVELENGTHS];
    double direction[3] = {cos(c->solar_elevation), 0, sin(c->solar_elevation)};
    uint32_t w;
    welkin_sky sky;
    welkin_error error = welkin_prepare(&sky, g->file, c, 0, scratch, floats);
    if (!error) error = ground_skylight(&sky, sums);
    if (!error) error = welkin_transmittance(&g->air, 0, direction, 2e7, through);
    for (w = 0; w < g->file->wavelengths && !error; w++) {
        double direct = direction[2] > 0 ? direction[2] * (double)through[w] : 0;
        logarithm[w] = (float)log(fmax(c->albedo / WELKIN__PI * (direct + sums[w]), FLT_MIN));
    }
    return error;
}

/* In azimuth 0. */
static void ground_turn(ground *g, double elevation)
{
    g->sun[0] = cos(elevation), g->sun[1] = 0, g->sun[2] = sin(elevation);
}

/* For a sky of these conditions, the sun in azimuth 0; the ground that is seen lies up to `dip` (rad) away. Suns of the
 * table are not farther apart than `step`, unless there are too many. */
static welkin_error ground_prepare(ground *g, const welkin_file *file, const welkin_conditions *conditions, double dip,
                                   double step)
{
    size_t floats = welkin_scratch_floats(file, 0);
    float *scratch = malloc(floats * sizeof *scratch);
    welkin_conditions c = *conditions;
    double highest = fmin(c.solar_elevation + dip, file->elevation_max);
    welkin_error error = scratch ? welkin_transmittance_prepare(&g->air, file, c.visibility) : WELKIN_ERROR_SCRATCH;
    uint32_t i;
    g->file = file;
    g->altitude = c.altitude;
    ground_turn(g, c.solar_elevation);
    g->lowest = fmax(c.solar_elevation - dip, file->elevation_min);
    g->suns = dip > 0 ? (uint32_t)fmin(2 + floor((highest - g->lowest) / step), GROUND_SUNS) : 1;
    g->step = g->suns > 1 ? (highest - g->lowest) / (g->suns - 1) : 0;
    c.altitude = welkin_altitude(file, 0);
    for (i = 0; i < g->suns && !error; i++) {
        c.solar_elevation = fmin(g->lowest + g->step * i, file->elevation_max);
        error = ground_row(g, &c, scratch, floats, g->logarithm[i]);
    }
    free(scratch);
    return error;
}

/* Relative radiance of the ground in a direction that meets it, as it is seen. */
static welkin_error ground_seen(const ground *g, const double v[3], float *radiance)
{
    double radius = g->file->planet_radius, h = g->altitude, b = (radius + h) * v[2], c = h * (2 * radius + h);
    double root = sqrt(fmax(b * b - c, 0)), distance = root - b > 0 ? c / (root - b) : 0, zenith[3], length, elevation, u;
    uint32_t w, i;
    welkin_error error = welkin_transmittance(&g->air, h, v, distance, radiance);
    if (error) return error;
    zenith[0] = distance * v[0], zenith[1] = distance * v[1], zenith[2] = distance * v[2] + h + radius;
    length = sqrt(zenith[0] * zenith[0] + zenith[1] * zenith[1] + zenith[2] * zenith[2]);
    elevation = asin(fmin(fmax((zenith[0] * g->sun[0] + zenith[2] * g->sun[2]) / length, -1), 1));
    u = g->step > 0 ? fmin(fmax((elevation - g->lowest) / g->step, 0), g->suns - 1.0) : 0;
    i = g->suns > 1 && (uint32_t)u > g->suns - 2 ? g->suns - 2 : (uint32_t)u;
    for (w = 0; w < g->file->wavelengths; w++) {
        const float *low = g->logarithm[i], *high = g->logarithm[g->suns > 1 ? i + 1 : i];
        radiance[w] *= (float)exp((double)low[w] + (u - i) * ((double)high[w] - (double)low[w]));
    }
    return WELKIN_OK;
}

#endif
