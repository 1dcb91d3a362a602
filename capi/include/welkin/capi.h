/* welkin/capi.h: the C interface of welkin, the clear sky for any renderer. Made by cbindgen of capi/src (the test
 * `header`); do not edit. In C++ include welkin/welkin.hpp.
 *
 * Handles. A WelkinModel is a file; skies, discs and the air are prepared of it for conditions; skies are baked into
 * tables for many queries. All are opaque and owned by the program: what a function writes to its last but one argument
 * (of type WelkinSomething **) is to be freed by welkin_something_free, in any order. A call that fails writes null. A
 * handle keeps alive what it needs of others.
 *
 * Errors. Functions that can fail return a WelkinStatus and, unless `error` is null, write the same with a text to the
 * WelkinError of the caller. If they fail, outputs keep what they held, unless the function says otherwise; null
 * pointers, pointers that are not aligned, arrays of a wrong length and outputs that overlap are errors. What cannot be
 * checked is the promise of the caller: pointers point to as many elements as the function says, handles are alive and
 * of the right type. Functions that cannot fail answer 0 or false for null.
 *
 * Threads. There are no globals. Functions that take handles as pointers to const may be called by any number of
 * threads at once, also with the same handle, and need no lock; what is not const must not be in use elsewhere. But for
 * models, whose chunks are read at first touch, queries that succeed neither block, allocate nor call the system.
 *
 * Units and frame. SI, angles in radians, wavelengths in nanometres, spectral radiance in W m⁻² sr⁻¹ nm⁻¹, colours in
 * cd m⁻². +z is the zenith, azimuths count counter-clockwise from +x seen from above. Directions point away from the
 * observer and need not be normalised. Points are metres, the origin on the ground below the observer.
 *
 * Versions. Call welkin_check_abi(WELKIN_ABI, &error) once. Structs that may grow have a struct_size, which must be
 * their sizeof; others never change.
 *
 * Nothing here has the name of anything in welkin.h, the reader in one header: a program may use both.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */

#ifndef WELKIN_CAPI_H
#define WELKIN_CAPI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/**
 * Major version of this interface, which is in the name of the shared library: programs need the same.
 */
#define WELKIN_ABI_MAJOR 1

/**
 * Minor version: it grows with new functions, and with new fields at the end of structs that have a struct_size.
 * Programs run with libraries of theirs or a greater one.
 */
#define WELKIN_ABI_MINOR 0

/**
 * Both.
 */
#define WELKIN_ABI_VERSION 65536

/**
 * Radiance at the wavelengths of the model, or at any between them.
 */
#define WELKIN_CHANNELS_SPECTRAL 0

/**
 * XYZ or RGB.
 */
#define WELKIN_CHANNELS_COLOUR 1

/**
 * Stokes vectors.
 */
#define WELKIN_CHANNELS_STOKES 2

/**
 * e1 lies in the vertical plane and points up, so e2 points to the right.
 */
#define WELKIN_FRAME_VERTICAL 0

/**
 * e1 is perpendicular to the plane of view direction and sun: light that air scattered once has Q > 0 and U = 0.
 */
#define WELKIN_FRAME_SUN_ALIGNED 1

/**
 * e1 is given by a vector.
 */
#define WELKIN_FRAME_AXIS 2

/**
 * The sky without the sun's disc.
 */
#define WELKIN_PART_SKY 0

/**
 * The visible part of the sun's disc.
 */
#define WELKIN_PART_SUN 1

/**
 * Linear sRGB (primaries of ITU-R BT.709), white D65.
 */
#define WELKIN_SPACE_SRGB 0

/**
 * Linear ITU-R BT.2020, white D65.
 */
#define WELKIN_SPACE_REC2020 1

/**
 * ACEScg (primaries AP1), white of ACES, reached by Bradford's adaptation from D65.
 */
#define WELKIN_SPACE_ACESCG 2

/**
 * CIE 1931 XYZ itself.
 */
#define WELKIN_SPACE_XYZ 3

/**
 * A tolerance of baking that is small against the error of the model itself.
 */
#define WELKIN_BAKE_TOLERANCE 0.0025

/**
 * What became of a call: WELKIN_STATUS_OK or a code of an error. Codes never change their meaning; a later library may
 * have more of them.
 *
 * From WELKIN_STATUS_IO to WELKIN_STATUS_POINT they are the classes of errors of the format specification and of the
 * Rust library; from WELKIN_STATUS_NULL on they are about the call itself.
 */
enum WelkinStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * All went well.
     */
    WELKIN_STATUS_OK = 0,
    /**
     * The operating system refused to read a file.
     */
    WELKIN_STATUS_IO = 1,
    /**
     * The bytes do not start like a welkin file.
     */
    WELKIN_STATUS_MAGIC = 2,
    /**
     * The file has a major version that this library does not know.
     */
    WELKIN_STATUS_VERSION = 3,
    /**
     * The file needs features that this library does not have.
     */
    WELKIN_STATUS_FEATURE = 4,
    /**
     * A chunk is stored in an encoding that this library cannot decode.
     */
    WELKIN_STATUS_ENCODING = 5,
    /**
     * An array or a file has the wrong length.
     */
    WELKIN_STATUS_LENGTH = 6,
    /**
     * The file is damaged.
     */
    WELKIN_STATUS_CHECKSUM = 7,
    /**
     * A value in the file breaks the format specification.
     */
    WELKIN_STATUS_VALUE = 8,
    /**
     * The file lacks a chunk that the conditions need.
     */
    WELKIN_STATUS_MISSING = 9,
    /**
     * A parameter is not finite or outside the range of the model.
     */
    WELKIN_STATUS_RANGE = 10,
    /**
     * No table is large enough for the wanted tolerance.
     */
    WELKIN_STATUS_TOLERANCE = 11,
    /**
     * The model is too large for point queries.
     */
    WELKIN_STATUS_LIMIT = 12,
    /**
     * A direction has length zero or a component that is not finite.
     */
    WELKIN_STATUS_DIRECTION = 13,
    /**
     * A point has a coordinate that is not finite, or lies too far away.
     */
    WELKIN_STATUS_POINT = 14,
    /**
     * A pointer is null that must not be.
     */
    WELKIN_STATUS_NULL = 64,
    /**
     * A pointer is not aligned as its elements need.
     */
    WELKIN_STATUS_ALIGNMENT = 65,
    /**
     * An output overlaps an input or another output.
     */
    WELKIN_STATUS_OVERLAP = 66,
    /**
     * A struct_size is smaller than that of version 1.0, or a field is set that this library does not know.
     */
    WELKIN_STATUS_STRUCT = 67,
    /**
     * A constant is none of those of its type, or text is not terminated or not UTF-8.
     */
    WELKIN_STATUS_ARGUMENT = 68,
    /**
     * This library was built without what the call needs.
     */
    WELKIN_STATUS_UNSUPPORTED = 69,
    /**
     * The program was compiled with a header that this library does not serve.
     */
    WELKIN_STATUS_ABI = 70,
    /**
     * A defect of the library. Handles that the call was to change must only be freed.
     */
    WELKIN_STATUS_PANIC = 71,
    /**
     * An error of the library of a class that has no code yet.
     */
    WELKIN_STATUS_OTHER = 72,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum WelkinStatus WelkinStatus;
#else
typedef int32_t WelkinStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Transmittance and in-scattered light of finite segments. Points are metres in the frame of WelkinTransmittance; a
 * thing is seen as its radiance times the transmittance plus the in-scattered light. Nothing allocates after it is
 * prepared.
 */
typedef struct WelkinAerialPerspective WelkinAerialPerspective;

/**
 * A sky in colour as tables of some 12 kB, for very many directions. Nothing allocates.
 */
typedef struct WelkinBakedColourSky WelkinBakedColourSky;

/**
 * A sky with its polarisation as tables. Nothing allocates.
 */
typedef struct WelkinBakedPolarisedSky WelkinBakedPolarisedSky;

/**
 * A sky as tables of some 50 kB per 16 wavelengths: many times faster than what it was made of, with a stated
 * additional error. Nothing allocates.
 */
typedef struct WelkinBakedSky WelkinBakedSky;

/**
 * A WelkinAerialPerspective for colour alone, in half the time and memory.
 */
typedef struct WelkinColourAerialPerspective WelkinColourAerialPerspective;

/**
 * A sky for colour alone: only the wavelengths that X, Y and Z are made of are prepared, in half the time.
 */
typedef struct WelkinColourSky WelkinColourSky;

/**
 * A clear-sky model over a file. Opening reads the head of the file only. May be shared by threads.
 */
typedef struct WelkinModel WelkinModel;

/**
 * A plan of a model: what to read for a scene.
 */
typedef struct WelkinPlan WelkinPlan;

/**
 * Answers for any conditions of a plan and any direction, without preparing a sky: for queries that share nothing.
 * Nothing allocates. May be shared by threads.
 */
typedef struct WelkinPointQuery WelkinPointQuery;

/**
 * The same with polarisation.
 */
typedef struct WelkinPolarisedPointQuery WelkinPolarisedPointQuery;

/**
 * A sky with its linear polarisation.
 */
typedef struct WelkinPolarisedSky WelkinPolarisedSky;

/**
 * The clear sky at one set of conditions: radiance for any direction, exact. Nothing allocates after it is prepared.
 * The sun's disc is not included.
 *
 * Below the horizon the ground itself is black, but the air before it is included, so the radiance there is not zero
 * above the ground. Renderers with a terrain take no sky there: they lay their geometry over it and add the air of
 * aerial perspective.
 */
typedef struct WelkinSky WelkinSky;

/**
 * Draws directions in proportion to the luminance of a sky, with or without the sun's disc. All directions are drawn,
 * also those below the horizon, where the light is that of the air before black ground: of the draws of the sky none on
 * the ground, 34 % at 1500 m (sun 8° high) and 73 % at 10 km. Where geometry is in the way they count as blocked.
 */
typedef struct WelkinSkySampler WelkinSkySampler;

/**
 * The sky in the light of sun and moon together.
 */
typedef struct WelkinSkySum WelkinSkySum;

/**
 * The sun's disc as an observer sees it through the air, with limb darkening, as far as it is above the horizon.
 */
typedef struct WelkinSolarDisc WelkinSolarDisc;

/**
 * Baked skies in colour under every sun of a range, of one observer and one air: the sky of a frame costs
 * microseconds.
 */
typedef struct WelkinSunCourse WelkinSunCourse;

/**
 * The air at one visibility: transmittance along straight lines. Points are metres in a frame with its origin on the
 * ground and +z up there; the planet's centre is at (0, 0, −R). Nothing blocks the way.
 */
