/* welkin.h: reads clear-sky radiance files of the welkin format, version 1.
 *
 * In exactly one C file: #define WELKIN_IMPLEMENTATION, then include this header. Link with -lm.
 *
 * The caller gives the bytes of a file and keeps them alive; nothing is allocated, there is no mutable global, and
 * every number of the file is checked before use. Bytes may be unaligned; the host may have either byte order.
 * Numbers must be IEEE 754: with -ffast-math or -ffinite-math-only the implementation does not compile.
 *
 * Look at every error. After one, what the call was to open, prepare or bake is empty, whatever it was before, and
 * questions to it are WELKIN_ERROR_STATE, sizes 0; what it was to return, and memory that it got, hold nothing of use.
 * What is not a number or too large in the arguments is an error (of range, direction or point), and results that come
 * without one are finite: what a float cannot hold is WELKIN_ERROR_VALUE, but for what comes from tables, and Q and U,
 * which stop at FLT_MAX. Arrays of radiance that are handed back must be ones that these functions gave. No pointer may
 * be NULL, but for `user` of welkin_unpack and `name` of welkin_colour_space_named; nor may a struct be asked that no
 * call has filled.
 *
 * With WELKIN_STATIC defined, all functions are private to the file that includes the implementation, and those that it
 * does not use are no warnings. Or define WELKIN_API: what stands before each function.
 *
 * Arrays of results belong to the wavelengths that the file stores, its nodes. Functions whose names end in _at answer
 * at any wavelength in its range.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef WELKIN_H
#define WELKIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef WELKIN_API
#ifndef WELKIN_STATIC
#define WELKIN_API extern
#elif defined(__GNUC__)
#define WELKIN_API static __attribute__((unused))
#else
#define WELKIN_API static
#endif
#endif

/* The classes of errors of the specification; one for a scratch that is too small; and one for questions to what is
 * not open or not prepared, as after a call that failed. */
typedef enum welkin_error {
    WELKIN_OK = 0,
    WELKIN_ERROR_MAGIC,
    WELKIN_ERROR_VERSION,
    WELKIN_ERROR_FEATURE,
    WELKIN_ERROR_LENGTH,
    WELKIN_ERROR_CHECKSUM,
    WELKIN_ERROR_VALUE,
    WELKIN_ERROR_ENCODING,
    WELKIN_ERROR_RANGE,
    WELKIN_ERROR_MISSING,
    WELKIN_ERROR_DIRECTION,
    WELKIN_ERROR_POINT,
    WELKIN_ERROR_SCRATCH,
    WELKIN_ERROR_STATE
} welkin_error;

/* Of this reader; the files have versions of their own. */
#define WELKIN_READER_VERSION "1.1.0"

#define WELKIN_MAX_CONSTITUENTS 16

/* Arrays on the stack are this long. Less may be defined, alike wherever the header is included: files that need more
 * do not open (WELKIN_ERROR_VALUE), tables of more intervals are not baked. */
#ifndef WELKIN_MAX_WAVELENGTHS
#define WELKIN_MAX_WAVELENGTHS 256
#endif
#ifndef WELKIN_MAX_FIELDS
#define WELKIN_MAX_FIELDS 16
#endif
#ifndef WELKIN_MAX_RANK
#define WELKIN_MAX_RANK 4096
#endif
#ifndef WELKIN_MAX_INTERVALS
#define WELKIN_MAX_INTERVALS 512
#endif
#if WELKIN_MAX_WAVELENGTHS < 16 || WELKIN_MAX_WAVELENGTHS % 16 || WELKIN_MAX_RANK < 16 || WELKIN_MAX_RANK % 16
#error "WELKIN_MAX_WAVELENGTHS and WELKIN_MAX_RANK must be multiples of 16"
#endif
#if WELKIN_MAX_WAVELENGTHS > 256 || WELKIN_MAX_FIELDS > 16 || WELKIN_MAX_RANK > 4096 || WELKIN_MAX_INTERVALS > 512
#error "the largest WELKIN_MAX_ values are 256 wavelengths, 16 fields, rank 4096 and 512 intervals"
#endif

/* What lies between the nodes: where the tables of the spectrum chunk are; private. */
typedef struct welkin_spectrum {
    welkin_error error; /* why it cannot be used: WELKIN_ERROR_MISSING in a file without one */
    uint32_t cells, taps, terms; /* terms of all cells together */
    const unsigned char *wavelength, *first_term, *term_weight, *term_extinction, *tap_node, *tap_weight, *extinction;
} welkin_spectrum;

/* What the fields are relative to: where the tables of the estimate chunk are; private. */
typedef struct welkin_estimate {
    welkin_error error; /* why it cannot be used: WELKIN_ERROR_MISSING in a file without one */
    uint32_t levels, angles, suns, densities, rings, estimates;
    double sun_lowest, sun_width;
    const unsigned char *level, *ring, *scatters, *albedo, *density, *column, *light;
} welkin_estimate;

/* A checked file. The public members are for reading only. */
typedef struct welkin_file {
    uint32_t wavelengths, altitudes, visibilities, fields, constituents;
    double planet_radius, top_altitude, elevation_min, elevation_max;
    const char *metadata; /* UTF-8, not terminated */
    uint32_t metadata_length;

    /* private */
    const unsigned char *bytes;
    size_t length;
    uint32_t up_intervals, down_intervals, phi_intervals, elevation_intervals;
    uint32_t features, solar_samples, chunk_count;
    double up_exponent, down_exponent, elevation_centre, elevation_width;
    size_t wavelength_at, altitude_at, visibility_at, extinction_at, albedo_at, phase_at, xyz_at;
    size_t solar_range_at, solar_at, field_at, metadata_at, directory_at;
    uint32_t rank, polarisation_rank; /* of the bases, 0 if absent */
    welkin_spectrum spectrum;
    welkin_estimate estimate;
    int unpacked;
} welkin_file;

/* What the visibilities stand for: a quantity that the file's maker chose. */
#define WELKIN_AXIS_NAME 64 /* bytes, at most */
#define WELKIN_AXIS_UNIT 32
typedef struct welkin_axis {
    char name[WELKIN_AXIS_NAME + 1], unit[WELKIN_AXIS_UNIT + 1]; /* UTF-8; empty unit: a number without */

    /* private */
    const welkin_file *file;
    const unsigned char *values;
} welkin_axis;

typedef struct welkin_conditions {
    double altitude;        /* m; from -500 up to 0 it counts as 0 */
    double visibility;      /* m */
    double albedo;          /* 0..=1 */
    double solar_elevation; /* rad, geometric */
    double solar_azimuth;   /* rad, counter-clockwise from +x */
} welkin_conditions;

/* Flags of a prepared sky. */
#define WELKIN_POLARISED 1u /* can answer welkin_stokes */
#define WELKIN_DENSE 2u     /* takes longer to prepare and more memory, answers faster */

/* Sums of products of spline coefficients, private. */
typedef struct welkin_table {
    uint32_t rank, row, channels; /* row: floats per component row; channels: floats per channel row */
    float *alpha, *phi, *channel; /* [up + down][row], [phi][row], [row][channels] */
    float *dense;                 /* [up + down][phi][channels], or null */
} welkin_table;

/* What the estimates of a direction are made of; private. Rows of wavelengths are a multiple of 8 long, those of
 * constituents 8. */
typedef struct welkin_estimate_tables {
    uint32_t row; /* floats per row of wavelengths */
    double level[24], ring[4], sun_start, sun_scale;
    float *extinction, *scattering;  /* [constituent][wavelength], [estimate][constituent][wavelength] */
    float *density, *column, *light; /* [density][8], [level][angle][8], [level][sun][wavelength] */
} welkin_estimate_tables;

/* A sky under fixed conditions; private. May be shared by threads. */
typedef struct welkin_sky {
    const welkin_file *file;
    double altitude, dip, sun[3], cos_azimuth, sin_azimuth, fade;
    float *column, *extinction, *level, *bounce, *phase;
    welkin_table radiance, polarisation;
    welkin_estimate_tables estimate;
    unsigned flags;
} welkin_sky;

/* The profiles of the air at one visibility, for transmittances; private. */
typedef struct welkin_transmittance_profile {
    const welkin_file *file;
    const unsigned char *edges, *densities;
    uint32_t layers;
    uint32_t visibility_node[2];
    double visibility_weight[2];
} welkin_transmittance_profile;

/* The light that the air of a scene scatters; private. May be shared by threads. */
typedef struct welkin_aerial_perspective {
    welkin_transmittance_profile air;
    double sun[3];
    uint32_t altitudes, suns, degree, orders, rank[4];
    const unsigned char *altitude, *sine, *factor[4]; /* axes, and the factors of the four modes */
    uint32_t visibilities, species, phase[16];
    double weight[4];                /* of the visibilities */
    const unsigned char *level[4];   /* [field][suns][wavelengths] */
    float *core[4];                  /* [altitude][sun][moment][channel] */
    float *extinction, *bounce, *parameter, *scattering;
} welkin_aerial_perspective;

/* Linear colour spaces: sRGB and Rec. 2020, white D65; ACEScg, white of ACES, by Bradford's adaptation from D65 (what
 * is white in sRGB is white there); CIE 1931 XYZ as it is. */
typedef enum welkin_colour_space { WELKIN_SRGB, WELKIN_REC2020, WELKIN_ACESCG, WELKIN_XYZ } welkin_colour_space;

/* Of a baked sky: how many intervals, 1..=WELKIN_MAX_INTERVALS, lie above the geometric horizon, below it, and between
 * the azimuth of the sun and the opposite one. {48, 24, 32, 0} is a good start. */
typedef struct welkin_resolution {
    uint32_t up, down, azimuths;
    int spectral; /* 0: the table holds X, Y, Z; otherwise the radiance at every wavelength of the file */
} welkin_resolution;

/* A sky in a table, and its luminance as a distribution of directions; private. May be shared by threads. */
typedef struct welkin_baked {
    const welkin_file *file;
    welkin_resolution resolution;
    uint32_t channels;
    double dip, cos_azimuth, sin_azimuth;
    double sun_height, sun_at, turn_at;   /* of the sun above the horizon; coordinates of it and of half of it */
    double up_end, down_end, azimuth_end; /* coordinates of zenith, nadir and the azimuth opposite to the sun */
    float *root;                          /* square roots, [up + 1 + down + 1][azimuths + 1][channels] */
    float *marginal, *conditional;        /* [up + down + 1], [up + down][azimuths + 1]; cumulative */
} welkin_baked;

/* The name of an error's class. */
WELKIN_API const char *welkin_error_name(welkin_error error);

/* Checks the head of a file, and its spectrum and estimates if it has them: what is wrong with those is the error of
 * questions that need them. The bytes must stay as they are while the file or skies of it are in use. */
WELKIN_API welkin_error welkin_open(welkin_file *file, const void *bytes, size_t length);

/* Decodes a zstd frame of `length` bytes into `out`, and returns how many bytes it wrote; anything but `capacity` is a
 * failure. ZSTD_decompress does what is wanted. */
typedef size_t welkin_decompress(void *user, void *out, size_t capacity, const void *frame, size_t length);

/* Bytes that welkin_unpack needs, 0 if no chunk is compressed (or if there are too many for a size_t). */
WELKIN_API size_t welkin_unpacked_length(const welkin_file *file);

/* Writes the same file without compression to `out`, and opens that in place of the compressed one, which stays open
 * after an error. A chunk that cannot be decoded is an error where it is used. */
WELKIN_API welkin_error welkin_unpack(welkin_file *file, welkin_decompress *decompress, void *user, void *out,
                                      size_t capacity);

WELKIN_API double welkin_wavelength(const welkin_file *file, uint32_t index);
WELKIN_API double welkin_altitude(const welkin_file *file, uint32_t index);
WELKIN_API double welkin_visibility(const welkin_file *file, uint32_t index);

/* Reads and checks what the visibilities stand for, if that is another quantity: WELKIN_ERROR_MISSING in a file without
 * such an axis. Name and unit are text from strangers. The file must outlive the axis. */
WELKIN_API welkin_error welkin_axis_prepare(welkin_axis *axis, const welkin_file *file);

/* The value at a node, 0 beyond the last. They increase strictly, or decrease strictly. */
WELKIN_API double welkin_axis_value(const welkin_axis *axis, uint32_t index);

/* The visibility, m, that stands for a value: what conditions take. WELKIN_ERROR_RANGE beyond the values. */
WELKIN_API welkin_error welkin_axis_visibility(const welkin_axis *axis, double value, double *visibility);

/* First and last wavelength that can be asked, nm: of the spectrum's cells, or in a file without one of the nodes. */
WELKIN_API welkin_error welkin_wavelength_range(const welkin_file *file, double range[2]);

/* How many floats welkin_prepare needs, with the same flags. */
WELKIN_API size_t welkin_scratch_floats(const welkin_file *file, unsigned flags);

/* Reads and checks what the conditions need. The scratch and the file must outlive the sky. WELKIN_ERROR_RANGE also for
 * unknown flags. */
WELKIN_API welkin_error welkin_prepare(welkin_sky *sky, const welkin_file *file, const welkin_conditions *conditions,
                                       unsigned flags, float *scratch, size_t scratch_floats);

/* Radiance per unit of solar irradiance, sr^-1, at every wavelength of the file. The direction need not be
 * normalised. */
WELKIN_API welkin_error welkin_radiance(const welkin_sky *sky, const double direction[3], float *radiance);

/* Stokes components in the vertical frame; the sky must be prepared with WELKIN_POLARISED. */
WELKIN_API welkin_error welkin_stokes(const welkin_sky *sky, const double direction[3], float *radiance, float *q,
                                      float *u);

/* CIE 1931 X, Y, Z in cd m^-2 of a radiance that welkin_radiance gave. */
WELKIN_API void welkin_xyz(const welkin_file *file, const float *radiance, double xyz[3]);

/* `srgb`, `rec2020`, `acescg` or `xyz`; null, or WELKIN_ERROR_RANGE, for what is none of these. */
WELKIN_API const char *welkin_colour_space_name(welkin_colour_space space);
WELKIN_API welkin_error welkin_colour_space_named(const char *name, welkin_colour_space *space);

/* From X, Y, Z to a colour space: red, green and blue, in cd m^-2 for those of welkin_xyz. Colours outside of the gamut
 * have negative components. WELKIN_ERROR_VALUE for what is not finite or does not stay so. */
WELKIN_API welkin_error welkin_rgb(welkin_colour_space space, const double xyz[3], double rgb[3]);

/* A radiance that welkin_radiance or welkin_in_scattering gave, at any wavelength in the range. In a file with a
 * spectrum the nodes are no means over absorption bands, and this is: also at the wavelength of a node. */
WELKIN_API welkin_error welkin_radiance_at(const welkin_file *file, const float *radiance, double wavelength,
                                           double *value);

/* Stokes components that welkin_stokes or welkin_in_scattering_stokes gave, in the same way: L, Q, U. */
WELKIN_API welkin_error welkin_stokes_at(const welkin_file *file, const float *radiance, const float *q, const float *u,
                                         double wavelength, double stokes[3]);

/* Solar irradiance, W m^-2 nm^-1. */
WELKIN_API welkin_error welkin_irradiance_at(const welkin_file *file, double wavelength, double *value);

/* How many floats welkin_bake needs; 0 for a resolution out of range. The macro says the same of constants in their
 * range, for arrays of fixed size: channels are 3, or in spectral tables the wavelengths of the file. */
#define WELKIN_BAKE_FLOATS(up, down, azimuths, channels) \
    (((size_t)(up) + (down) + 2) * ((size_t)(azimuths) + 1) * (channels) + (size_t)(up) + (down) + 1 + \
     ((size_t)(up) + (down)) * ((size_t)(azimuths) + 1))
WELKIN_API size_t welkin_bake_floats(const welkin_file *file, const welkin_resolution *resolution);

/* Fills a table with a prepared sky, of (up + down + 2) (azimuths + 1) directions. The memory must outlive the table;
 * the sky and its scratch need not. Nor need the file and its bytes, unless the table is spectral: colours and samples
 * come from the memory alone. WELKIN_ERROR_SCRATCH for too little memory. */
WELKIN_API welkin_error welkin_bake(welkin_baked *baked, const welkin_sky *sky, const welkin_resolution *resolution,
                                    float *memory, size_t memory_floats);

/* As welkin_xyz and welkin_radiance, from the table; the latter only from one that is spectral, from others it is
 * WELKIN_ERROR_MISSING. */
WELKIN_API welkin_error welkin_baked_xyz(const welkin_baked *baked, const double direction[3], double xyz[3]);
WELKIN_API welkin_error welkin_baked_radiance(const welkin_baked *baked, const double direction[3], float *radiance);

/* Relative errors of a table at so many directions (at least 1) all over the sphere: the one that 99 % of them do not
 * exceed (up to 5 % too large) and the largest. That of a direction is the largest of its channels: of X, Y and Z, or
 * of all wavelengths; what is below 1e-4 of the channel's brightest node counts as that. `sky` is the one that was
 * baked, and still there; WELKIN_ERROR_RANGE for a sky of another file. */
WELKIN_API welkin_error welkin_baked_error(const welkin_baked *baked, const welkin_sky *sky, uint32_t directions,
                                           double *p99, double *largest);

/* A unit vector for two uniform random numbers in 0..=1 (others: WELKIN_ERROR_RANGE), and its density per steradian,
 * about proportional to the luminance of the sky; welkin_sample_pdf gives that of any direction. It is never 0, also
 * where the sky is black: there the library in Rust, whose samples are others, says 0. */
WELKIN_API welkin_error welkin_sample(const welkin_baked *baked, double u1, double u2, double direction[3],
                                      double *pdf);
WELKIN_API welkin_error welkin_sample_pdf(const welkin_baked *baked, const double direction[3], double *pdf);

/* Reads and checks the profiles of the air. */
WELKIN_API welkin_error welkin_transmittance_prepare(welkin_transmittance_profile *air, const welkin_file *file,
                                                     double visibility);

/* Transmittance at every wavelength of the file, from a point at an altitude over a distance in a direction, in m. The
 * segment is straight, and nothing is in its way: below the ground, where the start may be, too, the air is that at the
 * ground. Altitudes above the spherical planet are -1e9..=1e9, distances 0..=4e9, and the components of the end, from
 * the ground below or above the start, -1e9..=1e9; others are WELKIN_ERROR_POINT. */
WELKIN_API welkin_error welkin_transmittance(const welkin_transmittance_profile *air, double altitude,
                                             const double direction[3], double distance, float *transmittance);

/* The same at `count` wavelengths in the range, from the spectrum: without one the error is WELKIN_ERROR_MISSING. In
 * absorption bands they are means, and the product of those of two parts is not that of the whole. */
WELKIN_API welkin_error welkin_transmittance_at(const welkin_transmittance_profile *air, double altitude,
                                                const double direction[3], double distance, const double *wavelengths,
                                                size_t count, float *transmittance);

/* How many floats welkin_aerial_perspective_prepare needs. */
WELKIN_API size_t welkin_aerial_perspective_floats(const welkin_file *file);

/* Reads and checks what scatters light. The altitude of the conditions does not matter. The scratch and the file must
 * outlive the aerial perspective. */
WELKIN_API welkin_error welkin_aerial_perspective_prepare(welkin_aerial_perspective *aerial, const welkin_file *file,
                                                          const welkin_conditions *conditions, float *scratch,
                                                          size_t scratch_floats);

/* Light that the air of a segment scatters towards its start, per unit of solar irradiance, sr^-1, at every wavelength
 * of the file. Segments are those of welkin_transmittance; what lies below the ground is lit as at the ground. An
 * integral over some hundred points: for checks and for tables, not for each pixel. */
WELKIN_API welkin_error welkin_in_scattering(const welkin_aerial_perspective *aerial, double altitude,
                                             const double direction[3], double distance, float *light);

/* The same light with its Stokes components Q and U in the vertical frame at the start. */
WELKIN_API welkin_error welkin_in_scattering_stokes(const welkin_aerial_perspective *aerial, double altitude,
                                                    const double direction[3], double distance, float *light, float *q,
                                                    float *u);

#ifdef __cplusplus
}
#endif

#endif /* WELKIN_H */

#if defined(WELKIN_IMPLEMENTATION) && !defined(WELKIN__IMPLEMENTED)
#define WELKIN__IMPLEMENTED

#if defined(__FAST_MATH__) || defined(_M_FP_FAST) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "welkin.h checks numbers of files, which -ffast-math and -ffinite-math-only remove"
#endif

#include <float.h>
#include <math.h>
#include <string.h>

#define WELKIN__HEADER 128u
#define WELKIN__ENTRY 64u
#define WELKIN__NONE 65535u
#define WELKIN__HALF_PI 1.57079632679489661923
#define WELKIN__PI (2 * WELKIN__HALF_PI)
#define WELKIN__SUN_RADIUS 0.004654793
#define WELKIN__HAS_SPECTRUM 1u  /* bits of required_features */
#define WELKIN__HAS_ESTIMATES 2u
#define WELKIN__ABSORBERS_SHIFT 16 /* from this bit on: which constituents absorb and do not scatter */
#define WELKIN__CELL_TERMS 64u /* at most */

/* Of files with estimates, at most; but there are always 8 columns of constituents. */
#define WELKIN__ESTIMATE_LEVELS 24u
#define WELKIN__ESTIMATE_RINGS 4u
#define WELKIN__ESTIMATES 4u
#define WELKIN__ESTIMATE_CONSTITUENTS 8u
#define WELKIN__ESTIMATE_WAVELENGTHS 64u

enum {
    WELKIN__RADIANCE = 1,
    WELKIN__COLUMN = 2,
    WELKIN__BASIS = 3,
    WELKIN__TRANSMITTANCE = 4,
    WELKIN__SOURCE = 5,
    WELKIN__POLARISATION = 6,
    WELKIN__POLARISATION_BASIS = 7,
    WELKIN__SOURCE_BASIS = 8,
    WELKIN__SPECTRUM = 9,
    WELKIN__ESTIMATE = 10,
    WELKIN__AXIS = 11,
    WELKIN__KINDS = 12
};

/* ---- bytes ---- */

static uint32_t welkin__u16(const unsigned char *p) { return (uint32_t)p[0] | (uint32_t)p[1] << 8; }

static uint32_t welkin__u32(const unsigned char *p) { return welkin__u16(p) | welkin__u16(p + 2) << 16; }

static uint64_t welkin__u64(const unsigned char *p) { return (uint64_t)welkin__u32(p) | (uint64_t)welkin__u32(p + 4) << 32; }

