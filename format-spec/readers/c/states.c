/* Tests what calls that fail leave behind, and what may go after baking: ./states FILE. SPDX-License-Identifier: MIT OR
 * Apache-2.0 */
#define WELKIN_IMPLEMENTATION
#include "welkin.h"
#include "welkin.h" /* a second time does no harm */

#include <stdio.h>
#include <stdlib.h>

static const welkin_conditions good = {500, 40e3, 0.2, 0.35, 1.57};
static const welkin_resolution colour = {12, 6, 8, 0};
static const double direction[3] = {0.6, 0, 0.8};
static float first[WELKIN_MAX_WAVELENGTHS], second[WELKIN_MAX_WAVELENGTHS], third[WELKIN_MAX_WAVELENGTHS];
static float *scratch, *memory;
static size_t scratch_floats, memory_floats;
static int failures, checks;

static void check(int right, const char *what, int line)
{
    checks++;
    if (right) return;
    failures++;
    printf("failed: %s (line %d)\n", what, line);
}

#define CHECK(condition) check(condition, #condition, __LINE__)
#define FAILS(call, class) CHECK((call) == WELKIN_ERROR_##class)

static void *allocate(size_t bytes)
{
    void *block = malloc(bytes);
    if (!block) exit(2);
    return block;
}

/* ---- what is empty refuses questions ---- */

static void refuse_sky(const welkin_sky *sky)
{
    welkin_baked baked;
    double xyz[3];
    FAILS(welkin_radiance(sky, direction, first), STATE);
    FAILS(welkin_stokes(sky, direction, first, second, third), STATE);
    FAILS(welkin_bake(&baked, sky, &colour, memory, memory_floats), STATE);
    FAILS(welkin_baked_xyz(&baked, direction, xyz), STATE);
}

static void refuse_baked(const welkin_baked *baked, const welkin_sky *sky)
{
    double out[3], pdf, largest;
    FAILS(welkin_baked_xyz(baked, direction, out), STATE);
    FAILS(welkin_baked_radiance(baked, direction, first), STATE);
    FAILS(welkin_baked_error(baked, sky, 10, &pdf, &largest), STATE);
    FAILS(welkin_sample(baked, 0.5, 0.5, out, &pdf), STATE);
    FAILS(welkin_sample_pdf(baked, direction, &pdf), STATE);
}

static void refuse_air(const welkin_transmittance_profile *air)
{
    static const double wavelength = 550;
    FAILS(welkin_transmittance(air, 500, direction, 1e4, first), STATE);
    FAILS(welkin_transmittance_at(air, 500, direction, 1e4, &wavelength, 1, first), STATE);
}

static void refuse_aerial(const welkin_aerial_perspective *aerial)
{
    FAILS(welkin_in_scattering(aerial, 500, direction, 1e4, first), STATE);
    FAILS(welkin_in_scattering_stokes(aerial, 500, direction, 1e4, first, second, third), STATE);
}

static void refuse_axis(const welkin_axis *axis)
{
    double visibility;
    FAILS(welkin_axis_visibility(axis, 300, &visibility), STATE);
    CHECK(welkin_axis_value(axis, 0) == 0 && axis->name[0] == 0);
}

static void refuse_file(welkin_file *file)
{
    welkin_axis axis;
    welkin_sky sky;
    welkin_transmittance_profile air;
    welkin_aerial_perspective aerial;
    double values[3];
    FAILS(welkin_prepare(&sky, file, &good, 0, scratch, scratch_floats), STATE);
    refuse_sky(&sky);
    FAILS(welkin_transmittance_prepare(&air, file, 40e3), STATE);
    refuse_air(&air);
    FAILS(welkin_aerial_perspective_prepare(&aerial, file, &good, scratch, scratch_floats), STATE);
    refuse_aerial(&aerial);
    FAILS(welkin_axis_prepare(&axis, file), STATE);
    refuse_axis(&axis);
    FAILS(welkin_wavelength_range(file, values), STATE);
    FAILS(welkin_radiance_at(file, first, 550, values), STATE);
    FAILS(welkin_stokes_at(file, first, second, third, 550, values), STATE);
    FAILS(welkin_irradiance_at(file, 550, values), STATE);
    FAILS(welkin_unpack(file, NULL, NULL, scratch, 0), STATE);
    CHECK(welkin_unpacked_length(file) == 0 && welkin_scratch_floats(file, WELKIN_DENSE) == 0);
    CHECK(welkin_aerial_perspective_floats(file) == 0 && welkin_bake_floats(file, &colour) == 0);
    CHECK(welkin_wavelength(file, 0) == 0 && welkin_altitude(file, 0) == 0 && welkin_visibility(file, 0) == 0);
    welkin_xyz(file, first, values);
    CHECK(values[0] == 0 && values[1] == 0 && values[2] == 0);
}

/* ---- calls that fail, on structs that were ready ---- */