typedef struct WelkinTransmittance WelkinTransmittance;

/**
 * The version and sizes that a program was compiled with: WELKIN_ABI fills it.
 */
typedef struct WelkinAbi {
    /**
     * WELKIN_ABI_VERSION.
     */
    uint32_t version;
    /**
     * sizeof(void *).
     */
    uint32_t pointer;
    /**
     * sizeof(WelkinError).
     */
    uint32_t error;
    /**
     * sizeof(WelkinConditions).
     */
    uint32_t conditions;
    /**
     * sizeof(WelkinPolarisationFrame).
     */
    uint32_t polarisation_frame;
    /**
     * sizeof(WelkinStokes).
     */
    uint32_t stokes;
    /**
     * sizeof(WelkinBakeError).
     */
    uint32_t bake_error;
    /**
     * sizeof(WelkinSample).
     */
    uint32_t sample;
    /**
     * sizeof(WelkinRanges).
     */
    uint32_t ranges;
    /**
     * sizeof(WelkinMoon).
     */
    uint32_t moon;
    /**
     * sizeof(WelkinBudget).
     */
    uint32_t budget;
    /**
     * sizeof(WelkinPlanSummary).
     */
    uint32_t plan_summary;
    /**
     * sizeof(WelkinCameraVolume).
     */
    uint32_t camera_volume;
    /**
     * Zero.
     */
    uint32_t reserved[3];
} WelkinAbi;

/**
 * Room for what went wrong, in the caller's memory: no state of the library holds errors. This struct never changes.
 */
typedef struct WelkinError {
    /**
     * What the call returned: a WelkinStatus.
     */
    int32_t status;
    /**
     * What went wrong in English, UTF-8, zero-terminated, cut where it is longer; empty where nothing did.
     */
    char text[256];
} WelkinError;

/**
 * What the model covers.
 */
typedef struct WelkinRanges {
    /**
     * Lowest and highest solar elevation, rad.
     */
    double solar_elevation[2];
    /**
     * Lowest and highest visibility, m.
     */
    double visibility[2];
    /**
     * Lowest and highest altitude of the observer, m.
     */
    double altitude[2];
    /**
     * Shortest and longest wavelength that can be asked for, nm.
     */
    double wavelength[2];
    /**
     * Radius of the planet, m.
     */
    double planet_radius;
    /**
     * Altitude where the air ends, m.
     */
    double top;
} WelkinRanges;

/**
 * A quantity that the visibilities of a model stand for. Name and unit are UTF-8 from whoever made the file,
 * zero-terminated: escape control characters before showing them.
 */
typedef struct WelkinAxis {
    /**
     * Least and largest value.
     */
    double range[2];
    /**
     * How many nodes it has.
     */
    uint64_t nodes;
    /**
     * What it is called.
     */
    char name[72];
    /**
     * What it is measured in; empty for a number without unit.
     */
    char unit[40];
} WelkinAxis;

/**
 * The conditions that a scene can meet, and what it tolerates. Albedo is free. Set all bytes to zero, then struct_size
 * and the fields.
 */
typedef struct WelkinBudget {
    /**
     * sizeof(WelkinBudget) of the program.
     */
    uint64_t struct_size;
    /**
     * Lowest and highest altitude of observers, m.
     */
    double altitude[2];
    /**
     * Lowest and highest visibility, m.
     */
    double visibility[2];
    /**
     * Lowest and highest elevation of the sun, rad.
     */
    double solar_elevation[2];
    /**
     * Relative error that baking may add at 95 % of directions and channels.
     */
    double tolerance;
    /**
     * What skies are asked for: one of WELKIN_CHANNELS_SPECTRAL, WELKIN_CHANNELS_COLOUR and WELKIN_CHANNELS_STOKES.
     */
    int32_t channels;
    /**
     * Zero.
     */
    int32_t reserved;
} WelkinBudget;

/**
 * What a scene gets. Set struct_size.
 */
typedef struct WelkinPlanSummary {
    /**
     * sizeof(WelkinPlanSummary) of the program.
     */
    uint64_t struct_size;
    /**
     * Bytes of the file that are read, all in all.
     */
    uint64_t file_bytes;
    /**
     * Chunks that are read.
     */
    uint64_t chunk_count;
    /**
     * Most bytes that a baked sky of the scene holds.
     */
    uint64_t sky_bytes;
    /**
     * Largest median of the relative error of a chunk against its traced data.
     */
    double error_median;
    /**
     * Largest 99th percentile of it.
     */
    double error_p99;
    /**
     * Relative error that baking adds at most at 95 % of directions and channels.
     */
    double bake_p95;
} WelkinPlanSummary;

/**
 * The conditions of a sky. Initialise with welkin_conditions_init, then set what differs.
 */
typedef struct WelkinConditions {
    /**
     * sizeof(WelkinConditions) of the program.
     */
    uint64_t struct_size;
    /**
     * Geometric elevation of the sun's centre above the observer's horizontal plane, rad.
     */
    double solar_elevation;
    /**
     * Azimuth of the sun, rad, counter-clockwise from +x seen from above. Any finite angle.
     */
    double solar_azimuth;
    /**
     * Horizontal meteorological range at the ground, m.
     */
    double visibility;
    /**
     * Albedo of the ground, 0..=1, the same at all wavelengths.
     */
    double albedo;
    /**
     * Altitude of the observer above the ground, m; from -500 up to 0 it counts as 0.
     */
    double altitude;
} WelkinConditions;

/**
 * Intensity and linear polarisation of light: what a polariser along e1 passes less what one along e2 passes is q, and
 * u the same of the diagonals e1 + e2 and e1 − e2.
 */
typedef struct WelkinStokes {
    /**
     * Radiance.
     */
    float i;
    /**
     * Polarised along e1 less e2.
     */
    float q;
    /**
     * Polarised along e1 + e2 less e1 − e2.
     */
    float u;
} WelkinStokes;

/**
 * The axis e1 of positive Q across the view direction w; e2 = w × e1. A null pointer means the vertical frame.
 */
typedef struct WelkinPolarisationFrame {
    /**
     * One of WELKIN_FRAME_VERTICAL, WELKIN_FRAME_SUN_ALIGNED and WELKIN_FRAME_AXIS.
     */
    int32_t kind;
    /**
     * For WELKIN_FRAME_AXIS: e1 is the part of this vector that is perpendicular to the view direction, such as the
     * up vector of a camera.
     */
    float axis[3];
} WelkinPolarisationFrame;

/**
 * What baking, or interpolating between baked skies, added to the relative error: percentiles over directions and
 * channels.
 */
typedef struct WelkinBakeError {
    /**
     * Median.
     */
    double median;
    /**
     * 95th percentile: at most the tolerance.
     */
    double p95;
    /**
     * 99th percentile.
     */
    double p99;
    /**
     * 99.9th percentile.
     */
    double p999;
    /**
     * Largest of the compared directions.
     */
    double max;
} WelkinBakeError;

/**
 * A direction, the density that it was drawn with and the light from there.
 */
typedef struct WelkinSample {
    /**
     * Unit vector.
     */
    float direction[3];
    /**
     * Density per solid angle, sr⁻¹.
     */
    float pdf;
    /**
     * CIE XYZ of sky and, if it is drawn, the sun's disc; Y in cd m⁻².
     */
    float xyz[3];
    /**
     * What it was drawn for: WELKIN_PART_SKY or WELKIN_PART_SUN. Its density counts both all the same.
     */
    int32_t part;
} WelkinSample;

/**
 * The moon: where it stands and how much of it is lit. Initialise with welkin_moon_init, then set what differs.
 */
typedef struct WelkinMoon {
    /**
     * sizeof(WelkinMoon) of the program.
     */
    uint64_t struct_size;
    /**
     * Geometric elevation of its centre above the observer's horizontal plane, rad.
     */
    double elevation;
    /**
     * Azimuth, rad, counter-clockwise from +x seen from above.
     */
    double azimuth;
    /**
     * Phase angle, rad: 0 is full, π new.
     */
    double phase_angle;
    /**
     * Distance of its centre from the observer, m.
     */
    double distance;
} WelkinMoon;

/**
 * A camera-aligned volume ("froxels"). Row `r`, column `c`, slice `k` ends at `from + depths[k] · (axis + x·right +
 * y·up)` with `x = (2c + 1) / columns − 1` and `y = 1 − (2r + 1) / rows`: with `axis` a unit vector and the other two
 * across it, as long as the tangents of half the fields of view, slices are planes. Set all bytes to zero, then
 * struct_size and the fields.
 */
typedef struct WelkinCameraVolume {
    /**
     * sizeof(WelkinCameraVolume) of the program.
     */
    uint64_t struct_size;
    /**
     * The camera, m.
     */
    double from[3];
    /**
     * The middle of the picture.
     */
    double axis[3];
    /**
     * From the middle to the right edge.
     */
    double right[3];
    /**
     * From the middle to the upper edge.
     */
    double up[3];
    /**
     * Columns of the volume.
     */
    uint64_t columns;
    /**
     * Rows of the volume.
     */
    uint64_t rows;
    /**
     * Slices of the volume.
     */
    uint64_t depth_count;
    /**
     * Where slices end, growing, in lengths of `axis`: `depths[depth_count]`.
     */
    const double *depths;
} WelkinCameraVolume;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Major · 65536 + minor version of the interface of the library that runs.
 */
uint32_t welkin_abi_version(void);

/**
 * Version of the library that runs, as "0.1.0". Static.
 */
const char *welkin_library_version(void);

/**
 * Checks that the header that a program was compiled with fits the library that it runs with: call it once with
 * WELKIN_ABI, before anything else.
 *
 * Errors: WELKIN_STATUS_ABI, and the text says what differs.
 */
WelkinStatus welkin_check_abi(const struct WelkinAbi *compiled, struct WelkinError *error);

/**
 * The name of a status: the class of an error as the format specification writes it, as "range"; "unknown" where the
 * number is no status of this library. Static, never null.
 */
const char *welkin_status_name(int32_t status);

/**
 * Opens a file by mapping it, where the library was built so. It must not be changed in place while the model or
 * anything that still reads it lives; replacing it by renaming is fine. `path` is zero-terminated, UTF-8 on Windows.
 *
 * Errors: WELKIN_STATUS_IO; WELKIN_STATUS_MAGIC, VERSION, FEATURE, LENGTH, CHECKSUM and VALUE for what is no sound
 * file.
 */