static float welkin__float(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float welkin__f32(const unsigned char *p) { return welkin__float(welkin__u32(p)); }

static double welkin__f64(const unsigned char *p)
{
    uint64_t bits = welkin__u64(p);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static float welkin__f16(const unsigned char *p)
{
    uint32_t bits = welkin__u16(p);
    uint32_t sign = (bits & 0x8000u) << 16, exponent = bits >> 10 & 31u, fraction = bits & 1023u;
    if (exponent == 0) {
        float value = (float)fraction * (1.0f / 16777216.0f);
        return sign ? -value : value;
    }
    exponent = exponent == 31u ? 255u : exponent + 112u;
    return welkin__float(sign | exponent << 23 | fraction << 13);
}

static uint32_t welkin__crc_byte(uint32_t crc, uint32_t byte)
{
    static const uint32_t nibble[16] = {0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu, 0x76DC4190u, 0x6B6B51F4u,
                                        0x4DB26158u, 0x5005713Cu, 0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu,
                                        0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu};
    crc ^= byte;
    crc = crc >> 4 ^ nibble[crc & 15u];
    return crc >> 4 ^ nibble[crc & 15u];
}

static uint32_t welkin__crc(uint32_t crc, const unsigned char *p, size_t n)
{
    size_t i;
    for (i = 0; i < n; i++) crc = welkin__crc_byte(crc, p[i]);
    return crc;
}

static uint32_t welkin__head_crc(const unsigned char *p, size_t head)
{
    static const unsigned char zeros[4] = {0, 0, 0, 0};
    uint32_t crc = welkin__crc(0xFFFFFFFFu, p, 32);
    crc = welkin__crc(crc, zeros, 4);
    return ~welkin__crc(crc, p + 36, head - 36);
}

static uint32_t welkin__ceil16(uint32_t n) { return (n + 15u) & ~15u; }

/* Narrowing a double that a float cannot hold would be undefined. */
static float welkin__narrow(double value)
{
    if (value > (double)FLT_MAX) return FLT_MAX;
    if (value < -(double)FLT_MAX) return -FLT_MAX;
    return (float)value;
}

static int welkin__within(double value, double low, double high) { return value >= low && value <= high; }

/* ---- head ---- */

static welkin_error welkin__check_start(const unsigned char *p, size_t length)
{
    static const unsigned char magic[8] = {0x89, 0x57, 0x4C, 0x4B, 0x0D, 0x0A, 0x1A, 0x0A};
    uint32_t constituents, known;
    if (length < sizeof magic || memcmp(p, magic, sizeof magic) != 0) return WELKIN_ERROR_MAGIC;
    if (length < WELKIN__HEADER) return WELKIN_ERROR_LENGTH;
    if (welkin__u16(p + 8) != 1) return WELKIN_ERROR_VERSION;
    constituents = welkin__u16(p + 48) < 16 ? (1u << welkin__u16(p + 48)) - 1 : 0xFFFFu;
    known = WELKIN__HAS_SPECTRUM | WELKIN__HAS_ESTIMATES | constituents << WELKIN__ABSORBERS_SHIFT;
    if ((welkin__u32(p + 12) & ~known) != 0) return WELKIN_ERROR_FEATURE;
    if (welkin__u64(p + 16) != length) return WELKIN_ERROR_LENGTH;
    return WELKIN_OK;
}

static int welkin__has_estimates(const welkin_file *f) { return (f->features & WELKIN__HAS_ESTIMATES) != 0; }

static void welkin__read_header(welkin_file *file)
{
    const unsigned char *p = file->bytes;
    file->features = welkin__u32(p + 12);
    file->chunk_count = welkin__u32(p + 36);
    file->wavelengths = welkin__u16(p + 40);
    file->altitudes = welkin__u16(p + 42);
    file->visibilities = welkin__u16(p + 44);
    file->fields = welkin__u16(p + 46);
    file->constituents = welkin__u16(p + 48);
    file->up_intervals = welkin__u16(p + 50);
    file->down_intervals = welkin__u16(p + 52);
    file->phi_intervals = welkin__u16(p + 54);
    file->elevation_intervals = welkin__u16(p + 56);
    file->solar_samples = welkin__u16(p + 58);
    file->metadata_length = welkin__u32(p + 60);
    file->planet_radius = welkin__f64(p + 64);
    file->top_altitude = welkin__f64(p + 72);
    file->up_exponent = welkin__f64(p + 80);
    file->down_exponent = welkin__f64(p + 88);
    file->elevation_min = welkin__f64(p + 96);
    file->elevation_max = welkin__f64(p + 104);
    file->elevation_centre = welkin__f64(p + 112);
    file->elevation_width = welkin__f64(p + 120);
}

static int welkin__counts_are_good(const welkin_file *f)
{
    uint64_t sky;
    if (f->wavelengths < 2 || f->wavelengths > WELKIN_MAX_WAVELENGTHS) return 0;
    if (f->altitudes < 1 || f->altitudes > 1024 || f->visibilities < 1 || f->visibilities > 1024) return 0;
    if (f->fields < 1 || f->fields > WELKIN_MAX_FIELDS) return 0;
    if (f->constituents < 1 || f->constituents > WELKIN_MAX_CONSTITUENTS) return 0;
    if (f->features >> WELKIN__ABSORBERS_SHIFT == (1u << f->constituents) - 1) return 0; /* none scatters */
    if (f->up_intervals < 1 || f->up_intervals > 1024 || f->down_intervals < 1 || f->down_intervals > 1024) return 0;
    if (f->phi_intervals < 1 || f->phi_intervals > 1024) return 0;
    if (f->elevation_intervals < 1 || f->elevation_intervals > 1024) return 0;
    if (f->solar_samples < 2 || f->solar_samples > 16384) return 0;
    if (welkin__has_estimates(f) &&
        (f->constituents > WELKIN__ESTIMATE_CONSTITUENTS || f->wavelengths > WELKIN__ESTIMATE_WAVELENGTHS))
        return 0;
    sky = (uint64_t)(f->up_intervals + f->down_intervals + 6) * (f->phi_intervals + 1) * f->fields * f->wavelengths;
    return sky <= 1u << 24;
}

static int welkin__header_numbers_are_good(const welkin_file *f)
{
    double last = welkin__f64(f->bytes + f->altitude_at + 8 * (size_t)(f->altitudes - 1));
    return welkin__within(f->planet_radius, 1e3, 1e9) && f->top_altitude > last && f->top_altitude <= 1e9 &&
           welkin__within(f->up_exponent, 1, 8) && welkin__within(f->down_exponent, 1, 8) && f->elevation_min >= -WELKIN__HALF_PI &&
           f->elevation_max > f->elevation_min && f->elevation_max <= WELKIN__HALF_PI &&
           welkin__within(f->elevation_centre, -WELKIN__HALF_PI, WELKIN__HALF_PI) && welkin__within(f->elevation_width, 1e-6, 1e6);
}

static size_t welkin__take(uint64_t *offset, uint64_t bytes)
{
    size_t at = (size_t)*offset;
    *offset += bytes;
    return at;
}

/* Sets where the head arrays are, and returns the length of the head. Counts are 16 and 32 bits wide: nothing
 * overflows. */
static uint64_t welkin__place_arrays(welkin_file *f)
{
    uint64_t offset = WELKIN__HEADER, nw = f->wavelengths, nv = f->visibilities;
    f->wavelength_at = welkin__take(&offset, 8 * nw);
    f->altitude_at = welkin__take(&offset, 8 * (uint64_t)f->altitudes);
    f->visibility_at = welkin__take(&offset, 8 * nv);
    f->extinction_at = welkin__take(&offset, 8 * nv * f->constituents * nw);
    f->albedo_at = welkin__take(&offset, 8 * nv * nw);
    f->phase_at = welkin__take(&offset, 8 * nw * f->fields);
    f->xyz_at = welkin__take(&offset, 24 * nw);
    f->solar_range_at = welkin__take(&offset, 16);
    f->solar_at = welkin__take(&offset, 4 * (uint64_t)f->solar_samples);
    f->field_at = welkin__take(&offset, 4 * (uint64_t)f->fields);
    f->metadata_at = welkin__take(&offset, f->metadata_length);
    offset = (offset + 7) & ~(uint64_t)7;
    f->directory_at = welkin__take(&offset, (uint64_t)WELKIN__ENTRY * f->chunk_count);
    return offset;
}

static int welkin__f64s_are_within(const unsigned char *p, size_t n, double low, double high)
{
    size_t i;
    for (i = 0; i < n; i++)
        if (!welkin__within(welkin__f64(p + 8 * i), low, high)) return 0;
    return 1;
}

static int welkin__increases(const unsigned char *p, size_t n)
{
    size_t i;
    for (i = 1; i < n; i++)
        if (!(welkin__f64(p + 8 * i) > welkin__f64(p + 8 * (i - 1)))) return 0;
    return 1;
}

static int welkin__axis_is_good(const unsigned char *p, size_t n, double low, double high)
{
    return welkin__f64s_are_within(p, n, low, high) && welkin__increases(p, n);
}

/* Interpolation divides by differences of these. */
static int welkin__transforms_are_distinct(const welkin_file *f)
{
    size_t i;
    const unsigned char *h = f->bytes + f->altitude_at, *v = f->bytes + f->visibility_at;
    for (i = 1; i < f->altitudes; i++)
        if (!(cbrt(welkin__f64(h + 8 * i)) > cbrt(welkin__f64(h + 8 * (i - 1))))) return 0;
    for (i = 1; i < f->visibilities; i++)
        if (!(1.0 / welkin__f64(v + 8 * i) < 1.0 / welkin__f64(v + 8 * (i - 1)))) return 0;
    return 1;
}

static int welkin__axes_are_good(const welkin_file *f)
{
    const unsigned char *p = f->bytes;
    return welkin__axis_is_good(p + f->wavelength_at, f->wavelengths, 1, 1e6) &&
           welkin__axis_is_good(p + f->altitude_at, f->altitudes, 0, 1e9) &&
           welkin__axis_is_good(p + f->visibility_at, f->visibilities, 1, 1e9) && welkin__transforms_are_distinct(f);
}

static int welkin__f32s_are_within(const unsigned char *p, size_t n, double low, double high)
{
    size_t i;
    for (i = 0; i < n; i++)
        if (!welkin__within((double)welkin__f32(p + 4 * i), low, high)) return 0;
    return 1;
}

/* Whether the samples of solar irradiance span an axis of wavelengths. */
static int welkin__solar_spans(const welkin_file *f, const unsigned char *axis, uint32_t n)
{
    const unsigned char *p = f->bytes + f->solar_range_at;
    double start = welkin__f64(p), step = welkin__f64(p + 8);
    return start <= welkin__f64(axis) && start + (f->solar_samples - 1) * step >= welkin__f64(axis + 8 * (size_t)(n - 1));
}

static int welkin__solar_is_good(const welkin_file *f)
{
    const unsigned char *p = f->bytes + f->solar_range_at;
    if (!(welkin__f64(p) >= 0) || !welkin__within(welkin__f64(p + 8), 1e-3, 1e6)) return 0;
    return welkin__solar_spans(f, f->bytes + f->wavelength_at, f->wavelengths) &&
           welkin__f32s_are_within(f->bytes + f->solar_at, f->solar_samples, 0, (double)FLT_MAX);
}

static int welkin__parameter_is_good(uint32_t phase, double parameter)
{
    if (phase == 1) return welkin__within(parameter, 0, 1);
    if (phase == 2) return parameter > -1 && parameter < 1;
    return welkin__within(parameter, -DBL_MAX, DBL_MAX);
}

static uint32_t welkin__field(const welkin_file *f, uint32_t index) { return welkin__u32(f->bytes + f->field_at + 4 * (size_t)index); }

static double welkin__parameter(const welkin_file *f, uint32_t field, uint32_t wavelength)
{
    return welkin__f64(f->bytes + f->phase_at + 8 * ((size_t)field * f->wavelengths + wavelength));
}

/* Which estimate a field is relative to is looked at with the estimates. */
static int welkin__fields_are_good(const welkin_file *f)
{
    uint32_t i, w;
    for (i = 0; i < f->fields; i++) {
        uint32_t field = welkin__field(f, i), phase = field & 0xFFFFu;
        if (phase > 2 || (field >> 17 & 0x7Fu) != 0) return 0;
        if (field >> 24 >= (welkin__has_estimates(f) ? WELKIN__ESTIMATES : 1u)) return 0;
        for (w = 0; w < f->wavelengths; w++)
            if (!welkin__parameter_is_good(phase, welkin__parameter(f, i, w))) return 0;
    }
    return 1;
}

static int welkin__tables_are_good(const welkin_file *f)
{
    const unsigned char *p = f->bytes;
    size_t nw = f->wavelengths, nv = f->visibilities, i;
    if (!welkin__f64s_are_within(p + f->extinction_at, nv * f->constituents * nw, 0, 1e6)) return 0;
    for (i = 0; i < nv * nw; i++) {
        double albedo = welkin__f64(p + f->albedo_at + 8 * i);
        if (!(albedo >= 0 && albedo < 1)) return 0;
    }
    return welkin__f64s_are_within(p + f->xyz_at, 3 * nw, -1e30, 1e30) && welkin__solar_is_good(f) && welkin__fields_are_good(f);
}

/* The bytes of the UTF-8 sequence at p, 0 if it is ill-formed. */
static size_t welkin__utf8_sequence(const unsigned char *p, size_t left)
{
    size_t n, i;
    unsigned char low = 0x80, high = 0xBF;
    if (p[0] < 0x80) return 1;
    if (p[0] < 0xC2 || p[0] > 0xF4) return 0;
    n = p[0] < 0xE0 ? 2 : p[0] < 0xF0 ? 3 : 4;
    if (n > left) return 0;
    if (p[0] == 0xE0) low = 0xA0;
    if (p[0] == 0xED) high = 0x9F;
    if (p[0] == 0xF0) low = 0x90;
    if (p[0] == 0xF4) high = 0x8F;
    if (p[1] < low || p[1] > high) return 0;
    for (i = 2; i < n; i++)
        if (p[i] < 0x80 || p[i] > 0xBF) return 0;
    return n;
}

static int welkin__metadata_is_good(const welkin_file *f)
{
    const unsigned char *p = f->bytes + f->metadata_at;
    size_t i = 0, n = f->metadata_length, end = f->directory_at - f->metadata_at;
    while (i < n) {
        size_t step = welkin__utf8_sequence(p + i, n - i);
        if (step == 0) return 0;
        i += step;
    }
    for (i = n; i < end; i++)
        if (p[i] != 0) return 0;
    return 1;
}

/* ---- directory ---- */

typedef struct welkin__entry {
    uint32_t kind, altitude, visibility, encoding, crc, rank, tier;
    uint64_t offset, stored, raw;
    float error_median, error_p99;
} welkin__entry;

static welkin__entry welkin__read_entry(const welkin_file *f, uint32_t index)
{
    const unsigned char *p = f->bytes + f->directory_at + (size_t)WELKIN__ENTRY * index;
    welkin__entry e;
    e.kind = welkin__u32(p);
    e.altitude = welkin__u16(p + 4);
    e.visibility = welkin__u16(p + 6);
    e.offset = welkin__u64(p + 8);
    e.stored = welkin__u64(p + 16);
    e.raw = welkin__u64(p + 24);
    e.encoding = welkin__u32(p + 32);
    e.crc = welkin__u32(p + 36);
    e.rank = welkin__u32(p + 40);
    e.tier = welkin__u32(p + 44);
    e.error_median = welkin__f32(p + 48);
    e.error_p99 = welkin__f32(p + 52);
    return e;
}

static int welkin__is_known(uint32_t kind) { return kind >= 1 && kind < WELKIN__KINDS; }

static int welkin__has_altitude(uint32_t kind)
{
    return kind == WELKIN__RADIANCE || kind == WELKIN__COLUMN || kind == WELKIN__POLARISATION;
}

static int welkin__has_visibility(uint32_t kind)
{
    return kind == WELKIN__RADIANCE || kind == WELKIN__SOURCE || kind == WELKIN__POLARISATION;
}

static int welkin__has_rank(uint32_t kind)
{
    return kind == WELKIN__RADIANCE || kind == WELKIN__BASIS || kind == WELKIN__POLARISATION || kind == WELKIN__POLARISATION_BASIS;
}

static uint32_t welkin__alpha_rows(const welkin_file *f) { return f->up_intervals + 3 + f->down_intervals + 3; }

/* Bytes of a payload, 0 where only the payload tells. */
static uint64_t welkin__payload_length(const welkin_file *f, uint32_t kind, uint32_t rank)
{
    uint64_t q = welkin__ceil16(rank), elevations = f->elevation_intervals + 3;
    uint64_t factors = 4 * q + 2 * q * (welkin__alpha_rows(f) + elevations), phi = 2 * q * (f->phi_intervals + 1);
    switch (kind) {
    case WELKIN__RADIANCE: return factors + (welkin__has_estimates(f) ? 0 : 2 * elevations * f->wavelengths);
    case WELKIN__COLUMN: return 4 * (uint64_t)welkin__alpha_rows(f) * f->constituents;
    case WELKIN__BASIS: return phi + 2 * q * welkin__ceil16(f->fields * f->wavelengths);
    case WELKIN__POLARISATION: return factors;
    case WELKIN__POLARISATION_BASIS: return phi + 2 * q * welkin__ceil16(4 * f->wavelengths);
    default: return 0;
    }
}

static int welkin__rank_is_good(const welkin_file *f, const welkin__entry *e)
{
    if (!welkin__has_rank(e->kind)) return e->rank == 0;
    if (e->rank < 1 || e->rank > WELKIN_MAX_RANK) return 0;
    if (e->kind == WELKIN__RADIANCE && f->rank != 0) return e->rank <= f->rank;
    if (e->kind == WELKIN__POLARISATION && f->polarisation_rank != 0) return e->rank <= f->polarisation_rank;
    return 1;
}

static int welkin__lengths_are_good(const welkin_file *f, const welkin__entry *e)
{
    uint64_t expected = welkin__payload_length(f, e->kind, e->rank);
    if (expected != 0 && e->raw != expected) return 0;
    if (e->encoding == 0 && e->raw != e->stored) return 0;
    return e->raw / 256 + (e->raw % 256 != 0) <= e->stored;
}

static int welkin__known_entry_is_good(const welkin_file *f, const welkin__entry *e)
{
    if (welkin__has_altitude(e->kind) ? e->altitude >= f->altitudes : e->altitude != WELKIN__NONE) return 0;
    if (welkin__has_visibility(e->kind) ? e->visibility >= f->visibilities : e->visibility != WELKIN__NONE) return 0;
    if (!welkin__rank_is_good(f, e) || !welkin__lengths_are_good(f, e) || e->tier != 0) return 0;
    return welkin__within((double)e->error_median, 0, (double)FLT_MAX) && welkin__within((double)e->error_p99, 0, (double)FLT_MAX);
}

/* Whether the chunk starts where it has to, and ends within the file; moves `end` behind it. */
static int welkin__place_is_good(const welkin__entry *e, uint64_t length, uint64_t *end)
{
    uint64_t start = (*end + 63) & ~(uint64_t)63;
    if (e->offset != start || start > length || e->stored > length - start) return 0;
    *end = start + e->stored;
    return 1;
}

static int welkin__entries_are_good(const welkin_file *f)
{
    uint64_t end = f->directory_at + (uint64_t)WELKIN__ENTRY * f->chunk_count;
    uint32_t i;
    for (i = 0; i < f->chunk_count; i++) {
        welkin__entry e = welkin__read_entry(f, i);
        if (!welkin__place_is_good(&e, f->length, &end)) return 0;
        if (welkin__is_known(e.kind) && !welkin__known_entry_is_good(f, &e)) return 0;
    }
    return end == f->length;
}

static void welkin__find_ranks(welkin_file *f)
{
    uint32_t i;
    for (i = 0; i < f->chunk_count; i++) {
        welkin__entry e = welkin__read_entry(f, i);
        if (e.kind == WELKIN__BASIS) f->rank = e.rank;
        if (e.kind == WELKIN__POLARISATION_BASIS) f->polarisation_rank = e.rank;
    }
}

/* A number for each possible (kind, altitude, visibility) of known kinds; entries must be good. */
static uint32_t welkin__key(const welkin_file *f, const welkin__entry *e)
{
    uint32_t cell = (welkin__has_altitude(e->kind) ? e->altitude : 0) * f->visibilities + (welkin__has_visibility(e->kind) ? e->visibility : 0);
    return cell * WELKIN__KINDS + e->kind;
}

/* Without memory for all keys: looks for duplicates among so many keys at a time as a small bitmap holds. */
static int welkin__has_duplicates(const welkin_file *f)
{
    enum { KEYS = 65536 };
    unsigned char seen[KEYS / 8];
    uint32_t keys = f->altitudes * f->visibilities * WELKIN__KINDS, first, i;
    for (first = 0; first < keys; first += KEYS) {
        memset(seen, 0, sizeof seen);
        for (i = 0; i < f->chunk_count; i++) {
            welkin__entry e = welkin__read_entry(f, i);
            uint32_t key = welkin__is_known(e.kind) ? welkin__key(f, &e) - first : (uint32_t)KEYS;
            if (key >= KEYS) continue;
            if (seen[key / 8] >> key % 8 & 1) return 1;
            seen[key / 8] = (unsigned char)(seen[key / 8] | 1u << key % 8);
        }
    }
    return 0;
}

WELKIN_API const char *welkin_error_name(welkin_error error)
{
    switch (error) {
    case WELKIN_OK: return "none";
    case WELKIN_ERROR_MAGIC: return "magic";
    case WELKIN_ERROR_VERSION: return "version";
    case WELKIN_ERROR_FEATURE: return "feature";
    case WELKIN_ERROR_LENGTH: return "length";
    case WELKIN_ERROR_CHECKSUM: return "checksum";
    case WELKIN_ERROR_VALUE: return "value";
    case WELKIN_ERROR_ENCODING: return "encoding";
    case WELKIN_ERROR_RANGE: return "range";
    case WELKIN_ERROR_MISSING: return "missing";
    case WELKIN_ERROR_DIRECTION: return "direction";
    case WELKIN_ERROR_POINT: return "point";
    case WELKIN_ERROR_SCRATCH: return "scratch";
    case WELKIN_ERROR_STATE: return "state";
    }
    return "unknown";
}

/* ---- chunks ---- */

static welkin_error welkin__find(const welkin_file *f, uint32_t kind, uint32_t altitude, uint32_t visibility,
                                 welkin__entry *found)
{
    uint32_t i;
    for (i = 0; i < f->chunk_count; i++) {
        *found = welkin__read_entry(f, i);
        if (found->kind == kind && found->altitude == altitude && found->visibility == visibility) return WELKIN_OK;
    }
    return WELKIN_ERROR_MISSING;
}

static int welkin__f32s_are_finite(const unsigned char *p, size_t n)
{
    size_t i;
    for (i = 0; i < n; i++)
        if ((welkin__u32(p + 4 * i) & 0x7F800000u) == 0x7F800000u) return 0;
    return 1;
}

static int welkin__f16s_are_finite(const unsigned char *p, size_t n)
{
    size_t i;
    for (i = 0; i < n; i++)
        if ((welkin__u16(p + 2 * i) & 0x7C00u) == 0x7C00u) return 0;
    return 1;
}

static int welkin__payload_is_finite(const welkin__entry *e, const unsigned char *p)
{
    size_t length = (size_t)e->raw, f32s = 0;
    if (e->kind == WELKIN__COLUMN) f32s = length / 4;
    if (e->kind == WELKIN__RADIANCE || e->kind == WELKIN__POLARISATION) f32s = welkin__ceil16(e->rank);
    return welkin__f32s_are_finite(p, f32s) && welkin__f16s_are_finite(p + 4 * f32s, (length - 4 * f32s) / 2);
}

/* The checked bytes of a chunk. Looks at the entry again, since the bytes may be of a mapped file that changed. */
static welkin_error welkin__payload(const welkin_file *f, const welkin__entry *e, const unsigned char **payload)
{
    const unsigned char *p;
    uint64_t expected = welkin__payload_length(f, e->kind, e->rank);
    if (!welkin__rank_is_good(f, e) || e->offset > f->length || e->stored > f->length - e->offset) return WELKIN_ERROR_VALUE;
    p = f->bytes + (size_t)e->offset;
    if (~welkin__crc(0xFFFFFFFFu, p, (size_t)e->stored) != e->crc) return WELKIN_ERROR_CHECKSUM;
    if (e->encoding == 1 && f->unpacked) return WELKIN_ERROR_VALUE; /* did not decode */
    if (e->encoding != 0) return WELKIN_ERROR_ENCODING;
    if (e->raw != e->stored || (expected != 0 && e->raw != expected)) return WELKIN_ERROR_VALUE;
    if (expected != 0 && !welkin__payload_is_finite(e, p)) return WELKIN_ERROR_VALUE;
    *payload = p;
    return WELKIN_OK;
}

/* ---- spectrum ---- */

/* Bytes of a payload with these counts. */
static uint64_t welkin__spectrum_length(const welkin_file *f, const welkin_spectrum *s, uint32_t examples)
{
    uint64_t cells = s->cells, nk = f->constituents, term = 4 * (1 + nk) + 8 * (uint64_t)s->taps;
    return 16 + 8 * cells + 4 * (cells + 1) + s->terms * term + 4 * cells * nk * f->visibilities + 4 * (uint64_t)examples * f->wavelengths;
}

/* The terms of a cell: the first, and how many; none where a mapped file changed. */
static uint32_t welkin__cell_terms(const welkin_spectrum *s, uint32_t cell, uint32_t *first)
{
    uint32_t end = welkin__u32(s->first_term + 4 * ((size_t)cell + 1));
    *first = welkin__u32(s->first_term + 4 * (size_t)cell);
    return end <= s->terms && *first < end && end - *first <= WELKIN__CELL_TERMS ? end - *first : 0;
}

static int welkin__terms_are_good(const welkin_file *f, const welkin_spectrum *s)
{
    uint32_t c, g, first, count, end = 0;
    for (c = 0; c < s->cells; c++) {
        double sum = 0;
        count = welkin__cell_terms(s, c, &first);
        if (count == 0 || first != end) return 0;
        end = first + count;
        for (g = first; g < end; g++) sum += (double)welkin__f32(s->term_weight + 4 * (size_t)g);
        if (!welkin__within(sum - 1, -1e-5, 1e-5)) return 0;
    }
    return end == s->terms && welkin__f32s_are_within(s->term_weight, s->terms, 0, 1) &&
           welkin__f32s_are_within(s->term_extinction, (size_t)s->terms * f->constituents, 0, 1e6);
}

static int welkin__taps_are_good(const welkin_file *f, const welkin_spectrum *s)
{
    size_t taps = (size_t)s->terms * s->taps, i;
    for (i = 0; i < taps; i++)
        if (welkin__u32(s->tap_node + 4 * i) >= f->wavelengths) return 0;
    return welkin__f32s_are_within(s->tap_weight, taps, -1e3, 1e3);
}

/* Sets where the tables are, and checks them; the counts are in their ranges and the length is right. */
static welkin_error welkin__place_spectrum(const welkin_file *f, const unsigned char *p, uint32_t examples,
                                           welkin_spectrum *s)
{
    size_t cells = s->cells, terms = s->terms, air = cells * f->visibilities * f->constituents;
    const unsigned char *example;
    s->wavelength = p + 16;
    s->first_term = s->wavelength + 8 * cells;
    s->term_weight = s->first_term + 4 * (cells + 1);
    s->term_extinction = s->term_weight + 4 * terms;
    s->tap_node = s->term_extinction + 4 * terms * f->constituents;
    s->tap_weight = s->tap_node + 4 * terms * s->taps;
    s->extinction = s->tap_weight + 4 * terms * s->taps;
    example = s->extinction + 4 * air;
    if (!welkin__axis_is_good(s->wavelength, cells, 1, 1e6) || !welkin__solar_spans(f, s->wavelength, s->cells)) return WELKIN_ERROR_VALUE;
    if (!welkin__terms_are_good(f, s) || !welkin__taps_are_good(f, s) || !welkin__f32s_are_within(s->extinction, air, 0, 1e6))
        return WELKIN_ERROR_VALUE;
    return welkin__f32s_are_within(example, (size_t)examples * f->wavelengths, -100, 100) ? WELKIN_OK : WELKIN_ERROR_VALUE;
}

static welkin_error welkin__read_spectrum(const welkin_file *f, welkin_spectrum *s)
{
    welkin__entry entry;
    const unsigned char *p;
    uint32_t examples;
    welkin_error error = welkin__find(f, WELKIN__SPECTRUM, WELKIN__NONE, WELKIN__NONE, &entry);
    if (!error) error = welkin__payload(f, &entry, &p);
    if (error) return error;
    if (entry.raw < 16) return WELKIN_ERROR_VALUE;
    s->cells = welkin__u32(p);
    s->taps = welkin__u32(p + 4);
    s->terms = welkin__u32(p + 8);
    examples = welkin__u32(p + 12);
    if (s->cells < 2 || s->cells > 4096 || s->taps < 1 || s->taps > 16) return WELKIN_ERROR_VALUE;
    if (s->terms < s->cells || s->terms > 65536 || examples > 1024) return WELKIN_ERROR_VALUE;
    if (entry.raw != welkin__spectrum_length(f, s, examples)) return WELKIN_ERROR_VALUE;
    return welkin__place_spectrum(f, p, examples, s);
}

/* ---- axis ---- */

static int welkin__is_text(const unsigned char *p, size_t n)
{
    size_t i = 0, step;
    for (; i < n; i += step) {
        step = welkin__utf8_sequence(p + i, n - i);
        if (step == 0) return 0;
    }
    return 1;
}

/* All values increase, or all decrease. */
static int welkin__is_monotonic(const unsigned char *p, uint32_t n)
{
    uint32_t i, up = 0, down = 0;
    for (i = 0; i + 1 < n; i++) {
        double a = welkin__f64(p + 8 * (size_t)i), b = welkin__f64(p + 8 * (size_t)i + 8);
        up += a < b;
        down += a > b;
    }
    return up + 1 == n || down + 1 == n;
}

static welkin_error welkin__read_axis(const welkin_file *f, welkin_axis *axis)
{
    welkin__entry entry;
    const unsigned char *p, *text;
    uint32_t nodes = f->visibilities, name, unit;
    welkin_error error = welkin__find(f, WELKIN__AXIS, WELKIN__NONE, WELKIN__NONE, &entry);
    if (!error) error = welkin__payload(f, &entry, &p);
    if (error) return error;
    if (entry.raw < 16 || welkin__u32(p) != nodes) return WELKIN_ERROR_VALUE;
    name = welkin__u32(p + 4);
    unit = welkin__u32(p + 8);
    if (name < 1 || name > WELKIN_AXIS_NAME || unit > WELKIN_AXIS_UNIT) return WELKIN_ERROR_VALUE;
    if (entry.raw != 16 + 8 * (uint64_t)nodes + name + unit) return WELKIN_ERROR_VALUE;
    text = p + 16 + 8 * (size_t)nodes;
    if (!welkin__f64s_are_within(p + 16, nodes, -1e30, 1e30) || !welkin__is_monotonic(p + 16, nodes)) return WELKIN_ERROR_VALUE;
    if (!welkin__is_text(text, name) || !welkin__is_text(text + name, unit)) return WELKIN_ERROR_VALUE;
    memcpy(axis->name, text, name);
    memcpy(axis->unit, text + name, unit);
    axis->values = p + 16;
    axis->file = f;
    return WELKIN_OK;
}

WELKIN_API welkin_error welkin_axis_prepare(welkin_axis *axis, const welkin_file *file)
{
    welkin_error error;
    memset(axis, 0, sizeof *axis);
    error = file->bytes ? welkin__read_axis(file, axis) : WELKIN_ERROR_STATE;
    if (error) memset(axis, 0, sizeof *axis);
    return error;
}

WELKIN_API double welkin_axis_value(const welkin_axis *axis, uint32_t index)
{
    if (!axis->file || index >= axis->file->visibilities) return 0;
    return welkin__f64(axis->values + 8 * (size_t)index);
}

/* Between two nodes, t of the way. */
static double welkin__axis_between(const welkin_axis *axis, uint32_t i, double t)
{
    double v = welkin_visibility(axis->file, i), w = welkin_visibility(axis->file, i + 1), between;
    if (t <= 0) return v;
    if (t >= 1) return w;
    between = 1 / ((1 - t) / v + t / w);
    return between < v ? v : between > w ? w : between; /* rounding */
}

WELKIN_API welkin_error welkin_axis_visibility(const welkin_axis *axis, double value, double *visibility)
{
    uint32_t last, i;
    double first, end, low, high, slack;
    if (!axis->file) return WELKIN_ERROR_STATE;
    last = axis->file->visibilities - 1;
    first = welkin_axis_value(axis, 0);
    end = welkin_axis_value(axis, last);
    low = first < end ? first : end;
    high = first < end ? end : first;
    slack = 1e-9 * (fabs(low) > fabs(high) ? fabs(low) : fabs(high));
    if (!welkin__within(value, low - slack, high + slack)) return WELKIN_ERROR_RANGE;
    value = value < low ? low : value > high ? high : value;
    *visibility = welkin_visibility(axis->file, last);
    for (i = 0; i < last; i++) {
        double p = welkin_axis_value(axis, i), q = welkin_axis_value(axis, i + 1);
        if (first < end ? value > q : value < q) continue;
        *visibility = welkin__axis_between(axis, i, (value - p) / (q - p));
        break;
    }
    return WELKIN_OK;
}

/* ---- estimates ---- */

/* Floats of a row of wavelengths. */
static uint32_t welkin__estimate_row(const welkin_file *f) { return (f->wavelengths + 7u) & ~7u; }

/* Bytes of a payload with these counts. */
static uint64_t welkin__estimate_length(const welkin_file *f, const welkin_estimate *t)
{
    uint64_t levels = t->levels, row = welkin__estimate_row(f);
    uint64_t tables = t->estimates * f->constituents * row + 8 * (uint64_t)t->densities + levels * (8 * (uint64_t)t->angles + t->suns * row);
    return 32 + 4 * (levels + t->rings + t->estimates + tables);
}

static int welkin__estimate_counts_are_good(const welkin_estimate *t)
{
    if (t->levels < 2 || t->levels > WELKIN__ESTIMATE_LEVELS || t->rings > WELKIN__ESTIMATE_RINGS) return 0;
    if (t->angles < 2 || t->angles > 256 || t->suns < 2 || t->suns > 256 || t->densities < 2 || t->densities > 4096) return 0;
    return t->estimates >= 1 && t->estimates <= WELKIN__ESTIMATES;
}

/* The first columns of rows; the others are padding. */
static int welkin__columns_are_within(const unsigned char *p, size_t rows, size_t row, size_t columns, double low,
                                      double high)
{
    size_t i;
    for (i = 0; i < rows; i++)
        if (!welkin__f32s_are_within(p + 4 * i * row, columns, low, high)) return 0;
    return 1;
}

static int welkin__levels_are_good(const welkin_file *f, const welkin_estimate *t)
{
    uint32_t i;
    if (welkin__f32(t->level) != 0 || welkin__f32(t->level + 4 * (size_t)(t->levels - 1)) != (float)f->top_altitude) return 0;
    for (i = 1; i < t->levels; i++)
        if (!((double)welkin__f32(t->level + 4 * (size_t)i) - (double)welkin__f32(t->level + 4 * (size_t)(i - 1)) >= 0.001)) return 0;
    return welkin__f32s_are_within(t->ring, t->rings, 0, (double)(float)f->top_altitude);
}

static int welkin__estimate_tables_are_good(const welkin_file *f, const welkin_estimate *t)
{
    size_t nk = f->constituents, nw = f->wavelengths, row = welkin__estimate_row(f);
    uint32_t i;
    for (i = 0; i < t->estimates; i++)
        if (welkin__u32(t->scatters + 4 * (size_t)i) >> nk != 0) return 0;
    return welkin__columns_are_within(t->albedo, t->estimates * nk, row, nw, 0, 1) &&
           welkin__columns_are_within(t->density, t->densities, 8, nk, 0, 1e6) &&
           welkin__columns_are_within(t->column, (size_t)t->levels * t->angles, 8, nk, -80, 80) &&
           welkin__columns_are_within(t->light, (size_t)t->levels * t->suns, row, nw, -80, 80);
}

/* Sets where the tables are, and checks them; the counts are in their ranges and the length is right. */
static welkin_error welkin__place_estimate(const welkin_file *f, const unsigned char *p, size_t length,
                                           welkin_estimate *t)
{
    size_t row = welkin__estimate_row(f);
    t->level = p + 32;
    t->ring = t->level + 4 * (size_t)t->levels;
    t->scatters = t->ring + 4 * (size_t)t->rings;
    t->albedo = t->scatters + 4 * (size_t)t->estimates;
    t->density = t->albedo + 4 * t->estimates * f->constituents * row;
    t->column = t->density + 32 * (size_t)t->densities;
    t->light = t->column + 32 * (size_t)t->levels * t->angles;
    t->sun_lowest = (double)welkin__f32(p + 24);
    t->sun_width = (double)welkin__f32(p + 28);
    if (!welkin__within(t->sun_lowest, -1, 0) || !welkin__within(t->sun_width, 1e-3, 1e3)) return WELKIN_ERROR_VALUE;
    if (!welkin__f32s_are_finite(t->albedo, (length - (size_t)(t->albedo - p)) / 4)) return WELKIN_ERROR_VALUE; /* also padding */
    return welkin__levels_are_good(f, t) && welkin__estimate_tables_are_good(f, t) ? WELKIN_OK : WELKIN_ERROR_VALUE;
}

static welkin_error welkin__read_estimate(const welkin_file *f, welkin_estimate *t)
{
    welkin__entry entry;
    const unsigned char *p;
    welkin_error error = welkin__find(f, WELKIN__ESTIMATE, WELKIN__NONE, WELKIN__NONE, &entry);
    if (!error) error = welkin__payload(f, &entry, &p);
    if (error) return error;
    if (entry.raw < 32) return WELKIN_ERROR_VALUE;
    t->levels = welkin__u32(p);
    t->angles = welkin__u32(p + 4);
    t->suns = welkin__u32(p + 8);
    t->densities = welkin__u32(p + 12);
    t->rings = welkin__u32(p + 16);
    t->estimates = welkin__u32(p + 20);
    if (!welkin__estimate_counts_are_good(t) || entry.raw != welkin__estimate_length(f, t)) return WELKIN_ERROR_VALUE;
    return welkin__place_estimate(f, p, (size_t)entry.raw, t);
}

/* The estimate that a field is relative to; in its range even if a mapped file changed. */
static uint32_t welkin__field_estimate(const welkin_file *f, uint32_t index)
{
    uint32_t estimate = welkin__field(f, index) >> 24;
    return estimate < f->estimate.estimates ? estimate : 0;
}

static int welkin__fields_have_estimates(const welkin_file *f)
{
    uint32_t i;
    if (f->estimate.error) return 1; /* not known */
    for (i = 0; i < f->fields; i++)
        if (welkin__field(f, i) >> 24 >= f->estimate.estimates) return 0;
    return 1;
}

/* ---- opening ---- */

/* Whether a file has this feature if and only if it has the chunk of the feature. */
static int welkin__is_declared(const welkin_file *f, uint32_t feature, welkin_error chunk)
{
    return (chunk != WELKIN_ERROR_MISSING) == ((f->features & feature) != 0);
}

static welkin_error welkin__check_file(welkin_file *file)
{
    uint64_t head;
    welkin_error error = welkin__check_start(file->bytes, file->length);
    if (error) return error;
    welkin__read_header(file);
    head = welkin__place_arrays(file);
    if (welkin__u64(file->bytes + 24) != head || head > file->length) return WELKIN_ERROR_LENGTH;
    if (welkin__head_crc(file->bytes, (size_t)head) != welkin__u32(file->bytes + 32)) return WELKIN_ERROR_CHECKSUM;
    if (!welkin__counts_are_good(file) || !welkin__axes_are_good(file) || !welkin__header_numbers_are_good(file) ||
        !welkin__tables_are_good(file) || !welkin__metadata_is_good(file))
        return WELKIN_ERROR_VALUE;
    welkin__find_ranks(file);
    if (!welkin__entries_are_good(file) || welkin__has_duplicates(file)) return WELKIN_ERROR_VALUE;
    file->spectrum.error = welkin__read_spectrum(file, &file->spectrum);
    file->estimate.error = welkin__read_estimate(file, &file->estimate);
    if (!welkin__is_declared(file, WELKIN__HAS_SPECTRUM, file->spectrum.error) ||
        !welkin__is_declared(file, WELKIN__HAS_ESTIMATES, file->estimate.error) || !welkin__fields_have_estimates(file))
        return WELKIN_ERROR_VALUE;
    file->metadata = (const char *)(file->bytes + file->metadata_at);
    return WELKIN_OK;
}

/* What is not open, and below what is not prepared, is all zero: questions look at a pointer that is then null. */
static welkin_error welkin__open(welkin_file *file, const void *bytes, size_t length, int unpacked)
{
    welkin_error error;
    memset(file, 0, sizeof *file);
    file->bytes = (const unsigned char *)bytes;
    file->length = length;
    file->unpacked = unpacked;
    error = welkin__check_file(file);
    if (error) memset(file, 0, sizeof *file);
    return error;
}

WELKIN_API welkin_error welkin_open(welkin_file *file, const void *bytes, size_t length)
{
    return welkin__open(file, bytes, length, 0);
}

/* ---- compressed chunks ---- */

static int welkin__is_packed(const welkin__entry *e) { return welkin__is_known(e->kind) && e->encoding == 1; }

/* Bytes of the blocks of a zstd frame (RFC 8878, 3.1.1.2), 0 if they reach beyond the end. */
static size_t welkin__blocks_length(const unsigned char *p, size_t left)
{
    size_t length = 0;
    uint32_t header, last = 0;
    while (!last) {
        uint32_t type, size;
        if (left - length < 3) return 0;
        header = welkin__u16(p + length) | (uint32_t)p[length + 2] << 16;
        last = header & 1;
        type = header >> 1 & 3;
        size = type == 1 ? 1 : header >> 3;
        length += 3;
        if (type == 3 || size > left - length) return 0;
        length += size;
    }
    return length;
}

/* Where the content size of a zstd frame is: behind a window of at most 128 MiB and a Dictionary_ID that is 0 (RFC
 * 8878, 3.1.1.1); 0 if the frame is none or breaks this. */
static size_t welkin__content_size_at(const unsigned char *p, size_t length)
{
    static const unsigned char magic[4] = {0x28, 0xB5, 0x2F, 0xFD}, widths[4] = {0, 1, 2, 4};
    size_t at, i;
    if (length < 10) return 0; /* the longest start, and the header of a block is yet to come */
    if (memcmp(p, magic, sizeof magic) != 0 || (p[4] & 0x08u) != 0) return 0;
    at = p[4] >> 5 & 1 ? 5 : 6;
    if (at == 6 && p[5] > (27 - 10) << 3) return 0;
    for (i = 0; i < widths[p[4] & 3u]; i++)
        if (p[at + i] != 0) return 0;
    return at + widths[p[4] & 3u];
}

/* Whether the bytes are exactly one zstd frame without dictionary that declares this content size (RFC 8878, 3.1.1). */
static int welkin__is_frame(const unsigned char *p, size_t length, uint64_t raw)
{
    static const unsigned char sizes[4] = {0, 2, 4, 8};
    size_t start = welkin__content_size_at(p, length), width, blocks;
    uint64_t declared = 0;
    if (start == 0) return 0;
    width = p[4] >> 6 == 0 && p[4] >> 5 & 1 ? 1 : sizes[p[4] >> 6];
    if (width == 0 || length - start < width) return 0;
    if (width == 1) declared = p[start];
    if (width == 2) declared = welkin__u16(p + start) + 256u;
    if (width == 4) declared = welkin__u32(p + start);
    if (width == 8) declared = welkin__u64(p + start);
    if (declared != raw) return 0;
    start += width;
    blocks = welkin__blocks_length(p + start, length - start);
    return blocks != 0 && length - start - blocks == (p[4] & 4u);
}

static void welkin__put_u32(unsigned char *p, uint32_t value)
{
    int i;
    for (i = 0; i < 4; i++) p[i] = (unsigned char)(value >> 8 * i & 255u);
}

static void welkin__put_u64(unsigned char *p, uint64_t value)
{
    welkin__put_u32(p, (uint32_t)(value & 0xFFFFFFFFu));
    welkin__put_u32(p + 4, (uint32_t)(value >> 32));
}

WELKIN_API size_t welkin_unpacked_length(const welkin_file *f)
{
    uint64_t length = f->directory_at + (uint64_t)WELKIN__ENTRY * f->chunk_count;
    uint32_t i, packed = 0;
    for (i = 0; i < f->chunk_count; i++) {
        welkin__entry e = welkin__read_entry(f, i);
        uint64_t size = welkin__is_packed(&e) && e.raw > e.stored ? e.raw : e.stored;
        packed += (uint32_t)welkin__is_packed(&e);
        length = (length + 63) & ~(uint64_t)63;
        if (size > (SIZE_MAX >> 1) || length > (SIZE_MAX >> 1)) return 0;
        length += size;
    }
    return packed ? (size_t)length : 0;
}

/* Writes a chunk, decoded if that succeeds, and what its entry says about it; returns its length. */
static size_t welkin__unpack_chunk(const welkin_file *f, const welkin__entry *e, welkin_decompress *decompress,
                                   void *user, unsigned char *entry, unsigned char *out)
{
    const unsigned char *stored = f->bytes + (size_t)e->offset;
    size_t length = (size_t)e->stored, raw = (size_t)e->raw;
    if (welkin__is_packed(e) && ~welkin__crc(0xFFFFFFFFu, stored, length) == e->crc && welkin__is_frame(stored, length, e->raw) &&
        decompress(user, out, raw, stored, length) == raw) {
        welkin__put_u64(entry + 16, raw);
        welkin__put_u32(entry + 32, 0);
        welkin__put_u32(entry + 36, ~welkin__crc(0xFFFFFFFFu, out, raw));
        return raw;
    }
    memcpy(out, stored, length);
    return length;
}

WELKIN_API welkin_error welkin_unpack(welkin_file *file, welkin_decompress *decompress, void *user, void *out,
                                      size_t capacity)
{
    unsigned char *bytes = (unsigned char *)out;
    size_t head = file->directory_at + (size_t)WELKIN__ENTRY * file->chunk_count, length = head;
    welkin_file unpacked;
    welkin_error error;
    uint32_t i;
    if (!file->bytes) return WELKIN_ERROR_STATE;
    if (welkin_unpacked_length(file) == 0) return WELKIN_OK;
    if (capacity < welkin_unpacked_length(file)) return WELKIN_ERROR_SCRATCH;
    memset(bytes, 0, capacity);
    memcpy(bytes, file->bytes, head);
    for (i = 0; i < file->chunk_count; i++) {
        welkin__entry e = welkin__read_entry(file, i);
        unsigned char *entry = bytes + file->directory_at + (size_t)WELKIN__ENTRY * i;
        if (e.offset > file->length || e.stored > file->length - e.offset) return WELKIN_ERROR_VALUE; /* a mapped file that changed */
        length = (length + 63) & ~(size_t)63;
        if (length > capacity || (size_t)(welkin__is_packed(&e) && e.raw > e.stored ? e.raw : e.stored) > capacity - length)
            return WELKIN_ERROR_VALUE;
        welkin__put_u64(entry + 8, length);
        length += welkin__unpack_chunk(file, &e, decompress, user, entry, bytes + length);
    }
    welkin__put_u64(bytes + 16, length);
    welkin__put_u32(bytes + 32, welkin__head_crc(bytes, head));
    error = welkin__open(&unpacked, bytes, length, 1);
    if (!error) *file = unpacked;
    return error;
}

/* ---- interpolation between nodes ---- */

typedef enum welkin__scale { WELKIN__PLAIN, WELKIN__CUBE_ROOT, WELKIN__INVERSE, WELKIN__SINE } welkin__scale;

typedef struct welkin__stencil {
    uint32_t count, node[4];
    double weight[4];
} welkin__stencil;

static double welkin__x(welkin__scale scale, double value)
{
    if (scale == WELKIN__CUBE_ROOT) return cbrt(value);
    if (scale == WELKIN__SINE) return asinh(12.5 * value);
    return scale == WELKIN__INVERSE ? 1.0 / value : value;
}

/* The last node that is not above the value, the first if there is none. */
static uint32_t welkin__node_below(const unsigned char *axis, uint32_t n, double value)
{
    uint32_t low = 0, high = n;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (welkin__f64(axis + 8 * (size_t)middle) <= value)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static welkin__stencil welkin__one_node(uint32_t node)
{
    welkin__stencil s = {1, {0, 0, 0, 0}, {1.0, 0, 0, 0}};
    s.node[0] = node;
    return s;
}

static welkin__stencil welkin__linear(const unsigned char *axis, uint32_t n, double value, welkin__scale scale)
{
    uint32_t i = welkin__node_below(axis, n, value);
    welkin__stencil s = welkin__one_node(i);
    double first = welkin__f64(axis + 8 * (size_t)i), x0, x1, t;
    if (first == value || i + 1 >= n) return s;
    x0 = welkin__x(scale, first);
    x1 = welkin__x(scale, welkin__f64(axis + 8 * (size_t)(i + 1)));
    t = (welkin__x(scale, value) - x0) / (x1 - x0);
    s.count = 2;
    s.node[1] = i + 1;
    s.weight[0] = 1.0 - t;
    s.weight[1] = t;
    return s;
}

/* Adds `factor` times the derivative at x[j] of the parabola through three nodes from a on. */
static void welkin__add_slope(double *weight, const double *x, uint32_t a, uint32_t j, double factor)
{
    double xa = x[a], xb = x[a + 1], xc = x[a + 2], xj = x[j];
    weight[a] += factor * (2 * xj - xb - xc) / ((xa - xb) * (xa - xc));
    weight[a + 1] += factor * (2 * xj - xa - xc) / ((xb - xa) * (xb - xc));
    weight[a + 2] += factor * (2 * xj - xa - xb) / ((xc - xa) * (xc - xb));
}

static uint32_t welkin__parabola_centre(uint32_t node, uint32_t n)
{
    if (node < 1) return 1;
    return node > n - 2 ? n - 2 : node;
}

static welkin__stencil welkin__cubic(const unsigned char *axis, uint32_t n, double value, welkin__scale scale)
{
    uint32_t i = welkin__node_below(axis, n, value), base, k, local;
    welkin__stencil s = {0, {0, 0, 0, 0}, {0, 0, 0, 0}};
    double x[4] = {0, 0, 0, 0}, t, t2, t3, h;
    if (n < 3 || i + 1 >= n || welkin__f64(axis + 8 * (size_t)i) == value) return welkin__linear(axis, n, value, scale);
    base = welkin__parabola_centre(i, n) - 1;
    local = i - base;
    s.count = n - base < 4 ? n - base : 4;
    for (k = 0; k < s.count; k++) {
        s.node[k] = base + k;
        x[k] = welkin__x(scale, welkin__f64(axis + 8 * (size_t)(base + k)));
    }
    h = x[local + 1] - x[local];
    t = (welkin__x(scale, value) - x[local]) / h;
    t2 = t * t;
    t3 = t2 * t;
    s.weight[local] += 2 * t3 - 3 * t2 + 1;
    s.weight[local + 1] += 3 * t2 - 2 * t3;
    welkin__add_slope(s.weight, x, 0, local, h * (t3 - 2 * t2 + t));
    welkin__add_slope(s.weight, x, welkin__parabola_centre(i + 1, n) - 1 - base, local + 1, h * (t3 - t2));
    return s;
}

/* Moves values that exceed the range by rounding into it; 0 if they are farther off or NaN. */
static int welkin__into_range(double *value, double low, double high)
{
    double slack = 1e-9 * (fabs(low) > fabs(high) ? fabs(low) : fabs(high));
    if (!welkin__within(*value, low - slack, high + slack)) return 0;
    if (*value < low) *value = low;
    if (*value > high) *value = high;
    return 1;
}

static int welkin__into_axis(const unsigned char *axis, uint32_t n, double *value)
{
    return welkin__into_range(value, welkin__f64(axis), welkin__f64(axis + 8 * (size_t)(n - 1)));
}

/* Without room for rounding, which wavelengths do not get. */
static int welkin__is_on_axis(const unsigned char *axis, uint32_t n, double value)
{
    return welkin__within(value, welkin__f64(axis), welkin__f64(axis + 8 * (size_t)(n - 1)));
}

/* ---- splines ---- */

typedef struct welkin__spline {
    uint32_t row[4];
    double weight[4];
} welkin__spline;

static welkin__spline welkin__free_spline(double u, uint32_t intervals)
{
    welkin__spline s;
    uint32_t i, k;
    double t;
    if (!(u > 0)) u = 0;
    if (u > (double)intervals) u = (double)intervals;
    i = (uint32_t)u;
    if (i > intervals - 1) i = intervals - 1;
    t = u - (double)i;
    s.weight[0] = (1 - t) * (1 - t) * (1 - t) / 6;
    s.weight[1] = ((3 * t - 6) * t * t + 4) / 6;
    s.weight[2] = (((3 - 3 * t) * t + 3) * t + 1) / 6;
    s.weight[3] = t * t * t / 6;
    for (k = 0; k < 4; k++) s.row[k] = i + k;
    return s;
}

static welkin__spline welkin__mirrored_spline(double u, uint32_t intervals)
{
    welkin__spline s = welkin__free_spline(u, intervals);
    uint32_t k;
    for (k = 0; k < 4; k++) {
        uint32_t m = s.row[k]; /* one more than the index, which can be -1 */
        s.row[k] = m == 0 ? 1 : m == intervals + 2 ? intervals - 1 : m - 1;
    }
    return s;
}

static double welkin__elevation_scale(const welkin_file *f, double e) { return asinh((e - f->elevation_centre) / f->elevation_width); }

static welkin__spline welkin__elevation_spline(const welkin_file *f, double e)
{
    double low = welkin__elevation_scale(f, f->elevation_min), high = welkin__elevation_scale(f, f->elevation_max);
    double u = high > low ? f->elevation_intervals * (welkin__elevation_scale(f, e) - low) / (high - low) : 0;
    return welkin__free_spline(u, f->elevation_intervals);
}

/* The spline at one column of an f16 table. */
static double welkin__f16_column(const unsigned char *table, size_t width, size_t column, const welkin__spline *s)
{
    double sum = 0;
    int k;
    for (k = 0; k < 4; k++) sum += s->weight[k] * (double)welkin__f16(table + 2 * (s->row[k] * width + column));
    return sum;
}

/* ---- preparation of a sky ---- */

typedef struct welkin__part {
    double weight;
    welkin__entry entry;
} welkin__part;

/* The chunks that a scene needs. */
typedef struct welkin__scene {
    uint32_t columns, radiances;
    welkin__part column[4], radiance[16], polarisation[16];
    welkin__entry basis, polarisation_basis;
} welkin__scene;

static welkin_error welkin__find_columns(const welkin_file *f, const welkin__stencil *a, welkin__scene *scene)
{
    uint32_t j;
    for (j = 0; j < a->count; j++) {
        welkin__part *part = &scene->column[scene->columns];
        if (a->weight[j] == 0) continue;
        if (welkin__find(f, WELKIN__COLUMN, a->node[j], WELKIN__NONE, &part->entry)) return WELKIN_ERROR_MISSING;
        part->weight = a->weight[j];
        scene->columns++;
    }
    return WELKIN_OK;
}

static welkin_error welkin__find_cells(const welkin_file *f, const welkin__stencil *a, const welkin__stencil *b,
                                       uint32_t kind, welkin__part *parts, uint32_t *count)
{
    uint32_t j, m;
    *count = 0;
    for (j = 0; j < a->count; j++)
        for (m = 0; m < b->count; m++) {
            welkin__part *part = &parts[*count];
            if (a->weight[j] == 0 || b->weight[m] == 0) continue;
            if (welkin__find(f, kind, a->node[j], b->node[m], &part->entry)) return WELKIN_ERROR_MISSING;
            part->weight = a->weight[j] * b->weight[m];
            ++*count;
        }
    return WELKIN_OK;
}

/* Everything that is missing is found before anything is checked. */
static welkin_error welkin__find_scene(const welkin_file *f, double altitude, double visibility, unsigned flags,
                                       welkin__scene *scene)
{
    welkin__stencil a = welkin__cubic(f->bytes + f->altitude_at, f->altitudes, altitude, WELKIN__CUBE_ROOT);
    welkin__stencil b = welkin__cubic(f->bytes + f->visibility_at, f->visibilities, visibility, WELKIN__INVERSE);
    memset(scene, 0, sizeof *scene);
    if (welkin__find(f, WELKIN__BASIS, WELKIN__NONE, WELKIN__NONE, &scene->basis)) return WELKIN_ERROR_MISSING;
    if (!welkin__has_estimates(f) && welkin__find_columns(f, &a, scene)) return WELKIN_ERROR_MISSING;
    if (welkin__find_cells(f, &a, &b, WELKIN__RADIANCE, scene->radiance, &scene->radiances)) return WELKIN_ERROR_MISSING;
    if (!(flags & WELKIN_POLARISED)) return WELKIN_OK;
    if (welkin__find(f, WELKIN__POLARISATION_BASIS, WELKIN__NONE, WELKIN__NONE, &scene->polarisation_basis)) return WELKIN_ERROR_MISSING;
    return welkin__find_cells(f, &a, &b, WELKIN__POLARISATION, scene->polarisation, &scene->radiances);
}

static size_t welkin__table_floats(const welkin_file *f, uint32_t rank, uint32_t channels, unsigned flags)
{
    size_t row = welkin__ceil16(rank), c = welkin__ceil16(channels), phi = f->phi_intervals + 1, alpha = welkin__alpha_rows(f);
    size_t dense = flags & WELKIN_DENSE ? alpha * phi * c : 0;
    return row * (alpha + phi + c) + dense;
}

/* Of the tables of estimates; none if those cannot be used. */
static size_t welkin__estimate_floats(const welkin_file *f)
{
    const welkin_estimate *t = &f->estimate;
    size_t row = welkin__estimate_row(f), levels = t->levels;
    if (t->error) return 0;
    return (1 + (size_t)t->estimates) * f->constituents * row + 8 * (size_t)t->densities + levels * (8 * (size_t)t->angles + t->suns * row);
}

/* Of the mean densities, which files with estimates do without. */
static size_t welkin__column_floats(const welkin_file *f)
{
    return welkin__has_estimates(f) ? 0 : (size_t)welkin__alpha_rows(f) * f->constituents;
}

WELKIN_API size_t welkin_scratch_floats(const welkin_file *f, unsigned flags)
{
    size_t nw = f->wavelengths;
    size_t floats = welkin__column_floats(f) + f->constituents * nw + 2 * nw + 4 * f->fields * nw + welkin__estimate_floats(f);
    floats += welkin__table_floats(f, f->rank, f->fields * f->wavelengths, flags);
    if (flags & WELKIN_POLARISED) floats += welkin__table_floats(f, f->polarisation_rank, 4 * f->wavelengths, flags);
    return floats;
}

static float *welkin__carve(float **scratch, size_t floats)
{
    float *block = *scratch;
    size_t i;
    for (i = 0; i < floats; i++) block[i] = 0;
    *scratch += floats;
    return block;
}

static void welkin__carve_table(const welkin_file *f, welkin_table *t, uint32_t rank, uint32_t channels, unsigned flags,
                                float **scratch)
{
    size_t alpha = welkin__alpha_rows(f), phi = f->phi_intervals + 1;
    t->rank = rank;
    t->row = welkin__ceil16(rank);
    t->channels = welkin__ceil16(channels);
    t->alpha = welkin__carve(scratch, alpha * t->row);
    t->phi = welkin__carve(scratch, phi * t->row);
    t->channel = welkin__carve(scratch, (size_t)t->row * t->channels);
    t->dense = flags & WELKIN_DENSE ? welkin__carve(scratch, alpha * phi * t->channels) : NULL;
}

static void welkin__carve_estimate(const welkin_file *f, welkin_estimate_tables *t, float **scratch)
{
    const welkin_estimate *e = &f->estimate;
    size_t row = welkin__estimate_row(f), air = f->constituents * row, levels = e->levels;
    t->row = (uint32_t)row;
    t->extinction = welkin__carve(scratch, air);
    t->scattering = welkin__carve(scratch, e->estimates * air);
    t->density = welkin__carve(scratch, 8 * (size_t)e->densities);
    t->column = welkin__carve(scratch, 8 * levels * e->angles);
    t->light = welkin__carve(scratch, levels * e->suns * row);
}

static void welkin__carve_sky(welkin_sky *sky, float *scratch)
{
    const welkin_file *f = sky->file;
    size_t nw = f->wavelengths;
    sky->column = welkin__carve(&scratch, welkin__column_floats(f));
    sky->extinction = welkin__carve(&scratch, f->constituents * nw);
    sky->level = welkin__carve(&scratch, nw);
    sky->bounce = welkin__carve(&scratch, nw);
    sky->phase = welkin__carve(&scratch, 4 * f->fields * nw);
    if (welkin__has_estimates(f)) welkin__carve_estimate(f, &sky->estimate, &scratch);
    welkin__carve_table(f, &sky->radiance, f->rank, f->fields * f->wavelengths, sky->flags, &scratch);
    if (sky->flags & WELKIN_POLARISED)
        welkin__carve_table(f, &sky->polarisation, f->polarisation_rank, 4 * f->wavelengths, sky->flags, &scratch);
}

/* Sums a table of all visibilities over the nodes of a stencil. */
static double welkin__head_value(const welkin_file *f, size_t at, size_t stride, size_t index, const welkin__stencil *s)
{
    double sum = 0;
    uint32_t i;
    for (i = 0; i < s->count; i++) sum += s->weight[i] * welkin__f64(f->bytes + at + 8 * (s->node[i] * stride + index));
    return sum;
}

static void welkin__prepare_head_tables(welkin_sky *sky, double visibility, double albedo)
{
    const welkin_file *f = sky->file;
    size_t nw = f->wavelengths, air = f->constituents * nw, i;
    welkin__stencil b = welkin__linear(f->bytes + f->visibility_at, f->visibilities, visibility, WELKIN__INVERSE);
    for (i = 0; i < air; i++) sky->extinction[i] = welkin__narrow(welkin__head_value(f, f->extinction_at, air, i, &b));
    for (i = 0; i < nw; i++) {
        double share = 1 - albedo * welkin__head_value(f, f->albedo_at, nw, i, &b);
        sky->bounce[i] = welkin__narrow(albedo / (share > DBL_EPSILON ? share : DBL_EPSILON));
    }
}

/* Four numbers of the phase function at one wavelength. Rayleigh: p0 + p1 cos². Henyey-Greenstein: p3 / x^(3/2) with
 * x = p0 + p1 (1 - cos) + p2 (1 + cos), a sum without cancellation for either sign of g. */
static void welkin__prepare_phase(uint32_t phase, double parameter, float *p, size_t stride)
{
    if (phase == 1) {
        double delta = (1 - parameter) / (1 + parameter / 2);
        p[0] = (float)(1 - delta / 4);
        p[stride] = (float)(0.75 * delta);
    } else if (phase == 2) {
        double size = fabs(parameter);
        p[0] = (float)((1 - size) * (1 - size));
        p[stride] = parameter > 0 ? (float)(2 * size) : 0;
        p[2 * stride] = parameter > 0 ? 0 : (float)(2 * size);
        p[3 * stride] = (float)((1 - size) * (1 + size));
    }
}

static void welkin__prepare_phases(welkin_sky *sky)
{
    const welkin_file *f = sky->file;
    size_t nw = f->wavelengths;
    uint32_t i, w;
    for (i = 0; i < f->fields; i++) {
        uint32_t phase = welkin__field(f, i) & 0xFFFFu;
        for (w = 0; w < f->wavelengths; w++) welkin__prepare_phase(phase, welkin__parameter(f, i, w), sky->phase + 4 * i * nw + w, nw);
    }
}

/* Copies the first columns of rows; the others stay 0. */
static void welkin__copy_columns(const unsigned char *p, size_t rows, size_t row, size_t columns, float *out)
{
    size_t i, c;
    for (i = 0; i < rows; i++)
        for (c = 0; c < columns; c++) out[i * row + c] = welkin__f32(p + 4 * (i * row + c));
}

static double welkin__sun_scale(const welkin_estimate *e, double sine) { return asinh(sine / e->sun_width); }

static void welkin__prepare_scattering(const welkin_file *f, welkin_estimate_tables *t)
{
    const welkin_estimate *e = &f->estimate;
    size_t nk = f->constituents, row = t->row, q, k, w;
    for (q = 0; q < e->estimates; q++)
        for (k = 0; k < nk; k++)
            for (w = 0; w < f->wavelengths && (welkin__u32(e->scatters + 4 * q) >> k & 1u) != 0; w++) {
                size_t i = (q * nk + k) * row + w;
                t->scattering[i] = welkin__f32(e->albedo + 4 * i) * t->extinction[k * row + w];
            }
}

static void welkin__prepare_estimate(welkin_sky *sky)
{
    const welkin_file *f = sky->file;
    const welkin_estimate *e = &f->estimate;
    welkin_estimate_tables *t = &sky->estimate;
    size_t nk = f->constituents, nw = f->wavelengths, k, w;
    uint32_t i;
    for (i = 0; i < e->levels; i++) t->level[i] = (double)welkin__f32(e->level + 4 * (size_t)i);
    for (i = 0; i < e->rings; i++) t->ring[i] = (double)welkin__f32(e->ring + 4 * (size_t)i);
    t->sun_start = welkin__sun_scale(e, e->sun_lowest);
    t->sun_scale = (e->suns - 1) / (welkin__sun_scale(e, 1) - t->sun_start);
    for (k = 0; k < nk; k++)
        for (w = 0; w < nw; w++) t->extinction[k * t->row + w] = sky->extinction[k * nw + w];
    welkin__prepare_scattering(f, t);
    welkin__copy_columns(e->density, e->densities, 8, nk, t->density);
    welkin__copy_columns(e->column, (size_t)e->levels * e->angles, 8, nk, t->column);
    welkin__copy_columns(e->light, (size_t)e->levels * e->suns, t->row, nw, t->light);
}

static welkin_error welkin__prepare_columns(welkin_sky *sky, const welkin__scene *scene)
{
    const welkin_file *f = sky->file;
    size_t n = (size_t)welkin__alpha_rows(f) * f->constituents, i;
    uint32_t j;
    for (j = 0; j < scene->columns; j++) {
        const unsigned char *p;
        welkin_error error = welkin__payload(f, &scene->column[j].entry, &p);
        if (error) return error;
        for (i = 0; i < n; i++)
            sky->column[i] = welkin__narrow((double)sky->column[i] + scene->column[j].weight * (double)welkin__f32(p + 4 * i));
    }
    return WELKIN_OK;
}

/* Adds a chunk at the sun's elevation, times its weight, to the rows over alpha. */
static void welkin__add_factors(const welkin_file *f, welkin_table *t, const welkin__part *part, const unsigned char *p,
                                const welkin__spline *elevation)
{
    size_t q = welkin__ceil16(part->entry.rank), rows = welkin__alpha_rows(f), a, i;
    const unsigned char *alpha = p + 4 * q, *elevations = alpha + 2 * rows * q;
    for (i = 0; i < part->entry.rank; i++) {
        double factor = part->weight * (double)welkin__f32(p + 4 * i) * welkin__f16_column(elevations, q, i, elevation);
        for (a = 0; a < rows; a++) {
            float *sum = &t->alpha[a * t->row + i];
            *sum = welkin__narrow((double)*sum + factor * (double)welkin__f16(alpha + 2 * (a * q + i)));
        }
    }
}

static void welkin__add_levels(const welkin_file *f, const welkin__part *part, const unsigned char *p,
                               const welkin__spline *elevation, double *level)
{
    size_t q = welkin__ceil16(part->entry.rank), rows = welkin__alpha_rows(f) + f->elevation_intervals + 3;
    uint32_t w;
    for (w = 0; w < f->wavelengths; w++)
        level[w] += part->weight * welkin__f16_column(p + 4 * q + 2 * rows * q, f->wavelengths, w, elevation);
}

static welkin_error welkin__add_cells(const welkin_file *f, welkin_table *t, const welkin__part *parts, uint32_t count,
                                      const welkin__spline *elevation, double *level)
{
    uint32_t i;
    for (i = 0; i < count; i++) {
        const unsigned char *p;
        welkin_error error = welkin__payload(f, &parts[i].entry, &p);
        if (error) return error;
        if (parts[i].entry.rank > t->rank) return WELKIN_ERROR_VALUE;
        welkin__add_factors(f, t, &parts[i], p, elevation);
        if (level) welkin__add_levels(f, &parts[i], p, elevation, level);
    }
    return WELKIN_OK;
}

/* What the azimuth counts where the sine of the sun's zenith angle is this: nothing under a vertical sun. */
static double welkin__azimuthal_fade(double sine)
{
    double t = fmin(20 * sine, 1);
    return t * (3 - t * t) / 2;
}

/* Fades coefficients over the azimuth towards their mean. */
static void welkin__fade(const welkin_file *f, welkin_table *t, double fade)
{
    size_t n = f->phi_intervals, a, i;
    if (fade >= 1) return;
    for (i = 0; i < t->row; i++) {
        double mean = 0;
        for (a = 0; a <= n; a++) mean += (a == 0 || a == n ? 0.5 : 1.0) / (double)n * (double)t->phi[a * t->row + i];
        for (a = 0; a <= n; a++) t->phi[a * t->row + i] = welkin__narrow(mean + fade * ((double)t->phi[a * t->row + i] - mean));
    }
}

static welkin_error welkin__read_basis(const welkin_file *f, const welkin__entry *entry, uint32_t channels,
                                       welkin_table *t)
{
    const unsigned char *p, *channel;
    size_t phi = f->phi_intervals + 1, a, i, c;
    welkin_error error = welkin__payload(f, entry, &p);
    if (error) return error;
    if (entry->rank != t->rank) return WELKIN_ERROR_VALUE;
    channel = p + 2 * phi * t->row;
    for (i = 0; i < t->rank; i++) {
        for (a = 0; a < phi; a++) t->phi[a * t->row + i] = welkin__f16(p + 2 * (a * t->row + i));
        for (c = 0; c < channels; c++) t->channel[i * t->channels + c] = welkin__f16(channel + 2 * (i * t->channels + c));
    }
    return WELKIN_OK;
}

/* out += the weighted sum of four rows */
static void welkin__add_rows(float *out, const float *a, const float *b, const float *c, const float *d,
                             const float w[4], uint32_t n)
{
    float wa = w[0], wb = w[1], wc = w[2], wd = w[3];
    uint32_t i;
    for (i = 0; i < n; i++) out[i] += (wa * a[i] + wb * b[i]) + (wc * c[i] + wd * d[i]);
}

/* out += the sum over components; rows are multiples of 16 */
static void welkin__add_components(const welkin_table *t, const float *weight, float *out)
{
    size_t c = t->channels;
    uint32_t i;
    for (i = 0; i + 4 <= t->row; i += 4) {
        const float *row = t->channel + i * c;
        welkin__add_rows(out, row, row + c, row + 2 * c, row + 3 * c, weight + i, t->channels);
    }
}

static void welkin__make_dense(const welkin_file *f, welkin_table *t)
{
    float weight[WELKIN_MAX_RANK];
    size_t rows = welkin__alpha_rows(f), phis = f->phi_intervals + 1, a, b;
    uint32_t i;
    for (a = 0; a < rows; a++)
        for (b = 0; b < phis; b++) {
            for (i = 0; i < t->row; i++) weight[i] = t->alpha[a * t->row + i] * t->phi[b * t->row + i];
            welkin__add_components(t, weight, t->dense + (a * phis + b) * t->channels);
        }
}

static welkin_error welkin__prepare_radiance(welkin_sky *sky, const welkin__scene *scene,
                                             const welkin__spline *elevation)
{
    const welkin_file *f = sky->file;
    double level[WELKIN_MAX_WAVELENGTHS] = {0};
    uint32_t w;
    welkin_error error = welkin__read_basis(f, &scene->basis, f->fields * f->wavelengths, &sky->radiance);
    if (!error)
        error = welkin__add_cells(f, &sky->radiance, scene->radiance, scene->radiances, elevation, welkin__has_estimates(f) ? NULL : level);
    if (error) return error;
    for (w = 0; w < f->wavelengths; w++) sky->level[w] = welkin__narrow(exp(level[w]));
    welkin__fade(f, &sky->radiance, sky->fade);
    if (sky->radiance.dense) welkin__make_dense(f, &sky->radiance);
    return WELKIN_OK;
}

static welkin_error welkin__prepare_polarisation(welkin_sky *sky, const welkin__scene *scene,
                                                 const welkin__spline *elevation)
{
    const welkin_file *f = sky->file;
    welkin_error error = welkin__read_basis(f, &scene->polarisation_basis, 4 * f->wavelengths, &sky->polarisation);
    if (!error) error = welkin__add_cells(f, &sky->polarisation, scene->polarisation, scene->radiances, elevation, NULL);
    if (error) return error;
    welkin__fade(f, &sky->polarisation, sky->fade);
    if (sky->polarisation.dense) welkin__make_dense(f, &sky->polarisation);
    return WELKIN_OK;
}

static int welkin__conditions_into_range(const welkin_file *f, welkin_conditions *c)
{
    /* An observer in a depression stands on the ground. */
    if (c->altitude >= -500 && c->altitude < 0) c->altitude = 0;
    return welkin__into_axis(f->bytes + f->altitude_at, f->altitudes, &c->altitude) &&
           welkin__into_axis(f->bytes + f->visibility_at, f->visibilities, &c->visibility) && welkin__into_range(&c->albedo, 0, 1) &&
           welkin__into_range(&c->solar_elevation, f->elevation_min, f->elevation_max) &&
           welkin__within(c->solar_azimuth, -DBL_MAX, DBL_MAX);
}

static void welkin__prepare_geometry(welkin_sky *sky, const welkin_conditions *c)
{
    double radius = sky->file->planet_radius;
    sky->altitude = c->altitude;
    sky->dip = atan(sqrt(c->altitude * (2 * radius + c->altitude)) / radius);
    sky->cos_azimuth = cos(c->solar_azimuth);
    sky->sin_azimuth = sin(c->solar_azimuth);
    sky->fade = welkin__azimuthal_fade(cos(c->solar_elevation));
    sky->sun[0] = cos(c->solar_elevation) * sky->cos_azimuth;
    sky->sun[1] = cos(c->solar_elevation) * sky->sin_azimuth;
    sky->sun[2] = sin(c->solar_elevation);
}

static welkin_error welkin__prepare(welkin_sky *sky, const welkin_file *file, const welkin_conditions *conditions,
                                    unsigned flags, float *scratch, size_t scratch_floats)
{
    welkin_conditions c = *conditions;
    welkin__scene scene;
    welkin__spline elevation;
    welkin_error error;
    if (!file->bytes) return WELKIN_ERROR_STATE;
    if (flags & ~(WELKIN_POLARISED | WELKIN_DENSE)) return WELKIN_ERROR_RANGE;
    sky->file = file;
    sky->flags = flags;
    if (!welkin__conditions_into_range(file, &c)) return WELKIN_ERROR_RANGE;
    error = welkin__find_scene(file, c.altitude, c.visibility, flags, &scene);
    if (!error && welkin__has_estimates(file)) error = file->estimate.error;
    if (error) return error;
    if (scratch_floats < welkin_scratch_floats(file, flags)) return WELKIN_ERROR_SCRATCH;
    welkin__carve_sky(sky, scratch);
    welkin__prepare_geometry(sky, &c);
    welkin__prepare_head_tables(sky, c.visibility, c.albedo);
    welkin__prepare_phases(sky);
    if (welkin__has_estimates(file)) welkin__prepare_estimate(sky);
    elevation = welkin__elevation_spline(file, c.solar_elevation);
    error = welkin__prepare_columns(sky, &scene);
    if (!error) error = welkin__prepare_radiance(sky, &scene, &elevation);
    if (!error && flags & WELKIN_POLARISED) error = welkin__prepare_polarisation(sky, &scene, &elevation);
    return error;
}

WELKIN_API welkin_error welkin_prepare(welkin_sky *sky, const welkin_file *file, const welkin_conditions *conditions,
                                       unsigned flags, float *scratch, size_t scratch_floats)
{
    welkin_error error;
    memset(sky, 0, sizeof *sky);
    error = welkin__prepare(sky, file, conditions, flags, scratch, scratch_floats);
    if (error) memset(sky, 0, sizeof *sky);
    return error;
}

/* ---- directions ---- */

typedef struct welkin__view {
    double v[3], level;     /* unit vector, its length in the horizontal plane */
    double cos_phi, sin_phi; /* azimuth less that of the sun */
    int up;
    welkin__spline alpha, phi; /* alpha's rows count from the first of the up axis */
    float cos_gamma, one_less_cos, one_plus_cos;
} welkin__view;

static welkin_error welkin__normalise(const double d[3], double v[3])
{
    double size = fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2]))), length;
    int i;
    if (!(fabs(d[0]) <= DBL_MAX && fabs(d[1]) <= DBL_MAX && fabs(d[2]) <= DBL_MAX) || size == 0) return WELKIN_ERROR_DIRECTION;
    for (i = 0; i < 3; i++) v[i] = d[i] / size;
    length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (i = 0; i < 3; i++) v[i] /= length;
    return WELKIN_OK;
}

