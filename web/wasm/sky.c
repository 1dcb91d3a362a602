/* What the page asks of a model: which bytes a sky needs, the sky in tables for a shader, and single directions.
 *
 * A file lies in memory at its full length before all of its bytes are there; the head tells which ones a sky needs.
 * The tables are those of welkin_bake, whose coordinates the shader repeats, with Stokes components at the same nodes.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#define WELKIN_STATIC
#define WELKIN_IMPLEMENTATION
#include "welkin.h"

#include "ground.h"
#include "moon.h"
#include "space.h"
#include "sun.h"

#define EXPORT(name) __attribute__((export_name(#name)))

enum { FILES = 2, MOST_RANGES = 64, HEADER = 12, RINGS = 16, SPOKES = 32 };

/* A model of which the page may hold two: one for colours, one for spectra. */
typedef struct slot {
    welkin_file file, moonlit;
    moon_light moon;
    welkin_sky sky;
    float *scratch;
    unsigned char *bytes;
    size_t length, capacity;
    int is_moonlit; /* the sky */
    welkin_conditions conditions;
} slot;

static slot slots[FILES];
static float *table;
static size_t table_floats;
static float header[HEADER], lattice[RINGS * SPOKES];
static double ranges[2 * MOST_RANGES];
static uint32_t range_count;
static double answers[4 * WELKIN_MAX_WAVELENGTHS];
static welkin_baked last_baked; /* lies in the memory of the table */
static float disc[SUN_HEADER + SUN_FLOATS];

/* Memory for the bytes of a file of this length, all zero; null if there is none. */
EXPORT(reserve) unsigned char *reserve(uint32_t index, uint32_t length)
{
    slot *s = &slots[index];
    free(s->bytes);
    memset(&s->file, 0, sizeof s->file);
    memset(&s->sky, 0, sizeof s->sky);
    s->bytes = calloc(1, (size_t)length + MOON_BYTES);
    s->length = s->bytes ? length : 0;
    return s->bytes;
}

/* Looks at the head, and at what came since. Skies are to be prepared anew. */
EXPORT(open_file) welkin_error open_file(uint32_t index)
{
    slot *s = &slots[index];
    memset(&s->sky, 0, sizeof s->sky);
    return welkin_open(&s->file, s->bytes, s->length);
}

EXPORT(count_of) uint32_t count_of(uint32_t index, uint32_t what)
{
    const welkin_file *f = &slots[index].file;
    return what == 0 ? f->wavelengths : what == 1 ? f->altitudes : f->visibilities;
}

EXPORT(node_of) double node_of(uint32_t index, uint32_t what, uint32_t node)
{
    const welkin_file *f = &slots[index].file;
    return what == 0 ? welkin_wavelength(f, node) : what == 1 ? welkin_altitude(f, node) : welkin_visibility(f, node);
}

EXPORT(elevation_limit) double elevation_limit(uint32_t index, int highest)
{
    return highest ? slots[index].file.elevation_max : slots[index].file.elevation_min;
}

EXPORT(radius) double radius(uint32_t index) { return slots[index].file.planet_radius; }
#include "air.h"
#include "terrain.h"

static void want(const welkin__entry *entry)
{
    if (range_count >= MOST_RANGES) return;
    ranges[2 * range_count] = (double)entry->offset;
    ranges[2 * range_count + 1] = (double)entry->stored;
    range_count++;
}

static welkin_error want_kind(const welkin_file *f, uint32_t kind)
{
    welkin__entry entry;
    welkin_error error = welkin__find(f, kind, WELKIN__NONE, WELKIN__NONE, &entry);
    if (!error) want(&entry);
    return error;
}

/* What the ground needs besides: the air, and skies where it lies. */
static welkin_error want_ground(const welkin_file *f, double visibility)
{
    welkin__scene scene;
    welkin_error error = want_kind(f, WELKIN__TRANSMITTANCE);
    uint32_t i;
    if (!error) error = welkin__find_scene(f, welkin_altitude(f, 0), visibility, 0, &scene);
    for (i = 0; !error && i < scene.columns; i++) want(&scene.column[i].entry);
    for (i = 0; !error && i < scene.radiances; i++) want(&scene.radiance[i].entry);
    return error;
}