WelkinStatus welkin_model_open(const char *path, struct WelkinModel **model, struct WelkinError *error);

/**
 * Opens a file by copying it into memory. Otherwise as welkin_model_open.
 */
WelkinStatus welkin_model_read(const char *path, struct WelkinModel **model, struct WelkinError *error);

/**
 * Opens a file that is in memory, `bytes[length]`, which is copied. Errors as of welkin_model_open.
 */
WelkinStatus welkin_model_from_bytes(const uint8_t *bytes,
                                     size_t length,
                                     struct WelkinModel **model,
                                     struct WelkinError *error);

/**
 * Opens the model that is embedded in the library.
 *
 * Errors: WELKIN_STATUS_UNSUPPORTED where it was built without.
 */
WelkinStatus welkin_model_default(struct WelkinModel **model, struct WelkinError *error);

/**
 * Frees a model; null is none. What was prepared of it lives on.
 */
void welkin_model_free(struct WelkinModel *model);

/**
 * Verifies all chunks at once instead of at their first touch.
 *
 * Errors: WELKIN_STATUS_CHECKSUM, ENCODING or VALUE for the first damaged one.
 */
WelkinStatus welkin_model_verify(const struct WelkinModel *model, struct WelkinError *error);

/**
 * How many wavelengths the model has; 0 for null.
 */
size_t welkin_model_wavelength_count(const struct WelkinModel *model);

/**
 * Writes the wavelengths of the model, nm: `wavelengths[count]` with `count` of welkin_model_wavelength_count.
 */
WelkinStatus welkin_model_wavelengths(const struct WelkinModel *model,
                                      double *wavelengths,
                                      size_t count,
                                      struct WelkinError *error);

/**
 * Writes what the model covers. Errors: those of a damaged file.
 */
WelkinStatus welkin_model_ranges(const struct WelkinModel *model,
                                 struct WelkinRanges *ranges,
                                 struct WelkinError *error);

/**
 * The same model over a ground whose albedo depends on wavelength, as a new handle: whatever conditions say, all that is
 * prepared from it is in the light of that ground. `wavelengths[count]` (nm) increase, `albedos[count]` are within
 * 0..=1; linear between them and constant beyond. The conditions of what is prepared have the albedo at 550 nm.
 *
 * What has conditions with each query says its albedo there: such queries refuse this model.
 *
 * Errors: WELKIN_STATUS_VALUE for no wavelength and such as do not increase, WELKIN_STATUS_RANGE for an albedo.
 */
WelkinStatus welkin_model_over(const struct WelkinModel *model,
                               const double *wavelengths,
                               const double *albedos,
                               size_t count,
                               struct WelkinModel **over,
                               struct WelkinError *error);

/**
 * Whether the model has a ground of its own: see welkin_model_over. False for null.
 */
bool welkin_model_has_ground(const struct WelkinModel *model);

/**
 * Whether the model has polarisation; false for null.
 */
bool welkin_model_is_polarised(const struct WelkinModel *model);

/**
 * Whether the light is that of the moon: see welkin_model_moonlit. False for null.
 */
bool welkin_model_is_moonlit(const struct WelkinModel *model);

/**
 * Length of the file, bytes; 0 for null.
 */
size_t welkin_model_file_bytes(const struct WelkinModel *model);

/**
 * Bytes of the file that were needed so far; 0 for null.
 */
size_t welkin_model_touched_bytes(const struct WelkinModel *model);

/**
 * Writes which quantity the visibilities of the model stand for.
 *
 * Errors: WELKIN_STATUS_MISSING where they stand for themselves; those of a damaged file.
 */
WelkinStatus welkin_model_axis(const struct WelkinModel *model, struct WelkinAxis *axis, struct WelkinError *error);

/**
 * Writes the values of that quantity at the nodes, which increase or decrease: `values[count]` with `count` of
 * welkin_model_axis. Errors as there.
 */
WelkinStatus welkin_model_axis_values(const struct WelkinModel *model,
                                      double *values,
                                      size_t count,
                                      struct WelkinError *error);

/**
 * Writes the visibility (m) that stands for a value: what conditions take.
 *
 * Errors: WELKIN_STATUS_RANGE beyond the values; those of welkin_model_axis.
 */
WelkinStatus welkin_model_axis_visibility(const struct WelkinModel *model,
                                          double value,
                                          double *visibility,
                                          struct WelkinError *error);

/**
 * Writes the value that a visibility (m) stands for. Errors as of welkin_model_axis_visibility.
 */
WelkinStatus welkin_model_axis_value(const struct WelkinModel *model,
                                     double visibility,
                                     double *value,
                                     struct WelkinError *error);

/**
 * Plans a scene: reads nothing of the model but its head.
 *
 * Errors: WELKIN_STATUS_RANGE for what the model does not cover; WELKIN_STATUS_MISSING if the file lacks a chunk.
 */
WelkinStatus welkin_model_plan(const struct WelkinModel *model,
                               const struct WelkinBudget *budget,
                               struct WelkinPlan **plan,
                               struct WelkinError *error);

/**
 * Frees a plan; null is none.
 */
void welkin_plan_free(struct WelkinPlan *plan);

/**
 * Writes what a plan costs and gets. The struct_size of `summary` must be set.
 */
WelkinStatus welkin_plan_summary(const struct WelkinPlan *plan,
                                 struct WelkinPlanSummary *summary,
                                 struct WelkinError *error);

/**
 * Reads and verifies what a plan of this model asks for, before the scene needs it. Errors: those of a damaged file.
 */
WelkinStatus welkin_model_load(const struct WelkinModel *model,
                               const struct WelkinPlan *plan,
                               struct WelkinError *error);

/**
 * Fills conditions: the sun 20° high towards +x, visibility 59.4 km, albedo 0.2, the observer on the ground.
 * `struct_size` is sizeof(WelkinConditions).
 */
WelkinStatus welkin_conditions_init(struct WelkinConditions *conditions,
                                    uint64_t struct_size,
                                    struct WelkinError *error);

/**
 * Unit vector towards the sun's centre, as `sun[3]`.
 */
WelkinStatus welkin_conditions_sun_direction(const struct WelkinConditions *conditions,
                                             double *sun,
                                             struct WelkinError *error);

/**
 * Degree of linear polarisation, 0..=1; 0 without light or for null.
 */
float welkin_stokes_degree(const struct WelkinStokes *stokes);

/**
 * Angle of polarisation from e1 towards e2, −π/2..=π/2 rad; 0 without polarisation or for null.
 */
float welkin_stokes_angle(const struct WelkinStokes *stokes);

/**
 * Radiance behind an ideal polariser at `angle` (rad) from e1 towards e2; 0 for null.
 */
float welkin_stokes_through_polariser(const struct WelkinStokes *stokes, float angle);

/**
 * Finds a space by its name: "srgb", "rec2020", "acescg" or "xyz".
 *
 * Errors: WELKIN_STATUS_VALUE for another name; WELKIN_STATUS_ARGUMENT if it is not UTF-8.
 */
WelkinStatus welkin_space_by_name(const char *name, int32_t *space, struct WelkinError *error);

/**
 * Converts CIE 1931 XYZ, `xyz[3]`, to `rgb[3]`, which may be the same memory. Not clipped.
 */
WelkinStatus welkin_space_from_xyz(int32_t space, const float *xyz, float *rgb, struct WelkinError *error);

/**
 * Writes the matrix of welkin_space_from_xyz, `matrix[3][3]`, a row for each component.
 */
WelkinStatus welkin_space_matrix(int32_t space, float *matrix, struct WelkinError *error);

/**
 * Prepares a sky. Reads only what the conditions need.
 *
 * Errors: WELKIN_STATUS_RANGE for conditions outside of the model; WELKIN_STATUS_MISSING if the file has not what they
 * need; those of a damaged file. The new handle does not need the model any more.
 */
WelkinStatus welkin_sky_new(const struct WelkinModel *model,
                            const struct WelkinConditions *conditions,
                            struct WelkinSky **sky,
                            struct WelkinError *error);

/**
 * Frees a sky; null is none. What was baked of it lives on.
 */
void welkin_sky_free(struct WelkinSky *sky);

/**
 * How many wavelengths results have; 0 for null.
 */
size_t welkin_sky_wavelength_count(const struct WelkinSky *sky);

/**
 * Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_sky_wavelength_count.
 */
WelkinStatus welkin_sky_wavelengths(const struct WelkinSky *sky,
                                    double *wavelengths,
                                    size_t count,
                                    struct WelkinError *error);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_sky_bytes(const struct WelkinSky *sky);

/**
 * Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
 */
WelkinStatus welkin_sky_conditions(const struct WelkinSky *sky,
                                   struct WelkinConditions *conditions,
                                   struct WelkinError *error);

/**
 * Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
 * uses the handle.
 */
WelkinStatus welkin_sky_set_solar_azimuth(struct WelkinSky *sky, double azimuth, struct WelkinError *error);

/**
 * Unit vector towards the sun's centre, as `sun[3]`.
 */
WelkinStatus welkin_sky_sun_direction(const struct WelkinSky *sky, float *sun, struct WelkinError *error);

/**
 * Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at each of its wavelengths: `radiance[count]`. `direction[3]` need not be
 * normalised.
 *
 * Errors: WELKIN_STATUS_DIRECTION for one that is zero or not finite; WELKIN_STATUS_LENGTH unless `count` is that of
 * the wavelengths.
 */
WelkinStatus welkin_sky_radiance(const struct WelkinSky *sky,
                                 const float *direction,
                                 float *radiance,
                                 size_t count,
                                 struct WelkinError *error);

/**
 * Radiance per unit of solar spectral irradiance, sr⁻¹; otherwise as welkin_sky_radiance.
 */
WelkinStatus welkin_sky_relative_radiance(const struct WelkinSky *sky,
                                          const float *direction,
                                          float *radiance,
                                          size_t count,
                                          struct WelkinError *error);

/**
 * welkin_sky_radiance for many directions, `directions[direction_count][3]`; `radiance[direction_count][wavelengths]`,
 * of which `count` is the number of all floats. What precedes a bad direction is written.
 */
WelkinStatus welkin_sky_radiance_batch(const struct WelkinSky *sky,
                                       const float *directions,
                                       size_t direction_count,
                                       float *radiance,
                                       size_t count,
                                       struct WelkinError *error);

/**
 * Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at any wavelength (nm) within the range of the model.
 *
 * Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for the wavelength.
 */
WelkinStatus welkin_sky_radiance_at(const struct WelkinSky *sky,
                                    const float *direction,
                                    double wavelength,
                                    float *radiance,
                                    struct WelkinError *error);

