/* The air from outside: what rays bring that come down to the model's highest altitude, in a table over the elevation
 * of the sun where they do (layers), that of the ray (rows, both sides of the horizon), and the azimuth between them
 * (columns). Rows and columns are those of welkin_bake; layers are even in arsinh((elevation + 2°) / 6°).
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef WELKIN_WEB_SPACE_H
#define WELKIN_WEB_SPACE_H

static const double SPACE_MIDDLE = -2 * WELKIN__PI / 180, SPACE_SCALE = 6 * WELKIN__PI / 180;
/* Rows of all layers that a texture has room for everywhere. */
enum { SPACE_MOST_ROWS = 2048, SPACE_HEADER = 8 };

typedef struct space_grid {
    double dip, up_end, down_end, azimuth_end, first, step;
    uint32_t layers, up, down, columns; /* intervals */
} space_grid;

static double space_coordinate(double elevation) { return welkin__asinh((elevation - SPACE_MIDDLE) / SPACE_SCALE); }

static double space_sun(const space_grid *g, uint32_t layer)
{
    return SPACE_MIDDLE + SPACE_SCALE * sinh(g->first + g->step * layer);
}

static uint32_t space_rows(const space_grid *g) { return g->up + g->down + 2; }

/* For suns from `low` to `high`, layers not farther apart than `step` of the coordinate. */
static void space_layout(space_grid *g, const welkin_file *f, double low, double high, double step)
{
    double altitude = welkin_altitude(f, f->altitudes - 1), span;
    uint32_t most = SPACE_MOST_ROWS / space_rows(g) - 1;
    low = fmin(fmax(low, f->elevation_min), f->elevation_max);
    high = fmin(fmax(high, low), f->elevation_max);
    g->dip = acos(f->planet_radius / (f->planet_radius + altitude));
    g->up_end = welkin__from_horizon(g->dip);
    g->down_end = welkin__from_horizon(WELKIN__HALF_PI - g->dip);
    g->azimuth_end = welkin__asinh(WELKIN__PI / WELKIN__AZIMUTH_SCALE);
    g->first = space_coordinate(low);
    span = space_coordinate(high) - g->first;
    g->layers = (uint32_t)fmin(fmax(ceil(span / step), 3), most);
    g->step = span / g->layers;
}

static double space_elevation(const space_grid *g, uint32_t row)
{
    if (row == 0) return WELKIN__BESIDE_HORIZON - g->dip;
    if (row <= g->up) return welkin__horizon_angle(g->up_end * row / g->up) - g->dip;
    if (row == g->up + 1) return -WELKIN__BESIDE_HORIZON - g->dip;
    return -welkin__horizon_angle(g->down_end * (row - g->up - 1) / g->down) - g->dip;
}

/* Square roots of X, Y, Z and nothing of one row. */
static welkin_error space_row(const space_grid *g, const welkin_sky *sky, const ground *under, uint32_t row, float *out)
{
    double elevation = space_elevation(g, row), xyz[3];
    float radiance[WELKIN_MAX_WAVELENGTHS], seen[WELKIN_MAX_WAVELENGTHS];
    uint32_t column, w, c;
    for (column = 0; column <= g->columns; column++) {
        double azimuth = WELKIN__AZIMUTH_SCALE * sinh(g->azimuth_end * column / g->columns);
        double level = cos(elevation), v[3] = {level * cos(azimuth), level * sin(azimuth), sin(elevation)};
        welkin_error error = welkin_radiance(sky, v, radiance);
        if (!error && under && row > g->up) {
            error = ground_seen(under, v, seen);
            for (w = 0; w < sky->file->wavelengths; w++) radiance[w] += seen[w];
        }
        if (error) return error;
        welkin_xyz(sky->file, radiance, xyz);
        for (c = 0; c < 3; c++) out[4 * column + c] = (float)sqrt(fmax(xyz[c], 0));
        out[4 * column + 3] = 0;
    }
    return WELKIN_OK;
}

/* Fills [layer][row][column][4]. The scratch is that of a sky. */
static welkin_error space_fill(const space_grid *g, const welkin_file *f, const welkin_conditions *conditions,
                               int is_grounded, double ground_step, float *scratch, size_t floats, float *out)
{
    static ground under;
    welkin_conditions c = *conditions;
    double low = space_sun(g, 0), high = space_sun(g, g->layers);
    uint32_t layer, row, rows = space_rows(g);
    welkin_error error = WELKIN_OK;
    c.altitude = welkin_altitude(f, f->altitudes - 1);
    c.solar_elevation = (low + high) / 2;
    if (is_grounded) error = ground_prepare(&under, f, &c, (high - low) / 2 + g->dip, ground_step);
    for (layer = 0; layer <= g->layers && !error; layer++) {
        welkin_sky sky;
        c.solar_elevation = fmin(fmax(space_sun(g, layer), f->elevation_min), f->elevation_max);
        ground_turn(&under, c.solar_elevation);
        error = welkin_prepare(&sky, f, &c, WELKIN_DENSE, scratch, floats);
        for (row = 0; row < rows && !error; row++)
            error = space_row(g, &sky, is_grounded ? &under : NULL, row,
                              out + 4 * ((size_t)layer * rows + row) * (g->columns + 1));
    }
    return error;
}

#endif