static void fail_open(const unsigned char *bytes, size_t length)
{
    welkin_file file;
    CHECK(!welkin_open(&file, bytes, length));
    FAILS(welkin_open(&file, bytes, length - 1), LENGTH);
    refuse_file(&file);
    CHECK(!welkin_open(&file, bytes, length));
    FAILS(welkin_open(&file, bytes, 100), LENGTH);
    refuse_file(&file);
    memset(&file, 0xAA, sizeof file);
    FAILS(welkin_open(&file, "", 0), MAGIC);
    refuse_file(&file);
}

static void fail_prepare(const welkin_file *file)
{
    static const double numbers[4] = {1, -1, HUGE_VAL, HUGE_VAL - HUGE_VAL};
    size_t least = welkin_scratch_floats(file, WELKIN_POLARISED);
    welkin_conditions bad = good;
    welkin_sky sky;
    welkin_axis axis;
    unsigned flag;
    int i;
    FAILS(welkin_axis_prepare(&axis, file), MISSING);
    refuse_axis(&axis);
    CHECK(!welkin_prepare(&sky, file, &good, WELKIN_POLARISED, scratch, scratch_floats));
    CHECK(!welkin_stokes(&sky, direction, first, second, third));
    FAILS(welkin_prepare(&sky, file, &good, WELKIN_POLARISED, scratch, least - 1), SCRATCH);
    refuse_sky(&sky);
    for (i = 0; i < 4; i++) {
        bad.visibility = numbers[i];
        memset(&sky, 0xAA, sizeof sky);
        FAILS(welkin_prepare(&sky, file, &bad, 0, scratch, scratch_floats), RANGE);
        refuse_sky(&sky);
    }
    for (flag = 4; flag; flag <<= 1) FAILS(welkin_prepare(&sky, file, &good, flag | 1, scratch, scratch_floats), RANGE);
    refuse_sky(&sky);
}

static void fail_bake(const welkin_file *file)
{
    static const welkin_resolution none = {0, 1, 1, 0};
    size_t least = welkin_bake_floats(file, &colour);
    double p99 = -1, largest = -1;
    welkin_baked baked;
    welkin_sky sky, empty;
    CHECK(!welkin_prepare(&sky, file, &good, 0, scratch, scratch_floats));
    CHECK(!welkin_bake(&baked, &sky, &colour, memory, least));
    CHECK(welkin_prepare(&empty, file, &good, 0, scratch, 0) == WELKIN_ERROR_SCRATCH);
    FAILS(welkin_baked_error(&baked, &empty, 10, &p99, &largest), STATE);
    FAILS(welkin_baked_error(&baked, &sky, 0, &p99, &largest), RANGE);
    CHECK(p99 == -1 && largest == -1);
    FAILS(welkin_bake(&baked, &sky, &colour, memory, least - 1), SCRATCH);
    refuse_baked(&baked, &sky);
    CHECK(!welkin_bake(&baked, &sky, &colour, memory, least));
    FAILS(welkin_bake(&baked, &sky, &none, memory, least), RANGE);
    refuse_baked(&baked, &sky);
    sky.radiance.channel[0] = HUGE_VALF; /* the sky answers WELKIN_ERROR_VALUE, when the table is half done */
    FAILS(welkin_bake(&baked, &sky, &colour, memory, least), VALUE);
    refuse_baked(&baked, &sky);
}

static void fail_segments(const welkin_file *file)
{
    static const double numbers[3] = {1, HUGE_VAL, HUGE_VAL - HUGE_VAL};
    welkin_transmittance_profile air;
    welkin_aerial_perspective aerial;
    welkin_conditions bad = good;
    int i;
    for (i = 0; i < 3; i++) {
        CHECK(!welkin_transmittance_prepare(&air, file, 40e3));
        CHECK(!welkin_transmittance(&air, 500, direction, 1e4, first));
        FAILS(welkin_transmittance_prepare(&air, file, numbers[i]), RANGE);
        refuse_air(&air);
        CHECK(!welkin_aerial_perspective_prepare(&aerial, file, &good, scratch, scratch_floats));
        bad.visibility = numbers[i];
        FAILS(welkin_aerial_perspective_prepare(&aerial, file, &bad, scratch, scratch_floats), RANGE);
        refuse_aerial(&aerial);
    }
    CHECK(!welkin_aerial_perspective_prepare(&aerial, file, &good, scratch, scratch_floats));
    FAILS(welkin_aerial_perspective_prepare(&aerial, file, &good, scratch, 0), SCRATCH);
    refuse_aerial(&aerial);
}

/* A bit of the chunks of a kind is wrong; only preparations see it. */
static void damage(unsigned char *bytes, const welkin_file *file, uint32_t kind)
{
    uint32_t i;
    for (i = 0; i < file->chunk_count; i++) {
        welkin__entry entry = welkin__read_entry(file, i);
        if (entry.kind == kind) bytes[entry.offset + entry.stored / 2] ^= 1;
    }
}