/**
 * CIE 1931 XYZ of the radiance, `xyz[3]`; Y is the luminance in cd m⁻².
 *
 * Errors: WELKIN_STATUS_DIRECTION.
 */
WelkinStatus welkin_sky_xyz(const struct WelkinSky *sky, const float *direction, float *xyz, struct WelkinError *error);

/**
 * The same in a colour space (WELKIN_SPACE_SRGB …), cd m⁻²: white of 1 cd m⁻² is (1, 1, 1). Not clipped, so components
 * of colours outside the gamut are negative.
 *
 * Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_ARGUMENT for an unknown space.
 */
WelkinStatus welkin_sky_rgb(const struct WelkinSky *sky,
                            const float *direction,
                            int32_t space,
                            float *rgb,
                            struct WelkinError *error);

/**
 * Prepares a sky for colour alone. Errors as of welkin_sky_new.
 */
WelkinStatus welkin_colour_sky_new(const struct WelkinModel *model,
                                   const struct WelkinConditions *conditions,
                                   struct WelkinColourSky **sky,
                                   struct WelkinError *error);

/**
 * Frees a sky; null is none. What was baked of it lives on.
 */
void welkin_colour_sky_free(struct WelkinColourSky *sky);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_colour_sky_bytes(const struct WelkinColourSky *sky);

/**
 * Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
 */
WelkinStatus welkin_colour_sky_conditions(const struct WelkinColourSky *sky,
                                          struct WelkinConditions *conditions,
                                          struct WelkinError *error);

/**
 * Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
 * uses the handle.
 */
WelkinStatus welkin_colour_sky_set_solar_azimuth(struct WelkinColourSky *sky,
                                                 double azimuth,
                                                 struct WelkinError *error);

/**
 * Unit vector towards the sun's centre, as `sun[3]`.
 */
WelkinStatus welkin_colour_sky_sun_direction(const struct WelkinColourSky *sky, float *sun, struct WelkinError *error);

/**
 * As welkin_sky_xyz.
 */
WelkinStatus welkin_colour_sky_xyz(const struct WelkinColourSky *sky,
                                   const float *direction,
                                   float *xyz,
                                   struct WelkinError *error);

/**
 * As welkin_sky_rgb.
 */
WelkinStatus welkin_colour_sky_rgb(const struct WelkinColourSky *sky,
                                   const float *direction,
                                   int32_t space,
                                   float *rgb,
                                   struct WelkinError *error);

/**
 * Prepares a polarised sky. Errors as of welkin_sky_new; WELKIN_STATUS_MISSING if the model is not polarised.
 */
WelkinStatus welkin_polarised_sky_new(const struct WelkinModel *model,
                                      const struct WelkinConditions *conditions,
                                      struct WelkinPolarisedSky **sky,
                                      struct WelkinError *error);

/**
 * Frees a sky; null is none. What was baked of it lives on.
 */
void welkin_polarised_sky_free(struct WelkinPolarisedSky *sky);

/**
 * How many wavelengths results have; 0 for null.
 */
size_t welkin_polarised_sky_wavelength_count(const struct WelkinPolarisedSky *sky);

/**
 * Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_polarised_sky_wavelength_count.
 */
WelkinStatus welkin_polarised_sky_wavelengths(const struct WelkinPolarisedSky *sky,
                                              double *wavelengths,
                                              size_t count,
                                              struct WelkinError *error);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_polarised_sky_bytes(const struct WelkinPolarisedSky *sky);

/**
 * Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
 */
WelkinStatus welkin_polarised_sky_conditions(const struct WelkinPolarisedSky *sky,
                                             struct WelkinConditions *conditions,
                                             struct WelkinError *error);

/**
 * Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
 * uses the handle.
 */
WelkinStatus welkin_polarised_sky_set_solar_azimuth(struct WelkinPolarisedSky *sky,
                                                    double azimuth,
                                                    struct WelkinError *error);

/**
 * Stokes vectors, W m⁻² sr⁻¹ nm⁻¹, at each of its wavelengths: `stokes[count]`, in a frame (null: the vertical one).
 *
 * Errors: WELKIN_STATUS_DIRECTION for a direction or an axis that is zero or not finite; WELKIN_STATUS_LENGTH unless
 * `count` is that of the wavelengths; WELKIN_STATUS_ARGUMENT for an unknown kind of frame.
 */
WelkinStatus welkin_polarised_sky_stokes(const struct WelkinPolarisedSky *sky,
                                         const float *direction,
                                         const struct WelkinPolarisationFrame *frame,
                                         struct WelkinStokes *stokes,
                                         size_t count,
                                         struct WelkinError *error);

/**
 * The Stokes vector at any wavelength (nm) within the range of the model.
 *
 * Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for the wavelength.
 */
WelkinStatus welkin_polarised_sky_stokes_at(const struct WelkinPolarisedSky *sky,
                                            const float *direction,
                                            const struct WelkinPolarisationFrame *frame,
                                            double wavelength,
                                            struct WelkinStokes *stokes,
                                            struct WelkinError *error);

/**
 * Stokes vectors of X, Y and Z, `xyz[3]`; that of Y in cd m⁻².
 */
WelkinStatus welkin_polarised_sky_xyz(const struct WelkinPolarisedSky *sky,
                                      const float *direction,
                                      const struct WelkinPolarisationFrame *frame,
                                      struct WelkinStokes *xyz,
                                      struct WelkinError *error);

/**
 * Bakes a sky into tables that add a relative error of at most `tolerance`, such as WELKIN_BAKE_TOLERANCE, at 95 % of
 * directions and wavelengths.
 *
 * Errors: WELKIN_STATUS_RANGE for a tolerance below 3e-4; WELKIN_STATUS_TOLERANCE if the largest table misses it.
 */
WelkinStatus welkin_sky_bake(const struct WelkinSky *sky,
                             double tolerance,
                             struct WelkinBakedSky **baked,
                             struct WelkinError *error);

/**
 * Frees a baked sky; null is none.
 */
void welkin_baked_sky_free(struct WelkinBakedSky *baked);

/**
 * How many wavelengths results have; 0 for null.
 */
size_t welkin_baked_sky_wavelength_count(const struct WelkinBakedSky *baked);

/**
 * Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_baked_sky_wavelength_count.
 */
WelkinStatus welkin_baked_sky_wavelengths(const struct WelkinBakedSky *baked,
                                          double *wavelengths,
                                          size_t count,
                                          struct WelkinError *error);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_baked_sky_bytes(const struct WelkinBakedSky *baked);

/**
 * Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
 */
WelkinStatus welkin_baked_sky_conditions(const struct WelkinBakedSky *baked,
                                         struct WelkinConditions *conditions,
                                         struct WelkinError *error);

/**
 * Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
 * uses the handle.
 */
WelkinStatus welkin_baked_sky_set_solar_azimuth(struct WelkinBakedSky *baked,
                                                double azimuth,
                                                struct WelkinError *error);

/**
 * What baking added to the error of the sky.
 */
WelkinStatus welkin_baked_sky_bake_error(const struct WelkinBakedSky *baked,
                                         struct WelkinBakeError *bake_error,
                                         struct WelkinError *error);

/**
 * As welkin_sky_radiance.
 */
WelkinStatus welkin_baked_sky_radiance(const struct WelkinBakedSky *baked,
                                       const float *direction,
                                       float *radiance,
                                       size_t count,
                                       struct WelkinError *error);

/**
 * As welkin_sky_radiance_batch. What precedes a bad direction may or may not be written.
 */
WelkinStatus welkin_baked_sky_radiance_batch(const struct WelkinBakedSky *baked,
                                             const float *directions,
                                             size_t direction_count,
                                             float *radiance,
                                             size_t count,
                                             struct WelkinError *error);

/**
 * The same with directions as three arrays, `x[direction_count]`, `y[…]`, `z[…]`: the fastest way.
 */
WelkinStatus welkin_baked_sky_radiance_soa(const struct WelkinBakedSky *baked,
                                           const float *x,
                                           const float *y,
                                           const float *z,
                                           size_t direction_count,
                                           float *radiance,
                                           size_t count,
                                           struct WelkinError *error);

/**
 * Hero wavelengths: spectral radiance, W m⁻² sr⁻¹ nm⁻¹, `radiance[4]`, at four wavelengths (nm) of a path,
 * `wavelengths[4]`, within the range of the model.
 *
 * Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for a wavelength.
 */
WelkinStatus welkin_baked_sky_hero(const struct WelkinBakedSky *baked,
                                   const float *direction,
                                   const float *wavelengths,
                                   float *radiance,
                                   struct WelkinError *error);

/**
 * welkin_baked_sky_hero for many directions, each with wavelengths of its own: `directions[count][3]`,
 * `wavelengths[count][4]`, `radiance[count][4]`. What precedes a bad one may or may not be written.
 */
WelkinStatus welkin_baked_sky_hero_batch(const struct WelkinBakedSky *baked,
                                         const float *directions,
                                         const float *wavelengths,
                                         size_t count,
                                         float *radiance,
                                         struct WelkinError *error);

/**
 * The same with directions as three arrays: the fastest way.
 */
WelkinStatus welkin_baked_sky_hero_soa(const struct WelkinBakedSky *baked,
                                       const float *x,
                                       const float *y,
                                       const float *z,
                                       const float *wavelengths,
                                       size_t count,
                                       float *radiance,
                                       struct WelkinError *error);

/**
 * Spectral irradiance, W m⁻² nm⁻¹, `irradiance[count]`, that the sky without the sun's disc gives one side of a plane
 * with this `normal[3]`. Below the horizon the ground is black, but the air before it is included: what a plane that
 * looks down gets of the ground is missing, not what it gets of the air. Takes some thousand queries.
 *
 * Errors as of welkin_baked_sky_radiance.
 */
WelkinStatus welkin_baked_sky_irradiance(const struct WelkinBakedSky *baked,
                                         const float *normal,
                                         float *irradiance,
                                         size_t count,
                                         struct WelkinError *error);

/**
 * As welkin_sky_bake, for colours.
 */
WelkinStatus welkin_sky_bake_colour(const struct WelkinSky *sky,
                                    double tolerance,
                                    struct WelkinBakedColourSky **baked,
                                    struct WelkinError *error);

/**
 * As welkin_sky_bake_colour.
 */
WelkinStatus welkin_colour_sky_bake(const struct WelkinColourSky *sky,
                                    double tolerance,
                                    struct WelkinBakedColourSky **baked,
                                    struct WelkinError *error);

