/* The C reader behind one function. SPDX-License-Identifier: MIT OR Apache-2.0 */
#define WELKIN_API static
#define WELKIN_IMPLEMENTATION
#include "welkin.h"

#include <stdlib.h>

/* Of the library that the target links anyway. */
size_t ZSTD_decompress(void *out, size_t capacity, const void *frame, size_t length);

/* More than this is not worth the time. */
#define MOST_BYTES ((size_t)1 << 26)

enum {
    RADIANCE,
    RADIANCE_AT,
    SPECTRAL_AT,
    XYZ,
    STOKES,
    STOKES_AT,
    TRANSMITTANCE,
    IN_SCATTERING,
    IN_SCATTERING_STOKES,
    TRANSMITTANCE_AT,
    IN_SCATTERING_AT,
    IN_SCATTERING_STOKES_AT,
    WAVELENGTH_RANGE,
    SUNLIGHT_AT
};

/* One question: altitude, visibility, albedo, elevation and azimuth of the sun, direction, wavelength, distance. */
typedef struct question {
    uint32_t quantity, dense;
    double cells[10];
} question;

/* The values, or an error. */
typedef struct answer {
    int32_t error;
    uint32_t count;
    double values[3 * WELKIN_MAX_WAVELENGTHS];
} answer;

static size_t inflate(void *user, void *out, size_t capacity, const void *frame, size_t length)
{
    (void)user;
    return ZSTD_decompress(out, capacity, frame, length);
}

static void put(answer *a, const float *values, uint32_t count)
{
    uint32_t i;
    for (i = 0; i < count; i++) a->values[a->count++] = (double)values[i];
}

static void put_doubles(answer *a, const double *values, uint32_t count)
{
    uint32_t i;
    for (i = 0; i < count; i++) a->values[a->count++] = values[i];
}

static void put_three(answer *a, const float *l, const float *q, const float *u, uint32_t count)
{
    put(a, l, count);
    put(a, q, count);
    put(a, u, count);
}

/* Far enough to be out of any air. */
#define SPACE 5e8

static welkin_error ask_transmittance(const welkin_file *file, const question *q, const welkin_conditions *c, answer *a)
{
    float through[WELKIN_MAX_WAVELENGTHS];
    int at = q->quantity == TRANSMITTANCE_AT;
    welkin_transmittance_profile air;
    welkin_error error = welkin_transmittance_prepare(&air, file, c->visibility);
    if (!error && at) error = welkin_transmittance_at(&air, c->altitude, q->cells + 5, q->cells[9], q->cells + 8, 1, through);
    if (!error && !at) error = welkin_transmittance(&air, c->altitude, q->cells + 5, q->cells[9], through);
    if (!error) put(a, through, at ? 1 : file->wavelengths);
    return error;
}

/* Irradiance times transmittance from the observer towards the centre of the sun. */
static welkin_error ask_sunlight(const welkin_file *file, const question *q, const welkin_conditions *c, answer *a)
{
    double altitude = c->altitude < 0 ? 0 : c->altitude, irradiance, direction[3];
    float through;
    welkin_transmittance_profile air;
    welkin_error error = welkin_transmittance_prepare(&air, file, c->visibility);
    direction[0] = cos(c->solar_elevation) * cos(c->solar_azimuth);
    direction[1] = cos(c->solar_elevation) * sin(c->solar_azimuth);
    direction[2] = sin(c->solar_elevation);
    if (!error) error = welkin_transmittance_at(&air, altitude, direction, SPACE, q->cells + 8, 1, &through);
    if (!error) error = welkin_irradiance_at(file, q->cells[8], &irradiance);
    if (error) return error;
    irradiance *= (double)through;
    put_doubles(a, &irradiance, 1);
    return WELKIN_OK;
}

static welkin_error put_stokes(const welkin_file *file, const question *q, float light[3][WELKIN_MAX_WAVELENGTHS], answer *a)
{
    double stokes[3];
    welkin_error error;
    if (q->quantity == STOKES || q->quantity == IN_SCATTERING_STOKES) {
        put_three(a, light[0], light[1], light[2], file->wavelengths);
        return WELKIN_OK;
    }
    error = welkin_stokes_at(file, light[0], light[1], light[2], q->cells[8], stokes);
    if (!error) put_doubles(a, stokes, 3);
    return error;
}