/* Offsets and lengths of the chunks that a sky under these conditions needs, and a ground if it is to have one;
 * `spectral` adds what lies between the nodes. */
EXPORT(plan)
welkin_error plan(uint32_t index, double altitude, double visibility, int polarised, int grounded, int spectral)
{
    const welkin_file *f = &slots[index].file;
    welkin_conditions c = {altitude, visibility, 0, 0, 0};
    welkin__scene scene;
    welkin_error error;
    uint32_t i;
    range_count = 0;
    if (!f->bytes) return WELKIN_ERROR_STATE;
    if (!welkin__conditions_into_range(f, &c)) return WELKIN_ERROR_RANGE;
    error = welkin__find_scene(f, c.altitude, c.visibility, polarised ? WELKIN_POLARISED : 0, &scene);
    if (!error && welkin__has_estimates(f)) error = want_kind(f, WELKIN__ESTIMATE);
    if (!error && spectral) error = want_kind(f, WELKIN__SPECTRUM);
    if (!error && grounded) error = want_ground(f, c.visibility);
    if (error) return error;
    want(&scene.basis);
    for (i = 0; i < scene.columns; i++) want(&scene.column[i].entry);
    for (i = 0; i < scene.radiances; i++) want(&scene.radiance[i].entry);
    if (polarised) want(&scene.polarisation_basis);
    for (i = 0; polarised && i < scene.radiances; i++) want(&scene.polarisation[i].entry);
    return WELKIN_OK;
}

/* Adds what the sun's disc needs. */
EXPORT(plan_disc) welkin_error plan_disc(uint32_t index) { return want_kind(&slots[index].file, WELKIN__TRANSMITTANCE); }

/* Adds what the air before a landscape needs. */
EXPORT(plan_air) welkin_error plan_air(uint32_t index, double visibility)
{
    const welkin_file *f = &slots[index].file;
    welkin_conditions c = {welkin_altitude(f, 0), visibility, 0, 0, 0};
    welkin__stencil nodes;
    uint32_t i;
    welkin__entry entry;
    welkin_error error = want_kind(f, WELKIN__TRANSMITTANCE);
    if (!error) error = want_kind(f, WELKIN__SOURCE_BASIS);
    if (error || !welkin__conditions_into_range(f, &c)) return error ? error : WELKIN_ERROR_RANGE;
    nodes = welkin__cubic(f->bytes + f->visibility_at, f->visibilities, c.visibility, WELKIN__INVERSE);
    for (i = 0; i < nodes.count && !error; i++) {
        if (nodes.weight[i] == 0) continue;
        error = welkin__find(f, WELKIN__SOURCE, WELKIN__NONE, nodes.node[i], &entry);
        if (!error) want(&entry);
    }
    return error;
}

EXPORT(range_total) uint32_t range_total(void) { return range_count; }
EXPORT(range_list) double *range_list(void) { return ranges; }

static welkin_error make_room(slot *s, size_t floats)
{
    if (floats <= s->capacity) return WELKIN_OK;
    free(s->scratch);
    s->scratch = malloc(floats * sizeof(float));
    s->capacity = s->scratch ? floats : 0;
    return s->scratch ? WELKIN_OK : WELKIN_ERROR_SCRATCH;
}

/* A sky with its light in azimuth 0: the sun, or, with a phase angle (degrees) of 0 or more, the moon. */
EXPORT(prepare)
welkin_error prepare(uint32_t index, double altitude, double visibility, double albedo, double elevation, double phase,
                     int polarised)
{
    slot *s = &slots[index];
    welkin_conditions c = {altitude, visibility, albedo, elevation, 0};
    unsigned flags = WELKIN_DENSE | (polarised ? WELKIN_POLARISED : 0);
    size_t floats = welkin_scratch_floats(&s->file, flags);
    welkin_error error = s->file.bytes ? WELKIN_OK : WELKIN_ERROR_STATE;
    memset(&s->sky, 0, sizeof s->sky);
    if (!error) error = make_room(s, floats);
    s->conditions = c;
    s->is_moonlit = phase >= 0;
    if (!error && s->is_moonlit) {
        moon_prepare(&s->moon, phase);
        moon_file(&s->moonlit, &s->file, s->bytes, &s->moon);
    }
    return error ? error : welkin_prepare(&s->sky, s->is_moonlit ? &s->moonlit : &s->file, &c, flags, s->scratch, floats);
}