/**
 * Bakes a sky into tables of the sizes of `other`, which holds that at conditions nearby: the next frame under a sun
 * that moves, in half the time. Nothing is measured: welkin_baked_colour_sky_bake_error then tells the error of
 * `other`, which holds for conditions close to its own. Bake afresh every degree or so; from 10 to −8° at 9 km the
 * 95th percentile grows to 0.8 %.
 */
WelkinStatus welkin_colour_sky_bake_like(const struct WelkinColourSky *sky,
                                         const struct WelkinBakedColourSky *other,
                                         struct WelkinBakedColourSky **baked,
                                         struct WelkinError *error);

/**
 * Frees a baked sky; null is none. Samplers of it live on.
 */
void welkin_baked_colour_sky_free(struct WelkinBakedColourSky *baked);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_baked_colour_sky_bytes(const struct WelkinBakedColourSky *baked);

/**
 * Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
 */
WelkinStatus welkin_baked_colour_sky_conditions(const struct WelkinBakedColourSky *baked,
                                                struct WelkinConditions *conditions,
                                                struct WelkinError *error);

/**
 * Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
 * uses the handle.
 */
WelkinStatus welkin_baked_colour_sky_set_solar_azimuth(struct WelkinBakedColourSky *baked,
                                                       double azimuth,
                                                       struct WelkinError *error);

/**
 * What baking added to the error of the sky.
 */
WelkinStatus welkin_baked_colour_sky_bake_error(const struct WelkinBakedColourSky *baked,
                                                struct WelkinBakeError *bake_error,
                                                struct WelkinError *error);

/**
 * As welkin_sky_xyz.
 */
WelkinStatus welkin_baked_colour_sky_xyz(const struct WelkinBakedColourSky *baked,
                                         const float *direction,
                                         float *xyz,
                                         struct WelkinError *error);

/**
 * As welkin_sky_rgb.
 */
WelkinStatus welkin_baked_colour_sky_rgb(const struct WelkinBakedColourSky *baked,
                                         const float *direction,
                                         int32_t space,
                                         float *rgb,
                                         struct WelkinError *error);

/**
 * welkin_baked_colour_sky_xyz for many directions, `directions[count][3]`; `xyz[count][3]`. What precedes a bad
 * direction may or may not be written.
 */
WelkinStatus welkin_baked_colour_sky_xyz_batch(const struct WelkinBakedColourSky *baked,
                                               const float *directions,
                                               size_t count,
                                               float *xyz,
                                               struct WelkinError *error);

/**
 * The same with directions as three arrays, `x[count]`, `y[count]`, `z[count]`: the fastest way.
 */
WelkinStatus welkin_baked_colour_sky_xyz_soa(const struct WelkinBakedColourSky *baked,
                                             const float *x,
                                             const float *y,
                                             const float *z,
                                             size_t count,
                                             float *xyz,
                                             struct WelkinError *error);

/**
 * welkin_baked_colour_sky_rgb for many directions, `directions[count][3]`; `rgb[count][3]`. What precedes a bad
 * direction may or may not be written.
 */
WelkinStatus welkin_baked_colour_sky_rgb_batch(const struct WelkinBakedColourSky *baked,
                                               const float *directions,
                                               size_t count,
                                               int32_t space,
                                               float *rgb,
                                               struct WelkinError *error);

/**
 * The same with directions as three arrays, `x[count]`, `y[count]`, `z[count]`: the fastest way.
 */
WelkinStatus welkin_baked_colour_sky_rgb_soa(const struct WelkinBakedColourSky *baked,
                                             const float *x,
                                             const float *y,
                                             const float *z,
                                             size_t count,
                                             int32_t space,
                                             float *rgb,
                                             struct WelkinError *error);

/**
 * As welkin_sky_bake; the tolerance holds for the radiance, and for (Q, U) relative to it.
 */
WelkinStatus welkin_polarised_sky_bake(const struct WelkinPolarisedSky *sky,
                                       double tolerance,
                                       struct WelkinBakedPolarisedSky **baked,
                                       struct WelkinError *error);

/**
 * Frees a baked sky; null is none.
 */
void welkin_baked_polarised_sky_free(struct WelkinBakedPolarisedSky *baked);

/**
 * How many wavelengths results have; 0 for null.
 */
size_t welkin_baked_polarised_sky_wavelength_count(const struct WelkinBakedPolarisedSky *baked);

/**
 * Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of
 * welkin_baked_polarised_sky_wavelength_count.
 */
WelkinStatus welkin_baked_polarised_sky_wavelengths(const struct WelkinBakedPolarisedSky *baked,
                                                    double *wavelengths,
                                                    size_t count,
                                                    struct WelkinError *error);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_baked_polarised_sky_bytes(const struct WelkinBakedPolarisedSky *baked);

/**
 * Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
 */
WelkinStatus welkin_baked_polarised_sky_conditions(const struct WelkinBakedPolarisedSky *baked,
                                                   struct WelkinConditions *conditions,
                                                   struct WelkinError *error);

/**
 * Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
 * uses the handle.
 */
WelkinStatus welkin_baked_polarised_sky_set_solar_azimuth(struct WelkinBakedPolarisedSky *baked,
                                                          double azimuth,
                                                          struct WelkinError *error);

/**
 * What baking added to the error of the sky.
 */
WelkinStatus welkin_baked_polarised_sky_bake_error(const struct WelkinBakedPolarisedSky *baked,
                                                   struct WelkinBakeError *bake_error,
                                                   struct WelkinError *error);

/**
 * What baking added to the error of (Q, U) over I, as a distance.
 */
WelkinStatus welkin_baked_polarised_sky_polarisation_error(const struct WelkinBakedPolarisedSky *baked,
                                                           struct WelkinBakeError *bake_error,
                                                           struct WelkinError *error);

/**
 * The radiance alone, as welkin_baked_sky_radiance.
 */
WelkinStatus welkin_baked_polarised_sky_radiance(const struct WelkinBakedPolarisedSky *baked,
                                                 const float *direction,
                                                 float *radiance,
                                                 size_t count,
                                                 struct WelkinError *error);

/**
 * Stokes vectors, W m⁻² sr⁻¹ nm⁻¹, as three arrays `i[count]`, `q[count]`, `u[count]` with an element per wavelength,
 * in a frame (null: the vertical one). Errors as of welkin_polarised_sky_stokes.
 */
WelkinStatus welkin_baked_polarised_sky_stokes(const struct WelkinBakedPolarisedSky *baked,
                                               const float *direction,
                                               const struct WelkinPolarisationFrame *frame,
                                               float *i,
                                               float *q,
                                               float *u,
                                               size_t count,
                                               struct WelkinError *error);

/**
 * The same for many directions as three arrays; the outputs are `[direction_count][wavelengths]`, of which `count` is
 * the number of floats of each.
 */
WelkinStatus welkin_baked_polarised_sky_stokes_soa(const struct WelkinBakedPolarisedSky *baked,
                                                   const float *x,
                                                   const float *y,
                                                   const float *z,
                                                   size_t direction_count,
                                                   const struct WelkinPolarisationFrame *frame,
                                                   float *i,
                                                   float *q,
                                                   float *u,
                                                   size_t count,
                                                   struct WelkinError *error);

/**
 * Stokes vectors at four wavelengths (nm) of a path: `wavelengths[4]`, `stokes[4]`.
 *
 * Errors: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for a wavelength.
 */
WelkinStatus welkin_baked_polarised_sky_hero(const struct WelkinBakedPolarisedSky *baked,
                                             const float *direction,
                                             const struct WelkinPolarisationFrame *frame,
                                             const float *wavelengths,
                                             struct WelkinStokes *stokes,
                                             struct WelkinError *error);

/**
 * The same for many directions: `directions[count][3]`, `wavelengths[count][4]`, `stokes[count][4]`. What precedes a
 * bad one may or may not be written.
 */
WelkinStatus welkin_baked_polarised_sky_hero_batch(const struct WelkinBakedPolarisedSky *baked,
                                                   const float *directions,
                                                   const struct WelkinPolarisationFrame *frame,
                                                   const float *wavelengths,
                                                   size_t count,
                                                   struct WelkinStokes *stokes,
                                                   struct WelkinError *error);

/**
 * Prepares draws of a baked sky and, unless `disc` is null, of the sun's disc, as often as its share of the luminous
 * flux is. The new handle needs neither of them any more. Both must have been prepared for the same conditions:
 * altitudes and visibilities are not compared, as discs do not tell them.
 *
 * Errors: WELKIN_STATUS_RANGE where the sun of `disc` stands more than 1e-4 rad from that of `baked`, as after turning
 * the sky.
 */
WelkinStatus welkin_baked_colour_sky_sampler(const struct WelkinBakedColourSky *baked,
                                             const struct WelkinSolarDisc *disc,
                                             struct WelkinSkySampler **sampler,
                                             struct WelkinError *error);

/**
 * Frees a sampler; null is none.
 */
void welkin_sky_sampler_free(struct WelkinSkySampler *sampler);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_sky_sampler_bytes(const struct WelkinSkySampler *sampler);

/**
 * Maps a point of the unit square, `point[2]`, to a direction with its density and light. Numbers outside 0..1 are
 * clamped. Errors: WELKIN_STATUS_RANGE for NaN.
 */
WelkinStatus welkin_sky_sampler_sample(const struct WelkinSkySampler *sampler,
                                       const float *point,
                                       struct WelkinSample *sample,
                                       struct WelkinError *error);

/**
 * The same for many points, `points[count][2]`; `samples[count]`.
 */
WelkinStatus welkin_sky_sampler_sample_batch(const struct WelkinSkySampler *sampler,
                                             const float *points,
                                             size_t count,
                                             struct WelkinSample *samples,
                                             struct WelkinError *error);

/**
 * The density of draws at any direction, sr⁻¹, the same as that of samples: to combine with other strategies.
 *
 * Errors: WELKIN_STATUS_DIRECTION.
 */
WelkinStatus welkin_sky_sampler_pdf(const struct WelkinSkySampler *sampler,
                                    const float *direction,
                                    float *pdf,
                                    struct WelkinError *error);

/**
 * CIE XYZ of what draws are in proportion to, `xyz[3]`: the sky and, if it is drawn, the sun's disc.
 *
 * Errors: WELKIN_STATUS_DIRECTION.
 */
WelkinStatus welkin_sky_sampler_xyz(const struct WelkinSkySampler *sampler,
                                    const float *direction,
                                    float *xyz,
                                    struct WelkinError *error);

/**
 * Prepares the sun's disc. Errors as of welkin_sky_new.
 */