static void welkin__find_alpha(const welkin_sky *sky, welkin__view *view)
{
    const welkin_file *f = sky->file;
    double delta = atan2(view->v[2], view->level) + sky->dip;
    int k;
    view->up = delta >= 0;
    if (view->up) {
        view->alpha = welkin__free_spline(f->up_intervals * pow(delta / (WELKIN__HALF_PI + sky->dip), 1 / f->up_exponent), f->up_intervals);
        return;
    }
    view->alpha =
        welkin__free_spline(f->down_intervals * pow(-delta / (WELKIN__HALF_PI - sky->dip), 1 / f->down_exponent), f->down_intervals);
    for (k = 0; k < 4; k++) view->alpha.row[k] += f->up_intervals + 3;
}

static void welkin__find_phi(const welkin_sky *sky, welkin__view *view)
{
    const double *v = view->v;
    double along = v[0] * sky->cos_azimuth + v[1] * sky->sin_azimuth, across = v[1] * sky->cos_azimuth - v[0] * sky->sin_azimuth;
    double length = sqrt(along * along + across * across), phi = 0;
    view->cos_phi = 1;
    view->sin_phi = 0;
    if (length > 0) {
        view->cos_phi = along / length;
        view->sin_phi = across / length;
        phi = atan2(fabs(across), along);
    }
    view->phi = welkin__mirrored_spline(sky->file->phi_intervals * phi / (2 * WELKIN__HALF_PI), sky->file->phi_intervals);
}