/* Q/I and U/I sin(azimuth) of X, Y and Z: smooth also where the sky is symmetric. */
static welkin_error bake_degrees(const welkin_sky *sky, const welkin_baked *b, uint32_t row, uint32_t column, float *out)
{
    float radiance[WELKIN_MAX_WAVELENGTHS], q[WELKIN_MAX_WAVELENGTHS], u[WELKIN_MAX_WAVELENGTHS];
    double elevation = welkin__row_elevation(b, row), azimuth = welkin__column_azimuth(b, column), direction[3];
    double light[3], parts[2][3];
    welkin_error error;
    int c;
    if (row == 0) elevation += WELKIN__BESIDE_HORIZON;
    if (row == b->resolution.up + 1) elevation -= WELKIN__BESIDE_HORIZON;
    azimuth = fmin(fmax(azimuth, 1e-3), WELKIN__PI - 1e-3);
    welkin__point(b, sin(elevation), cos(elevation), azimuth, direction);
    error = welkin_stokes(sky, direction, radiance, q, u);
    if (error) return error;
    welkin_xyz(sky->file, radiance, light);
    welkin_xyz(sky->file, q, parts[0]);
    welkin_xyz(sky->file, u, parts[1]);
    for (c = 0; c < 3; c++) {
        out[c] = light[c] > 0 ? (float)(parts[0][c] / light[c]) : 0;
        out[4 + c] = light[c] > 0 ? (float)(parts[1][c] / light[c] / sin(azimuth)) : 0;
    }
    out[3] = out[7] = 0;
    return WELKIN_OK;
}

/* [node][root, Q, U][4], of which the last two only where the sky is polarised. */
static welkin_error spread(const slot *s, const welkin_baked *b, int polarised)
{
    uint32_t rows = b->resolution.up + b->resolution.down + 2, columns = b->resolution.azimuths + 1, row, column;
    size_t nodes = (size_t)rows * columns, i;
    float *degrees = table + 4 * nodes;
    for (i = 0; i < nodes; i++) {
        memcpy(table + 4 * i, b->root + 3 * i, 3 * sizeof(float));
        table[4 * i + 3] = 0;
    }
    for (row = 0; polarised && row < rows; row++)
        for (column = 0; column < columns; column++) {
            welkin_error error = bake_degrees(&s->sky, b, row, column, degrees + 8 * ((size_t)row * columns + column));
            if (error) return error;
        }
    return WELKIN_OK;
}

/* Luminances over the upper hemisphere, of which the library exposes pictures; from the light's azimuth on. */
static void luminances(const welkin_baked *b)
{
    int i;
    for (i = 0; i < RINGS * SPOKES; i++) {
        double z = (i / SPOKES + 0.5) / RINGS, level = sqrt(1 - z * z), azimuth = 2 * WELKIN__PI * (i % SPOKES) / SPOKES;
        double direction[3] = {level * cos(azimuth), level * sin(azimuth), z}, xyz[3];
        if (welkin_baked_xyz(b, direction, xyz)) xyz[1] = 0;
        lattice[i] = (float)xyz[1];
    }
}

