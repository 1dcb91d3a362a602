/* Times all wavelengths of random directions in one sky, and baked skies with their errors.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0 */
#define WELKIN_IMPLEMENTATION
#include "welkin.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define DIRECTIONS 4096

static unsigned char *read_all(const char *path, size_t *length)
{
    FILE *stream = fopen(path, "rb");
    unsigned char *bytes = NULL;
    long size = -1;
    if (stream && fseek(stream, 0, SEEK_END) == 0) size = ftell(stream);
    if (size > 0 && fseek(stream, 0, SEEK_SET) == 0) bytes = malloc((size_t)size);
    if (bytes) *length = fread(bytes, 1, (size_t)size, stream);
    if (stream) fclose(stream);
    return bytes;
}

static double seconds(void) { return (double)clock() / CLOCKS_PER_SEC; }

static double uniform(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)*state / 4294967296.0;
}

static void draw_directions(double (*directions)[3])
{
    uint32_t state = 1, i;
    for (i = 0; i < DIRECTIONS; i++) {
        double z = 2 * uniform(&state) - 1, azimuth = 6.283185307179586 * uniform(&state), level = sqrt(1 - z * z);
        directions[i][0] = level * cos(azimuth);
        directions[i][1] = level * sin(azimuth);
        directions[i][2] = z;
    }
}

/* Between the first two nodes of each axis, where there are two; the sun 30 degrees high if that is in range. */
static welkin_conditions choose_conditions(const welkin_file *file)
{
    welkin_conditions c = {0, 0, 0.2, 0.5235987755982988, 1.0};
    double x = file->altitudes > 1 ? welkin_altitude(file, 1) : 0;
    c.altitude = file->altitudes > 1 ? 0.7 * x + 0.3 * welkin_altitude(file, 0) : welkin_altitude(file, 0);
    c.visibility = (welkin_visibility(file, 0) + welkin_visibility(file, file->visibilities > 1 ? 1 : 0)) / 2;
    if (c.solar_elevation > file->elevation_max || c.solar_elevation < file->elevation_min)
        c.solar_elevation = (file->elevation_min + file->elevation_max) / 2;
    return c;
}

static int time_directions(const welkin_sky *sky, double (*directions)[3])
{
    float l[WELKIN_MAX_WAVELENGTHS], q[WELKIN_MAX_WAVELENGTHS], u[WELKIN_MAX_WAVELENGTHS];
    double start = seconds(), spent, sum = 0;
    long count = 0;
    do {
        int i;
        for (i = 0; i < DIRECTIONS; i++) {
            welkin_error error =
                sky->flags & WELKIN_POLARISED ? welkin_stokes(sky, directions[i], l, q, u) : welkin_radiance(sky, directions[i], l);
            if (error) return 1;
            sum += (double)l[0];
        }
        count += DIRECTIONS;
        spent = seconds() - start;
    } while (spent < 1);
    printf("%8.1f ns per direction (mean %.6g)\n", 1e9 * spent / (double)count, sum / (double)count);
    return 0;
}

static int time_mode(const welkin_file *file, unsigned flags, const char *name, double (*directions)[3])
{
    size_t floats = welkin_scratch_floats(file, flags);
    float *scratch = malloc(floats * sizeof *scratch);
    welkin_conditions conditions = choose_conditions(file);
    welkin_sky sky;
    double start = seconds();
    welkin_error error = scratch ? welkin_prepare(&sky, file, &conditions, flags, scratch, floats) : WELKIN_ERROR_SCRATCH;
    int failed = error != WELKIN_OK;
    if (error)
        printf("%s: %s\n", name, welkin_error_name(error));
    else
        printf("%-20s %8.1f ms and %6.1f MiB to prepare, ", name, 1e3 * (seconds() - start), (double)floats * 4 / 1048576);
    if (!failed) failed = time_directions(&sky, directions);
    free(scratch);
    return failed;
}

/* Nanoseconds per direction of what a table answers: its values, or samples with their densities. */
static double time_table(const welkin_baked *baked, double (*directions)[3], int sample)
{
    float radiance[WELKIN_MAX_WAVELENGTHS];
    double start = seconds(), spent, out[3], pdf;
    uint32_t state = 1;
    long count = 0;
    do {
        int i;
        for (i = 0; i < DIRECTIONS; i++) {
            if (sample) {
                double u = uniform(&state);
                welkin_sample(baked, u, uniform(&state), out, &pdf);
            } else if (baked->resolution.spectral) {
                welkin_baked_radiance(baked, directions[i], radiance);
            } else {
                welkin_baked_xyz(baked, directions[i], out);
            }
        }
        count += DIRECTIONS;
        spent = seconds() - start;
    } while (spent < 0.3);
    return 1e9 * spent / (double)count;
}

