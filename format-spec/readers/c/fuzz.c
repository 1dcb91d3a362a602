/* Any bytes, with lengths, checksums and features made right: errors, or numbers that are finite and not negative.
 *
 *     clang -std=c99 -g -O1 -fsanitize=fuzzer,address,undefined -o fuzz fuzz.c -lm && ./fuzz CORPUS ../../conformance/files
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0 */
#define WELKIN_IMPLEMENTATION
#include "welkin.h"

#include <stdlib.h>

/* More scratch than this is not worth the time. */
#define MOST_FLOATS (1u << 22)

static void forge(unsigned char *bytes, size_t length)
{
    uint64_t head = welkin__u64(bytes + 24), count = welkin__u32(bytes + 36), i;
    uint32_t features = 0;
    welkin__put_u64(bytes + 16, length);
    if (head > length || count * WELKIN__ENTRY > head - WELKIN__HEADER || head < WELKIN__HEADER) return;
    for (i = 0; i < count; i++) {
        unsigned char *entry = bytes + head - (count - i) * WELKIN__ENTRY;
        uint64_t offset = welkin__u64(entry + 8), stored = welkin__u64(entry + 16);
        if (welkin__u32(entry) == WELKIN__SPECTRUM) features |= WELKIN__HAS_SPECTRUM;
        if (welkin__u32(entry) == WELKIN__ESTIMATE) features |= WELKIN__HAS_ESTIMATES;
        if (offset < head || offset > length || stored > length - offset) continue;
        welkin__put_u32(entry + 36, ~welkin__crc(0xFFFFFFFFu, bytes + offset, (size_t)stored));
    }
    welkin__put_u32(bytes + 12, features);
    welkin__put_u32(bytes + 32, welkin__head_crc(bytes, (size_t)head));
}

static void check(const float *values, uint32_t count, float low, float high)
{
    uint32_t i;
    for (i = 0; i < count; i++)
        if (!(values[i] >= low && values[i] <= high)) abort();
}

/* Shares of the range at which wavelengths are asked. */
static const double shares[5] = {0, 0.013, 0.37, 0.82, 1};

static double wavelength_at(const welkin_file *file, int i)
{
    double range[2];
    if (welkin_wavelength_range(file, range)) return welkin_wavelength(file, 0);
    return (1 - shares[i]) * range[0] + shares[i] * range[1];
}

static void ask_wavelengths(const welkin_file *file, const float *light, const float *q, const float *u)
{
    double value, stokes[3];
    int i;
    for (i = 0; i < 5; i++) {
        double wavelength = wavelength_at(file, i);
        if (!welkin_radiance_at(file, light, wavelength, &value) && !(value >= 0 && value <= DBL_MAX)) abort();
        if (!welkin_irradiance_at(file, wavelength, &value) && !(value >= 0 && value <= DBL_MAX)) abort();
        if (!q || welkin_stokes_at(file, light, q, u, wavelength, stokes)) continue;
        if (!(stokes[0] >= 0 && fabs(stokes[1]) <= DBL_MAX && fabs(stokes[2]) <= DBL_MAX)) abort();
    }
}

/* A table as small as any that has all kinds of cells. */
static void ask_table(const welkin_sky *sky, int spectral)
{
    static const double directions[3][3] = {{0, 0, 1}, {1, 0, 0.01}, {0.3, -0.2, -0.5}};
    welkin_resolution resolution = {2, 1, 1, 0};
    float light[WELKIN_MAX_WAVELENGTHS], memory[10 * WELKIN_MAX_WAVELENGTHS + 10];
    double xyz[3], rgb[3], sample[3], pdf, p99, largest;
    welkin_baked baked;
    int i, k;
    resolution.spectral = spectral;
    if (welkin_bake(&baked, sky, &resolution, memory, sizeof memory / sizeof *memory)) return;
    for (i = 0; i < 3; i++) {
        if (spectral && !welkin_baked_radiance(&baked, directions[i], light))
            check(light, sky->file->wavelengths, 0, FLT_MAX);
        if (welkin_baked_xyz(&baked, directions[i], xyz) || welkin_rgb(WELKIN_ACESCG, xyz, rgb)) abort();
        if (welkin_sample_pdf(&baked, directions[i], &pdf) || !(pdf > 0 && pdf <= DBL_MAX)) abort();
        if (welkin_sample(&baked, shares[i], shares[4 - i], sample, &pdf) || !(pdf > 0 && pdf <= DBL_MAX)) abort();
        for (k = 0; k < 3; k++)
            if (!(fabs(sample[k]) <= 1.000001)) abort();
    }
    if (!welkin_baked_error(&baked, sky, 2, &p99, &largest) && !(p99 >= 0 && largest >= p99 && largest <= DBL_MAX))
        abort();
}