static void welkin__find_gamma(const welkin_sky *sky, welkin__view *view)
{
    double less = 0, plus = 0, cosine = 0;
    int i;
    for (i = 0; i < 3; i++) {
        double v = view->v[i], s = sky->sun[i];
        less += (v - s) * (v - s) / 2;
        plus += (v + s) * (v + s) / 2;
        cosine += v * s;
    }
    view->cos_gamma = (float)cosine;
    view->one_less_cos = (float)less;
    view->one_plus_cos = (float)plus;
}

static welkin_error welkin__look(const welkin_sky *sky, const double direction[3], welkin__view *view)
{
    welkin_error error = sky->file ? welkin__normalise(direction, view->v) : WELKIN_ERROR_STATE;
    if (error) return error;
    view->level = sqrt(view->v[0] * view->v[0] + view->v[1] * view->v[1]);
    welkin__find_alpha(sky, view);
    welkin__find_phi(sky, view);
    welkin__find_gamma(sky, view);
    return WELKIN_OK;
}

/* Length of the ray to the top of the atmosphere or to the ground. */
static double welkin__ray_length(const welkin_sky *sky, const welkin__view *view)
{
    double radius = sky->file->planet_radius, top = sky->file->top_altitude, h = sky->altitude;
    double fall = (radius + h) * view->v[2], product, root;
    if (view->up) {
        product = (top - h) * (2 * radius + top + h);
        root = sqrt(fall * fall + product);
        return fall > 0 ? product / (fall + root) : root - fall;
    }
    product = h * (2 * radius + h);
    root = sqrt(fmax(0, fall * fall - product));
    return product > 0 && root - fall > 0 ? product / (root - fall) : 0;
}

/* 1 - exp(-depth) for depth >= 0, without branches that keep it from being vectorised. */
static float welkin__absorbed(float depth)
{
    float x = depth < 87.0f ? depth : 87.0f, n = (float)(int)(x * 1.44269504f + 0.5f), r, power, p;
    r = n * 0.693359375f - x; /* ln 2 in two parts: the first is exact in few bits */
    r -= n * 2.12194440e-4f;
    power = welkin__float((uint32_t)(127 - (int)n) << 23);
    p = 1.0f / 5040;
    p = p * r + 1.0f / 720;
    p = p * r + 1.0f / 120;
    p = p * r + 1.0f / 24;
    p = p * r + 1.0f / 6;
    p = p * r + 0.5f;
    p = p * r + 1.0f;
    return (1.0f - power) - power * (p * r);
}

/* (1 - T) w S at every wavelength, w the share of the constituents that scatter in the optical depth */
static void welkin__envelope(const welkin_sky *sky, const welkin__view *view, float *out)
{
    const welkin_file *f = sky->file;
    uint32_t absorbers = f->features >> WELKIN__ABSORBERS_SHIFT;
    double length = welkin__ray_length(sky, view), mean;
    float scattering[WELKIN_MAX_WAVELENGTHS];
    uint32_t k, w, i;
    for (w = 0; w < f->wavelengths; w++) out[w] = scattering[w] = 0;
    for (k = 0; k < f->constituents; k++) {
        const float *extinction = sky->extinction + (size_t)k * f->wavelengths;
        float column;
        for (i = 0, mean = 0; i < 4; i++)
            mean += view->alpha.weight[i] * (double)sky->column[(size_t)view->alpha.row[i] * f->constituents + k];
        column = welkin__narrow(length * exp(mean < 600 ? mean : 600)); /* stays finite */
        for (w = 0; w < f->wavelengths; w++) out[w] += extinction[w] * column;
        if ((absorbers >> k & 1) == 0)
            for (w = 0; w < f->wavelengths; w++) scattering[w] += extinction[w] * column;
    }
    for (w = 0; w < f->wavelengths; w++) {
        float share = absorbers == 0 ? 1 : out[w] > 0 ? scattering[w] / out[w] : 0;
        out[w] = welkin__absorbed(out[w]) * share * sky->level[w];
    }
}

static void welkin__sum_dense(const welkin_file *f, const welkin_table *t, const welkin__view *view, float *out)
{
    size_t phis = f->phi_intervals + 1, c = t->channels;
    int a, b;
    for (a = 0; a < 4; a++) {
        const float *plane = t->dense + view->alpha.row[a] * phis * c;
        const uint32_t *row = view->phi.row;
        float weight[4];
        for (b = 0; b < 4; b++) weight[b] = (float)(view->alpha.weight[a] * view->phi.weight[b]);
        welkin__add_rows(out, plane + row[0] * c, plane + row[1] * c, plane + row[2] * c, plane + row[3] * c, weight, t->channels);
    }
}

