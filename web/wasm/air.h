/* The air before a landscape: its light and what it leaves of light behind, for directions and distances from a camera.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef WELKIN_WEB_AIR_H
#define WELKIN_WEB_AIR_H

enum { AIR_MOST_ROWS = 48, AIR_MOST_COLUMNS = 33, AIR_DISTANCES = 48, AIR_LOBES = 3, AIR_HEADER = 24 };
enum { SUNLIGHT_COLUMNS = 65, SUNLIGHT_ROWS = 12 };

static const double AIR_ROW_SCALE = 0.04;                      /* rad; rows crowd this close to the horizon */
static const double SUNLIGHT_REACH = 0.19, SUNLIGHT_TOP = 4000; /* how much higher or lower the sun stands; m */

/* A shape of light around the sun: what is scattered once, with the phase functions, and more often. Light is divided by
 * it before it is tabulated, so that tables are smooth. */
typedef struct air_shape {
    double often, molecules, lobe[AIR_LOBES], asymmetry[AIR_LOBES];
} air_shape;

typedef struct air_view {
    const slot *from;
    welkin_aerial_perspective aerial;
    air_shape shape;
    double altitude, nearest, farthest, white[3]; /* nearest and farthest of the distances, m */
} air_view;

static float air_table[8 * AIR_MOST_ROWS * AIR_MOST_COLUMNS * AIR_DISTANCES]; /* [distance][row][column][light, depth] */
static float air_header[AIR_HEADER];
static float sunlight[4 * SUNLIGHT_ROWS * SUNLIGHT_COLUMNS];

/* Of a direction, from the cosine of its angle to the sun. */
static double air_shape_at(const air_shape *shape, double cosine)
{
    double sum = shape->often + shape->molecules * 0.75 * (1 + cosine * cosine);
    int i;
    for (i = 0; i < AIR_LOBES; i++) {
        double g = shape->asymmetry[i], x = (1 - g) * (1 - g) + 2 * g * (1 - cosine);
        sum += shape->lobe[i] * (1 - g * g) / (x * sqrt(x));
    }
    return sum;
}

/* The shape at the camera, at the wavelength in the middle; whatever it is, what comes out of the tables is right at
 * their nodes. */
static void air_find_shape(air_view *view)
{
    const welkin_aerial_perspective *a = &view->aerial;
    size_t nw = a->air.file->wavelengths, nk = a->air.file->constituents, w = nw / 2, k, lobes = 0;
    double level[3] = {-a->sun[1], a->sun[0], 0}, profile[WELKIN_MAX_CONSTITUENTS], direct[WELKIN_MAX_WAVELENGTHS];
    double source[WELKIN__LOOKS][WELKIN_MAX_WAVELENGTHS], total = 0;
    welkin__spot spot = welkin__spot_at(a, fmin(view->altitude, 3000), level, 0);
    uint32_t p;
    welkin__profiles(&a->air, spot.altitude, profile);
    welkin__sunlight(a, &spot, direct);
    welkin__sources(a, &spot, source);
    memset(&view->shape, 0, sizeof view->shape);
    for (p = 0; p < a->species; p++) {
        double scattering = 0;
        for (k = 0; k < nk; k++) scattering += (double)a->scattering[(p * nk + k) * nw + w] * profile[k];
        total += scattering;
        if (a->phase[p] == 1) view->shape.molecules += scattering * direct[w] / (4 * WELKIN__PI);
        else if (lobes < AIR_LOBES) {
            view->shape.lobe[lobes] = scattering * direct[w] / (4 * WELKIN__PI);
            view->shape.asymmetry[lobes++] = fmax((double)a->parameter[p * nw + w], 0);
        }
    }
    view->shape.often = fmax(total * source[WELKIN__PARTICLES][w], 1e-30);
}