static void ask_sky(const welkin_file *file, const welkin_conditions *conditions, unsigned flags, float *scratch, size_t floats)
{
    static const double directions[3][3] = {{0, 0, 1}, {1, 0, 0.01}, {0.3, -0.2, -0.5}};
    float light[WELKIN_MAX_WAVELENGTHS], q[WELKIN_MAX_WAVELENGTHS], u[WELKIN_MAX_WAVELENGTHS];
    welkin_sky sky;
    int i;
    if (welkin_prepare(&sky, file, conditions, flags, scratch, floats)) return;
    ask_table(&sky, (flags & WELKIN_DENSE) != 0);
    for (i = 0; i < 3; i++) {
        if (!welkin_radiance(&sky, directions[i], light)) {
            check(light, file->wavelengths, 0, FLT_MAX);
            ask_wavelengths(file, light, NULL, NULL);
        }
        if (flags & WELKIN_POLARISED && !welkin_stokes(&sky, directions[i], light, q, u)) {
            check(q, file->wavelengths, -FLT_MAX, FLT_MAX);
            check(u, file->wavelengths, -FLT_MAX, FLT_MAX);
            ask_wavelengths(file, light, q, u);
        }
    }
}

static void ask_segments(const welkin_file *file, const welkin_conditions *conditions, float *scratch, size_t floats)
{
    static const double segments[4][4] = {{1, 0, 0.01, 9e4}, {0.1, 0.2, 0.9, 1e6}, {0.3, 0, -0.5, 3e3}, {1, 0, 0, 0}};
    float values[WELKIN_MAX_WAVELENGTHS], q[WELKIN_MAX_WAVELENGTHS], u[WELKIN_MAX_WAVELENGTHS];
    welkin_transmittance_profile air;
    welkin_aerial_perspective aerial;
    double wavelengths[5];
    int i, lit;
    if (welkin_transmittance_prepare(&air, file, conditions->visibility)) return;
    for (i = 0; i < 5; i++) wavelengths[i] = wavelength_at(file, i);
    lit = !welkin_aerial_perspective_prepare(&aerial, file, conditions, scratch, floats);
    for (i = 0; i < 4; i++) {
        if (!welkin_transmittance(&air, 100, segments[i], segments[i][3], values)) check(values, file->wavelengths, 0, 1);
        if (!welkin_transmittance_at(&air, 100, segments[i], segments[i][3], wavelengths, 5, values)) check(values, 5, 0, 1);
        if (lit && !welkin_in_scattering(&aerial, 100, segments[i], segments[i][3], values)) check(values, file->wavelengths, 0, FLT_MAX);
        if (lit && !welkin_in_scattering_stokes(&aerial, 100, segments[i], segments[i][3], values, q, u)) {
            check(q, file->wavelengths, -FLT_MAX, FLT_MAX);
            check(u, file->wavelengths, -FLT_MAX, FLT_MAX);
            ask_wavelengths(file, values, q, u);
        }
    }
}

static void ask(const welkin_file *file)
{
    size_t floats = welkin_scratch_floats(file, WELKIN_POLARISED | WELKIN_DENSE), more = welkin_aerial_perspective_floats(file);
    float *scratch;
    int i;
    if (more > floats) floats = more;
    if (floats > MOST_FLOATS || !(scratch = malloc(floats * sizeof *scratch + 1))) return;
    for (i = 0; i < 3; i++) {
        double t = i / 2.0;
        welkin_conditions c;
        c.altitude = (1 - t) * welkin_altitude(file, 0) + t * welkin_altitude(file, file->altitudes - 1);
        c.visibility = (1 - t) * welkin_visibility(file, 0) + t * welkin_visibility(file, file->visibilities - 1);
        c.solar_elevation = (1 - t) * file->elevation_min + t * file->elevation_max;
        c.albedo = t;
        c.solar_azimuth = t;
        ask_sky(file, &c, 0, scratch, floats);
        ask_sky(file, &c, WELKIN_POLARISED | WELKIN_DENSE, scratch, floats);
        ask_segments(file, &c, scratch, floats);
    }
    free(scratch);
}

/* Stands in for zstd: gives as many bytes as are wanted, from the frame. */
static size_t decode(void *user, void *out, size_t capacity, const void *frame, size_t length)
{
    size_t i;
    (void)user;
    for (i = 0; i < capacity; i++) ((unsigned char *)out)[i] = ((const unsigned char *)frame)[i % length];
    return capacity;
}

static void ask_unpacked(const welkin_file *packed)
{
    size_t length = welkin_unpacked_length(packed);
    welkin_file file = *packed;
    void *out = length && length <= 4 * MOST_FLOATS ? malloc(length) : NULL;
    if (out && welkin_unpack(&file, decode, NULL, out, length - 1) != WELKIN_ERROR_SCRATCH) abort();
    if (file.bytes != packed->bytes) abort(); /* still open */
    if (out && !welkin_unpack(&file, decode, NULL, out, length)) ask(&file);
    free(out);
}

int LLVMFuzzerTestOneInput(const unsigned char *data, size_t length)
{
    unsigned char *bytes = malloc(length ? length : 1);
    welkin_file file;
    if (!bytes) return 0;
    if (length) memcpy(bytes, data, length);
    if (!welkin_open(&file, bytes, length)) ask(&file);
    if (length >= WELKIN__HEADER) {
        forge(bytes, length);
        if (!welkin_open(&file, bytes, length)) {
            ask(&file);
            ask_unpacked(&file);
        }
    }
    free(bytes);
    return 0;
}