static int bake(const welkin_sky *sky, welkin_resolution resolution, double (*directions)[3])
{
    size_t floats = welkin_bake_floats(sky->file, &resolution);
    float *memory = malloc(floats * sizeof *memory);
    welkin_baked baked;
    double start = seconds(), spent, p99, largest;
    welkin_error error = memory ? welkin_bake(&baked, sky, &resolution, memory, floats) : WELKIN_ERROR_SCRATCH;
    spent = seconds() - start;
    if (!error) error = welkin_baked_error(&baked, sky, 20000, &p99, &largest);
    if (error)
        printf("a baked sky: %s\n", welkin_error_name(error));
    else
        printf("baked %s %3u + %2u x %2u %7.0f KiB, %5.1f ms, %4.0f ns per direction, %4.0f ns per sample, errors: p99 "
               "%.3f %%, largest %.2f %%\n",
               resolution.spectral ? "spectral" : "colour  ", resolution.up, resolution.down, resolution.azimuths,
               (double)floats / 256, 1e3 * spent, time_table(&baked, directions, 0), time_table(&baked, directions, 1),
               100 * p99, 100 * largest);
    free(memory);
    return error != WELKIN_OK;
}

static int bake_all(const welkin_file *file, const welkin_conditions *conditions, double (*directions)[3])
{
    static const welkin_resolution resolutions[5] = {
        {32, 16, 24, 0}, {48, 24, 32, 0}, {96, 48, 64, 0}, {48, 24, 32, 1}, {96, 48, 64, 1}};
    size_t floats = welkin_scratch_floats(file, WELKIN_DENSE);
    float *scratch = malloc(floats * sizeof *scratch);
    welkin_sky sky;
    int failed = !scratch || welkin_prepare(&sky, file, conditions, WELKIN_DENSE, scratch, floats), i;
    if (failed) printf("baked skies: no sky\n");
    for (i = 0; i < 5 && !failed; i++) failed = bake(&sky, resolutions[i], directions);
    free(scratch);
    return failed;
}

int main(int count, char **arguments)
{
    static double directions[DIRECTIONS][3];
    size_t length = 0;
    unsigned char *bytes = count == 2 || count == 4 ? read_all(arguments[1], &length) : NULL;
    welkin_file file;
    welkin_error error;
    welkin_conditions conditions;
    int failed;
    if (!bytes) {
        fprintf(stderr, "usage: bench FILE [ALTITUDE SOLAR_ELEVATION] (of baked skies; m, degrees)\n");
        return 2;
    }
    error = welkin_open(&file, bytes, length);
    if (error) {
        fprintf(stderr, "%s: %s\n", arguments[1], welkin_error_name(error));
        return 1;
    }
    draw_directions(directions);
    printf("%u wavelengths, %u fields, rank %u\n", file.wavelengths, file.fields, file.rank);
    printf("floats of scratch: %zu, dense %zu, polarised %zu, both %zu; aerial perspective %zu\n",
           welkin_scratch_floats(&file, 0), welkin_scratch_floats(&file, WELKIN_DENSE),
           welkin_scratch_floats(&file, WELKIN_POLARISED),
           welkin_scratch_floats(&file, WELKIN_POLARISED | WELKIN_DENSE),
           welkin_aerial_perspective_floats(&file));
    failed = time_mode(&file, 0, "radiance", directions);
    failed |= time_mode(&file, WELKIN_DENSE, "radiance, dense", directions);
    if (file.polarisation_rank) {
        failed |= time_mode(&file, WELKIN_POLARISED, "Stokes", directions);
        failed |= time_mode(&file, WELKIN_POLARISED | WELKIN_DENSE, "Stokes, dense", directions);
    }
    conditions = choose_conditions(&file);
    if (count == 4) {
        conditions.altitude = strtod(arguments[2], NULL);
        conditions.solar_elevation = strtod(arguments[3], NULL) * 3.141592653589793 / 180;
    }
    failed |= bake_all(&file, &conditions, directions);
    free(bytes);
    return failed;
}