static void fail_on_damage(unsigned char *bytes, size_t length)
{
    welkin_file file;
    welkin_sky sky;
    welkin_transmittance_profile air;
    welkin_aerial_perspective aerial;
    uint32_t kind;
    CHECK(!welkin_open(&file, bytes, length));
    for (kind = WELKIN__RADIANCE; kind <= WELKIN__SOURCE_BASIS; kind++) {
        int polarised = kind == WELKIN__POLARISATION || kind == WELKIN__POLARISATION_BASIS;
        if (kind == WELKIN__COLUMN) continue; /* not in every file */
        damage(bytes, &file, kind);
        CHECK(!welkin_open(&file, bytes, length));
        if (kind == WELKIN__RADIANCE || kind == WELKIN__BASIS || polarised) {
            FAILS(welkin_prepare(&sky, &file, &good, WELKIN_POLARISED, scratch, scratch_floats), CHECKSUM);
            refuse_sky(&sky);
        } else {
            FAILS(welkin_aerial_perspective_prepare(&aerial, &file, &good, scratch, scratch_floats), CHECKSUM);
            refuse_aerial(&aerial);
        }
        if (kind == WELKIN__TRANSMITTANCE) {
            FAILS(welkin_transmittance_prepare(&air, &file, 40e3), CHECKSUM);
            refuse_air(&air);
        }
        damage(bytes, &file, kind);
    }
}

/* ---- what may go ---- */

typedef struct answers {
    double xyz[3], sample[3], pdf[2];
} answers;

static answers ask(const welkin_baked *baked)
{
    answers a;
    CHECK(!welkin_baked_xyz(baked, direction, a.xyz) && !welkin_sample(baked, 0.3, 0.8, a.sample, &a.pdf[0]) &&
          !welkin_sample_pdf(baked, direction, &a.pdf[1]));
    return a;
}

/* All but the table lies in blocks that are freed after baking. */
static void outlive_file(const unsigned char *bytes, size_t length)
{
    static float table[WELKIN_BAKE_FLOATS(12, 6, 8, 3)];
    unsigned char *copy = memcpy(allocate(length), bytes, length);
    welkin_file *file = allocate(sizeof *file);
    welkin_sky *sky = allocate(sizeof *sky);
    answers before, after;
    welkin_baked baked;
    CHECK(!welkin_open(file, copy, length));
    CHECK(!welkin_prepare(sky, file, &good, 0, scratch, scratch_floats));
    CHECK(!welkin_bake(&baked, sky, &colour, table, sizeof table / sizeof *table));
    before = ask(&baked);
    memset(copy, 0xAA, length);
    memset(file, 0xAA, sizeof *file);
    memset(sky, 0xAA, sizeof *sky);
    memset(scratch, 0xFF, scratch_floats * sizeof *scratch);
    free(copy);
    free(file);
    free(sky);
    after = ask(&baked);
    CHECK(before.xyz[1] > 0 && memcmp(&before, &after, sizeof before) == 0);
}

static void count_floats(const welkin_file *file)
{
    static const welkin_resolution some[4] = {{1, 1, 1, 0}, {48, 24, 32, 1}, {3, 7, 11, 0}, {512, 512, 512, 1}};
    int i;
    for (i = 0; i < 4; i++) {
        size_t channels = some[i].spectral ? file->wavelengths : 3;
        if (some[i].up > WELKIN_MAX_INTERVALS) continue;
        CHECK(WELKIN_BAKE_FLOATS(some[i].up, some[i].down, some[i].azimuths, channels) ==
              welkin_bake_floats(file, &some[i]));
    }
}

int main(int count, char **arguments)
{
    FILE *stream = count == 2 ? fopen(arguments[1], "rb") : NULL;
    size_t most = (size_t)1 << 26, length, aerial_floats;
    unsigned char *bytes = stream ? malloc(most) : NULL;
    welkin_file file;
    welkin_error error;
    if (!bytes) {
        fprintf(stderr, "usage: states FILE\n");
        return 2;
    }
    length = fread(bytes, 1, most, stream);
    fclose(stream);
    error = welkin_open(&file, bytes, length);
    if (error) {
        fprintf(stderr, "%s does not open: %s\n", arguments[1], welkin_error_name(error));
        return 2;
    }
    scratch_floats = welkin_scratch_floats(&file, WELKIN_POLARISED | WELKIN_DENSE);
    aerial_floats = welkin_aerial_perspective_floats(&file);
    if (scratch_floats < aerial_floats) scratch_floats = aerial_floats;
    memory_floats = welkin_bake_floats(&file, &colour);
    scratch = allocate(scratch_floats * sizeof *scratch);
    memory = allocate(memory_floats * sizeof *memory);
    fail_open(bytes, length);
    fail_prepare(&file);
    fail_bake(&file);
    fail_segments(&file);
    fail_on_damage(bytes, length);
    outlive_file(bytes, length);
    count_floats(&file);
    free(scratch);
    free(memory);
    free(bytes);
    printf("%d checks of states, %d failed\n", checks, failures);
    return failures != 0;
}
