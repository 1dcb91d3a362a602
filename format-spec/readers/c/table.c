/* Tests colour spaces, baked skies and sampling: ./table FILE. SPDX-License-Identifier: MIT OR Apache-2.0 */
#define WELKIN_IMPLEMENTATION
#include "welkin.h"

#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

static int failures, checks;

static void check(int good, const char *what, double value)
{
    checks++;
    if (good) return;
    failures++;
    printf("failed: %s (%.9g)\n", what, value);
}

static double uniform(void)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) / 9007199254740992.0;
}

static void random_direction(double direction[3])
{
    double z = 2 * uniform() - 1, azimuth = 2 * PI * uniform(), level = sqrt(1 - z * z);
    direction[0] = level * cos(azimuth);
    direction[1] = level * sin(azimuth);
    direction[2] = z;
}

/* ---- colour spaces ---- */

static void invert(double a[3][3], double out[3][3])
{
    double determinant = 0;
    int i, j;
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++)
            out[j][i] = a[(i + 1) % 3][(j + 1) % 3] * a[(i + 2) % 3][(j + 2) % 3] -
                        a[(i + 1) % 3][(j + 2) % 3] * a[(i + 2) % 3][(j + 1) % 3];
    for (i = 0; i < 3; i++) determinant += a[0][i] * out[i][0];
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++) out[i][j] /= determinant;
}

static void apply(double a[3][3], const double v[3], double out[3])
{
    int i;
    for (i = 0; i < 3; i++) out[i] = a[i][0] * v[0] + a[i][1] * v[1] + a[i][2] * v[2];
}

static void from_chromaticity(const double xy[2], double xyz[3])
{
    xyz[0] = xy[0] / xy[1];
    xyz[1] = 1;
    xyz[2] = (1 - xy[0] - xy[1]) / xy[1];
}

/* From XYZ to a space of these primaries and white, its light adapted from `lit` by Bradford's method. */
static void derive(double xy[4][2], const double lit[2], const double xyz[3], double rgb[3])
{
    static double bradford[3][3] = {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}};
    double primaries[3][3], inverse[3][3], back[3][3], white[3], source[3], cone[3], cone_white[3], cone_source[3],
        size[3], adapted[3];
    int i, j;
    for (i = 0; i < 3; i++) {
        double primary[3];
        from_chromaticity(xy[i], primary);
        for (j = 0; j < 3; j++) primaries[j][i] = primary[j];
    }
    from_chromaticity(xy[3], white);
    from_chromaticity(lit, source);
    invert(primaries, inverse);
    apply(inverse, white, size);
    apply(bradford, xyz, cone);
    apply(bradford, white, cone_white);
    apply(bradford, source, cone_source);
    for (i = 0; i < 3; i++) cone[i] *= cone_white[i] / cone_source[i];
    invert(bradford, back);
    apply(back, cone, adapted);
    apply(inverse, adapted, rgb);
    for (i = 0; i < 3; i++) rgb[i] /= size[i];
}