static void welkin__add_spline_rows(float *out, const float *table, const welkin__spline *s, uint32_t width)
{
    float weight[4];
    size_t w = width;
    int k;
    for (k = 0; k < 4; k++) weight[k] = (float)s->weight[k];
    welkin__add_rows(out, table + s->row[0] * w, table + s->row[1] * w, table + s->row[2] * w, table + s->row[3] * w, weight, width);
}

static void welkin__sum_factors(const welkin_table *t, const welkin__view *view, float *out)
{
    float weight[WELKIN_MAX_RANK], phi[WELKIN_MAX_RANK];
    uint32_t i;
    for (i = 0; i < t->row; i++) weight[i] = phi[i] = 0;
    welkin__add_spline_rows(weight, t->alpha, &view->alpha, t->row);
    welkin__add_spline_rows(phi, t->phi, &view->phi, t->row);
    for (i = 0; i < t->row; i++) weight[i] *= phi[i];
    welkin__add_components(t, weight, out);
}

/* The channels of a table in a direction. */
static void welkin__sum(const welkin_file *f, const welkin_table *t, const welkin__view *view, float *out)
{
    uint32_t c;
    for (c = 0; c < t->channels; c++) out[c] = 0;
    if (t->dense)
        welkin__sum_dense(f, t, view, out);
    else
        welkin__sum_factors(t, view, out);
}

static void welkin__apply_rayleigh(const float *p, size_t nw, float cosine, float *field)
{
    size_t w;
    for (w = 0; w < nw; w++) field[w] *= p[w] + p[nw + w] * (cosine * cosine);
}

static void welkin__apply_henyey_greenstein(const float *p, size_t nw, const welkin__view *view, float *field)
{
    float less = view->one_less_cos, plus = view->one_plus_cos;
    size_t w;
    for (w = 0; w < nw; w++) {
        float x = p[w] + p[nw + w] * less + p[2 * nw + w] * plus;
        field[w] *= p[3 * nw + w] / (x * sqrtf(x));
    }
}

/* ---- what estimates say about a direction ---- */

/* Columns above this (m) are as dark, and their sums over constituents, times an extinction, stay finite. */
#define WELKIN__MAX_COLUMN 1e30

/* A place along the ray where the estimates are computed. */
typedef struct welkin__stop {
    double distance, altitude, sun; /* sun: of its centre above the geometric horizon, in radii of the disc */
    double column[WELKIN__ESTIMATE_CONSTITUENTS]; /* to the observer */
    float density[WELKIN__ESTIMATE_CONSTITUENTS];
    float depth[WELKIN__ESTIMATE_WAVELENGTHS], sunlit[WELKIN__ESTIMATE_WAVELENGTHS]; /* p and its exp(-p) */
    float dimming[WELKIN__ESTIMATE_WAVELENGTHS], diffuse[WELKIN__ESTIMATE_WAVELENGTHS]; /* q and its exp(-q) */
} welkin__stop;

/* The ray of a direction. */
typedef struct welkin__ray {
    double fall, towards, length; /* towards: cosine of the angle between ray and sun */
    uint32_t count;
    double distance[3 + 2 * WELKIN__ESTIMATE_LEVELS + 2 * WELKIN__ESTIMATE_RINGS];
} welkin__ray;

static void welkin__add_stop(welkin__ray *ray, double distance)
{
    uint32_t i = ray->count;
    if (!(distance > 0 && distance < ray->length)) return;
    for (; i > 0 && ray->distance[i - 1] > distance; i--) ray->distance[i] = ray->distance[i - 1];
    ray->distance[i] = distance;
    ray->count++;
}

/* Roots of a x^2 + 2 b x + c, a > 0, without cancellation; 0 for none. */
static int welkin__roots(double a, double b, double c, double roots[2])
{
    double square = b * b - a * c, sum;
    if (!(square >= 0)) return 0;
    sum = b > 0 ? -b - sqrt(square) : -b + sqrt(square);
    roots[0] = sum / a;
    roots[1] = sum != 0 ? c / sum : 0;
    return 1;
}

/* Where a stop at the shadow counts: on the day side of the planet nearer and nearer to the observer. */
static double welkin__moved(const welkin_sky *sky, const welkin__ray *ray, double distance)
{
    double t;
    if (distance > ray->length) distance = ray->length;
    t = ((sky->file->planet_radius + sky->altitude) * sky->sun[2] + distance * ray->towards) / 300e3;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return distance * (1 - t * t * (3 - 2 * t));
}

/* Stops on the cylinders around the axis of the Earth's shadow, and where the ray is nearest to that axis. */
static void welkin__add_rings(const welkin_sky *sky, const welkin__view *view, welkin__ray *ray)
{
    double radius = sky->file->planet_radius, start = radius + sky->altitude, roots[2];
    double across = start * sqrt(sky->sun[0] * sky->sun[0] + sky->sun[1] * sky->sun[1]);
    const double *v = view->v, *s = sky->sun;
    double x = v[1] * s[2] - v[2] * s[1], y = v[2] * s[0] - v[0] * s[2], z = v[0] * s[1] - v[1] * s[0];
    double square = x * x + y * y + z * z, slope = start * (v[2] - s[2] * ray->towards);
    uint32_t i, rings = sky->file->estimate.rings;
    if (!(square >= 1e-9) || rings == 0) return;
    welkin__add_stop(ray, welkin__moved(sky, ray, -slope / square));
    for (i = 0; i < rings; i++) {
        double edge = radius + sky->estimate.ring[i];
        if (!welkin__roots(square, slope, (across - edge) * (across + edge), roots)) continue;
        welkin__add_stop(ray, welkin__moved(sky, ray, roots[0]));
        welkin__add_stop(ray, welkin__moved(sky, ray, roots[1]));
    }
}

static void welkin__find_stops(const welkin_sky *sky, const welkin__view *view, welkin__ray *ray)
{
    const welkin_file *f = sky->file;
    double radius = f->planet_radius, h = sky->altitude, roots[2];
    uint32_t i;
    ray->fall = (radius + h) * view->v[2];
    ray->towards = view->v[0] * sky->sun[0] + view->v[1] * sky->sun[1] + view->v[2] * sky->sun[2];
    ray->length = welkin__ray_length(sky, view);
    ray->distance[0] = 0;
    ray->count = 1;
    for (i = 1; i < f->estimate.levels; i++) {
        double z = sky->estimate.level[i];
        if (!welkin__roots(1, ray->fall, (h - z) * (2 * radius + h + z), roots)) continue;
        welkin__add_stop(ray, roots[0]);
        welkin__add_stop(ray, roots[1]);
    }
    if (view->up) welkin__add_stop(ray, -ray->fall);
    welkin__add_rings(sky, view, ray);
    ray->distance[ray->count++] = ray->length;
}

/* A place on an axis of n nodes: the share of the node behind `node`. */
typedef struct welkin__place {
    uint32_t node;
    double share;
} welkin__place;

static welkin__place welkin__place_at(double coordinate, uint32_t n)
{
    welkin__place place;
    if (!(coordinate > 0)) coordinate = 0;
    if (coordinate > (double)(n - 1)) coordinate = (double)(n - 1);
    place.node = (uint32_t)coordinate;
    if (place.node > n - 2) place.node = n - 2;
    place.share = coordinate - (double)place.node;
    return place;
}

static welkin__place welkin__level_place(const welkin_sky *sky, double altitude)
{
    const double *level = sky->estimate.level;
    uint32_t i = 0;
    welkin__place place;
    while (i + 2 < sky->file->estimate.levels && level[i + 1] <= altitude) i++;
    place = welkin__place_at((altitude - level[i]) / (level[i + 1] - level[i]), 2);
    place.node = i;
    return place;
}

/* A point of the ray, |P| = radius + altitude: altitude, and the square of the distance from the horizon. */
static double welkin__altitude_at(const welkin_sky *sky, const welkin__ray *ray, double distance, double *horizon)
{
    double radius = sky->file->planet_radius;
    *horizon = fmax(0, sky->altitude * (2 * radius + sky->altitude) + distance * (distance + 2 * ray->fall));
    return *horizon / (radius + sqrt(radius * radius + *horizon));
}

static void welkin__densities(const welkin_sky *sky, double altitude, float *density)
{
    uint32_t n = sky->file->estimate.densities, k;
    welkin__place place = welkin__place_at((n - 1) * sqrt(altitude / sky->file->top_altitude), n);
    const float *row = sky->estimate.density + 8 * (size_t)place.node;
    float share = (float)place.share;
    for (k = 0; k < 8; k++) density[k] = (1 - share) * row[k] + share * row[8 + k];
}

/* Visible share of the sun's disc. */
static double welkin__disc(double x)
{
    if (x <= -1) return 0;
    return x >= 1 ? 1 : 0.5 + (x * sqrt(1 - x * x) + asin(x)) / WELKIN__PI;
}

/* Its integral over x, within -1..=1. */
static double welkin__disc_integral(double x)
{
    double square = fmax(0, 1 - x * x), root = sqrt(square);
    return x / 2 + (root - square * root / 3 + x * asin(x)) / WELKIN__PI;
}

/* Height of the visible part's centroid above the horizon. */
static double welkin__disc_height(double x)
{
    double square = 1 - x * x;
    if (x >= 1) return x;
    return x <= -0.999 ? 0 : fmax(0, x + 2 / (3 * WELKIN__PI) * square * sqrt(square) / welkin__disc(x));
}

/* Share of a panel's air before a share of its length, where the panel climbs by `climb` scale heights. */
static double welkin__air_before(double t, double climb)
{
    double steep = fmax(fabs(climb), 0.001);
    t = fmin(fmax(t, 0), 1);
    return climb > 0 ? expm1(-steep * t) / expm1(-steep) : 1 - expm1(-steep * (1 - t)) / expm1(-steep);
}

/* Share of a panel's air that the sun shines on. */
static double welkin__visible_share(const welkin__stop *from, const welkin__stop *to)
{
    double a = from->sun, b = to->sun, climb = (to->altitude - from->altitude) / 8000, pa, pb, mean;
    double a1 = fmin(fmax(a, -1), 1), b1 = fmin(fmax(b, -1), 1);
    if ((a >= 1 && b >= 1) || (a <= -1 && b <= -1)) return a > 0 ? 1 : 0;
    if (fabs(b - a) < 0.01) return welkin__disc((a + b) / 2);
    pa = welkin__air_before((a1 - a) / (b - a), climb);
    pb = welkin__air_before((b1 - a) / (b - a), climb);
    mean = fabs(b1 - a1) < 0.01 ? welkin__disc((a1 + b1) / 2) : (welkin__disc_integral(b1) - welkin__disc_integral(a1)) / (b1 - a1);
    return fmin(fmax((a >= 1 ? pa : 0) + (pb - pa) * mean + (b >= 1 ? 1 - pb : 0), 0), 1);
}

/* exp(-x), as if each x were within -88..=87 or infinite, without branches that keep it from being vectorised. */
static void welkin__decay(const float *values, uint32_t count, float *out)
{
    uint32_t i;
    for (i = 0; i < count; i++) {
        float x = values[i] < 87.0f ? values[i] : 87.0f, n, r, power, p;
        x = x > -88.0f ? x : -88.0f;
        n = (float)((int)(x * 1.44269504f + 128.5f) - 128);
        r = n * 0.693359375f - x; /* as in welkin__absorbed */
        r -= n * 2.12194440e-4f;
        power = welkin__float((uint32_t)(127 - (int)n) << 23);
        p = 1.0f / 5040;
        p = p * r + 1.0f / 720;
        p = p * r + 1.0f / 120;
        p = p * r + 1.0f / 24;
        p = p * r + 1.0f / 6;
        p = p * r + 0.5f;
        p = p * r + 1.0f;
        p = p * r + 1.0f;
        out[i] = values[i] < 87.0f ? power * p : 0.0f;
    }
}

/* Means of exp(-x) between p and q, where it is at_p and at_q. */
static void welkin__mean_decay(const float *p, const float *q, const float *at_p, const float *at_q, uint32_t count,
                               float *out)
{
    uint32_t i;
    for (i = 0; i < count; i++) {
        float x = q[i] - p[i], series, ratio;
        int alike = fabsf(x) < 0.25f;
        series = 1.0f / 120 - x * (1.0f / 720);
        series = 1.0f / 24 - x * series;
        series = 1.0f / 6 - x * series;
        series = 0.5f - x * series;
        series = at_p[i] * (1.0f - x * series);
        ratio = (at_p[i] - at_q[i]) / (alike ? 1.0f : x);
        out[i] = alike ? series : ratio;
    }
}

/* Sums over constituents of a table's rows times columns, eight wavelengths at a time. */
static void welkin__sum_columns(const welkin_sky *sky, const float *table, const double *column, float *out)
{
    float c[WELKIN__ESTIMATE_CONSTITUENTS], sum[8];
    size_t row = sky->estimate.row, nk = sky->file->constituents, k, w;
    int i;
    for (k = 0; k < nk; k++) c[k] = welkin__narrow(column[k]);
    for (w = 0; w + 8 <= row; w += 8) {
        for (i = 0; i < 8; i++) sum[i] = 0;
        for (k = 0; k < nk; k++)
            for (i = 0; i < 8; i++) sum[i] += table[k * row + w + (size_t)i] * c[k];
        for (i = 0; i < 8; i++) out[w + (size_t)i] = sum[i];
    }
}

/* Adds a share of ln of the columns from a level to the sun, of which so many radii are seen at a place with a dip. */
static void welkin__add_columns_to_sun(const welkin_sky *sky, uint32_t level, double seen, double dip, double share,
                                       double *column)
{
    double radius = sky->file->planet_radius, z = sky->estimate.level[level];
    double own = atan(sqrt(z * (2 * radius + z)) / radius), range = WELKIN__HALF_PI + own;
    double angle = fmax(0, seen * WELKIN__SUN_RADIUS + (own - dip) * seen / (seen + 1));
    uint32_t n = sky->file->estimate.angles, k;
    welkin__place place = welkin__place_at((n - 1) * angle * (range + 0.1) / (range * (angle + 0.1)), n);
    const float *row = sky->estimate.column + 8 * ((size_t)level * n + place.node);
    for (k = 0; k < sky->file->constituents; k++)
        column[k] += share * ((1 - place.share) * (double)row[k] + place.share * (double)row[8 + k]);
}

/* Columns from a stop to the sun. */
static void welkin__columns_to_sun(const welkin_sky *sky, const welkin__place *level, double height, double dip,
                                   double *column)
{
    double seen = welkin__disc_height(height);
    uint32_t k;
    for (k = 0; k < sky->file->constituents; k++) column[k] = 0;
    welkin__add_columns_to_sun(sky, level->node, seen, dip, 1 - level->share, column);
    welkin__add_columns_to_sun(sky, level->node + 1, seen, dip, level->share, column);
    for (k = 0; k < sky->file->constituents; k++) column[k] = exp(column[k]);
}

/* ln of the diffuse light at a stop. */
static void welkin__diffuse_light(const welkin_sky *sky, const welkin__place *level, double sine, float *light)
{
    const welkin_estimate_tables *t = &sky->estimate;
    uint32_t n = sky->file->estimate.suns, w;
    welkin__place place = welkin__place_at((asinh(sine / sky->file->estimate.sun_width) - t->sun_start) * t->sun_scale, n);
    const float *low = t->light + ((size_t)level->node * n + place.node) * t->row, *high = low + (size_t)n * t->row;
    float weight[4];
    weight[0] = (float)((1 - level->share) * (1 - place.share));
    weight[1] = (float)((1 - level->share) * place.share);
    weight[2] = (float)(level->share * (1 - place.share));
    weight[3] = (float)(level->share * place.share);
    for (w = 0; w < t->row; w++) light[w] = 0;
    welkin__add_rows(light, low, low + t->row, high, high + t->row, weight, t->row);
}

/* Depths of a stop, whose distance, altitude and columns are known. */
static void welkin__light_stop(const welkin_sky *sky, const welkin__ray *ray, double horizon, welkin__stop *stop)
{
    double radius = sky->file->planet_radius, dip = atan(sqrt(horizon) / radius), columns[WELKIN__ESTIMATE_CONSTITUENTS];
    double sine = ((radius + sky->altitude) * sky->sun[2] + stop->distance * ray->towards) / (radius + stop->altitude);
    float light[WELKIN__ESTIMATE_WAVELENGTHS];
    welkin__place level = welkin__level_place(sky, stop->altitude);
    uint32_t k, w, row = sky->estimate.row;
    sine = fmin(fmax(sine, -1), 1);
    stop->sun = (asin(sine) + dip) / WELKIN__SUN_RADIUS;
    welkin__columns_to_sun(sky, &level, stop->sun, dip, columns);
    welkin__diffuse_light(sky, &level, sine, light);
    for (k = 0; k < sky->file->constituents; k++) columns[k] = fmin(columns[k] + stop->column[k], WELKIN__MAX_COLUMN);
    welkin__sum_columns(sky, sky->estimate.extinction, columns, stop->depth);
    welkin__sum_columns(sky, sky->estimate.extinction, stop->column, stop->dimming);
    for (w = 0; w < row; w++) stop->dimming[w] -= light[w];
    welkin__decay(stop->depth, row, stop->sunlit);
    welkin__decay(stop->dimming, row, stop->diffuse);
}

/* Adds the columns of the panel before the stop, which has its density. */
static void welkin__add_panel_columns(const welkin_sky *sky, const welkin__ray *ray, const welkin__stop *before,
                                      welkin__stop *stop, double *panel)
{
    float middle[WELKIN__ESTIMATE_CONSTITUENTS];
    double horizon;
    uint32_t k;
    welkin__densities(sky, welkin__altitude_at(sky, ray, (before->distance + stop->distance) / 2, &horizon), middle);
    for (k = 0; k < sky->file->constituents; k++) {
        double sum = (double)before->density[k] + 4 * (double)middle[k] + (double)stop->density[k];
        panel[k] = (stop->distance - before->distance) / 6 * sum;
        stop->column[k] = before->column[k] + panel[k];
    }
}

/* Adds the light of a panel to one estimate. */
static void welkin__add_light(const welkin_sky *sky, uint32_t index, const double *panel, const float *mean, float *sum)
{
    float scattered[WELKIN__ESTIMATE_WAVELENGTHS];
    uint32_t row = sky->estimate.row, w;
    welkin__sum_columns(sky, sky->estimate.scattering + (size_t)index * sky->file->constituents * row, panel, scattered);
    for (w = 0; w < row; w++) sum[w] += mean[w] * scattered[w];
}

static void welkin__add_panel(const welkin_sky *sky, const welkin__stop *from, const welkin__stop *to,
                              const double *panel, float (*estimates)[WELKIN__ESTIMATE_WAVELENGTHS])
{
    uint32_t last = sky->file->estimate.estimates - 1, row = sky->estimate.row, q, w;
    float mean[WELKIN__ESTIMATE_WAVELENGTHS], share = last > 0 ? (float)welkin__visible_share(from, to) : 0;
    welkin__mean_decay(from->dimming, to->dimming, from->diffuse, to->diffuse, row, mean);
    welkin__add_light(sky, last, panel, mean, estimates[last]);
    if (!(share > 0)) return;
    welkin__mean_decay(from->depth, to->depth, from->sunlit, to->sunlit, row, mean);
    for (w = 0; w < row; w++) mean[w] *= share;
    for (q = 0; q < last; q++) welkin__add_light(sky, q, panel, mean, estimates[q]);
}

/* The estimates of a direction. An observer on the ground who looks down has one panel without air. */
static void welkin__estimate(const welkin_sky *sky, const welkin__view *view,
                             float (*estimates)[WELKIN__ESTIMATE_WAVELENGTHS])
{
    uint32_t last = sky->file->estimate.estimates - 1, row = sky->estimate.row, i, q, w;
    double panel[WELKIN__ESTIMATE_CONSTITUENTS], horizon;
    welkin__stop stops[2];
    welkin__ray ray;
    welkin__find_stops(sky, view, &ray);
    for (q = 0; q <= last; q++)
        for (w = 0; w < row; w++) estimates[q][w] = 0;
    for (i = 0; i < ray.count; i++) {
        welkin__stop *stop = &stops[i & 1u], *before = &stops[(i & 1u) ^ 1u];
        stop->distance = ray.distance[i];
        stop->altitude = welkin__altitude_at(sky, &ray, stop->distance, &horizon);
        welkin__densities(sky, stop->altitude, stop->density);
        if (i > 0)
            welkin__add_panel_columns(sky, &ray, before, stop, panel);
        else
            memset(stop->column, 0, sizeof stop->column);
        welkin__light_stop(sky, &ray, horizon, stop);
        if (i > 0) welkin__add_panel(sky, before, stop, panel, estimates);
    }
    for (q = 0; q < last; q++)
        for (w = 0; w < row; w++) estimates[q][w] = estimates[q][w] * (float)(0.25 / WELKIN__PI) + 0.001f * estimates[last][w];
}

/* What makes light of the channels: (1 - T) w S for all, or an estimate for each field. */
typedef struct welkin__light {
    float envelope[WELKIN_MAX_WAVELENGTHS]; /* 1 with estimates */
    float estimate[WELKIN__ESTIMATES][WELKIN__ESTIMATE_WAVELENGTHS];
    const float *diffuse; /* the last estimate, or null */
} welkin__light;

static void welkin__find_light(const welkin_sky *sky, const welkin__view *view, welkin__light *light)
{
    uint32_t w;
    light->diffuse = NULL;
    if (!welkin__has_estimates(sky->file)) {
        welkin__envelope(sky, view, light->envelope);
        return;
    }
    for (w = 0; w < sky->file->wavelengths; w++) light->envelope[w] = 1;
    welkin__estimate(sky, view, light->estimate);
    light->diffuse = light->estimate[sky->file->estimate.estimates - 1];
}

/* ---- radiance ---- */

/* Sum of the fields times estimates, phase functions and ground; and of what polarises, if asked. */
static void welkin__sum_fields(const welkin_sky *sky, const welkin__view *view, const welkin__light *light, float *sum,
                               float *polarising)
{
    const welkin_file *f = sky->file;
    float channels[WELKIN_MAX_FIELDS * WELKIN_MAX_WAVELENGTHS];
    size_t nw = f->wavelengths, w;
    uint32_t i;
    welkin__sum(f, &sky->radiance, view, channels);
    for (i = 0; i < f->fields; i++) {
        const float *p = sky->phase + 4 * i * nw;
        float *field = channels + i * nw;
        uint32_t code = welkin__field(f, i), phase = code & 0xFFFFu;
        const float *estimate = light->estimate[welkin__field_estimate(f, i)];
        if (light->diffuse)
            for (w = 0; w < nw; w++) field[w] *= estimate[w];
        if (code >> 16 & 1u)
            for (w = 0; w < nw; w++) field[w] *= sky->bounce[w];
        if (polarising && phase == 1)
            for (w = 0; w < nw; w++) polarising[w] += p[nw + w] * field[w];
        if (phase == 1) welkin__apply_rayleigh(p, nw, view->cos_gamma, field);
        if (phase == 2) welkin__apply_henyey_greenstein(p, nw, view, field);
        for (w = 0; w < nw; w++) sum[w] += field[w];
    }
}

/* Looks at the sum too: where it is not a number, the larger of it and 0 would hide that. */
static welkin_error welkin__finish(uint32_t nw, const float *envelope, const float *sum, float *radiance)
{
    int good = 1;
    uint32_t w;
    for (w = 0; w < nw; w++) {
        radiance[w] = envelope[w] * (sum[w] > 0 ? sum[w] : 0);
        good &= fabsf(sum[w]) <= FLT_MAX && radiance[w] <= FLT_MAX;
    }
    return good ? WELKIN_OK : WELKIN_ERROR_VALUE;
}

WELKIN_API welkin_error welkin_radiance(const welkin_sky *sky, const double direction[3], float *radiance)
{
    float sum[WELKIN_MAX_WAVELENGTHS];
    welkin__light light;
    welkin__view view;
    uint32_t w;
    welkin_error error = welkin__look(sky, direction, &view);
    if (error) return error;
    for (w = 0; w < sky->file->wavelengths; w++) sum[w] = 0;
    welkin__find_light(sky, &view, &light);
    welkin__sum_fields(sky, &view, &light, sum, NULL);
    return welkin__finish(sky->file->wavelengths, light.envelope, sum, radiance);
}

/* ---- polarisation ---- */

/* In f64, where the squares of all f32 numbers are finite. */
static welkin_error welkin__limit_polarisation(float radiance, double q, double u, float *q_out, float *u_out)
{
    double size = sqrt(q * q + u * u), factor = size > (double)radiance ? (double)radiance / size : 1;
    if (!(size <= DBL_MAX)) return WELKIN_ERROR_VALUE;
    *q_out = welkin__narrow(q * factor);
    *u_out = welkin__narrow(u * factor);
    return WELKIN_OK;
}

WELKIN_API welkin_error welkin_stokes(const welkin_sky *sky, const double direction[3], float *radiance, float *q,
                                      float *u)
{
    float sum[WELKIN_MAX_WAVELENGTHS] = {0}, polarising[WELKIN_MAX_WAVELENGTHS] = {0}, multiple[4 * WELKIN_MAX_WAVELENGTHS];
    welkin__light light;
    double p1, p2, level = sky->sun[0] * sky->cos_azimuth + sky->sun[1] * sky->sin_azimuth;
    welkin__view view;
    uint32_t nw, w;
    welkin_error error = WELKIN_ERROR_MISSING;
    if (!sky->file || sky->flags & WELKIN_POLARISED) error = welkin__look(sky, direction, &view);
    if (error) return error;
    nw = sky->file->wavelengths;
    welkin__find_light(sky, &view, &light);
    welkin__sum_fields(sky, &view, &light, sum, polarising);
    error = welkin__finish(nw, light.envelope, sum, radiance);
    if (error) return error;
    welkin__sum(sky->file, &sky->polarisation, &view, multiple);
    p1 = view.level * sky->sun[2] - view.v[2] * level * view.cos_phi;
    p2 = level * view.sin_phi;
    for (w = 0; w < nw && !error; w++) {
        double d = (double)polarising[w], bounce = (double)sky->bounce[w], size = (double)light.envelope[w];
        double diffuse = light.diffuse ? (double)light.diffuse[w] : 1;
        double q_more = diffuse * ((double)multiple[w] + bounce * (double)multiple[2 * nw + w]);
        double u_more = diffuse * ((double)multiple[nw + w] + bounce * (double)multiple[3 * nw + w]);
        double q_sum = d * (p2 * p2 - p1 * p1) + q_more;
        double u_sum = -2 * d * p1 * p2 + sky->fade * view.sin_phi * u_more;
        error = welkin__limit_polarisation(radiance[w], size * q_sum, size * u_sum, &q[w], &u[w]);
    }
    return error;
}

