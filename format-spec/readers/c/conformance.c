/* Answers the queries of the conformance suite. SPDX-License-Identifier: MIT OR Apache-2.0 */
#define WELKIN_IMPLEMENTATION
#include "welkin.h"

#include <stdio.h>
#include <stdlib.h>

#ifdef WELKIN_ZSTD
#include <zstd.h>

static size_t inflate(void *user, void *out, size_t capacity, const void *frame, size_t length)
{
    (void)user;
    return ZSTD_decompress(out, capacity, frame, length);
}

/* Replaces a compressed file by the same one without compression. */
static unsigned char *unpack(welkin_file *file, unsigned char *bytes)
{
    size_t length = welkin_unpacked_length(file);
    unsigned char *unpacked = length ? malloc(length) : NULL;
    if (!unpacked) return bytes;
    if (welkin_unpack(file, inflate, NULL, unpacked, length)) {
        fprintf(stderr, "the file does not unpack\n");
        free(unpacked);
        return bytes;
    }
    free(bytes);
    return unpacked;
}
#else
static unsigned char *unpack(welkin_file *file, unsigned char *bytes)
{
    (void)file;
    return bytes;
}
#endif

typedef struct query {
    char quantity[64];
    welkin_conditions conditions;
    double direction[3], wavelength, distance;
} query;

static unsigned char *read_all(const char *path, size_t *length)
{
    FILE *stream = fopen(path, "rb");
    unsigned char *bytes = NULL;
    long size;
    if (!stream) return NULL;
    if (fseek(stream, 0, SEEK_END) == 0 && (size = ftell(stream)) >= 0 && fseek(stream, 0, SEEK_SET) == 0) {
        *length = (size_t)size;
        bytes = malloc(*length ? *length : 1);
        if (bytes && fread(bytes, 1, *length, stream) != *length) {
            free(bytes);
            bytes = NULL;
        }
    }
    fclose(stream);
    return bytes;
}

static int parse(char *line, query *q)
{
    double *cells[] = {&q->conditions.altitude,
                       &q->conditions.visibility,
                       &q->conditions.albedo,
                       &q->conditions.solar_elevation,
                       &q->conditions.solar_azimuth,
                       &q->direction[0],
                       &q->direction[1],
                       &q->direction[2],
                       &q->wavelength,
                       &q->distance};
    char *rest;
    size_t i, length = strcspn(line, "\t");
    if (length >= sizeof q->quantity) return 0;
    memcpy(q->quantity, line, length);
    q->quantity[length] = 0;
    line += length;
    for (i = 0; i < sizeof cells / sizeof *cells; i++, line = rest) {
        *cells[i] = strtod(line, &rest);
        if (rest == line) return 0;
    }
    return 1;
}

static void print_floats(const float *values, uint32_t count)
{
    uint32_t i;
    for (i = 0; i < count; i++) printf("%.9g ", (double)values[i]);
}

static int is(const query *q, const char *quantity) { return strcmp(q->quantity, quantity) == 0; }

static welkin_error answer_transmittance(const welkin_file *file, const query *q)
{
    float transmittance[WELKIN_MAX_WAVELENGTHS];
    welkin_transmittance_profile air;
    int at = is(q, "transmittance_at");
    welkin_error error = welkin_transmittance_prepare(&air, file, q->conditions.visibility);
    if (error) return error;
    if (at)
        error = welkin_transmittance_at(&air, q->conditions.altitude, q->direction, q->distance, &q->wavelength, 1, transmittance);
    else
        error = welkin_transmittance(&air, q->conditions.altitude, q->direction, q->distance, transmittance);
    if (!error) print_floats(transmittance, at ? 1 : file->wavelengths);
    return error;
}

static welkin_error print_at(const welkin_file *file, const query *q, const float *radiance)
{
    double value, irradiance = 1;
    welkin_error error = welkin_radiance_at(file, radiance, q->wavelength, &value);
    if (!error && is(q, "radiance_at")) error = welkin_irradiance_at(file, q->wavelength, &irradiance);
    if (!error) printf("%.12g", value * irradiance);
    return error;
}

/* At all wavelengths of the file, or at that of a query for one. */
static welkin_error print_stokes(const welkin_file *file, const query *q, const float *l, const float *s, const float *u)
{
    double stokes[3];
    welkin_error error;
    if (!is(q, "stokes_at") && !is(q, "in_scattering_stokes_at")) {
        print_floats(l, file->wavelengths);
        print_floats(s, file->wavelengths);
        print_floats(u, file->wavelengths);
        return WELKIN_OK;
    }
    error = welkin_stokes_at(file, l, s, u, q->wavelength, stokes);
    if (!error) printf("%.12g %.12g %.12g", stokes[0], stokes[1], stokes[2]);
    return error;
}