WelkinStatus welkin_solar_disc_new(const struct WelkinModel *model,
                                   const struct WelkinConditions *conditions,
                                   struct WelkinSolarDisc **disc,
                                   struct WelkinError *error);

/**
 * Frees a disc; null is none.
 */
void welkin_solar_disc_free(struct WelkinSolarDisc *disc);

/**
 * How many wavelengths results have; 0 for null.
 */
size_t welkin_solar_disc_wavelength_count(const struct WelkinSolarDisc *disc);

/**
 * Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_solar_disc_wavelength_count.
 */
WelkinStatus welkin_solar_disc_wavelengths(const struct WelkinSolarDisc *disc,
                                           double *wavelengths,
                                           size_t count,
                                           struct WelkinError *error);

/**
 * Whether any of it is above the horizon; false for null.
 */
bool welkin_solar_disc_is_visible(const struct WelkinSolarDisc *disc);

/**
 * Solid angle of what is visible of it, sr; 0 for null.
 */
double welkin_solar_disc_solid_angle(const struct WelkinSolarDisc *disc);

/**
 * Unit vector towards its centre, as `direction[3]`.
 */
WelkinStatus welkin_solar_disc_direction(const struct WelkinSolarDisc *disc,
                                         float *direction,
                                         struct WelkinError *error);

/**
 * Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, `radiance[count]`; zero in directions that it does not cover. Add it to that of
 * the sky. Errors as of welkin_sky_radiance.
 */
WelkinStatus welkin_solar_disc_radiance(const struct WelkinSolarDisc *disc,
                                        const float *direction,
                                        float *radiance,
                                        size_t count,
                                        struct WelkinError *error);

/**
 * The same at any wavelength (nm) within the range of the model. Errors as of welkin_sky_radiance_at.
 */
WelkinStatus welkin_solar_disc_radiance_at(const struct WelkinSolarDisc *disc,
                                           const float *direction,
                                           double wavelength,
                                           float *radiance,
                                           struct WelkinError *error);

/**
 * CIE XYZ of its radiance, `xyz[3]`. Errors: WELKIN_STATUS_DIRECTION.
 */
WelkinStatus welkin_solar_disc_xyz(const struct WelkinSolarDisc *disc,
                                   const float *direction,
                                   float *xyz,
                                   struct WelkinError *error);

/**
 * The same in a colour space, as welkin_sky_rgb.
 */
WelkinStatus welkin_solar_disc_rgb(const struct WelkinSolarDisc *disc,
                                   const float *direction,
                                   int32_t space,
                                   float *rgb,
                                   struct WelkinError *error);

/**
 * Spectral irradiance, W m⁻² nm⁻¹, `irradiance[count]`, that it gives one side of a plane with this `normal[3]`.
 * Errors as of welkin_sky_radiance.
 */
WelkinStatus welkin_solar_disc_irradiance(const struct WelkinSolarDisc *disc,
                                          const float *normal,
                                          float *irradiance,
                                          size_t count,
                                          struct WelkinError *error);

/**
 * Bakes skies for all solar elevations from `elevations[0]` to `elevations[1]` (rad); the sun of the conditions does
 * not count. By day that takes as long as baking some tens of skies (0..30° at 1500 m: 41 skies, 0.4 s, 0.9 MB);
 * through twilight, where skies change from one tenth of a degree to the next, seconds and some MB.
 *
 * Errors as of welkin_sky_new and welkin_sky_bake.
 */
WelkinStatus welkin_sun_course_new(const struct WelkinModel *model,
                                   const struct WelkinConditions *conditions,
                                   const double *elevations,
                                   double tolerance,
                                   struct WelkinSunCourse **course,
                                   struct WelkinError *error);

/**
 * Frees a course; null is none.
 */
void welkin_sun_course_free(struct WelkinSunCourse *course);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_sun_course_bytes(const struct WelkinSunCourse *course);

/**
 * How many skies are baked; 0 for null.
 */
size_t welkin_sun_course_skies(const struct WelkinSunCourse *course);

/**
 * Lowest and highest elevation, rad, as `elevations[2]`.
 */
WelkinStatus welkin_sun_course_elevations(const struct WelkinSunCourse *course,
                                          double *elevations,
                                          struct WelkinError *error);

/**
 * What interpolating between baked skies adds, the worst that was found between them.
 */
WelkinStatus welkin_sun_course_interpolation_error(const struct WelkinSunCourse *course,
                                                   struct WelkinBakeError *bake_error,
                                                   struct WelkinError *error);

/**
 * The sky under a sun at an elevation of the range and any azimuth (rad), as a new handle.
 *
 * Errors: WELKIN_STATUS_RANGE.
 */
WelkinStatus welkin_sun_course_at(const struct WelkinSunCourse *course,
                                  double elevation,
                                  double azimuth,
                                  struct WelkinBakedColourSky **baked,
                                  struct WelkinError *error);

/**
 * The same into a sky that is there already, in its memory: for a sun that moves with every frame. Not while another
 * thread uses that sky. Its samplers keep the sky that they were made of, and discs are to be prepared anew. Takes
 * some microseconds, and up to a millisecond where the tables of the baked skies change size, as they do in twilight.
 */
WelkinStatus welkin_sun_course_write(const struct WelkinSunCourse *course,
                                     double elevation,
                                     double azimuth,
                                     struct WelkinBakedColourSky *baked,
                                     struct WelkinError *error);

/**
 * Fills a moon: full as it can be without an eclipse, 45° high towards +x, at its mean distance. `struct_size` is
 * sizeof(WelkinMoon).
 */
WelkinStatus welkin_moon_init(struct WelkinMoon *moon, uint64_t struct_size, struct WelkinError *error);

/**
 * The phase angle (rad) of a moon at mean distance in a direction `moon[3]`, with the sun in another, `sun[3]`.
 */
WelkinStatus welkin_moon_phase_angle(const double *moon,
                                     const double *sun,
                                     double *phase_angle,
                                     struct WelkinError *error);

/**
 * The same model with the moon in place of the sun, as a new handle: skies, discs and air are those that the moon
 * lights, where conditions say with `solar_elevation` and `solar_azimuth` where it stands. Radiances of both lights
 * add.
 *
 * Errors: WELKIN_STATUS_RANGE for a phase angle outside 0..=π or a distance that the moon cannot have.
 */
WelkinStatus welkin_model_moonlit(const struct WelkinModel *model,
                                  const struct WelkinMoon *moon,
                                  struct WelkinModel **moonlit,
                                  struct WelkinError *error);

/**
 * Prepares the sky of sun and moon. One that is too far below the horizon adds nothing.
 *
 * Errors as of welkin_sky_new and welkin_model_moonlit.
 */
WelkinStatus welkin_sky_sum_new(const struct WelkinModel *model,
                                const struct WelkinConditions *conditions,
                                const struct WelkinMoon *moon,
                                struct WelkinSkySum **sum,
                                struct WelkinError *error);

/**
 * Frees a sky; null is none.
 */
void welkin_sky_sum_free(struct WelkinSkySum *sum);

/**
 * As welkin_sky_radiance, at the wavelengths of the model.
 */
WelkinStatus welkin_sky_sum_radiance(const struct WelkinSkySum *sum,
                                     const float *direction,
                                     float *radiance,
                                     size_t count,
                                     struct WelkinError *error);

/**
 * As welkin_sky_xyz.
 */
WelkinStatus welkin_sky_sum_xyz(const struct WelkinSkySum *sum,
                                const float *direction,
                                float *xyz,
                                struct WelkinError *error);

/**
 * As welkin_sky_rgb.
 */
WelkinStatus welkin_sky_sum_rgb(const struct WelkinSkySum *sum,
                                const float *direction,
                                int32_t space,
                                float *rgb,
                                struct WelkinError *error);

/**
 * Prepares point queries within a plan of this model, and reads what it asks for. The new handle keeps what it needs
 * of the model alive.
 *
 * Errors: WELKIN_STATUS_LIMIT for models that are too large; those of a damaged file.
 */
WelkinStatus welkin_point_query_new(const struct WelkinModel *model,
                                    const struct WelkinPlan *plan,
                                    struct WelkinPointQuery **query,
                                    struct WelkinError *error);

/**
 * Frees a query; null is none.
 */
void welkin_point_query_free(struct WelkinPointQuery *query);

/**
 * Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at the wavelengths of the model: `radiance[count]`.
 *
 * Errors: WELKIN_STATUS_RANGE for the conditions; WELKIN_STATUS_MISSING for those outside of the plan;
 * WELKIN_STATUS_DIRECTION; WELKIN_STATUS_LENGTH.
 */
WelkinStatus welkin_point_query_radiance(const struct WelkinPointQuery *query,
                                         const struct WelkinConditions *conditions,
                                         const float *direction,
                                         float *radiance,
                                         size_t count,
                                         struct WelkinError *error);

/**
 * The same at any wavelength (nm) within the range of the model. Errors also: WELKIN_STATUS_RANGE for the wavelength.
 */
WelkinStatus welkin_point_query_radiance_at(const struct WelkinPointQuery *query,
                                            const struct WelkinConditions *conditions,
                                            const float *direction,
                                            double wavelength,
                                            float *radiance,
                                            struct WelkinError *error);

/**
 * Prepares point queries with polarisation, within a plan for WELKIN_CHANNELS_STOKES. Otherwise as
 * welkin_point_query_new.
 */
WelkinStatus welkin_polarised_point_query_new(const struct WelkinModel *model,
                                              const struct WelkinPlan *plan,
                                              struct WelkinPolarisedPointQuery **query,
                                              struct WelkinError *error);

/**
 * Frees a query; null is none.
 */
void welkin_polarised_point_query_free(struct WelkinPolarisedPointQuery *query);

/**
 * The Stokes vector at any wavelength (nm) within the range of the model, in a frame (null: the vertical one). Errors
 * as of welkin_point_query_radiance_at.
 */
WelkinStatus welkin_polarised_point_query_stokes_at(const struct WelkinPolarisedPointQuery *query,
                                                    const struct WelkinConditions *conditions,
                                                    const float *direction,
                                                    const struct WelkinPolarisationFrame *frame,
                                                    double wavelength,
                                                    struct WelkinStokes *stokes,
                                                    struct WelkinError *error);

/**
 * Prepares the air at a visibility (m).
 *
 * Errors: WELKIN_STATUS_RANGE; WELKIN_STATUS_MISSING if the file has no transmittance; those of a damaged file.
 */
WelkinStatus welkin_transmittance_new(const struct WelkinModel *model,
                                      double visibility,
                                      struct WelkinTransmittance **air,
                                      struct WelkinError *error);