/* ---- wavelengths and colour ---- */

WELKIN_API double welkin_wavelength(const welkin_file *f, uint32_t index)
{
    return index < f->wavelengths ? welkin__f64(f->bytes + f->wavelength_at + 8 * (size_t)index) : 0;
}

WELKIN_API double welkin_altitude(const welkin_file *f, uint32_t index)
{
    return index < f->altitudes ? welkin__f64(f->bytes + f->altitude_at + 8 * (size_t)index) : 0;
}

WELKIN_API double welkin_visibility(const welkin_file *f, uint32_t index)
{
    return index < f->visibilities ? welkin__f64(f->bytes + f->visibility_at + 8 * (size_t)index) : 0;
}

WELKIN_API void welkin_xyz(const welkin_file *f, const float *radiance, double xyz[3])
{
    uint32_t w, i;
    for (i = 0; i < 3; i++) xyz[i] = 0;
    for (w = 0; w < f->wavelengths; w++)
        for (i = 0; i < 3; i++) xyz[i] += (double)radiance[w] * welkin__f64(f->bytes + f->xyz_at + 8 * (3 * (size_t)w + i));
}

/* The wavelengths between which the file answers. */
static welkin_error welkin__spectral_axis(const welkin_file *f, const unsigned char **axis, uint32_t *n)
{
    int nodes = f->spectrum.error == WELKIN_ERROR_MISSING;
    if (!f->bytes) return WELKIN_ERROR_STATE;
    *axis = nodes ? f->bytes + f->wavelength_at : f->spectrum.wavelength;
    *n = nodes ? f->wavelengths : f->spectrum.cells;
    return nodes ? WELKIN_OK : f->spectrum.error;
}

WELKIN_API welkin_error welkin_wavelength_range(const welkin_file *f, double range[2])
{
    const unsigned char *axis;
    uint32_t n;
    welkin_error error = welkin__spectral_axis(f, &axis, &n);
    if (error) return error;
    range[0] = welkin__f64(axis);
    range[1] = welkin__f64(axis + 8 * (size_t)(n - 1));
    return WELKIN_OK;
}

static welkin_error welkin__check_wavelength(const welkin_file *f, double wavelength)
{
    const unsigned char *axis;
    uint32_t n;
    welkin_error error = welkin__spectral_axis(f, &axis, &n);
    if (error) return error;
    return welkin__is_on_axis(axis, n, wavelength) ? WELKIN_OK : WELKIN_ERROR_RANGE;
}

/* L, Q/L and U/L between the nodes of a file without a spectrum. Without Q and U only the first. */
static void welkin__light_of_nodes(const welkin_file *f, const float *radiance, const float *q, const float *u,
                                   double wavelength, double light[3])
{
    const unsigned char *axis = f->bytes + f->wavelength_at;
    welkin__stencil cubic = welkin__cubic(axis, f->wavelengths, wavelength, WELKIN__PLAIN), linear;
    double logarithm = 0, plain = 0;
    int dark = 0;
    uint32_t i;
    light[1] = light[2] = 0;
    for (i = 0; i < cubic.count; i++) {
        double node = (double)radiance[cubic.node[i]];
        if (cubic.weight[i] == 0) continue;
        if (!(node > 0)) {
            dark = 1;
            continue;
        }
        logarithm += cubic.weight[i] * log(node);
        if (!q) continue;
        light[1] += cubic.weight[i] * (double)q[cubic.node[i]] / node;
        light[2] += cubic.weight[i] * (double)u[cubic.node[i]] / node;
    }
    light[0] = exp(logarithm);
    if (!dark) return;
    linear = welkin__linear(axis, f->wavelengths, wavelength, WELKIN__PLAIN);
    for (i = 0; i < linear.count; i++) plain += linear.weight[i] * (double)radiance[linear.node[i]];
    light[0] = plain;
}

/* Tables of the nodes: ln L, none less than 2^-27 of the largest, Q/L and U/L. */
typedef struct welkin__node_tables {
    int parts; /* 1, or 3 with Q and U */
    double table[3][WELKIN_MAX_WAVELENGTHS];
} welkin__node_tables;

/* Whether there is light at all. */
static int welkin__tabulate(uint32_t nw, const float *radiance, const float *q, const float *u,
                            welkin__node_tables *nodes)
{
    double largest = 0;
    uint32_t w;
    for (w = 0; w < nw; w++) largest = fmax(largest, (double)radiance[w]);
    if (!(largest > 0)) return 0;
    nodes->parts = q ? 3 : 1;
    for (w = 0; w < nw; w++) {
        double node = (double)radiance[w];
        nodes->table[0][w] = log(fmax(node, largest / 134217728));
        if (!q) continue;
        nodes->table[1][w] = node > 0 ? (double)q[w] / node : 0;
        nodes->table[2][w] = node > 0 ? (double)u[w] / node : 0;
    }
    return 1;
}

/* What the taps of a term make of a table of the nodes. */
static double welkin__term_sum(const welkin_file *f, size_t term, const double *table)
{
    const welkin_spectrum *s = &f->spectrum;
    double sum = 0;
    size_t i;
    for (i = term * s->taps; i < (term + 1) * s->taps; i++) {
        uint32_t node = welkin__u32(s->tap_node + 4 * i);
        if (node < f->wavelengths) sum += (double)welkin__f32(s->tap_weight + 4 * i) * table[node]; /* is, unless a mapped file changed */
    }
    return sum;
}

/* ln L, Q/L and U/L of a cell, the mean over its terms. Exponentials are of differences from the brightest. */
static void welkin__cell_light(const welkin_file *f, uint32_t cell, const welkin__node_tables *nodes, double light[3])
{
    double logarithm[WELKIN__CELL_TERMS], brightest = -DBL_MAX, total = 0;
    uint32_t first, i, count = welkin__cell_terms(&f->spectrum, cell, &first);
    int k;
    light[1] = light[2] = 0;
    for (i = 0; i < count; i++) {
        logarithm[i] = welkin__term_sum(f, first + i, nodes->table[0]);
        if (welkin__f32(f->spectrum.term_weight + 4 * (size_t)(first + i)) > 0) brightest = fmax(brightest, logarithm[i]);
    }
    for (i = 0; i < count; i++) {
        double weight = (double)welkin__f32(f->spectrum.term_weight + 4 * (size_t)(first + i));
        if (!(weight > 0)) continue;
        weight *= exp(logarithm[i] - brightest);
        total += weight;
        for (k = 1; k < nodes->parts; k++) light[k] += weight * welkin__term_sum(f, first + i, nodes->table[k]);
    }
    light[0] = brightest + log(total);
    for (k = 1; k < nodes->parts; k++) light[k] /= total;
}

/* L, Q/L and U/L from the spectrum. */
static void welkin__light_of_cells(const welkin_file *f, const float *radiance, const float *q, const float *u,
                                   double wavelength, double light[3])
{
    welkin__stencil cells = welkin__linear(f->spectrum.wavelength, f->spectrum.cells, wavelength, WELKIN__PLAIN);
    welkin__node_tables nodes;
    double cell[3];
    uint32_t c;
    int k;
    for (k = 0; k < 3; k++) light[k] = 0;
    if (!welkin__tabulate(f->wavelengths, radiance, q, u, &nodes)) return;
    for (c = 0; c < cells.count; c++) {
        welkin__cell_light(f, cells.node[c], &nodes, cell);
        for (k = 0; k < 3; k++) light[k] += cells.weight[c] * cell[k];
    }
    light[0] = exp(light[0]);
}

static welkin_error welkin__light_at(const welkin_file *f, const float *radiance, const float *q, const float *u,
                                     double wavelength, double light[3])
{
    welkin_error error = welkin__check_wavelength(f, wavelength);
    if (error) return error;
    if (f->spectrum.error == WELKIN_ERROR_MISSING)
        welkin__light_of_nodes(f, radiance, q, u, wavelength, light);
    else
        welkin__light_of_cells(f, radiance, q, u, wavelength, light);
    return light[0] <= DBL_MAX ? WELKIN_OK : WELKIN_ERROR_VALUE;
}

WELKIN_API welkin_error welkin_radiance_at(const welkin_file *f, const float *radiance, double wavelength,
                                           double *value)
{
    double light[3];
    welkin_error error = welkin__light_at(f, radiance, NULL, NULL, wavelength, light);
    if (!error) *value = light[0];
    return error;
}

WELKIN_API welkin_error welkin_stokes_at(const welkin_file *f, const float *radiance, const float *q, const float *u,
                                         double wavelength, double stokes[3])
{
    double light[3], degree;
    welkin_error error = welkin__light_at(f, radiance, q, u, wavelength, light);
    if (error) return error;
    degree = fmax(1, sqrt(light[1] * light[1] + light[2] * light[2])); /* weights below 0 can overshoot */
    stokes[0] = light[0];
    stokes[1] = light[1] / degree * light[0];
    stokes[2] = light[2] / degree * light[0];
    return WELKIN_OK;
}

WELKIN_API welkin_error welkin_irradiance_at(const welkin_file *f, double wavelength, double *value)
{
    const unsigned char *p, *samples;
    welkin__spline at;
    double u, t;
    uint32_t i;
    welkin_error error = welkin__check_wavelength(f, wavelength);
    if (error) return error;
    p = f->bytes + f->solar_range_at;
    samples = f->bytes + f->solar_at;
    u = (wavelength - welkin__f64(p)) / welkin__f64(p + 8);
    at = welkin__free_spline(u, f->solar_samples - 1); /* for its clamped interval */
    i = at.row[0];
    t = fmin(fmax(u - (double)i, 0), 1);
    *value = (1 - t) * (double)welkin__f32(samples + 4 * (size_t)i) + t * (double)welkin__f32(samples + 4 * (size_t)(i + 1));
    return WELKIN_OK;
}

/* ---- colour spaces ---- */

static const char *const welkin__space_names[4] = {"srgb", "rec2020", "acescg", "xyz"};

WELKIN_API const char *welkin_colour_space_name(welkin_colour_space space)
{
    return (unsigned)space < 4 ? welkin__space_names[space] : NULL;
}

WELKIN_API welkin_error welkin_colour_space_named(const char *name, welkin_colour_space *space)
{
    int i;
    for (i = 0; name && i < 4; i++)
        if (strcmp(name, welkin__space_names[i]) == 0) {
            *space = (welkin_colour_space)i;
            return WELKIN_OK;
        }
    return WELKIN_ERROR_RANGE;
}