/* Adds what is seen of the ground to the rows below the horizon; its light is not polarised. */
static welkin_error add_ground(const slot *s, const welkin_baked *b, int polarised)
{
    static ground under;
    uint32_t row, column, up = b->resolution.up, columns = b->resolution.azimuths + 1;
    uint32_t rows = up + b->resolution.down + 2;
    welkin_error error = ground_prepare(&under, s->sky.file, &s->conditions, b->dip, 0.025);
    for (row = up + 1; row < rows && !error; row++)
        for (column = 0; column < columns && !error; column++) {
            size_t node = (size_t)row * columns + column, c;
            double elevation = welkin__row_elevation(b, row), direction[3], xyz[3];
            float radiance[WELKIN_MAX_WAVELENGTHS], *root = table + 4 * node;
            float *degrees = table + 4 * (size_t)rows * columns + 8 * node;
            if (row == up + 1) elevation -= WELKIN__BESIDE_HORIZON;
            welkin__point(b, sin(elevation), cos(elevation), welkin__column_azimuth(b, column), direction);
            error = ground_seen(&under, direction, radiance);
            welkin_xyz(s->sky.file, radiance, xyz);
            for (c = 0; c < 3 && !error; c++) {
                double sky = (double)root[c] * (double)root[c], both = sky + fmax(xyz[c], 0);
                root[c] = (float)sqrt(both);
                if (polarised && both > 0) degrees[c] *= (float)(sky / both), degrees[4 + c] *= (float)(sky / both);
            }
        }
    return error;
}

/* Room in the table. */
static welkin_error make_table(size_t floats)
{
    if (floats <= table_floats) return WELKIN_OK;
    free(table);
    table = malloc(floats * sizeof(float));
    table_floats = table ? floats : 0;
    return table ? WELKIN_OK : WELKIN_ERROR_SCRATCH;
}

static void describe(const welkin_baked *b, double elevation)
{
    const float values[HEADER] = {(float)b->dip,       (float)b->sun_height,          (float)b->sun_at,
                                  (float)b->turn_at,   (float)b->up_end,              (float)b->down_end,
                                  (float)b->azimuth_end, (float)b->resolution.up,     (float)b->resolution.down,
                                  (float)b->resolution.azimuths, (float)elevation, 0};
    memcpy(header, values, sizeof header);
}

/* Fills the table with the prepared sky. */
EXPORT(bake)
welkin_error bake(uint32_t index, uint32_t up, uint32_t down, uint32_t azimuths, int polarised, int grounded)
{
    slot *s = &slots[index];
    welkin_resolution resolution = {up, down, azimuths, 0};
    size_t nodes = (size_t)(up + down + 2) * (azimuths + 1), baked_floats = welkin_bake_floats(&s->file, &resolution);
    size_t floats = 12 * nodes + baked_floats;
    welkin_baked baked;
    welkin_error error;
    if (!s->sky.file) return WELKIN_ERROR_STATE;
    error = make_table(floats);
    if (!error) error = welkin_bake(&baked, &s->sky, &resolution, table + 12 * nodes, baked_floats);
    if (!error) error = spread(s, &baked, polarised);
    if (!error && grounded) error = add_ground(s, &baked, polarised);
    if (error) return error;
    last_baked = baked;
    describe(&baked, asin(s->sky.sun[2]));
    luminances(&baked);
    return WELKIN_OK;
}

/* Fills the table with the air from outside, for suns from `low` to `high` (rad) where rays meet it; the header says how
 * many layers these are. */
EXPORT(bake_space)
welkin_error bake_space(uint32_t index, double visibility, double albedo, double low, double high, double step,
                        uint32_t up, uint32_t down, uint32_t columns, int grounded)
{
    slot *s = &slots[index];
    welkin_conditions c = {0, visibility, albedo, 0, 0};
    space_grid g = {.up = up, .down = down, .columns = columns};
    size_t floats = welkin_scratch_floats(&s->file, WELKIN_DENSE);
    welkin_error error = s->file.bytes ? WELKIN_OK : WELKIN_ERROR_STATE;
    memset(&s->sky, 0, sizeof s->sky);
    if (!error) error = make_room(s, floats);
    if (error) return error;
    space_layout(&g, &s->file, low, high, step);
    error = make_table((size_t)4 * (g.layers + 1) * space_rows(&g) * (columns + 1));
    if (error) return error;
    const float values[SPACE_HEADER] = {(float)g.dip, (float)g.up_end, (float)g.down_end, (float)g.azimuth_end,
                                        (float)g.first, (float)g.step, (float)g.layers, 0};
    memcpy(header, values, sizeof values);
    return space_fill(&g, &s->file, &c, grounded, step / 6, s->scratch, floats, table);
}