/* What air beyond this point would send if all of it was in the sun. */
static void air_beyond(const air_view *view, const welkin__line *ray, double at, const double *through,
                       const welkin__sight *sight, double *beyond)
{
    const welkin_aerial_perspective *a = &view->aerial;
    size_t nw = a->air.file->wavelengths, nk = a->air.file->constituents, w, k;
    double columns[WELKIN_MAX_CONSTITUENTS] = {0}, left[WELKIN_MAX_WAVELENGTHS];
    welkin__line rest = *ray;
    uint32_t p;
    rest.start = at;
    welkin__integrate(&a->air, &rest, columns);
    welkin__attenuate(a, columns, left);
    for (w = 0; w < nw; w++) {
        double depth = -log(fmax(left[w], 1e-300)), sum = 0;
        for (p = 0; p < a->species; p++)
            for (k = 0; k < nk; k++)
                sum += (double)a->scattering[(p * nk + k) * nw + w] * columns[k] / (4 * WELKIN__PI) *
                       welkin__phase_value(a->phase[p], (double)a->parameter[p * nw + w], sight->v, a->sun);
        beyond[w] = sum * (depth > 1e-3 ? (1 - left[w]) / depth : 1 - depth / 2) * through[w];
    }
}

/* Factors of linear sRGB of things as white as the sun. */
static void air_factors(const air_view *view, const double *through, double factor[3])
{
    float spectrum[WELKIN_MAX_WAVELENGTHS];
    double xyz[3], seen[3], white[3];
    int c;
    uint32_t w;
    for (w = 0; w < view->from->file.wavelengths; w++) spectrum[w] = (float)through[w];
    welkin_xyz(&view->from->file, spectrum, xyz);
    for (c = 0; c < 3; c++) xyz[c] = fmin(fmax(xyz[c] / view->white[c], 0), 1) * view->white[c];
    if (welkin_rgb(WELKIN_SRGB, xyz, seen) || welkin_rgb(WELKIN_SRGB, view->white, white)) seen[0] = seen[1] = seen[2] = 0;
    for (c = 0; c < 3; c++) factor[c] = fmin(fmax(seen[c] / white[c], 0), 1);
}

/* The light so far, which becomes that of the sky where hardly any can come from beyond: as the library joins them. */
static void air_write(const air_view *view, const double *light, const double *beyond, const float *sky,
                      const double *through, double distance, double shape, float *out)
{
    float spectrum[WELKIN_MAX_WAVELENGTHS];
    double xyz[3], factor[3];
    uint32_t w;
    int c;
    for (w = 0; w < view->from->file.wavelengths; w++) {
        double near = fmax(1 - beyond[w] / fmax(light[w] + beyond[w], 1e-38) / 0.04, 0);
        spectrum[w] = (float)(light[w] + near * near * ((double)sky[w] - light[w]));
    }
    welkin_xyz(&view->from->file, spectrum, xyz);
    air_factors(view, through, factor);
    for (c = 0; c < 3; c++) {
        out[c] = (float)log2(fmax(xyz[c], 1e-30) / (distance * shape));
        out[4 + c] = (float)(-log(fmax(factor[c], 1e-30)) / distance);
    }
    out[3] = out[7] = 0;
}

/* What ends a line of sight is not nearer than the highest ridge, nor much farther than the horizon. */
static void air_find_reach(air_view *view, double radius)
{
    view->nearest = fmax(100, 0.7 * (view->altitude - 4000));
    view->farthest = fmax(1.05 * sqrt(view->altitude * (2 * radius + view->altitude)), 120e3);
}

static double air_distance(const air_view *view, int i)
{
    return view->nearest * exp(log(view->farthest / view->nearest) * i / (AIR_DISTANCES - 1));
}