static welkin_error answer_in_scattering(const welkin_file *file, const query *q, float *scratch, size_t floats)
{
    float light[WELKIN_MAX_WAVELENGTHS];
    welkin_aerial_perspective aerial;
    welkin_error error = welkin_aerial_perspective_prepare(&aerial, file, &q->conditions, scratch, floats);
    if (!error) error = welkin_in_scattering(&aerial, q->conditions.altitude, q->direction, q->distance, light);
    if (!error && is(q, "in_scattering_at")) return print_at(file, q, light);
    if (!error) print_floats(light, file->wavelengths);
    return error;
}

static welkin_error answer_in_scattering_stokes(const welkin_file *file, const query *q, float *scratch, size_t floats)
{
    float l[WELKIN_MAX_WAVELENGTHS], s[WELKIN_MAX_WAVELENGTHS], u[WELKIN_MAX_WAVELENGTHS];
    welkin_aerial_perspective aerial;
    welkin_error error = welkin_aerial_perspective_prepare(&aerial, file, &q->conditions, scratch, floats);
    if (!error) error = welkin_in_scattering_stokes(&aerial, q->conditions.altitude, q->direction, q->distance, l, s, u);
    return error ? error : print_stokes(file, q, l, s, u);
}

static welkin_error answer_stokes(const welkin_sky *sky, const query *q)
{
    float l[WELKIN_MAX_WAVELENGTHS], s[WELKIN_MAX_WAVELENGTHS], u[WELKIN_MAX_WAVELENGTHS];
    welkin_error error = welkin_stokes(sky, q->direction, l, s, u);
    return error ? error : print_stokes(sky->file, q, l, s, u);
}

static welkin_error answer_radiance(const welkin_sky *sky, const query *q)
{
    float radiance[WELKIN_MAX_WAVELENGTHS];
    double xyz[3];
    welkin_error error = welkin_radiance(sky, q->direction, radiance);
    if (error) return error;
    if (is(q, "relative_radiance")) {
        print_floats(radiance, sky->file->wavelengths);
    } else if (is(q, "xyz")) {
        welkin_xyz(sky->file, radiance, xyz);
        printf("%.12g %.12g %.12g", xyz[0], xyz[1], xyz[2]);
    } else {
        return print_at(sky->file, q, radiance);
    }
    return WELKIN_OK;
}

/* A value stands where visibilities do. */
static welkin_error answer_axis(const welkin_file *file, const query *q)
{
    welkin_axis axis;
    double visibility;
    welkin_error error = welkin_axis_prepare(&axis, file);
    if (!error) error = welkin_axis_visibility(&axis, q->conditions.visibility, &visibility);
    if (!error) printf("%.12g", visibility);
    return error;
}

static welkin_error answer(const welkin_file *file, const query *q, unsigned mode, float *scratch, size_t floats)
{
    int stokes = is(q, "stokes") || is(q, "stokes_at");
    welkin_sky sky;
    welkin_error error;
    if (is(q, "axis_visibility")) return answer_axis(file, q);
    if (is(q, "transmittance") || is(q, "transmittance_at")) return answer_transmittance(file, q);
    if (is(q, "in_scattering") || is(q, "in_scattering_at")) return answer_in_scattering(file, q, scratch, floats);
    if (is(q, "in_scattering_stokes") || is(q, "in_scattering_stokes_at")) return answer_in_scattering_stokes(file, q, scratch, floats);
    error = welkin_prepare(&sky, file, &q->conditions, mode | (stokes ? WELKIN_POLARISED : 0), scratch, floats);
    if (error) return error;
    return stokes ? answer_stokes(&sky, q) : answer_radiance(&sky, q);
}

int main(int count, char **arguments)
{
    char line[4096];
    size_t length = 0, floats = 0;
    unsigned mode = count == 3 && strcmp(arguments[1], "--dense") == 0 ? WELKIN_DENSE : 0;
    unsigned char *bytes = count >= 2 ? read_all(arguments[count - 1], &length) : NULL;
    float *scratch = NULL;
    welkin_file file;
    welkin_error opened;
    if (!bytes) {
        fprintf(stderr, "usage: conformance [--dense] FILE < queries\n");
        return 2;
    }
    opened = welkin_open(&file, bytes, length);
    if (!opened) {
        bytes = unpack(&file, bytes);
        floats = welkin_scratch_floats(&file, mode | WELKIN_POLARISED);
        if (floats < welkin_aerial_perspective_floats(&file)) floats = welkin_aerial_perspective_floats(&file);
        scratch = malloc(floats * sizeof *scratch);
        if (!scratch) return 2;
    }
    while (fgets(line, sizeof line, stdin)) {
        query q;
        welkin_error error;
        if (!parse(line, &q)) return 2;
        error = opened ? opened : answer(&file, &q, mode, scratch, floats);
        if (error) printf("error %s", welkin_error_name(error));
        printf("\n");
    }
    free(scratch);
    free(bytes);
    return 0;
}