/* Optical thickness of molecules and particles over that of molecules, at the wavelength next to 550 nm: the library's
 * `Model::turbidity`. Not above 0 if there is an error. */
EXPORT(turbidity) double turbidity(uint32_t index, double visibility)
{
    const double molecules = 0.0971, ozone = 0.0306, up[3] = {0, 0, 1};
    const welkin_file *f = &slots[index].file;
    welkin_transmittance_profile air;
    float through[WELKIN_MAX_WAVELENGTHS];
    uint32_t w, best = 0;
    welkin_error error = f->bytes ? welkin_transmittance_prepare(&air, f, visibility) : WELKIN_ERROR_STATE;
    if (!error) error = welkin_transmittance(&air, 0, up, 2e5, through);
    if (error) return -(double)error;
    for (w = 1; w < f->wavelengths; w++)
        if (fabs(welkin_wavelength(f, w) - 550) < fabs(welkin_wavelength(f, best) - 550)) best = w;
    return (-log((double)through[best]) - ozone) / molecules;
}

/* The disc over the prepared sky: its header, and its table. */
EXPORT(bake_disc) welkin_error bake_disc(uint32_t index)
{
    return sun_fill(&slots[index].file, &slots[index].conditions, disc + SUN_HEADER, disc);
}

/* The air below an elevation under the sky that was baked last. */
EXPORT(bake_air) welkin_error bake_air(uint32_t index, uint32_t rows, uint32_t columns, double highest)
{
    return air_bake(&slots[index], &last_baked, rows, columns, highest);
}

EXPORT(air_at) float *air_at(void) { return air_table; }
EXPORT(air_header_at) float *air_header_at(void) { return air_header; }
EXPORT(sunlight_at) float *sunlight_at(void) { return sunlight; }
EXPORT(disc_at) float *disc_at(void) { return disc; }

EXPORT(table_at) float *table_at(void) { return table; }
EXPORT(header_at) float *header_at(void) { return header; }
EXPORT(lattice_at) float *lattice_at(void) { return lattice; }
EXPORT(answers_at) double *answers_at(void) { return answers; }

/* Wavelength, radiance, Q and U (W m^-2 sr^-1 nm^-1) of the prepared sky, at the wavelengths of the
 * file, or, with a step above 0, from `first` on every `step` nm. Returns minus an error, or how many there are. */
EXPORT(look) int look(uint32_t index, double x, double y, double z, double first, double step, uint32_t count)
{
    slot *s = &slots[index];
    float radiance[WELKIN_MAX_WAVELENGTHS], q[WELKIN_MAX_WAVELENGTHS], u[WELKIN_MAX_WAVELENGTHS];
    double direction[3] = {x, y, z};
    int polarised = (s->sky.flags & WELKIN_POLARISED) != 0;
    welkin_error error;
    uint32_t i, c;
    memset(q, 0, sizeof q);
    memset(u, 0, sizeof u);
    error = polarised ? welkin_stokes(&s->sky, direction, radiance, q, u) : welkin_radiance(&s->sky, direction, radiance);
    if (!(step > 0)) count = s->file.wavelengths;
    if (count > WELKIN_MAX_WAVELENGTHS) return -(int)WELKIN_ERROR_RANGE;
    for (i = 0; i < count && !error; i++) {
        double wavelength = step > 0 ? first + step * i : welkin_wavelength(&s->file, i), stokes[3], irradiance;
        error = welkin_irradiance_at(&s->file, wavelength, &irradiance);
        stokes[0] = (double)radiance[i % s->file.wavelengths], stokes[1] = (double)q[i % s->file.wavelengths];
        stokes[2] = (double)u[i % s->file.wavelengths];
        if (!error && step > 0) error = welkin_stokes_at(&s->file, radiance, q, u, wavelength, stokes);
        if (s->is_moonlit) irradiance *= moon_relative(&s->moon, wavelength);
        answers[4 * i] = wavelength;
        for (c = 0; c < 3; c++) answers[4 * i + 1 + c] = stokes[c] * irradiance;
    }
    return error ? -(int)error : (int)count;
}

EXPORT(error_text) const char *error_text(welkin_error error) { return welkin_error_name(error); }