static welkin_error ask_segment(const welkin_file *file, const question *q, const welkin_conditions *c, float *scratch, size_t floats,
                                answer *a)
{
    float light[3][WELKIN_MAX_WAVELENGTHS];
    double value;
    const double *direction = q->cells + 5;
    welkin_aerial_perspective aerial;
    welkin_error error = welkin_aerial_perspective_prepare(&aerial, file, c, scratch, floats);
    if (error) return error;
    if (q->quantity == IN_SCATTERING_STOKES || q->quantity == IN_SCATTERING_STOKES_AT) {
        error = welkin_in_scattering_stokes(&aerial, c->altitude, direction, q->cells[9], light[0], light[1], light[2]);
        return error ? error : put_stokes(file, q, light, a);
    }
    error = welkin_in_scattering(&aerial, c->altitude, direction, q->cells[9], light[0]);
    if (error) return error;
    if (q->quantity == IN_SCATTERING) {
        put(a, light[0], file->wavelengths);
        return WELKIN_OK;
    }
    error = welkin_radiance_at(file, light[0], q->cells[8], &value);
    if (!error) put_doubles(a, &value, 1);
    return error;
}

static welkin_error ask_stokes(const welkin_sky *sky, const question *q, answer *a)
{
    float light[3][WELKIN_MAX_WAVELENGTHS];
    welkin_error error = welkin_stokes(sky, q->cells + 5, light[0], light[1], light[2]);
    return error ? error : put_stokes(sky->file, q, light, a);
}

static welkin_error ask_range(const welkin_file *file, answer *a)
{
    double range[2];
    welkin_error error = welkin_wavelength_range(file, range);
    if (!error) put_doubles(a, range, 2);
    return error;
}

static welkin_error ask_sky(const welkin_sky *sky, const question *q, answer *a)
{
    float light[WELKIN_MAX_WAVELENGTHS];
    double xyz[3], value, irradiance = 1;
    welkin_error error;
    if (q->quantity == STOKES || q->quantity == STOKES_AT) return ask_stokes(sky, q, a);
    error = welkin_radiance(sky, q->cells + 5, light);
    if (error) return error;
    if (q->quantity == RADIANCE) put(a, light, sky->file->wavelengths);
    if (q->quantity == XYZ) {
        welkin_xyz(sky->file, light, xyz);
        put_doubles(a, xyz, 3);
    }
    if (q->quantity == RADIANCE || q->quantity == XYZ) return WELKIN_OK;
    error = welkin_radiance_at(sky->file, light, q->cells[8], &value);
    if (!error && q->quantity == SPECTRAL_AT) error = welkin_irradiance_at(sky->file, q->cells[8], &irradiance);
    value *= irradiance;
    if (!error) put_doubles(a, &value, 1);
    return error;
}

static welkin_error ask(const welkin_file *file, const question *q, float *scratch, size_t floats, answer *a)
{
    const double *cells = q->cells;
    unsigned flags = q->dense ? WELKIN_DENSE : 0;
    welkin_conditions c;
    welkin_sky sky;
    welkin_error error;
    c.altitude = cells[0];
    c.visibility = cells[1];
    c.albedo = cells[2];
    c.solar_elevation = cells[3];
    c.solar_azimuth = cells[4];
    if (q->quantity == WAVELENGTH_RANGE) return ask_range(file, a);
    if (q->quantity == SUNLIGHT_AT) return ask_sunlight(file, q, &c, a);
    if (q->quantity == TRANSMITTANCE || q->quantity == TRANSMITTANCE_AT) return ask_transmittance(file, q, &c, a);
    if (q->quantity >= TRANSMITTANCE) return ask_segment(file, q, &c, scratch, floats, a);
    if (q->quantity == STOKES || q->quantity == STOKES_AT) flags |= WELKIN_POLARISED;
    error = welkin_prepare(&sky, file, &c, flags, scratch, floats);
    return error ? error : ask_sky(&sky, q, a);
}

static void ask_all(const welkin_file *file, const question *questions, size_t count, answer *answers)
{
    size_t floats = welkin_scratch_floats(file, WELKIN_POLARISED | WELKIN_DENSE), aerial = welkin_aerial_perspective_floats(file), i;
    float *scratch;
    if (floats < aerial) floats = aerial;
    scratch = floats <= MOST_BYTES / sizeof *scratch ? malloc(floats * sizeof *scratch + 1) : NULL;
    for (i = 0; i < count; i++)
        answers[i].error = scratch ? (int32_t)ask(file, &questions[i], scratch, floats, &answers[i]) : WELKIN_ERROR_SCRATCH;
    free(scratch);
}

/* Returns the error at open. The answers must be zero. */
int32_t welkin_c_reader(const void *bytes, size_t length, const question *questions, size_t count, answer *answers);
int32_t welkin_c_reader(const void *bytes, size_t length, const question *questions, size_t count, answer *answers)
{
    welkin_file file;
    welkin_error error = welkin_open(&file, bytes, length);
    size_t unpacked;
    void *room;
    if (error) return (int32_t)error;
    unpacked = welkin_unpacked_length(&file);
    if (unpacked > MOST_BYTES) return WELKIN_ERROR_SCRATCH;
    room = unpacked ? malloc(unpacked) : NULL;
    if (room) error = welkin_unpack(&file, inflate, NULL, room, unpacked);
    if (!error) ask_all(&file, questions, count, answers);
    free(room);
    return (int32_t)error;
}