/**
 * Frees the air; null is none.
 */
void welkin_transmittance_free(struct WelkinTransmittance *air);

/**
 * How many wavelengths results have; 0 for null.
 */
size_t welkin_transmittance_wavelength_count(const struct WelkinTransmittance *air);

/**
 * Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of welkin_transmittance_wavelength_count.
 */
WelkinStatus welkin_transmittance_wavelengths(const struct WelkinTransmittance *air,
                                              double *wavelengths,
                                              size_t count,
                                              struct WelkinError *error);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_transmittance_bytes(const struct WelkinTransmittance *air);

/**
 * Transmittance between two points, `from[3]` and `to[3]`, at each of its wavelengths: `out[count]`, 0..=1.
 *
 * Errors: WELKIN_STATUS_POINT for coordinates that are not finite or beyond 1e9 m; WELKIN_STATUS_LENGTH.
 */
WelkinStatus welkin_transmittance_between(const struct WelkinTransmittance *air,
                                          const double *from,
                                          const double *to,
                                          float *out,
                                          size_t count,
                                          struct WelkinError *error);

/**
 * The same at any wavelength (nm) within the range of the model. In an absorption band it is the mean over the band.
 * Errors also: WELKIN_STATUS_RANGE.
 */
WelkinStatus welkin_transmittance_between_at(const struct WelkinTransmittance *air,
                                             const double *from,
                                             const double *to,
                                             double wavelength,
                                             float *out,
                                             struct WelkinError *error);

/**
 * Optical depth between two points; otherwise as welkin_transmittance_between.
 */
WelkinStatus welkin_transmittance_optical_depth(const struct WelkinTransmittance *air,
                                                const double *from,
                                                const double *to,
                                                float *out,
                                                size_t count,
                                                struct WelkinError *error);

/**
 * Transmittance from a point to space in a `direction[3]`, which need not be normalised; zero where the ground is in
 * the way. Errors also: WELKIN_STATUS_DIRECTION.
 */
WelkinStatus welkin_transmittance_to_space(const struct WelkinTransmittance *air,
                                           const double *from,
                                           const double *direction,
                                           float *out,
                                           size_t count,
                                           struct WelkinError *error);

/**
 * The same at any wavelength (nm) within the range of the model. In an absorption band it is the mean over the band.
 * Errors also: WELKIN_STATUS_RANGE.
 */
WelkinStatus welkin_transmittance_to_space_at(const struct WelkinTransmittance *air,
                                              const double *from,
                                              const double *direction,
                                              double wavelength,
                                              float *out,
                                              struct WelkinError *error);

/**
 * Transmittance from a point in a direction through all of the air, up to the ground where that is in the way. Errors
 * as of welkin_transmittance_to_space.
 */
WelkinStatus welkin_transmittance_to_end(const struct WelkinTransmittance *air,
                                         const double *from,
                                         const double *direction,
                                         float *out,
                                         size_t count,
                                         struct WelkinError *error);

/**
 * The same at any wavelength (nm) within the range of the model. In an absorption band it is the mean over the band.
 * Errors also: WELKIN_STATUS_RANGE.
 */
WelkinStatus welkin_transmittance_to_end_at(const struct WelkinTransmittance *air,
                                            const double *from,
                                            const double *direction,
                                            double wavelength,
                                            float *out,
                                            struct WelkinError *error);

/**
 * Prepares the air of a scene, of which the altitude of the conditions plays no part.
 *
 * Errors as of welkin_sky_new.
 */
WelkinStatus welkin_aerial_perspective_new(const struct WelkinModel *model,
                                           const struct WelkinConditions *conditions,
                                           struct WelkinAerialPerspective **aerial,
                                           struct WelkinError *error);

/**
 * Frees an aerial perspective; null is none.
 */
void welkin_aerial_perspective_free(struct WelkinAerialPerspective *aerial);

/**
 * How many wavelengths results have; 0 for null.
 */
size_t welkin_aerial_perspective_wavelength_count(const struct WelkinAerialPerspective *aerial);

/**
 * Writes the wavelengths of results, nm: `wavelengths[count]` with `count` of
 * welkin_aerial_perspective_wavelength_count.
 */
WelkinStatus welkin_aerial_perspective_wavelengths(const struct WelkinAerialPerspective *aerial,
                                                   double *wavelengths,
                                                   size_t count,
                                                   struct WelkinError *error);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_aerial_perspective_bytes(const struct WelkinAerialPerspective *aerial);

/**
 * Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
 */
WelkinStatus welkin_aerial_perspective_conditions(const struct WelkinAerialPerspective *aerial,
                                                  struct WelkinConditions *conditions,
                                                  struct WelkinError *error);

/**
 * Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
 * uses the handle.
 */
WelkinStatus welkin_aerial_perspective_set_solar_azimuth(struct WelkinAerialPerspective *aerial,
                                                         double azimuth,
                                                         struct WelkinError *error);

/**
 * How far the air of segments may be from the origin, as an angle at the planet's centre, rad; 0 for null.
 */
double welkin_aerial_perspective_reach(const struct WelkinAerialPerspective *aerial);

/**
 * Of the segment from `from[3]`, where the observer is, to `to[3]`: `in_scattering[count]` in W m⁻² sr⁻¹ nm⁻¹ and
 * `transmittance[count]`, an element per wavelength.
 *
 * Errors: WELKIN_STATUS_POINT for a point that is not finite, beyond 1e9 m or out of reach; WELKIN_STATUS_LENGTH.
 */
WelkinStatus welkin_aerial_perspective_in_scattering(const struct WelkinAerialPerspective *aerial,
                                                     const double *from,
                                                     const double *to,
                                                     float *in_scattering,
                                                     float *transmittance,
                                                     size_t count,
                                                     struct WelkinError *error);

/**
 * Of all of the air from a point in a `direction[3]`, up to the ground where that is in the way; otherwise as
 * welkin_aerial_perspective_in_scattering. Errors also: WELKIN_STATUS_DIRECTION.
 */
WelkinStatus welkin_aerial_perspective_to_end(const struct WelkinAerialPerspective *aerial,
                                              const double *from,
                                              const double *direction,
                                              float *in_scattering,
                                              float *transmittance,
                                              size_t count,
                                              struct WelkinError *error);

/**
 * Of segments from a camera to many points, `points[point_count][3]`; the outputs are `[point_count][wavelengths]`, of
 * which `count` is the number of floats of each. What precedes a bad point is written.
 */
WelkinStatus welkin_aerial_perspective_in_scattering_batch(const struct WelkinAerialPerspective *aerial,
                                                           const double *camera,
                                                           const double *points,
                                                           size_t point_count,
                                                           float *in_scattering,
                                                           float *transmittance,
                                                           size_t count,
                                                           struct WelkinError *error);

/**
 * Of segments from `from` to the points at growing `distances[distance_count]` (m) in a `direction[3]`: the slices of
 * a ray, each piece integrated once. The outputs are `[distance_count][wavelengths]`, of which `count` is the number
 * of floats.
 *
 * Errors also: WELKIN_STATUS_DIRECTION; WELKIN_STATUS_RANGE for distances that are negative or do not grow.
 */
WelkinStatus welkin_aerial_perspective_in_scattering_along(const struct WelkinAerialPerspective *aerial,
                                                           const double *from,
                                                           const double *direction,
                                                           const double *distances,
                                                           size_t distance_count,
                                                           float *in_scattering,
                                                           float *transmittance,
                                                           size_t count,
                                                           struct WelkinError *error);

/**
 * The in-scattered light of a segment at any wavelength (nm) within the range of the model, W m⁻² sr⁻¹ nm⁻¹.
 */
WelkinStatus welkin_aerial_perspective_in_scattering_at(const struct WelkinAerialPerspective *aerial,
                                                        const double *from,
                                                        const double *to,
                                                        double wavelength,
                                                        float *in_scattering,
                                                        struct WelkinError *error);

/**
 * CIE XYZ of the in-scattered light of a segment, `light[3]`, and what the air leaves of X, Y and Z of things lit by
 * the sun, `factors[3]`.
 */
WelkinStatus welkin_aerial_perspective_xyz(const struct WelkinAerialPerspective *aerial,
                                           const double *from,
                                           const double *to,
                                           float *light,
                                           float *factors,
                                           struct WelkinError *error);

/**
 * The same in a colour space (WELKIN_SPACE_SRGB …): light in cd m⁻². What is there is seen as `radiance · factors +
 * light`.
 */
WelkinStatus welkin_aerial_perspective_rgb(const struct WelkinAerialPerspective *aerial,
                                           const double *from,
                                           const double *to,
                                           int32_t space,
                                           float *light,
                                           float *factors,
                                           struct WelkinError *error);

/**
 * The in-scattered light of a segment with its polarisation, as three arrays with an element per wavelength, in a
 * frame (null: the vertical one) at the start, and the transmittance.
 */
WelkinStatus welkin_aerial_perspective_in_scattering_stokes(const struct WelkinAerialPerspective *aerial,
                                                            const double *from,
                                                            const double *to,
                                                            const struct WelkinPolarisationFrame *frame,
                                                            float *i,
                                                            float *q,
                                                            float *u,
                                                            float *transmittance,
                                                            size_t count,
                                                            struct WelkinError *error);

/**
 * Stokes vectors of the in-scattered light of a segment in linear sRGB, `light[3]`, and the factors of things,
 * `factors[3]`.
 */
WelkinStatus welkin_aerial_perspective_rgb_stokes(const struct WelkinAerialPerspective *aerial,
                                                  const double *from,
                                                  const double *to,
                                                  const struct WelkinPolarisationFrame *frame,
                                                  struct WelkinStokes *light,
                                                  float *factors,
                                                  struct WelkinError *error);

/**
 * As welkin_aerial_perspective_in_scattering from where the sky was prepared, (0, 0, altitude), but that the light
 * goes over into that of the sky where hardly any can come from beyond the segment: what is far vanishes in the sky
 * without a seam.
 *
 * Errors also: WELKIN_STATUS_RANGE if the sky has another sun, visibility or albedo.
 */
WelkinStatus welkin_aerial_perspective_joined_in_scattering(const struct WelkinAerialPerspective *aerial,
                                                            const struct WelkinSky *sky,
                                                            const double *to,
                                                            float *in_scattering,
                                                            float *transmittance,
                                                            size_t count,
                                                            struct WelkinError *error);

/**
 * The same for many points, as welkin_aerial_perspective_in_scattering_batch.
 */