/* All distances of a direction; one follows the other by `stride` floats. */
static welkin_error air_ray(const air_view *view, const double v[3], float *out, size_t stride)
{
    static const double node = 0.57735026918962576;
    const welkin_aerial_perspective *a = &view->aerial;
    double light[WELKIN_MAX_WAVELENGTHS] = {0}, through[WELKIN_MAX_WAVELENGTHS], beyond[WELKIN_MAX_WAVELENGTHS];
    double emission[3][WELKIN_MAX_WAVELENGTHS], columns[WELKIN_MAX_CONSTITUENTS] = {0}, before = 0, lowest;
    double radius = a->air.file->planet_radius, top = a->air.file->top_altitude;
    float sky[WELKIN_MAX_WAVELENGTHS];
    welkin__sight sight = {{v[0], v[1], v[2]}, 0, 0};
    welkin__line ray, piece;
    int i, j;
    uint32_t w;
    welkin_error error = welkin_radiance(&view->from->sky, v, sky);
    welkin__find_sun(&sight, a->sun);
    ray.radius = radius;
    ray.start = (radius + view->altitude) * v[2];
    ray.end = 4 * (radius + view->altitude + top);
    ray.low = view->altitude + (view->altitude * view->altitude - ray.start * ray.start) / (2 * radius);
    piece = ray;
    piece.end = ray.start;
    for (i = 0; i < AIR_DISTANCES && !error; i++) {
        double distance = air_distance(view, i), half = (distance - before) / 2;
        for (j = -1; j < 2; j += 2) {
            double s = before + half * (1 + j * node);
            welkin__spot spot = welkin__spot_at(a, view->altitude, v, s);
            piece.start = piece.end;
            piece.end = ray.start + s;
            welkin__integrate(&a->air, &piece, columns);
            welkin__attenuate(a, columns, through);
            /* Beyond the air, and where nothing is seen any more, nothing comes. */
            lowest = 0;
            for (w = 0; w < a->air.file->wavelengths; w++) lowest = fmax(lowest, through[w]);
            if (spot.altitude >= top || lowest < 1e-5) continue;
            welkin__emission(a, &spot, &sight, emission);
            for (w = 0; w < a->air.file->wavelengths; w++) light[w] += half * through[w] * emission[0][w];
        }
        piece.start = piece.end;
        piece.end = ray.start + distance;
        welkin__integrate(&a->air, &piece, columns);
        welkin__attenuate(a, columns, through);
        air_beyond(view, &ray, piece.end, through, &sight, beyond);
        air_write(view, light, beyond, sky, through, distance, air_shape_at(&view->shape, welkin__dot(v, a->sun)), out + stride * (size_t)i);
        before = distance;
    }
    return error;
}

static double air_row_coordinate(double angle) { return asinh(angle / AIR_ROW_SCALE); }

/* Rows from the nadir to an elevation, columns from the azimuth of the sun to the opposite one. */
static welkin_error air_fill(const air_view *view, uint32_t rows, uint32_t columns, double highest)
{
    double radius = view->from->file.planet_radius, h = view->altitude;
    double dip = atan(sqrt(h * (2 * radius + h)) / radius);
    double low = air_row_coordinate(-WELKIN__HALF_PI + dip), high = air_row_coordinate(highest + dip);
    const float values[AIR_HEADER] = {
        (float)dip, (float)low, (float)((rows - 1) / (high - low)), (float)rows, (float)columns,
        (float)view->shape.often, (float)view->shape.molecules, (float)h,
        (float)view->shape.lobe[0], (float)view->shape.lobe[1], (float)view->shape.lobe[2], (float)radius,
        (float)view->shape.asymmetry[0], (float)view->shape.asymmetry[1], (float)view->shape.asymmetry[2], 0, 0, 0, 0, 0,
        (float)view->nearest, (float)((AIR_DISTANCES - 1) / log(view->farthest / view->nearest)), 0, 0};
    uint32_t row, column;
    welkin_error error = WELKIN_OK;
    memcpy(air_header, values, sizeof values);
    for (row = 0; row < rows; row++)
        for (column = 0; column < columns && !error; column++) {
            double e = AIR_ROW_SCALE * sinh(low + (high - low) * row / (rows - 1)) - dip, a = WELKIN__PI * column / (columns - 1);
            double v[3] = {cos(e) * cos(a), cos(e) * sin(a), sin(e)};
            error = air_ray(view, v, air_table + 8 * ((size_t)row * columns + column), 8 * (size_t)rows * columns);
        }
    return error;
}