WELKIN_API welkin_error welkin_rgb(welkin_colour_space space, const double xyz[3], double rgb[3])
{
    /* Rows of red, green and blue; inverses of primaries and white, the third after Bradford's adaptation. */
    static const double matrix[4][3][3] = {{{3.24097, -1.5373832, -0.49861076},
                                            {-0.96924365, 1.8759675, 0.04155506},
                                            {0.05563008, -0.20397696, 1.0569715}},
                                           {{1.7166512, -0.35567078, -0.2533663},
                                            {-0.6666843, 1.6164812, 0.015768546},
                                            {0.017639857, -0.042770613, 0.9421031}},
                                           {{1.6605853, -0.31529556, -0.24150933},
                                            {-0.65992606, 1.6083915, 0.017298595},
                                            {0.009002569, -0.0035668764, 0.9136433}},
                                           {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    double x = xyz[0], y = xyz[1], z = xyz[2]; /* the caller may convert in place */
    int good = 1, i;
    if ((unsigned)space >= 4) return WELKIN_ERROR_RANGE;
    for (i = 0; i < 3; i++) {
        const double *row = matrix[space][i];
        rgb[i] = row[0] * x + row[1] * y + row[2] * z;
        good &= fabs(rgb[i]) <= DBL_MAX;
    }
    return good ? WELKIN_OK : WELKIN_ERROR_VALUE;
}

/* ---- baked skies ----
 *
 * The table is uniform in three coordinates, which are 0 at the geometric horizon and at the azimuth of the sun:
 *
 *     up       above the horizon; dense at the horizon and at the height of the sun
 *     down     below the horizon; dense there
 *     azimuth  between a direction and the sun, either way; denser at the sun
 *
 * The horizon has nodes on both sides, and nothing is interpolated across it: the jump stays one. The rule is cubic
 * with the slopes of parabolas through three nodes, as in the specification between chunks; azimuths are level at both
 * ends, where the sky is symmetric. Square roots are what is interpolated, so light does not become negative.
 *
 * The distribution has a density that is constant in a cell between nodes: the mean luminance of its corners. */

#define WELKIN__HEIGHT_SCALE 0.06 /* rad: how wide the dense parts of the coordinates are */
#define WELKIN__AZIMUTH_SCALE 0.8
#define WELKIN__BESIDE_HORIZON 1e-11 /* rad: where the sides of the horizon are looked at */
#define WELKIN__EVEN_SHARE 1e-3 /* of samples, over all cells alike: what is dark at the corners may not be within */

/* asinh, faster and less exact near 0, where nothing depends on it. */
static double welkin__asinh(double x) { return log(x + sqrt(x * x + 1)); }

/* From an angle above or below the horizon to a coordinate, 2 asinh sqrt(angle / scale), and back. The square root
 * resolves rays that graze the ground, whose length has an infinite slope there. */
static double welkin__from_horizon(double angle)
{
    double x = angle / WELKIN__HEIGHT_SCALE;
    return log(1 + 2 * x + 2 * sqrt(x * (x + 1)));
}

static double welkin__horizon_angle(double coordinate)
{
    double s = sinh(coordinate / 2);
    return WELKIN__HEIGHT_SCALE * s * s;
}

/* From half the height of the sun on, the coordinate is about the sun. */
static void welkin__place_sun(welkin_baked *b, double height)
{
    b->sun_height = fmax(0, height);
    b->turn_at = welkin__from_horizon(b->sun_height / 2);
    b->sun_at = b->turn_at + welkin__asinh(b->sun_height / 2 / WELKIN__HEIGHT_SCALE);
}

static double welkin__up_coordinate(const welkin_baked *b, double height)
{
    if (height < b->sun_height / 2) return welkin__from_horizon(height);
    return b->sun_at + welkin__asinh((height - b->sun_height) / WELKIN__HEIGHT_SCALE);
}

static double welkin__up_height(const welkin_baked *b, double coordinate)
{
    if (coordinate < b->turn_at) return welkin__horizon_angle(coordinate);
    return b->sun_height + WELKIN__HEIGHT_SCALE * sinh(coordinate - b->sun_at);
}

/* Elevation of a row of nodes: `up` + 1 of them from the horizon to the zenith, then those from it to the nadir. */
static double welkin__row_elevation(const welkin_baked *b, uint32_t row)
{
    uint32_t up = b->resolution.up, down = b->resolution.down;
    if (row <= up) return welkin__up_height(b, b->up_end * row / up) - b->dip;
    return -welkin__horizon_angle(b->down_end * (row - up - 1) / down) - b->dip;
}

static double welkin__column_azimuth(const welkin_baked *b, uint32_t column)
{
    return WELKIN__AZIMUTH_SCALE * sinh(b->azimuth_end * column / b->resolution.azimuths);
}

/* Where a direction is in the table. */
typedef struct welkin__table_place {
    int up;
    double row, column; /* coordinates in intervals; rows count from the horizon */
} welkin__table_place;

static double welkin__intervals_before(double coordinate, double end, uint32_t intervals)
{
    return fmin(fmax(intervals * coordinate / end, 0), intervals);
}

static welkin_error welkin__find_place(const welkin_baked *b, const double direction[3], welkin__table_place *place)
{
    double v[3], height, along, across;
    welkin_error error = b->root ? welkin__normalise(direction, v) : WELKIN_ERROR_STATE;
    if (error) return error;
    height = atan2(v[2], sqrt(v[0] * v[0] + v[1] * v[1])) + b->dip;
    along = v[0] * b->cos_azimuth + v[1] * b->sin_azimuth;
    across = v[1] * b->cos_azimuth - v[0] * b->sin_azimuth;
    place->up = height >= 0;
    place->row = place->up ? welkin__intervals_before(welkin__up_coordinate(b, height), b->up_end, b->resolution.up)
                           : welkin__intervals_before(welkin__from_horizon(-height), b->down_end, b->resolution.down);
    place->column = welkin__intervals_before(welkin__asinh(atan2(fabs(across), along) / WELKIN__AZIMUTH_SCALE),
                                             b->azimuth_end, b->resolution.azimuths);
    return WELKIN_OK;
}

static uint32_t welkin__cell_at(double coordinate, uint32_t intervals)
{
    return coordinate < intervals ? (uint32_t)coordinate : intervals - 1;
}

/* The rule between nodes; slopes at the ends are 0 or those of one-sided parabolas. */
static welkin__spline welkin__between(double coordinate, uint32_t intervals, int level_ends)
{
    uint32_t cell = welkin__cell_at(coordinate, intervals), k;
    double t = coordinate - cell, first = t * (1 - t) * (1 - t), second = t * t * (t - 1);
    welkin__spline s;
    double *w = s.weight;
    w[0] = w[3] = 0;
    w[2] = intervals > 1 || level_ends ? t * t * (3 - 2 * t) : t;
    w[1] = 1 - w[2];
    if (cell > 0) {
        w[0] -= first / 2;
        w[2] += first / 2;
    } else if (!level_ends && intervals > 1) {
        w[1] -= 1.5 * first;
        w[2] += 2 * first;
        w[3] -= first / 2;
    }
    if (cell + 1 < intervals) {
        w[1] -= second / 2;
        w[3] += second / 2;
    } else if (!level_ends && intervals > 1) {
        w[0] += second / 2;
        w[1] -= 2 * second;
        w[2] += 1.5 * second;
    }
    for (k = 0; k < 4; k++) s.row[k] = cell + k < 1 ? 0 : cell + k - 1 > intervals ? intervals : cell + k - 1;
    return s;
}

static welkin_error welkin__look_up(const welkin_baked *b, const double direction[3], float *values)
{
    size_t nc = b->channels, columns = b->resolution.azimuths + 1, c;
    welkin__table_place place;
    welkin__spline row, column;
    int i, j;
    welkin_error error = welkin__find_place(b, direction, &place);
    if (error) return error;
    row = welkin__between(place.row, place.up ? b->resolution.up : b->resolution.down, 0);
    column = welkin__between(place.column, b->resolution.azimuths, 1);
    for (c = 0; c < nc; c++) values[c] = 0;
    for (i = 0; i < 4; i++) {
        size_t first = (row.row[i] + (place.up ? 0 : b->resolution.up + 1)) * columns;
        float weight[4];
        for (j = 0; j < 4; j++) weight[j] = (float)(row.weight[i] * column.weight[j]);
        welkin__add_rows(values, b->root + (first + column.row[0]) * nc, b->root + (first + column.row[1]) * nc,
                         b->root + (first + column.row[2]) * nc, b->root + (first + column.row[3]) * nc, weight,
                         b->channels);
    }
    for (c = 0; c < nc; c++) values[c] = welkin__narrow((double)values[c] * (double)values[c]);
    return WELKIN_OK;
}

WELKIN_API welkin_error welkin_baked_xyz(const welkin_baked *baked, const double direction[3], double xyz[3])
{
    float values[WELKIN_MAX_WAVELENGTHS];
    welkin_error error = welkin__look_up(baked, direction, values);
    int i;
    if (error) return error;
    if (baked->resolution.spectral)
        welkin_xyz(baked->file, values, xyz);
    else
        for (i = 0; i < 3; i++) xyz[i] = (double)values[i];
    return WELKIN_OK;
}

WELKIN_API welkin_error welkin_baked_radiance(const welkin_baked *baked, const double direction[3], float *radiance)
{
    if (baked->root && !baked->resolution.spectral) return WELKIN_ERROR_MISSING;
    return welkin__look_up(baked, direction, radiance);
}

static size_t welkin__baked_nodes(const welkin_resolution *r)
{
    return (size_t)(r->up + r->down + 2) * (r->azimuths + 1);
}

static size_t welkin__bake_channels(const welkin_file *f, const welkin_resolution *r)
{
    return r->spectral ? f->wavelengths : 3;
}

WELKIN_API size_t welkin_bake_floats(const welkin_file *file, const welkin_resolution *r)
{
    size_t cells = r->up + (size_t)r->down;
    if (!file->bytes) return 0;
    if (r->up < 1 || r->up > WELKIN_MAX_INTERVALS || r->down < 1 || r->down > WELKIN_MAX_INTERVALS) return 0;
    if (r->azimuths < 1 || r->azimuths > WELKIN_MAX_INTERVALS) return 0;
    return welkin__baked_nodes(r) * welkin__bake_channels(file, r) + cells + 1 + cells * (r->azimuths + 1);
}

/* What a table of the sky holds of a direction. */
static welkin_error welkin__ask(const welkin_sky *sky, int spectral, const double direction[3], double *values)
{
    float radiance[WELKIN_MAX_WAVELENGTHS];
    welkin_error error = welkin_radiance(sky, direction, radiance);
    uint32_t w;
    if (error) return error;
    if (!spectral) welkin_xyz(sky->file, radiance, values);
    for (w = 0; spectral && w < sky->file->wavelengths; w++) values[w] = (double)radiance[w];
    return WELKIN_OK;
}

static void welkin__point(const welkin_baked *b, double sine, double level, double azimuth, double direction[3])
{
    double x = level * cos(azimuth), y = level * sin(azimuth);
    direction[0] = x * b->cos_azimuth - y * b->sin_azimuth;
    direction[1] = x * b->sin_azimuth + y * b->cos_azimuth;
    direction[2] = sine;
}

static welkin_error welkin__bake_row(const welkin_baked *b, const welkin_sky *sky, uint32_t row)
{
    double elevation = welkin__row_elevation(b, row), direction[3], values[WELKIN_MAX_WAVELENGTHS];
    uint32_t columns = b->resolution.azimuths + 1, j, c;
    float *out = b->root + (size_t)row * columns * b->channels;
    if (row == 0) elevation += WELKIN__BESIDE_HORIZON;
    if (row == b->resolution.up + 1) elevation -= WELKIN__BESIDE_HORIZON;
    for (j = 0; j < columns; j++, out += b->channels) {
        welkin_error error;
        welkin__point(b, sin(elevation), cos(elevation), welkin__column_azimuth(b, j), direction);
        error = welkin__ask(sky, b->resolution.spectral, direction, values);
        if (error) return error;
        for (c = 0; c < b->channels; c++) out[c] = welkin__narrow(sqrt(fmax(values[c], 0)));
    }
    return WELKIN_OK;
}

static double welkin__node_luminance(const welkin_baked *b, size_t node)
{
    const float *root = b->root + node * b->channels;
    float radiance[WELKIN_MAX_WAVELENGTHS];
    double xyz[3];
    uint32_t c;
    if (!b->resolution.spectral) return (double)root[1] * (double)root[1];
    for (c = 0; c < b->channels; c++) radiance[c] = welkin__narrow((double)root[c] * (double)root[c]);
    welkin_xyz(b->file, radiance, xyz);
    return fmax(xyz[1], 0);
}

/* The node at the start of a row of cells, towards the horizon; there is no row of cells at the horizon itself. */
static uint32_t welkin__node_row(const welkin_baked *b, uint32_t row) { return row < b->resolution.up ? row : row + 1; }

/* Solid angle of a cell, with its counterpart on the other side of the sun. */
static double welkin__cell_solid_angle(const welkin_baked *b, uint32_t row, uint32_t column)
{
    uint32_t node = welkin__node_row(b, row);
    double from = welkin__row_elevation(b, node), to = welkin__row_elevation(b, node + 1);
    double height = 2 * fabs(sin((to - from) / 2)) * fabs(cos((from + to) / 2)); /* difference of sines */
    return 2 * height * (welkin__column_azimuth(b, column + 1) - welkin__column_azimuth(b, column));
}

/* Cumulative shares, of which each is larger than what a float of 1 resolves. */
static void welkin__accumulate(const double *weight, uint32_t n, float *cumulative)
{
    double total = 0, sum = 0, even = WELKIN__EVEN_SHARE;
    uint32_t i;
    for (i = 0; i < n; i++) total += weight[i];
    if (!(total > 0)) even = total = 1;
    cumulative[0] = 0;
    for (i = 0; i < n; i++) {
        sum += (1 - even) * weight[i] / total + even / n;
        cumulative[i + 1] = (float)sum;
    }
    cumulative[n] = 1;
}

static void welkin__bake_distribution(const welkin_baked *b)
{
    uint32_t rows = b->resolution.up + b->resolution.down, columns = b->resolution.azimuths, i, j;
    double cell[WELKIN_MAX_INTERVALS], row[2 * WELKIN_MAX_INTERVALS];
    for (i = 0; i < rows; i++) {
        size_t low = (size_t)welkin__node_row(b, i) * (columns + 1), high = low + columns + 1;
        double before = welkin__node_luminance(b, low) + welkin__node_luminance(b, high);
        row[i] = 0;
        for (j = 0; j < columns; j++) {
            double after = welkin__node_luminance(b, low + j + 1) + welkin__node_luminance(b, high + j + 1);
            cell[j] = (before + after) / 4 * welkin__cell_solid_angle(b, i, j);
            row[i] += cell[j];
            before = after;
        }
        welkin__accumulate(cell, columns, b->conditional + (size_t)i * (columns + 1));
    }
    welkin__accumulate(row, rows, b->marginal);
}

static welkin_error welkin__bake(welkin_baked *baked, const welkin_sky *sky, const welkin_resolution *resolution,
                                 float *memory, size_t memory_floats)
{
    size_t floats = sky->file ? welkin_bake_floats(sky->file, resolution) : 0;
    uint32_t rows = resolution->up + resolution->down, row;
    welkin_error error = WELKIN_OK;
    if (!sky->file) return WELKIN_ERROR_STATE;
    if (floats == 0) return WELKIN_ERROR_RANGE;
    if (memory_floats < floats) return WELKIN_ERROR_SCRATCH;
    baked->file = sky->file;
    baked->resolution = *resolution;
    baked->channels = (uint32_t)welkin__bake_channels(sky->file, resolution);
    baked->dip = sky->dip;
    welkin__place_sun(baked, asin(sky->sun[2]) + sky->dip);
    baked->cos_azimuth = sky->cos_azimuth;
    baked->sin_azimuth = sky->sin_azimuth;
    baked->up_end = welkin__up_coordinate(baked, WELKIN__HALF_PI + sky->dip);
    baked->down_end = welkin__from_horizon(WELKIN__HALF_PI - sky->dip);
    baked->azimuth_end = welkin__asinh(WELKIN__PI / WELKIN__AZIMUTH_SCALE);
    baked->root = memory;
    baked->marginal = memory + welkin__baked_nodes(resolution) * baked->channels;
    baked->conditional = baked->marginal + rows + 1;
    for (row = 0; row < rows + 2 && !error; row++) error = welkin__bake_row(baked, sky, row);
    if (!error) welkin__bake_distribution(baked);
    return error;
}

WELKIN_API welkin_error welkin_bake(welkin_baked *baked, const welkin_sky *sky, const welkin_resolution *resolution,
                                    float *memory, size_t memory_floats)
{
    welkin_error error;
    memset(baked, 0, sizeof *baked);
    error = welkin__bake(baked, sky, resolution, memory, memory_floats);
    if (error) memset(baked, 0, sizeof *baked);
    return error;
}

/* Directions of a sequence that fills the sphere evenly. */
static void welkin__spread(uint32_t index, double direction[3])
{
    double first = 0.5 + (double)index * 0.7548776662466927, second = 0.5 + (double)index * 0.5698402909980532;
    double sine = 1 - 2 * (first - floor(first)), level = sqrt((1 - sine) * (1 + sine));
    direction[0] = level * cos(2 * WELKIN__PI * second);
    direction[1] = level * sin(2 * WELKIN__PI * second);
    direction[2] = sine;
}

static double welkin__direction_error(const welkin_baked *b, const double *exact, const float *baked,
                                      const double *least)
{
    double largest = 0;
    uint32_t c;
    for (c = 0; c < b->channels; c++) {
        double difference = fabs((double)baked[c] - exact[c]);
        if (difference > 0) largest = fmax(largest, difference / fmax(fabs(exact[c]), least[c]));
    }
    return largest;
}

#define WELKIN__ERROR_BINS 1024 /* sixteen for each factor of two, from 2^-40 */

WELKIN_API welkin_error welkin_baked_error(const welkin_baked *baked, const welkin_sky *sky, uint32_t directions,
                                           double *p99, double *largest)
{
    uint32_t count[WELKIN__ERROR_BINS] = {0}, i, c, bin;
    double least[WELKIN_MAX_WAVELENGTHS] = {0}, exact[WELKIN_MAX_WAVELENGTHS], direction[3], error, most = 0;
    float values[WELKIN_MAX_WAVELENGTHS];
    uint64_t within = 0;
    size_t node, nodes = welkin__baked_nodes(&baked->resolution);
    if (!baked->root || !sky->file) return WELKIN_ERROR_STATE;
    if (directions == 0 || sky->file != baked->file) return WELKIN_ERROR_RANGE;
    for (node = 0; node < nodes; node++)
        for (c = 0; c < baked->channels; c++) {
            double root = (double)baked->root[node * baked->channels + c];
            least[c] = fmax(least[c], 1e-4 * root * root);
        }
    for (i = 0; i < directions; i++) {
        welkin_error failure;
        welkin__spread(i, direction);
        failure = welkin__ask(sky, baked->resolution.spectral, direction, exact);
        if (!failure) failure = welkin__look_up(baked, direction, values);
        if (failure) return failure;
        error = welkin__direction_error(baked, exact, values, least);
        most = fmax(most, error);
        count[(uint32_t)fmin(fmax(16 * (log2(fmax(error, 1e-300)) + 40), 0), WELKIN__ERROR_BINS - 1)]++;
    }
    for (bin = 0; bin + 1 < WELKIN__ERROR_BINS && 100 * (within + count[bin]) < 99 * (uint64_t)directions; bin++)
        within += count[bin];
    *p99 = fmin(most, exp2((bin + 1) / 16.0 - 40));
    *largest = most;
    return WELKIN_OK;
}

/* ---- sampling ---- */

/* Density of a cell per steradian. */
static double welkin__cell_pdf(const welkin_baked *b, uint32_t row, uint32_t column)
{
    const float *conditional = b->conditional + (size_t)row * (b->resolution.azimuths + 1) + column;
    double marginal = (double)b->marginal[row + 1] - (double)b->marginal[row];
    return marginal * ((double)conditional[1] - (double)conditional[0]) / welkin__cell_solid_angle(b, row, column);
}

/* The cell of a random number, and how far it is within. */
static uint32_t welkin__invert(const float *cumulative, uint32_t n, double u, double *share)
{
    uint32_t low = 0, high = n;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if ((double)cumulative[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    *share = (u - (double)cumulative[low]) / ((double)cumulative[low + 1] - (double)cumulative[low]);
    return low;
}

WELKIN_API welkin_error welkin_sample(const welkin_baked *baked, double u1, double u2, double direction[3], double *pdf)
{
    uint32_t rows = baked->resolution.up + baked->resolution.down, columns = baked->resolution.azimuths;
    uint32_t row, column, node;
    double side = u2 < 0.5 ? 1 : -1, along, across, low, sine, azimuth;
    if (!baked->root) return WELKIN_ERROR_STATE;
    if (!welkin__within(u1, 0, 1) || !welkin__within(u2, 0, 1)) return WELKIN_ERROR_RANGE;
    row = welkin__invert(baked->marginal, rows, u1, &along);
    column = welkin__invert(baked->conditional + (size_t)row * (columns + 1), columns, u2 < 0.5 ? 2 * u2 : 2 * u2 - 1,
                            &across);
    node = welkin__node_row(baked, row);
    low = sin(welkin__row_elevation(baked, node));
    sine = low + along * (sin(welkin__row_elevation(baked, node + 1)) - low);
    azimuth = welkin__column_azimuth(baked, column);
    azimuth += across * (welkin__column_azimuth(baked, column + 1) - azimuth);
    welkin__point(baked, sine, sqrt(fmax((1 - sine) * (1 + sine), 0)), side * azimuth, direction);
    *pdf = welkin__cell_pdf(baked, row, column);
    return WELKIN_OK;
}

WELKIN_API welkin_error welkin_sample_pdf(const welkin_baked *baked, const double direction[3], double *pdf)
{
    uint32_t up = baked->resolution.up, down = baked->resolution.down, row;
    welkin__table_place place;
    welkin_error error = welkin__find_place(baked, direction, &place);
    if (error) return error;
    row = place.up ? welkin__cell_at(place.row, up) : up + welkin__cell_at(place.row, down);
    *pdf = welkin__cell_pdf(baked, row, welkin__cell_at(place.column, baked->resolution.azimuths));
    return WELKIN_OK;
}

/* ---- transmittance ---- */

static int welkin__edges_are_good(const welkin_file *f, const unsigned char *edges, uint32_t layers)
{
    uint32_t i;
    if (welkin__f64(edges) != 0 || welkin__f64(edges + 8 * (size_t)layers) != f->top_altitude) return 0;
    for (i = 0; i < layers; i++) {
        double step = welkin__f64(edges + 8 * (size_t)(i + 1)) - welkin__f64(edges + 8 * (size_t)i);
        if (!(step >= 0.001 && step <= 1e9)) return 0;
    }
    return 1;
}

static welkin_error welkin__read_profile(welkin_transmittance_profile *air, const welkin__entry *entry)
{
    const welkin_file *f = air->file;
    const unsigned char *p;
    size_t densities;
    welkin_error error = welkin__payload(f, entry, &p);
    if (error) return error;
    if (entry->raw < 8) return WELKIN_ERROR_VALUE;
    air->layers = welkin__u32(p);
    if (air->layers < 1 || air->layers > 1024) return WELKIN_ERROR_VALUE;
    densities = (2 * (size_t)air->layers + 1) * f->constituents;
    if (entry->raw != 8 + 8 * ((uint64_t)air->layers + 1) + 4 * densities) return WELKIN_ERROR_VALUE;
    air->edges = p + 8;
    air->densities = air->edges + 8 * ((size_t)air->layers + 1);
    if (!welkin__edges_are_good(f, air->edges, air->layers) || !welkin__f32s_are_within(air->densities, densities, 0, 1e6))
        return WELKIN_ERROR_VALUE;
    return WELKIN_OK;
}

WELKIN_API welkin_error welkin_transmittance_prepare(welkin_transmittance_profile *air, const welkin_file *file,
                                                     double visibility)
{
    welkin__stencil b;
    welkin__entry entry;
    welkin_error error;
    uint32_t i;
    memset(air, 0, sizeof *air);
    if (!file->bytes) return WELKIN_ERROR_STATE;
    if (!welkin__into_axis(file->bytes + file->visibility_at, file->visibilities, &visibility)) return WELKIN_ERROR_RANGE;
    if (welkin__find(file, WELKIN__TRANSMITTANCE, WELKIN__NONE, WELKIN__NONE, &entry)) return WELKIN_ERROR_MISSING;
    air->file = file;
    b = welkin__linear(file->bytes + file->visibility_at, file->visibilities, visibility, WELKIN__INVERSE);
    for (i = 0; i < 2; i++) {
        air->visibility_node[i] = b.node[i];
        air->visibility_weight[i] = b.weight[i];
    }
    error = welkin__read_profile(air, &entry);
    if (error) memset(air, 0, sizeof *air);
    return error;
}

/* A straight line: w = low + s²/2R at the distance s from the point closest to the planet's centre. */
typedef struct welkin__line {
    double radius, low, start, end;
} welkin__line;

/* Where the line comes up to a value of w, 0 if it is above it everywhere. */
static double welkin__crossing(const welkin__line *line, double w) { return sqrt(fmax(0, 2 * line->radius * (w - line->low))); }

/* Adds the integrals over a piece of the line within one layer. */
static void welkin__add_piece(const welkin_transmittance_profile *air, const welkin__line *line, uint32_t layer,
                              double bottom, double thickness, double s0, double s1, double *columns)
{
    size_t nk = air->file->constituents, k;
    const unsigned char *d = air->densities + 8 * layer * nk;
    double l, m, scale = 2 * line->radius * thickness, mean, square;
    s0 = fmax(s0, line->start);
    s1 = fmin(s1, line->end);
    if (!(s1 > s0)) return;
    l = s1 - s0;
    m = (s0 + s1) / 2;
    mean = fmin(fmax((line->low - bottom) / thickness + (m * m + l * l / 12) / scale, 0), 1);
    square = mean * mean + fmin((m * m * l * l / 3 + l * l * l * l / 180) / scale / scale, 0.25);
    for (k = 0; k < nk; k++) {
        double a = (double)welkin__f32(d + 4 * k), b = (double)welkin__f32(d + 4 * (nk + k)), c = (double)welkin__f32(d + 4 * (2 * nk + k));
        columns[k] += l * fmax(0, a + 2 * (b - a) * mean + (a - 2 * b + c) * square);
    }
}

/* Below the ground the profiles are those at the ground. */
static void welkin__add_underground(const welkin_transmittance_profile *air, const welkin__line *line, double *columns)
{
    double depth = welkin__crossing(line, 0), s0 = fmax(-depth, line->start), s1 = fmin(depth, line->end);
    uint32_t k;
    for (k = 0; k < air->file->constituents && s1 > s0; k++) columns[k] += (s1 - s0) * (double)welkin__f32(air->densities + 4 * (size_t)k);
}

static void welkin__integrate(const welkin_transmittance_profile *air, const welkin__line *line, double *columns)
{
    double bottom = 0, inner = welkin__crossing(line, 0);
    uint32_t i;
    welkin__add_underground(air, line, columns);
    for (i = 0; i < air->layers; i++) {
        double h = welkin__f64(air->edges + 8 * (size_t)(i + 1)), top = h + h * h / (2 * line->radius), outer = welkin__crossing(line, top);
        welkin__add_piece(air, line, i, bottom, top - bottom, -outer, -inner, columns);
        welkin__add_piece(air, line, i, bottom, top - bottom, inner, outer, columns);
        bottom = top;
        inner = outer;
    }
}

/* Normalises the direction of a segment that starts at an altitude above the origin. */
static welkin_error welkin__segment(double altitude, const double direction[3], double distance, double v[3])
{
    const double farthest = 1e9;
    if (welkin__normalise(direction, v)) return WELKIN_ERROR_DIRECTION;
    if (!welkin__within(altitude, -farthest, farthest) || !welkin__within(distance, 0, 4 * farthest)) return WELKIN_ERROR_POINT;
    if (!welkin__within(distance * v[0], -farthest, farthest) || !welkin__within(distance * v[1], -farthest, farthest) ||
        !welkin__within(altitude + distance * v[2], -farthest, farthest))
        return WELKIN_ERROR_POINT;
    return WELKIN_OK;
}

/* Integrals of the profiles along a segment. */
static welkin_error welkin__segment_columns(const welkin_transmittance_profile *air, double altitude,
                                            const double direction[3], double distance, double *columns)
{
    double v[3], radius;
    welkin__line line;
    uint32_t k;
    welkin_error error = air->file ? welkin__segment(altitude, direction, distance, v) : WELKIN_ERROR_STATE;
    if (error) return error;
    line.radius = radius = air->file->planet_radius;
    line.start = (radius + altitude) * v[2];
    line.end = line.start + distance;
    line.low = altitude + (altitude * altitude - line.start * line.start) / (2 * radius);
    for (k = 0; k < air->file->constituents; k++) columns[k] = 0;
    welkin__integrate(air, &line, columns);
    return WELKIN_OK;
}

WELKIN_API welkin_error welkin_transmittance(const welkin_transmittance_profile *air, double altitude,
                                             const double direction[3], double distance, float *transmittance)
{
    const welkin_file *f = air->file;
    double columns[WELKIN_MAX_CONSTITUENTS];
    size_t nw, table, w, k;
    welkin_error error = welkin__segment_columns(air, altitude, direction, distance, columns);
    if (error) return error;
    nw = f->wavelengths;
    table = f->constituents * nw;
    for (w = 0; w < nw; w++) {
        double depth = 0;
        for (k = 0; k < f->constituents; k++) {
            const unsigned char *p = f->bytes + f->extinction_at + 8 * (k * nw + w);
            double first = welkin__f64(p + 8 * air->visibility_node[0] * table), second = welkin__f64(p + 8 * air->visibility_node[1] * table);
            depth += columns[k] * (air->visibility_weight[0] * first + air->visibility_weight[1] * second);
        }
        transmittance[w] = (float)exp(-depth);
    }
    return WELKIN_OK;
}

/* Optical depth in a cell, but for absorption lines. */
static double welkin__cell_depth(const welkin_transmittance_profile *air, const double *columns, size_t cell)
{
    const welkin_file *f = air->file;
    size_t cells = f->spectrum.cells, table = f->constituents * cells, k;
    double depth = 0;
    for (k = 0; k < f->constituents; k++) {
        const unsigned char *p = f->spectrum.extinction + 4 * (k * cells + cell);
        double first = (double)welkin__f32(p + 4 * air->visibility_node[0] * table);
        double second = (double)welkin__f32(p + 4 * air->visibility_node[1] * table);
        depth += columns[k] * (air->visibility_weight[0] * first + air->visibility_weight[1] * second);
    }
    return depth;
}

/* What absorption lines leave of the light of a cell, in the mean over its band. */
static double welkin__cell_lines(const welkin_file *f, const double *columns, uint32_t cell)
{
    const welkin_spectrum *s = &f->spectrum;
    double mean = 0;
    size_t nk = f->constituents, k;
    uint32_t first, i, count = welkin__cell_terms(s, cell, &first);
    for (i = first; i < first + count; i++) {
        double depth = 0;
        for (k = 0; k < nk; k++) depth += columns[k] * (double)welkin__f32(s->term_extinction + 4 * (i * nk + k));
        mean += (double)welkin__f32(s->term_weight + 4 * (size_t)i) * exp(-depth);
    }
    return mean;
}

WELKIN_API welkin_error welkin_transmittance_at(const welkin_transmittance_profile *air, double altitude,
                                                const double direction[3], double distance, const double *wavelengths,
                                                size_t count, float *transmittance)
{
    const welkin_spectrum *s = air->file ? &air->file->spectrum : NULL;
    double columns[WELKIN_MAX_CONSTITUENTS];
    size_t w;
    uint32_t c;
    welkin_error error = s ? s->error : WELKIN_ERROR_STATE;
    if (!error) error = welkin__segment_columns(air, altitude, direction, distance, columns);
    for (w = 0; w < count && !error; w++) error = welkin__check_wavelength(air->file, wavelengths[w]);
    for (w = 0; w < count && !error; w++) {
        welkin__stencil cells = welkin__linear(s->wavelength, s->cells, wavelengths[w], WELKIN__PLAIN);
        double depth = 0, lines = 0;
        for (c = 0; c < cells.count; c++) {
            depth += cells.weight[c] * welkin__cell_depth(air, columns, cells.node[c]);
            lines += cells.weight[c] * welkin__cell_lines(air->file, columns, cells.node[c]);
        }
        transmittance[w] = (float)fmin(exp(-depth) * lines, 1); /* the sum of shares is only about 1 */
    }
    return error;
}

/* ---- light that segments scatter ---- */

#define WELKIN__MAX_MOMENTS 32
#define WELKIN__MAX_COMPONENTS 64
#define WELKIN__MAX_HARMONICS 325 /* of degree 24 */

static int welkin__source_ranks_are_good(const unsigned char *p)
{
    uint32_t i;
    for (i = 0; i < 4; i++)
        if (welkin__u32(p + 4 * i) < 1 || welkin__u32(p + 4 * i) > WELKIN__MAX_COMPONENTS) return 0;
    return welkin__u32(p + 8) <= WELKIN__MAX_MOMENTS;
}

static int welkin__steps_are_good(const unsigned char *axis, uint32_t n, double low, double high, double step)
{
    uint32_t i;
    if (!welkin__f64s_are_within(axis, n, low, high)) return 0;
    for (i = 1; i < n; i++)
        if (!(welkin__f64(axis + 8 * (size_t)i) - welkin__f64(axis + 8 * (size_t)(i - 1)) >= step)) return 0;
    return 1;
}

static uint32_t welkin__harmonic_count(uint32_t degree, uint32_t orders)
{
    uint32_t m, count = 0;
    for (m = 0; m <= orders; m++) count += degree - m + 1;
    return count;
}

/* Counts are in their ranges when this is called. */
static welkin_error welkin__place_source_basis(welkin_aerial_perspective *aerial, const unsigned char *p,
                                               uint64_t length)
{
    uint32_t i, rows[4], nw = aerial->air.file->wavelengths;
    uint64_t axes = 8 * ((uint64_t)aerial->altitudes + aerial->suns), factors = 0;
    rows[0] = aerial->altitudes;
    rows[1] = aerial->suns;
    rows[2] = 4 + welkin__harmonic_count(aerial->degree, aerial->orders);
    rows[3] = 2 * nw;
    aerial->altitude = p + 32;
    aerial->sine = aerial->altitude + 8 * (size_t)aerial->altitudes;
    for (i = 0; i < 4; i++) {
        aerial->factor[i] = p + 32 + (size_t)(axes + 4 * factors);
        factors += (uint64_t)rows[i] * aerial->rank[i];
    }
    if (length != 32 + axes + 4 * factors || (uint64_t)aerial->altitudes * nw * aerial->rank[2] > 1u << 18) return WELKIN_ERROR_VALUE;
    if (!welkin__steps_are_good(aerial->altitude, aerial->altitudes, 0, 1e9, 0.001)) return WELKIN_ERROR_VALUE;
    if (!welkin__steps_are_good(aerial->sine, aerial->suns, -1, 1, 1e-9)) return WELKIN_ERROR_VALUE;
    return welkin__f32s_are_finite(aerial->factor[0], (size_t)factors) ? WELKIN_OK : WELKIN_ERROR_VALUE;
}

static welkin_error welkin__read_source_basis(welkin_aerial_perspective *aerial, const welkin__entry *entry)
{
    const unsigned char *p;
    uint32_t i;
    welkin_error error = welkin__payload(aerial->air.file, entry, &p);
    if (error) return error;
    if (entry->raw < 32 || !welkin__source_ranks_are_good(p + 16)) return WELKIN_ERROR_VALUE;
    aerial->altitudes = welkin__u32(p);
    aerial->suns = welkin__u32(p + 4);
    aerial->degree = welkin__u32(p + 8);
    aerial->orders = welkin__u32(p + 12);
    for (i = 0; i < 4; i++) aerial->rank[i] = welkin__u32(p + 16 + 4 * i);
    if (aerial->altitudes < 2 || aerial->altitudes > 256 || aerial->suns < 2 || aerial->suns > 256) return WELKIN_ERROR_VALUE;
    if (aerial->degree > 24 || aerial->orders > aerial->degree) return WELKIN_ERROR_VALUE;
    return welkin__place_source_basis(aerial, p, entry->raw);
}

/* Where the tables of a source chunk are. */
typedef struct welkin__source {
    uint32_t species;
    const unsigned char *phase, *parameter, *scattering, *level, *core;
    double scale;
} welkin__source;

static size_t welkin__core_size(const welkin_aerial_perspective *aerial)
{
    return (size_t)aerial->rank[0] * aerial->rank[1] * aerial->rank[2] * aerial->rank[3];
}

static int welkin__species_are_good(const welkin_aerial_perspective *aerial, const welkin__source *source)
{
    size_t nw = aerial->air.file->wavelengths, p, w;
    for (p = 0; p < source->species; p++) {
        uint32_t phase = welkin__u32(source->phase + 4 * p);
        if (phase != 1 && phase != 2) return 0;
        for (w = 0; w < nw; w++)
            if (!welkin__parameter_is_good(phase, (double)welkin__f32(source->parameter + 4 * (p * nw + w)))) return 0;
    }
    return welkin__f32s_are_within(source->scattering, source->species * (size_t)aerial->air.file->constituents * nw, 0, 1e6);
}

/* Checks a source and that it fits the basis. */
static welkin_error welkin__read_source(const welkin_aerial_perspective *aerial, const welkin__entry *entry,
                                        welkin__source *source)
{
    const welkin_file *f = aerial->air.file;
    const unsigned char *p;
    size_t nw = f->wavelengths, levels = 2 * nw, core = welkin__core_size(aerial);
    uint32_t suns, i;
    welkin_error error = welkin__payload(f, entry, &p);
    if (error) return error;
    if (entry->raw < 32 || !welkin__source_ranks_are_good(p + 8)) return WELKIN_ERROR_VALUE;
    source->species = welkin__u32(p);
    suns = welkin__u32(p + 4);
    if (source->species < 1 || source->species > 16 || suns != aerial->suns) return WELKIN_ERROR_VALUE;
    for (i = 0; i < 4; i++)
        if (welkin__u32(p + 8 + 4 * i) != aerial->rank[i]) return WELKIN_ERROR_VALUE;
    levels *= suns;
    source->scale = (double)welkin__f32(p + 24);
    source->phase = p + 32;
    source->parameter = source->phase + 4 * (size_t)source->species;
    source->scattering = source->parameter + 4 * source->species * nw;
    source->level = source->scattering + 4 * source->species * f->constituents * nw;
    source->core = source->level + 4 * levels;
    if (entry->raw != 32 + 4 * (source->species * (1 + nw + f->constituents * nw) + levels) + 2 * core) return WELKIN_ERROR_VALUE;
    if (!welkin__f32s_are_finite(p + 24, 1) || !welkin__f32s_are_finite(source->level, levels)) return WELKIN_ERROR_VALUE;
    if (!welkin__f16s_are_finite(source->core, core) || !welkin__species_are_good(aerial, source)) return WELKIN_ERROR_VALUE;
    return WELKIN_OK;
}

/* An upper bound that follows from the directory alone. */
WELKIN_API size_t welkin_aerial_perspective_floats(const welkin_file *f)
{
    size_t longest = 0;
    uint32_t i;
    for (i = 0; i < f->chunk_count; i++) {
        welkin__entry e = welkin__read_entry(f, i);
        if (e.kind == WELKIN__SOURCE && e.raw > longest) longest = (size_t)e.raw;
    }
    return 2 * longest + longest / 4 + (size_t)(f->constituents + 1) * f->wavelengths;
}

/* Widens the core, and adds the species of visibilities that count linearly. */
static void welkin__take_source(welkin_aerial_perspective *aerial, const welkin__source *source, uint32_t m,
                                double linear)
{
    size_t nw = aerial->air.file->wavelengths, core = welkin__core_size(aerial), i;
    aerial->level[m] = source->level;
    for (i = 0; i < core; i++) aerial->core[m][i] = welkin__narrow(source->scale * (double)welkin__f16(source->core + 2 * i));
    for (i = 0; i < aerial->species * nw; i++) {
        float *sum = &aerial->parameter[i];
        *sum = welkin__narrow((double)*sum + linear * (double)welkin__f32(source->parameter + 4 * i));
    }
    for (i = 0; i < aerial->species * nw * aerial->air.file->constituents; i++) {
        float *sum = &aerial->scattering[i];
        *sum = welkin__narrow((double)*sum + linear * (double)welkin__f32(source->scattering + 4 * i));
    }
}

static int welkin__same_species(const welkin_aerial_perspective *aerial, const welkin__source *source)
{
    uint32_t i;
    if (source->species != aerial->species) return 0;
    for (i = 0; i < aerial->species; i++)
        if (welkin__u32(source->phase + 4 * (size_t)i) != aerial->phase[i]) return 0;
    return 1;
}

static double welkin__weight_of(const welkin__stencil *s, uint32_t node)
{
    uint32_t i;
    double weight = 0;
    for (i = 0; i < s->count; i++)
        if (s->node[i] == node) weight += s->weight[i];
    return weight;
}

static welkin_error welkin__read_sources(welkin_aerial_perspective *aerial, const welkin__entry *entries,
                                         const welkin__stencil *linear, float **scratch)
{
    const welkin_file *f = aerial->air.file;
    uint32_t m, i;
    for (m = 0; m < aerial->visibilities; m++) {
        welkin__source source;
        welkin_error error = welkin__read_source(aerial, &entries[m], &source);
        if (error) return error;
        if (m == 0) {
            aerial->species = source.species;
            for (i = 0; i < source.species; i++) aerial->phase[i] = welkin__u32(source.phase + 4 * (size_t)i);
            aerial->parameter = welkin__carve(scratch, (size_t)source.species * f->wavelengths);
            aerial->scattering = welkin__carve(scratch, (size_t)source.species * f->constituents * f->wavelengths);
        }
        if (!welkin__same_species(aerial, &source)) return WELKIN_ERROR_VALUE;
        aerial->core[m] = welkin__carve(scratch, welkin__core_size(aerial));
        welkin__take_source(aerial, &source, m, welkin__weight_of(linear, entries[m].visibility));
    }
    return WELKIN_OK;
}

static void welkin__prepare_air_tables(welkin_aerial_perspective *aerial, const welkin_conditions *c,
                                       const welkin__stencil *linear, float **scratch)
{
    const welkin_file *f = aerial->air.file;
    size_t nw = f->wavelengths, air = f->constituents * nw, i;
    aerial->extinction = welkin__carve(scratch, air);
    aerial->bounce = welkin__carve(scratch, nw);
    for (i = 0; i < air; i++) aerial->extinction[i] = welkin__narrow(welkin__head_value(f, f->extinction_at, air, i, linear));
    for (i = 0; i < nw; i++) {
        double share = 1 - c->albedo * welkin__head_value(f, f->albedo_at, nw, i, linear);
        aerial->bounce[i] = welkin__narrow(c->albedo / (share > DBL_EPSILON ? share : DBL_EPSILON));
    }
    aerial->sun[0] = cos(c->solar_elevation) * cos(c->solar_azimuth);
    aerial->sun[1] = cos(c->solar_elevation) * sin(c->solar_azimuth);
    aerial->sun[2] = sin(c->solar_elevation);
}

static welkin_error welkin__find_sources(welkin_aerial_perspective *aerial, const welkin__stencil *b,
                                         welkin__entry *basis, welkin__entry *entries)
{
    uint32_t m;
    if (welkin__find(aerial->air.file, WELKIN__TRANSMITTANCE, WELKIN__NONE, WELKIN__NONE, basis)) return WELKIN_ERROR_MISSING;
    if (welkin__find(aerial->air.file, WELKIN__SOURCE_BASIS, WELKIN__NONE, WELKIN__NONE, basis)) return WELKIN_ERROR_MISSING;
    for (m = 0; m < b->count; m++) {
        if (b->weight[m] == 0) continue;
        if (welkin__find(aerial->air.file, WELKIN__SOURCE, WELKIN__NONE, b->node[m], &entries[aerial->visibilities])) return WELKIN_ERROR_MISSING;
        aerial->weight[aerial->visibilities++] = b->weight[m];
    }
    return WELKIN_OK;
}

static welkin_error welkin__aerial_perspective_prepare(welkin_aerial_perspective *aerial, const welkin_file *file,
                                                       const welkin_conditions *conditions, float *scratch,
                                                       size_t scratch_floats)
{
    const unsigned char *axis;
    welkin_conditions c = *conditions;
    welkin__stencil cubic, linear;
    welkin__entry basis, entries[4];
    welkin_error error;
    if (!file->bytes) return WELKIN_ERROR_STATE;
    aerial->air.file = file;
    axis = file->bytes + file->visibility_at;
    c.altitude = welkin_altitude(file, 0);
    if (!welkin__conditions_into_range(file, &c)) return WELKIN_ERROR_RANGE;
    cubic = welkin__cubic(axis, file->visibilities, c.visibility, WELKIN__INVERSE);
    linear = welkin__linear(axis, file->visibilities, c.visibility, WELKIN__INVERSE);
    error = welkin__find_sources(aerial, &cubic, &basis, entries);
    if (error) return error;
    if (scratch_floats < welkin_aerial_perspective_floats(file)) return WELKIN_ERROR_SCRATCH;
    error = welkin_transmittance_prepare(&aerial->air, file, c.visibility);
    if (!error) error = welkin__read_source_basis(aerial, &basis);
    if (error) return error;
    welkin__prepare_air_tables(aerial, &c, &linear, &scratch);
    return welkin__read_sources(aerial, entries, &linear, &scratch);
}

WELKIN_API welkin_error welkin_aerial_perspective_prepare(welkin_aerial_perspective *aerial, const welkin_file *file,
                                                          const welkin_conditions *conditions, float *scratch,
                                                          size_t scratch_floats)
{
    welkin_error error;
    memset(aerial, 0, sizeof *aerial);
    error = welkin__aerial_perspective_prepare(aerial, file, conditions, scratch, scratch_floats);
    if (error) memset(aerial, 0, sizeof *aerial);
    return error;
}

/* Cosine and sine of the azimuth of the view less that of the sun, counter-clockwise around the vertical; 0 where there
 * is none. */
typedef struct welkin__azimuth {
    double cosine, sine;
} welkin__azimuth;

/* A point of a segment, and what is where there. */
typedef struct welkin__spot {
    double up[3], altitude, sine, cos_theta, sin_theta; /* sine of the sun's elevation; the view direction from the vertical */
    double fade;                                        /* what the azimuth counts */
    welkin__azimuth phi;
} welkin__spot;

/* A line of sight from its start: a unit vector, and the components of the sun's direction along e1 and e2 of the
 * vertical frame. */
typedef struct welkin__sight {
    double v[3], p1, p2;
} welkin__sight;

static double welkin__dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* What is left of a vector across a unit vector. */
static double welkin__across(const double *vector, const double *up, double *across)
{
    double along = welkin__dot(vector, up);
    int i;
    for (i = 0; i < 3; i++) across[i] = vector[i] - along * up[i];
    return sqrt(welkin__dot(across, across));
}

static welkin__azimuth welkin__azimuth_between(const double *view, const double *sun, const double *up)
{
    welkin__azimuth phi = {1, 0};
    double v[3], s[3], lengths = welkin__across(view, up, v);
    lengths *= welkin__across(sun, up, s);
    if (lengths > 1e-12) {
        double turn = up[0] * (s[1] * v[2] - s[2] * v[1]) + up[1] * (s[2] * v[0] - s[0] * v[2]) + up[2] * (s[0] * v[1] - s[1] * v[0]);
        phi.cosine = fmin(fmax(welkin__dot(v, s) / lengths, -1), 1);
        phi.sine = fmin(fmax(turn / lengths, -1), 1);
    }
    return phi;
}

static void welkin__find_sun(welkin__sight *sight, const double *sun)
{
    static const double up[3] = {0, 0, 1};
    welkin__azimuth phi = welkin__azimuth_between(sight->v, sun, up);
    double view = sqrt(sight->v[0] * sight->v[0] + sight->v[1] * sight->v[1]), level = sqrt(sun[0] * sun[0] + sun[1] * sun[1]);
    sight->p1 = view * sun[2] - sight->v[2] * level * phi.cosine;
    sight->p2 = level * phi.sine;
}

static welkin__spot welkin__spot_at(const welkin_aerial_perspective *aerial, double altitude, const double v[3],
                                    double s)
{
    welkin__spot spot;
    double radius = aerial->air.file->planet_radius, distance, level[3];
    int i;
    for (i = 0; i < 3; i++) spot.up[i] = s * v[i];
    spot.up[2] += radius + altitude;
    distance = sqrt(welkin__dot(spot.up, spot.up));
    for (i = 0; i < 3; i++) spot.up[i] = distance > 0 ? spot.up[i] / distance : (double)(i == 2);
    spot.altitude = fmax(0, distance - radius);
    spot.sine = fmin(fmax(welkin__dot(spot.up, aerial->sun), -1), 1);
    spot.cos_theta = fmin(fmax(welkin__dot(spot.up, v), -1), 1);
    spot.sin_theta = sqrt(1 - spot.cos_theta * spot.cos_theta);
    spot.phi = welkin__azimuth_between(v, aerial->sun, spot.up);
    spot.fade = welkin__azimuthal_fade(welkin__across(aerial->sun, spot.up, level));
    return spot;
}

/* The profiles of the constituents at an altitude from the ground on. */
static void welkin__profiles(const welkin_transmittance_profile *air, double altitude, double *profile)
{
    size_t nk = air->file->constituents, k;
    double radius = air->file->planet_radius, bottom, top, t;
    uint32_t i = welkin__node_below(air->edges, air->layers + 1, altitude);
    const unsigned char *d = air->densities + 8 * i * nk;
    for (k = 0; k < nk; k++) profile[k] = 0;
    if (i >= air->layers) return;
    bottom = welkin__f64(air->edges + 8 * (size_t)i);
    top = welkin__f64(air->edges + 8 * (size_t)(i + 1));
    t = (altitude - bottom) * (1 + (altitude + bottom) / (2 * radius)) / ((top - bottom) * (1 + (top + bottom) / (2 * radius)));
    for (k = 0; k < nk; k++)
        profile[k] = (1 - t) * (1 - t) * (double)welkin__f32(d + 4 * k) + 2 * t * (1 - t) * (double)welkin__f32(d + 4 * (nk + k)) +
                     t * t * (double)welkin__f32(d + 4 * (2 * nk + k));
}

static void welkin__attenuate(const welkin_aerial_perspective *aerial, const double *columns, double *transmittance)
{
    size_t nw = aerial->air.file->wavelengths, w, k;
    for (w = 0; w < nw; w++) {
        double depth = 0;
        for (k = 0; k < aerial->air.file->constituents; k++) depth += columns[k] * (double)aerial->extinction[k * nw + w];
        transmittance[w] = exp(-depth);
    }
}

/* D: the share of the disc above the horizon times the transmittance towards the centroid of that share. */
static void welkin__sunlight(const welkin_aerial_perspective *aerial, const welkin__spot *spot, double *light)
{
    const welkin_file *f = aerial->air.file;
    double radius = f->planet_radius, h = spot->altitude, columns[WELKIN_MAX_CONSTITUENTS] = {0};
    double e = asin(spot->sine), dip = atan(sqrt(h * (2 * radius + h)) / radius);
    double c = fmin(fmax((e + dip) / WELKIN__SUN_RADIUS, -1), 1), rest = 1 - c * c, area = WELKIN__HALF_PI + c * sqrt(rest) + asin(c);
    welkin__line line;
    uint32_t w;
    if (!(area > 0)) {
        for (w = 0; w < f->wavelengths; w++) light[w] = 0;
        return;
    }
    line.radius = radius;
    line.start = (radius + h) * sin(e + WELKIN__SUN_RADIUS * 2 / 3 * rest * sqrt(rest) / area);
    line.end = 4 * (radius + h + f->top_altitude);
    line.low = h + (h * h - line.start * line.start) / (2 * radius);
    welkin__integrate(&aerial->air, &line, columns);
    welkin__attenuate(aerial, columns, light);
    for (w = 0; w < f->wavelengths; w++) light[w] *= area / WELKIN__PI;
}

/* Rows of a factor mixed by a stencil. */
static void welkin__mix(const unsigned char *factor, uint32_t rank, const welkin__stencil *s, double *out)
{
    uint32_t i, r;
    for (r = 0; r < rank; r++) {
        out[r] = 0;
        for (i = 0; i < s->count; i++) out[r] += s->weight[i] * (double)welkin__f32(factor + 4 * ((size_t)s->node[i] * rank + r));
    }
}

static welkin__stencil welkin__at_nodes(const unsigned char *axis, uint32_t n, double value, welkin__scale scale)
{
    value = fmin(fmax(value, welkin__f64(axis)), welkin__f64(axis + 8 * (size_t)(n - 1)));
    return welkin__cubic(axis, n, value, scale);
}

/* N_lm P_lm(cos theta) fade^m cos(m phi) in the order of the file. */
static void welkin__harmonics(const welkin_aerial_perspective *aerial, const welkin__spot *spot, double *values)
{
    double diagonal = sqrt(0.25 / WELKIN__PI), cosine = 1, sine = 0, x = spot->cos_theta;
    double cp = spot->fade * spot->phi.cosine, sp = spot->fade * spot->phi.sine;
    uint32_t m, l;
    for (m = 0; m <= aerial->orders; m++) {
        double value, before = 0, last = 0;
        if (m > 0) {
            double next = cosine * cp - sine * sp;
            sine = cosine * sp + sine * cp;
            cosine = next;
            diagonal *= sqrt((2.0 * m + 1) / (2.0 * m)) * spot->sin_theta;
        }
        value = diagonal;
        for (l = m; l <= aerial->degree; l++) {
            double next, a = sqrt((4.0 * (l + 1) * (l + 1) - 1) / ((double)(l + 1) * (l + 1) - (double)m * m));
            *values++ = value * cosine * (m > 0 ? sqrt(2) : 1);
            next = a * (x * value - before * last);
            before = 1 / a;
            last = value;
            value = next;
        }
    }
}

/* How light arrives at a line of sight: from molecules, from particles, and Q and U from molecules. */
enum { WELKIN__MOLECULES, WELKIN__PARTICLES, WELKIN__Q, WELKIN__U, WELKIN__LOOKS };

/* Factors of the tensor's components xx, yy, zz, xz. */
static void welkin__tensor_looks(const welkin__spot *spot, double (*looks)[4])
{
    double c = spot->cos_theta, s = spot->sin_theta, cp = spot->fade * spot->phi.cosine, sp = spot->fade * spot->phi.sine;
    double cp2 = (1 + cp * cp - sp * sp) / 2, sp2 = 1 - cp2;
    looks[WELKIN__MOLECULES][0] = c * c * cp2 + sp2;
    looks[WELKIN__MOLECULES][1] = c * c * sp2 + cp2;
    looks[WELKIN__Q][0] = c * c * cp2 - sp2;
    looks[WELKIN__Q][1] = c * c * sp2 - cp2;
    looks[WELKIN__MOLECULES][2] = looks[WELKIN__Q][2] = s * s;
    looks[WELKIN__MOLECULES][3] = looks[WELKIN__Q][3] = -2 * s * c * cp;
    looks[WELKIN__U][0] = -2 * c * sp * cp;
    looks[WELKIN__U][1] = 2 * c * sp * cp;
    looks[WELKIN__U][2] = 0;
    looks[WELKIN__U][3] = 2 * s * sp;
    memset(looks[WELKIN__PARTICLES], 0, sizeof looks[WELKIN__PARTICLES]);
}

/* How the components of the moments look. */
static void welkin__see(const welkin_aerial_perspective *aerial, const welkin__spot *spot,
                        double (*seen)[WELKIN__MAX_MOMENTS])
{
    double tensor[WELKIN__LOOKS][4], harmonics[WELKIN__MAX_HARMONICS];
    uint32_t b, i, k, rm = aerial->rank[2], nh = welkin__harmonic_count(aerial->degree, aerial->orders);
    const unsigned char *factor = aerial->factor[2];
    welkin__tensor_looks(spot, tensor);
    welkin__harmonics(aerial, spot, harmonics);
    for (b = 0; b < rm; b++) {
        for (k = 0; k < WELKIN__LOOKS; k++)
            for (seen[k][b] = 0, i = 0; i < 4; i++) seen[k][b] += tensor[k][i] * (double)welkin__f32(factor + 4 * ((size_t)i * rm + b));
        for (i = 0; i < nh; i++)
            seen[WELKIN__PARTICLES][b] += harmonics[i] * (double)welkin__f32(factor + 4 * ((size_t)(4 + i) * rm + b));
    }
}

/* The core of a visibility at an altitude and sun, seen in every way: [look][channel components]. */
static void welkin__contract(const welkin_aerial_perspective *aerial, uint32_t visibility, const double *a,
                             const double *s, double (*seen)[WELKIN__MAX_MOMENTS],
                             double (*out)[WELKIN__MAX_COMPONENTS])
{
    float sum[WELKIN__MAX_MOMENTS * WELKIN__MAX_COMPONENTS];
    const float *core = aerial->core[visibility];
    uint32_t i, j, b, c, rc = aerial->rank[3], width = aerial->rank[2] * rc;
    for (c = 0; c < width; c++) sum[c] = 0;
    for (i = 0; i < aerial->rank[0]; i++)
        for (j = 0; j < aerial->rank[1]; j++, core += width) {
            float weight = welkin__narrow(a[i] * s[j]);
            for (c = 0; c < width; c++) sum[c] += weight * core[c];
        }
    for (i = 0; i < WELKIN__LOOKS; i++)
        for (c = 0; c < rc; c++)
            for (out[i][c] = 0, b = 0; b < aerial->rank[2]; b++) out[i][c] += seen[i][b] * (double)sum[b * rc + c];
}

static double welkin__level_at(const welkin_aerial_perspective *aerial, uint32_t visibility, const welkin__stencil *sun,
                               uint32_t field, uint32_t w)
{
    double sum = 0;
    uint32_t i, nw = aerial->air.file->wavelengths;
    for (i = 0; i < sun->count; i++)
        sum += sun->weight[i] * (double)welkin__f32(aerial->level[visibility] + 4 * (((size_t)field * aerial->suns + sun->node[i]) * nw + w));
    return sum;
}

/* S_R, S_A, Q_R and U_R at every wavelength. */
static void welkin__sources(const welkin_aerial_perspective *aerial, const welkin__spot *spot,
                            double (*out)[WELKIN_MAX_WAVELENGTHS])
{
    welkin__stencil altitude = welkin__at_nodes(aerial->altitude, aerial->altitudes, spot->altitude, WELKIN__CUBE_ROOT);
    welkin__stencil sun = welkin__at_nodes(aerial->sine, aerial->suns, spot->sine, WELKIN__SINE);
    double a[WELKIN__MAX_COMPONENTS], s[WELKIN__MAX_COMPONENTS], seen[WELKIN__LOOKS][WELKIN__MAX_MOMENTS],
        part[WELKIN__LOOKS][WELKIN__MAX_COMPONENTS];
    double logarithm[WELKIN_MAX_WAVELENGTHS] = {0};
    uint32_t m, w, i, c, f, rc = aerial->rank[3], nw = aerial->air.file->wavelengths;
    welkin__mix(aerial->factor[0], aerial->rank[0], &altitude, a);
    welkin__mix(aerial->factor[1], aerial->rank[1], &sun, s);
    welkin__see(aerial, spot, seen);
    for (i = 0; i < WELKIN__LOOKS; i++)
        for (w = 0; w < nw; w++) out[i][w] = 0;
    for (m = 0; m < aerial->visibilities; m++) {
        welkin__contract(aerial, m, a, s, seen, part);
        for (w = 0; w < nw; w++) {
            double air = welkin__level_at(aerial, m, &sun, 0, w), ground = welkin__level_at(aerial, m, &sun, 1, w);
            double share[2] = {1, 0};
            share[1] = (double)aerial->bounce[w] * exp(ground - air);
            logarithm[w] += aerial->weight[m] * air;
            for (i = 0; i < WELKIN__LOOKS; i++)
                for (f = 0; f < 2; f++)
                    for (c = 0; c < rc; c++)
                        out[i][w] += aerial->weight[m] * share[f] * part[i][c] *
                                     (double)welkin__f32(aerial->factor[3] + 4 * (((size_t)f * nw + w) * rc + c));
        }
    }
    for (i = 0; i < WELKIN__LOOKS; i++)
        for (w = 0; w < nw; w++) out[i][w] = exp(logarithm[w]) * (i < WELKIN__Q && out[i][w] < 0 ? 0 : out[i][w]);
}

/* Times 4 pi. */
static double welkin__phase_value(uint32_t phase, double p, const double v[3], const double sun[3])
{
    double less = 0, plus = 0, cosine = welkin__dot(v, sun), delta = (1 - p) / (1 + p / 2), size = fabs(p), x;
    int i;
    if (phase == 1) return delta * 0.75 * (1 + cosine * cosine) + 1 - delta;
    for (i = 0; i < 3; i++) {
        less += (v[i] - sun[i]) * (v[i] - sun[i]) / 2;
        plus += (v[i] + sun[i]) * (v[i] + sun[i]) / 2;
    }
    x = (1 - size) * (1 - size) + 2 * size * (p > 0 ? less : plus);
    return (1 - size) * (1 + size) / (x * sqrt(x));
}

/* L, Q and U per metre of what the air of a point sends along the segment. */
static void welkin__emission(const welkin_aerial_perspective *aerial, const welkin__spot *spot,
                             const welkin__sight *sight, double (*light)[WELKIN_MAX_WAVELENGTHS])
{
    double profile[WELKIN_MAX_CONSTITUENTS], sunlight[WELKIN_MAX_WAVELENGTHS], source[WELKIN__LOOKS][WELKIN_MAX_WAVELENGTHS];
    size_t nw = aerial->air.file->wavelengths, nk = aerial->air.file->constituents, w, k;
    uint32_t p;
    welkin__profiles(&aerial->air, spot->altitude, profile);
    welkin__sunlight(aerial, spot, sunlight);
    welkin__sources(aerial, spot, source);
    for (k = 0; k < 3; k++)
        for (w = 0; w < nw; w++) light[k][w] = 0;
    for (p = 0; p < aerial->species; p++)
        for (w = 0; w < nw; w++) {
            double parameter = (double)aerial->parameter[p * nw + w], once = sunlight[w] / (4 * WELKIN__PI), scattering = 0, dipole;
            int molecules = aerial->phase[p] == 1;
            for (k = 0; k < nk; k++) scattering += (double)aerial->scattering[(p * nk + k) * nw + w] * profile[k];
            light[0][w] += scattering * (once * welkin__phase_value(aerial->phase[p], parameter, sight->v, aerial->sun) +
                                         source[molecules ? WELKIN__MOLECULES : WELKIN__PARTICLES][w]);
            if (!molecules) continue;
            dipole = once * 0.75 * (1 - parameter) / (1 + parameter / 2);
            light[1][w] += scattering * (dipole * (sight->p2 * sight->p2 - sight->p1 * sight->p1) + source[WELKIN__Q][w]);
            light[2][w] += scattering * (-2 * dipole * sight->p1 * sight->p2 + source[WELKIN__U][w]);
        }
}

/* Ends of intervals between two distances from the tangent point, ever closer towards the start and towards the lowest
 * point. */
static uint32_t welkin__intervals(double start, double end, double *ends)
{
    double length = end - start, lowest = fmin(fmax(0, start), end), step = 1;
    uint32_t n = 0, i, j;
    ends[n++] = start;
    ends[n++] = end;
    ends[n++] = lowest;
    for (i = 1; i <= 10; i++) {
        step /= 2;
        ends[n++] = start + length * step;
        ends[n++] = fmax(start, lowest - length * step);
        ends[n++] = fmin(end, lowest + length * step);
    }
    for (i = 1; i < 8; i++) ends[n++] = start + length * i / 8;
    for (i = 1; i < n; i++)
        for (j = i; j > 0 && ends[j - 1] > ends[j]; j--) {
            double swap = ends[j];
            ends[j] = ends[j - 1];
            ends[j - 1] = swap;
        }
    return n;
}

/* The segment from an altitude along a unit vector; Gauss-Legendre rule of three points in each interval. */
static void welkin__gather(const welkin_aerial_perspective *aerial, double altitude, const welkin__sight *sight,
                           const welkin__line *segment, double (*sum)[WELKIN_MAX_WAVELENGTHS])
{
    static const double node[3] = {-0.7745966692414834, 0, 0.7745966692414834}, weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const welkin_file *f = aerial->air.file;
    double top = f->top_altitude + f->top_altitude * f->top_altitude / (2 * f->planet_radius), reach = welkin__crossing(segment, top);
    double ends[64], columns[WELKIN_MAX_CONSTITUENTS] = {0}, light[3][WELKIN_MAX_WAVELENGTHS], through[WELKIN_MAX_WAVELENGTHS];
    double start = fmax(segment->start, -reach), end = fmin(segment->end, reach);
    welkin__line piece = *segment;
    uint32_t i, j, k, w, n;
    piece.end = start;
    n = end > start ? welkin__intervals(start, end, ends) : 0;
    for (i = 1; i < n; i++)
        for (j = 0; j < 3 && ends[i] > ends[i - 1]; j++) {
            double half = (ends[i] - ends[i - 1]) / 2, s = ends[i - 1] + half * (1 + node[j]);
            welkin__spot spot = welkin__spot_at(aerial, altitude, sight->v, s - segment->start);
            piece.start = piece.end;
            piece.end = s;
            welkin__integrate(&aerial->air, &piece, columns);
            welkin__attenuate(aerial, columns, through);
            welkin__emission(aerial, &spot, sight, light);
            for (k = 0; k < 3; k++)
                for (w = 0; w < f->wavelengths; w++) sum[k][w] += 2 * half * weight[j] * through[w] * light[k][w];
        }
}

/* Sums of L, Q and U along a segment. */
static welkin_error welkin__in_scattering(const welkin_aerial_perspective *aerial, double altitude,
                                          const double direction[3], double distance,
                                          double (*sum)[WELKIN_MAX_WAVELENGTHS])
{
    double radius;
    welkin__line line;
    welkin__sight sight;
    int good = 1;
    uint32_t w;
    welkin_error error = WELKIN_ERROR_STATE;
    if (aerial->air.file) error = welkin__segment(altitude, direction, distance, sight.v);
    if (error) return error;
    welkin__find_sun(&sight, aerial->sun);
    line.radius = radius = aerial->air.file->planet_radius;
    line.start = (radius + altitude) * sight.v[2];
    line.end = line.start + distance;
    line.low = altitude + (altitude * altitude - line.start * line.start) / (2 * radius);
    welkin__gather(aerial, altitude, &sight, &line, sum);
    for (w = 0; w < aerial->air.file->wavelengths; w++) good &= sum[0][w] >= 0 && sum[0][w] <= (double)FLT_MAX;
    return good ? WELKIN_OK : WELKIN_ERROR_VALUE;
}

WELKIN_API welkin_error welkin_in_scattering(const welkin_aerial_perspective *aerial, double altitude,
                                             const double direction[3], double distance, float *light)
{
    double sum[3][WELKIN_MAX_WAVELENGTHS] = {{0}};
    uint32_t w;
    welkin_error error = welkin__in_scattering(aerial, altitude, direction, distance, sum);
    for (w = 0; !error && w < aerial->air.file->wavelengths; w++) light[w] = welkin__narrow(sum[0][w]);
    return error;
}

WELKIN_API welkin_error welkin_in_scattering_stokes(const welkin_aerial_perspective *aerial, double altitude,
                                                    const double direction[3], double distance, float *light, float *q,
                                                    float *u)
{
    double sum[3][WELKIN_MAX_WAVELENGTHS] = {{0}};
    uint32_t w;
    welkin_error error = welkin__in_scattering(aerial, altitude, direction, distance, sum);
    for (w = 0; !error && w < aerial->air.file->wavelengths; w++) {
        light[w] = welkin__narrow(sum[0][w]);
        error = welkin__limit_polarisation(light[w], sum[1][w], sum[2][w], &q[w], &u[w]);
    }
    return error;
}

#endif /* WELKIN_IMPLEMENTATION */