static void test_colour_spaces(void)
{
    static double chromaticities[3][4][2] = {{{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3127, 0.329}},
                                             {{0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, {0.3127, 0.329}},
                                             {{0.713, 0.293}, {0.165, 0.83}, {0.128, 0.044}, {0.32168, 0.33767}}};
    static const double lit[2] = {0.3127, 0.329}, colour[3] = {0.3, 0.2, 0.7};
    welkin_colour_space space;
    double rgb[3], expected[3];
    int i, j;
    for (i = 0; i < 4; i++) {
        const char *name = welkin_colour_space_name((welkin_colour_space)i);
        check(name && !welkin_colour_space_named(name, &space) && space == (welkin_colour_space)i, "names of spaces",
              i);
        check(!welkin_rgb((welkin_colour_space)i, colour, rgb), "a colour", i);
        if (i < 3) derive(chromaticities[i], lit, colour, expected);
        for (j = 0; j < 3; j++) check(fabs(rgb[j] - (i < 3 ? expected[j] : colour[j])) < 5e-7, "components", rgb[j]);
    }
    check(welkin_colour_space_named("sRGB ", &space) == WELKIN_ERROR_RANGE, "an unknown name", 0);
    check(welkin_colour_space_named(NULL, &space) == WELKIN_ERROR_RANGE, "no name", 0);
    memcpy(expected, rgb, sizeof rgb);
    rgb[0] = 1e308;
    rgb[1] = -1e308;
    check(welkin_rgb(WELKIN_SRGB, rgb, rgb) == WELKIN_ERROR_VALUE, "a colour that overflows", rgb[0]);
    rgb[0] = HUGE_VAL;
    check(welkin_rgb(WELKIN_XYZ, rgb, rgb) == WELKIN_ERROR_VALUE, "an infinite colour", rgb[0]);
}

/* ---- baked skies ---- */

typedef struct scene {
    welkin_sky sky;
    welkin_baked baked;
    float *scratch, *memory;
} scene;

static float *floats(size_t count)
{
    float *memory = malloc(count * sizeof *memory);
    if (!memory) exit(2);
    return memory;
}

/* Memory of just the sizes that are asked for: an access beyond them is seen by sanitizers. */
static void open_scene(scene *s, const welkin_file *file, double altitude, double elevation,
                       welkin_resolution resolution)
{
    welkin_conditions conditions = {0, 50e3, 0.3, 0, 1};
    size_t size = welkin_scratch_floats(file, WELKIN_DENSE), table = welkin_bake_floats(file, &resolution);
    conditions.altitude = altitude;
    conditions.solar_elevation = elevation * PI / 180;
    s->scratch = floats(size);
    s->memory = floats(table);
    check(!welkin_prepare(&s->sky, file, &conditions, WELKIN_DENSE, s->scratch, size), "a sky", elevation);
    check(welkin_bake(&s->baked, &s->sky, &resolution, s->memory, table - 1) == WELKIN_ERROR_SCRATCH,
          "too little memory", 0);
    check(!welkin_bake(&s->baked, &s->sky, &resolution, s->memory, table), "a baked sky", elevation);
}

static void close_scene(scene *s)
{
    free(s->scratch);
    free(s->memory);
}

static double luminance(const welkin_sky *sky, const double direction[3])
{
    float radiance[WELKIN_MAX_WAVELENGTHS];
    double xyz[3];
    check(!welkin_radiance(sky, direction, radiance), "a radiance", 0);
    welkin_xyz(sky->file, radiance, xyz);
    return xyz[1];
}

static double baked_luminance(const welkin_baked *baked, const double direction[3])
{
    double xyz[3];
    check(!welkin_baked_xyz(baked, direction, xyz), "a baked colour", 0);
    return xyz[1];
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Errors of a colour table as the header defines them, but counted another way, at other directions. */
static double measure_p99(const scene *s)
{
    static double errors[4000];
    double brightest[3] = {0, 0, 0};
    size_t node, nodes = welkin__baked_nodes(&s->baked.resolution);
    int i, k;
    for (node = 0; node < nodes; node++)
        for (k = 0; k < 3; k++) {
            double root = (double)s->memory[3 * node + (size_t)k];
            brightest[k] = fmax(brightest[k], root * root);
        }
    for (i = 0; i < 4000; i++) {
        float radiance[WELKIN_MAX_WAVELENGTHS];
        double direction[3], exact[3], baked[3];
        random_direction(direction);
        check(!welkin_radiance(&s->sky, direction, radiance), "a radiance", 0);
        welkin_xyz(s->sky.file, radiance, exact);
        check(!welkin_baked_xyz(&s->baked, direction, baked), "a baked colour", 0);
        errors[i] = 0;
        for (k = 0; k < 3; k++)
            if (exact[k] > 0)
                errors[i] = fmax(errors[i], fabs(baked[k] - exact[k]) / fmax(exact[k], 1e-4 * brightest[k]));
    }
    qsort(errors, 4000, sizeof *errors, compare);
    return errors[3959];
}

static void test_errors(const welkin_file *file)
{
    static const welkin_resolution small = {48, 24, 32, 0}, large = {96, 48, 64, 0}, spectral = {48, 24, 32, 1};
    static const double elevations[4] = {-4, 2, 30, 80};
    double p99, largest, finer, own;
    int i;
    for (i = 0; i < 4; i++) {
        scene s;
        open_scene(&s, file, 500, elevations[i], small);
        check(!welkin_baked_error(&s.baked, &s.sky, 4000, &p99, &largest), "an error", 0);
        check(p99 > 0 && p99 < 0.005 && largest >= p99, "the error of a small table", p99);
        own = measure_p99(&s);
        check(p99 > 0.8 * own && p99 < 1.3 * own, "the error next to one of other directions", p99 / own);
        close_scene(&s);
        open_scene(&s, file, 500, elevations[i], large);
        check(!welkin_baked_error(&s.baked, &s.sky, 4000, &finer, &largest), "an error", 0);
        check(finer < 0.45 * p99, "the error of a table twice as fine", finer / p99);
        close_scene(&s);
    }
    {
        scene s;
        open_scene(&s, file, 500, 30, spectral);
        check(!welkin_baked_error(&s.baked, &s.sky, 1000, &p99, &largest), "an error", 0);
        check(p99 > 0 && p99 < 0.02, "the error of a spectral table", p99);
        close_scene(&s);
    }
}

/* Just above and below the geometric horizon, where radiance jumps. */
static void test_horizon(const welkin_file *file)
{
    static const welkin_resolution resolution = {48, 24, 32, 0};
    double jump = 0;
    scene s;
    int i, side;
    open_scene(&s, file, 30, 10, resolution);
    for (i = 0; i < 64; i++) {
        double exact[2], azimuth = 2 * PI * uniform();
        for (side = 0; side < 2; side++) {
            double elevation = (side ? 1e-7 : -1e-7) - s.sky.dip, direction[3];
            direction[0] = cos(elevation) * cos(azimuth);
            direction[1] = cos(elevation) * sin(azimuth);
            direction[2] = sin(elevation);
            exact[side] = luminance(&s.sky, direction);
            check(fabs(baked_luminance(&s.baked, direction) / exact[side] - 1) < 0.01, "a side of the horizon",
                  elevation);
        }
        jump = fmax(jump, exact[1] / exact[0]);
    }
    check(jump > 1.2, "the jump itself", jump);
    close_scene(&s);
}

static void test_spectral(const welkin_file *file)
{
    static const welkin_resolution resolution = {16, 8, 12, 1};
    static const double direction[3] = {0.2, -3, 0.7};
    float radiance[WELKIN_MAX_WAVELENGTHS];
    double xyz[3], baked[3];
    scene s;
    open_scene(&s, file, 500, 30, resolution);
    check(!welkin_baked_radiance(&s.baked, direction, radiance), "a baked radiance", 0);
    welkin_xyz(file, radiance, xyz);
    check(!welkin_baked_xyz(&s.baked, direction, baked), "the colour of a spectral table", 0);
    check(memcmp(xyz, baked, sizeof xyz) == 0, "is that of its radiance", baked[1]);
    check(fabs(baked[1] / luminance(&s.sky, direction) - 1) < 0.02, "is near that of the sky", baked[1]);
    close_scene(&s);
}

/* ---- sampling ---- */

#define ROWS 16
#define COLUMNS 32
#define SAMPLES 100000
#define POINTS 8 /* squared, per bin */

static int bin_of(const double v[3])
{
    int row = (int)((v[2] + 1) / 2 * ROWS), column = (int)((atan2(v[1], v[0]) / (2 * PI) + 0.5) * COLUMNS);
    row = row < ROWS ? row : ROWS - 1;
    column = column < COLUMNS ? column : COLUMNS - 1;
    return row * COLUMNS + column;
}

/* Integrals of the density over each bin, and of the luminance over the sphere, at a point in each cell of a grid. */
static double integrate(const scene *s, double *share)
{
    double light = 0, cell = 4 * PI / (ROWS * COLUMNS * POINTS * POINTS), direction[3], pdf = 0;
    int i, j;
    for (i = 0; i < ROWS * COLUMNS; i++) share[i] = 0;
    for (i = 0; i < ROWS * POINTS; i++)
        for (j = 0; j < COLUMNS * POINTS; j++) {
            double z = 2 * (i + uniform()) / (ROWS * POINTS) - 1,
                   azimuth = 2 * PI * ((j + uniform()) / (COLUMNS * POINTS) - 0.5);
            direction[0] = sqrt(1 - z * z) * cos(azimuth);
            direction[1] = sqrt(1 - z * z) * sin(azimuth);
            direction[2] = z;
            check(!welkin_sample_pdf(&s->baked, direction, &pdf), "a density", z);
            check(pdf > 0 && pdf <= DBL_MAX, "a finite density above 0", pdf);
            share[bin_of(direction)] += pdf * cell;
            light += luminance(&s->sky, direction) * cell;
        }
    return light;
}

static void test_distribution(const welkin_file *file, double altitude, double elevation, int spectral)
{
    static const welkin_resolution colour = {48, 24, 32, 0}, spectrum = {32, 16, 24, 1};
    static double share[ROWS * COLUMNS];
    static long count[ROWS * COLUMNS];
    double light, total = 0, chi = 0, estimate = 0, squares = 0, largest = 0;
    long i, bins = 0, below = 0;
    scene s;
    open_scene(&s, file, altitude, elevation, spectral ? spectrum : colour);
    light = integrate(&s, share);
    memset(count, 0, sizeof count);
    for (i = 0; i < SAMPLES; i++) {
        double direction[3], pdf = 0, again = 0, value, u1 = uniform(), u2 = uniform();
        check(!welkin_sample(&s.baked, u1, u2, direction, &pdf), "a sample", 0);
        check(!welkin_sample_pdf(&s.baked, direction, &again), "the density of a sample", 0);
        check(fabs(again / pdf - 1) < 1e-9, "one density of a sample", again / pdf);
        check(fabs(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2] - 1) < 1e-12,
              "a unit vector", 0);
        count[bin_of(direction)]++;
        below += direction[2] < 0;
        if (i % 10) continue;
        value = luminance(&s.sky, direction) / pdf;
        estimate += value;
        squares += value * value;
        largest = fmax(largest, value);
    }
    for (i = 0; i < ROWS * COLUMNS; i++) {
        double expected = share[i] * SAMPLES, difference = (double)count[i] - expected;
        total += share[i];
        if (expected < 5) continue;
        chi += difference * difference / expected;
        bins++;
    }
    estimate /= SAMPLES / 10;
    squares = sqrt(fmax(squares / (SAMPLES / 10) - estimate * estimate, 0)) / estimate;
    printf("h %6.0f m, sun %3.0f deg, %s: density %.5f, chi^2 %.0f of %ld bins, estimate %.4f, deviation of a sample "
           "%.3f\n",
           altitude, elevation, spectral ? "spectral" : "colour", total, chi, bins, estimate / light, squares);
    check(fabs(total - 1) < 2e-3, "the integral of the density", total);
    check(bins > 100 && chi < (double)bins + 5 * sqrt(2.0 * (double)bins), "chi squared", chi);
    check(fabs(estimate / light - 1) < 5e-3, "the integral of the luminance", estimate / light);
    check(squares < 0.3 && largest < 20 * estimate, "the deviation of samples", squares);
    check(altitude > 0 || below < SAMPLES / 500, "samples in the dark", (double)below);
    close_scene(&s);
}

/* ---- bad questions ---- */

static void test_refusals(const welkin_file *file)
{
    static const welkin_resolution bad[6] = {{0, 1, 1, 0},   {1, 0, 1, 0},          {1, 1, 0, 1},
                                             {513, 1, 1, 0}, {1, UINT32_MAX, 1, 1}, {1, 1, 513, 0}};
    static const welkin_resolution least[3] = {{1, 1, 1, 0}, {2, 1, 2, 1}, {3, 2, 1, 0}};
    static const double numbers[4] = {-1e-9, 1.0000001, HUGE_VAL, -HUGE_VAL};
    const double nowhere[3] = {0, 0, 0}, up[3] = {0, 0, 1}, unknown[3] = {0, HUGE_VAL - HUGE_VAL, 1};
    double direction[3], pdf, xyz[3], largest;
    float radiance[WELKIN_MAX_WAVELENGTHS];
    welkin_baked other;
    welkin_file copy = *file;
    scene s;
    int i, j;
    for (i = 0; i < 3; i++) {
        open_scene(&s, file, 500, 5, least[i]);
        for (j = 0; j < 2000; j++) {
            random_direction(direction);
            check(baked_luminance(&s.baked, direction) >= 0, "the light of a tiny table", i);
            check(!welkin_sample_pdf(&s.baked, direction, &pdf) && pdf > 0, "the density of a tiny table", i);
            check(!welkin_sample(&s.baked, j / 1999.0, 1 - j / 1999.0, direction, &pdf) && pdf > 0,
                  "a sample of a tiny table", i);
        }
        if (i < 2) close_scene(&s);
    }
    for (i = 0; i < 6; i++) {
        check(welkin_bake_floats(file, &bad[i]) == 0, "no size of a bad resolution", i);
        check(welkin_bake(&other, &s.sky, &bad[i], s.memory, 1) == WELKIN_ERROR_RANGE, "a bad resolution", i);
    }
    for (i = 0; i < 5; i++) {
        double number = i < 4 ? numbers[i] : unknown[1];
        check(welkin_sample(&s.baked, number, 0.5, direction, &pdf) == WELKIN_ERROR_RANGE, "a bad first number",
              number);
        check(welkin_sample(&s.baked, 0.5, number, direction, &pdf) == WELKIN_ERROR_RANGE, "a bad second number",
              number);
    }
    check(welkin_baked_xyz(&s.baked, nowhere, xyz) == WELKIN_ERROR_DIRECTION, "no direction", 0);
    check(welkin_baked_xyz(&s.baked, unknown, xyz) == WELKIN_ERROR_DIRECTION, "a direction that is no number", 0);
    check(welkin_sample_pdf(&s.baked, unknown, &pdf) == WELKIN_ERROR_DIRECTION, "the density of no number", 0);
    check(welkin_baked_radiance(&s.baked, up, radiance) == WELKIN_ERROR_MISSING, "radiance of a table of colour", 0);
    check(welkin_baked_error(&s.baked, &s.sky, 0, &pdf, &largest) == WELKIN_ERROR_RANGE, "an error at no direction", 0);
    s.sky.file = &copy;
    check(welkin_baked_error(&s.baked, &s.sky, 9, &pdf, &largest) == WELKIN_ERROR_RANGE, "an error with another file",
          0);
    close_scene(&s);
}

int main(int count, char **arguments)
{
    FILE *stream = count == 2 ? fopen(arguments[1], "rb") : NULL;
    size_t most = (size_t)1 << 26, length;
    unsigned char *bytes = stream ? malloc(most) : NULL;
    welkin_file file;
    if (!bytes) {
        fprintf(stderr, "usage: table FILE\n");
        return 2;
    }
    length = fread(bytes, 1, most, stream);
    fclose(stream);
    if (welkin_open(&file, bytes, length)) {
        fprintf(stderr, "%s does not open\n", arguments[1]);
        return 2;
    }
    test_colour_spaces();
    test_errors(&file);
    test_horizon(&file);
    test_spectral(&file);
    test_distribution(&file, 500, 30, 0);
    test_distribution(&file, 0, 2, 0);
    test_distribution(&file, 12000, -3, 0);
    test_distribution(&file, 500, 89.9, 1);
    test_refusals(&file);
    free(bytes);
    printf("%d checks, %d failed\n", checks, failures);
    return failures != 0;
}