/* Irradiance of a plane that faces the sun, X, Y and Z, as logarithms: by altitude, and by how much higher the sun stands. */
static welkin_error sunlight_fill(const air_view *view, double elevation)
{
    uint32_t row, column, c;
    for (row = 0; row < SUNLIGHT_ROWS; row++)
        for (column = 0; column < SUNLIGHT_COLUMNS; column++) {
            double t = 2.0 * column / (SUNLIGHT_COLUMNS - 1) - 1, up = (double)row / (SUNLIGHT_ROWS - 1), xyz[3];
            double e = elevation + SUNLIGHT_REACH * t * fabs(t), v[3] = {cos(e), 0, sin(e)};
            float through[WELKIN_MAX_WAVELENGTHS], *out = sunlight + 4 * (row * SUNLIGHT_COLUMNS + column);
            welkin_error error = welkin_transmittance(&view->aerial.air, SUNLIGHT_TOP * up * up, v, 2e7, through);
            if (error) return error;
            welkin_xyz(&view->from->file, through, xyz);
            for (c = 0; c < 3; c++) out[c] = (float)log2(fmax(xyz[c], 1e-12));
            out[3] = 0;
        }
    return WELKIN_OK;
}

/* Irradiance of a level plane by a sky in a table, linear sRGB. */
static welkin_error skylight_find(const welkin_baked *sky, double rgb[3])
{
    enum { RINGS = 12, SPOKES = 24 };
    double sum[3] = {0}, xyz[3];
    int ring, spoke, c;
    welkin_error error = WELKIN_OK;
    for (ring = 0; ring < RINGS; ring++)
        for (spoke = 0; spoke < SPOKES && !error; spoke++) {
            double sine = sqrt((ring + 0.5) / RINGS), a = 2 * WELKIN__PI * spoke / SPOKES;
            double v[3] = {sine * cos(a), sine * sin(a), sqrt(1 - sine * sine)};
            error = welkin_baked_xyz(sky, v, xyz);
            for (c = 0; c < 3 && !error; c++) sum[c] += xyz[c] * WELKIN__PI / (RINGS * SPOKES);
        }
    return error ? error : welkin_rgb(WELKIN_SRGB, sum, rgb);
}

/* The air before things below an elevation, under the prepared sky that is also in a table. */
static welkin_error air_bake(const slot *s, const welkin_baked *baked, uint32_t rows, uint32_t columns, double highest)
{
    static air_view view;
    size_t floats = welkin_aerial_perspective_floats(&s->file);
    float *scratch = malloc(floats * sizeof *scratch), ones[WELKIN_MAX_WAVELENGTHS];
    double rgb[3] = {0, 0, 0};
    uint32_t w;
    int c;
    welkin_error error = scratch && rows <= AIR_MOST_ROWS && columns <= AIR_MOST_COLUMNS ? WELKIN_OK : WELKIN_ERROR_SCRATCH;
    if (!error) error = welkin_aerial_perspective_prepare(&view.aerial, &s->file, &s->conditions, scratch, floats);
    view.from = s;
    view.altitude = s->conditions.altitude;
    for (w = 0; w < s->file.wavelengths; w++) ones[w] = 1;
    welkin_xyz(&s->file, ones, view.white);
    air_find_reach(&view, s->file.planet_radius);
    if (!error) air_find_shape(&view);
    if (!error) error = air_fill(&view, rows, columns, highest);
    if (!error) error = sunlight_fill(&view, s->conditions.solar_elevation);
    if (!error) error = skylight_find(baked, rgb);
    for (c = 0; c < 3; c++) air_header[15 + c] = (float)rgb[c];
    free(scratch);
    return error;
}

#endif