WelkinStatus welkin_aerial_perspective_joined_batch(const struct WelkinAerialPerspective *aerial,
                                                    const struct WelkinSky *sky,
                                                    const double *points,
                                                    size_t point_count,
                                                    float *in_scattering,
                                                    float *transmittance,
                                                    size_t count,
                                                    struct WelkinError *error);

/**
 * The same in CIE XYZ, as welkin_aerial_perspective_xyz.
 */
WelkinStatus welkin_aerial_perspective_joined_xyz(const struct WelkinAerialPerspective *aerial,
                                                  const struct WelkinSky *sky,
                                                  const double *to,
                                                  float *light,
                                                  float *factors,
                                                  struct WelkinError *error);

/**
 * The same in a colour space (WELKIN_SPACE_SRGB …), as welkin_aerial_perspective_rgb.
 */
WelkinStatus welkin_aerial_perspective_joined_rgb(const struct WelkinAerialPerspective *aerial,
                                                  const struct WelkinSky *sky,
                                                  const double *to,
                                                  int32_t space,
                                                  float *light,
                                                  float *factors,
                                                  struct WelkinError *error);

/**
 * The same in linear sRGB.
 */
WelkinStatus welkin_aerial_perspective_joined_srgb(const struct WelkinAerialPerspective *aerial,
                                                   const struct WelkinSky *sky,
                                                   const double *to,
                                                   float *light,
                                                   float *factors,
                                                   struct WelkinError *error);

/**
 * The same with polarisation, as welkin_aerial_perspective_rgb_stokes, before a polarised sky.
 */
WelkinStatus welkin_aerial_perspective_joined_srgb_stokes(const struct WelkinAerialPerspective *aerial,
                                                          const struct WelkinPolarisedSky *sky,
                                                          const double *to,
                                                          const struct WelkinPolarisationFrame *frame,
                                                          struct WelkinStokes *light,
                                                          float *factors,
                                                          struct WelkinError *error);

/**
 * Prepares the air of a scene for colour alone. Errors as of welkin_aerial_perspective_new.
 */
WelkinStatus welkin_colour_aerial_perspective_new(const struct WelkinModel *model,
                                                  const struct WelkinConditions *conditions,
                                                  struct WelkinColourAerialPerspective **aerial,
                                                  struct WelkinError *error);

/**
 * Frees an aerial perspective; null is none.
 */
void welkin_colour_aerial_perspective_free(struct WelkinColourAerialPerspective *aerial);

/**
 * Memory on the heap, bytes; 0 for null.
 */
size_t welkin_colour_aerial_perspective_bytes(const struct WelkinColourAerialPerspective *aerial);

/**
 * Writes the conditions that it was prepared for. The struct_size of `conditions` must be set.
 */
WelkinStatus welkin_colour_aerial_perspective_conditions(const struct WelkinColourAerialPerspective *aerial,
                                                         struct WelkinConditions *conditions,
                                                         struct WelkinError *error);

/**
 * Turns it about the vertical so that the sun has this azimuth (rad). Costs no preparation. Not while another thread
 * uses the handle.
 */
WelkinStatus welkin_colour_aerial_perspective_set_solar_azimuth(struct WelkinColourAerialPerspective *aerial,
                                                                double azimuth,
                                                                struct WelkinError *error);

/**
 * As welkin_aerial_perspective_xyz.
 */
WelkinStatus welkin_colour_aerial_perspective_xyz(const struct WelkinColourAerialPerspective *aerial,
                                                  const double *from,
                                                  const double *to,
                                                  float *light,
                                                  float *factors,
                                                  struct WelkinError *error);

/**
 * As welkin_aerial_perspective_rgb.
 */
WelkinStatus welkin_colour_aerial_perspective_rgb(const struct WelkinColourAerialPerspective *aerial,
                                                  const double *from,
                                                  const double *to,
                                                  int32_t space,
                                                  float *light,
                                                  float *factors,
                                                  struct WelkinError *error);

/**
 * In linear sRGB, of segments from `from` to the points at growing `distances[distance_count]` (m) in a
 * `direction[3]`: `light[distance_count][3]` and `factors[distance_count][3]`. Errors as of
 * welkin_aerial_perspective_in_scattering_along.
 */
WelkinStatus welkin_colour_aerial_perspective_srgb_along(const struct WelkinColourAerialPerspective *aerial,
                                                         const double *from,
                                                         const double *direction,
                                                         const double *distances,
                                                         size_t distance_count,
                                                         float *light,
                                                         float *factors,
                                                         struct WelkinError *error);

/**
 * Fills a volume in linear sRGB: `light` and `factors` are `[rows][columns][depths][3]`, of which `count` is rows ×
 * columns × depths. On all cores where the library was built with rayon. Allocates.
 *
 * Errors also: WELKIN_STATUS_LENGTH for another count; WELKIN_STATUS_RANGE for depths that do not grow.
 */
WelkinStatus welkin_colour_aerial_perspective_srgb_volume(const struct WelkinColourAerialPerspective *aerial,
                                                          const struct WelkinCameraVolume *volume,
                                                          float *light,
                                                          float *factors,
                                                          size_t count,
                                                          struct WelkinError *error);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* WELKIN_CAPI_H */

/* What welkin_check_abi takes: a pointer to the version and sizes that a program was compiled with. */
#define WELKIN_ABI_SIZES \
    WELKIN_ABI_VERSION, sizeof(void *), sizeof(WelkinError), sizeof(WelkinConditions), \
    sizeof(WelkinPolarisationFrame), sizeof(WelkinStokes), sizeof(WelkinBakeError), sizeof(WelkinSample), \
    sizeof(WelkinRanges), sizeof(WelkinMoon), sizeof(WelkinBudget), sizeof(WelkinPlanSummary), \
    sizeof(WelkinCameraVolume), {0, 0, 0}
#ifndef __cplusplus
#define WELKIN_ABI (&(const WelkinAbi){WELKIN_ABI_SIZES})
#endif

/* The layout that the library was compiled with. */
#if UINTPTR_MAX == 0xffffffffffffffff
#if defined(__cplusplus) && __cplusplus >= 201103L
#define WELKIN_LAYOUT(condition, what) static_assert(condition, what)
#elif defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define WELKIN_LAYOUT(condition, what) _Static_assert(condition, what)
#endif
#endif
#ifdef WELKIN_LAYOUT
WELKIN_LAYOUT(sizeof(WelkinError) == 260, "size of WelkinError");
WELKIN_LAYOUT(offsetof(WelkinError, text) == 4, "WelkinError.text");
WELKIN_LAYOUT(sizeof(WelkinConditions) == 48, "size of WelkinConditions");
WELKIN_LAYOUT(offsetof(WelkinConditions, solar_elevation) == 8, "WelkinConditions.solar_elevation");
WELKIN_LAYOUT(offsetof(WelkinConditions, solar_azimuth) == 16, "WelkinConditions.solar_azimuth");
WELKIN_LAYOUT(offsetof(WelkinConditions, visibility) == 24, "WelkinConditions.visibility");
WELKIN_LAYOUT(offsetof(WelkinConditions, albedo) == 32, "WelkinConditions.albedo");
WELKIN_LAYOUT(offsetof(WelkinConditions, altitude) == 40, "WelkinConditions.altitude");
WELKIN_LAYOUT(sizeof(WelkinPolarisationFrame) == 16, "size of WelkinPolarisationFrame");
WELKIN_LAYOUT(offsetof(WelkinPolarisationFrame, axis) == 4, "WelkinPolarisationFrame.axis");
WELKIN_LAYOUT(sizeof(WelkinStokes) == 12, "size of WelkinStokes");
WELKIN_LAYOUT(offsetof(WelkinStokes, u) == 8, "WelkinStokes.u");
WELKIN_LAYOUT(sizeof(WelkinBakeError) == 40, "size of WelkinBakeError");
WELKIN_LAYOUT(offsetof(WelkinBakeError, max) == 32, "WelkinBakeError.max");
WELKIN_LAYOUT(sizeof(WelkinSample) == 32, "size of WelkinSample");
WELKIN_LAYOUT(offsetof(WelkinSample, pdf) == 12, "WelkinSample.pdf");
WELKIN_LAYOUT(offsetof(WelkinSample, xyz) == 16, "WelkinSample.xyz");
WELKIN_LAYOUT(offsetof(WelkinSample, part) == 28, "WelkinSample.part");
WELKIN_LAYOUT(sizeof(WelkinRanges) == 80, "size of WelkinRanges");
WELKIN_LAYOUT(offsetof(WelkinRanges, wavelength) == 48, "WelkinRanges.wavelength");
WELKIN_LAYOUT(offsetof(WelkinRanges, top) == 72, "WelkinRanges.top");
WELKIN_LAYOUT(sizeof(WelkinAxis) == 136, "size of WelkinAxis");
WELKIN_LAYOUT(offsetof(WelkinAxis, nodes) == 16, "WelkinAxis.nodes");
WELKIN_LAYOUT(offsetof(WelkinAxis, name) == 24, "WelkinAxis.name");
WELKIN_LAYOUT(offsetof(WelkinAxis, unit) == 96, "WelkinAxis.unit");
WELKIN_LAYOUT(sizeof(WelkinMoon) == 40, "size of WelkinMoon");
WELKIN_LAYOUT(offsetof(WelkinMoon, distance) == 32, "WelkinMoon.distance");
WELKIN_LAYOUT(sizeof(WelkinBudget) == 72, "size of WelkinBudget");
WELKIN_LAYOUT(offsetof(WelkinBudget, altitude) == 8, "WelkinBudget.altitude");
WELKIN_LAYOUT(offsetof(WelkinBudget, channels) == 64, "WelkinBudget.channels");
WELKIN_LAYOUT(sizeof(WelkinPlanSummary) == 56, "size of WelkinPlanSummary");
WELKIN_LAYOUT(offsetof(WelkinPlanSummary, bake_p95) == 48, "WelkinPlanSummary.bake_p95");
WELKIN_LAYOUT(sizeof(WelkinCameraVolume) == 136, "size of WelkinCameraVolume");
WELKIN_LAYOUT(offsetof(WelkinCameraVolume, columns) == 104, "WelkinCameraVolume.columns");
WELKIN_LAYOUT(offsetof(WelkinCameraVolume, depths) == 128, "WelkinCameraVolume.depths");
WELKIN_LAYOUT(sizeof(WelkinAbi) == 64, "size of WelkinAbi");
WELKIN_LAYOUT(offsetof(WelkinAbi, camera_volume) == 48, "WelkinAbi.camera_volume");
#undef WELKIN_LAYOUT
#endif
