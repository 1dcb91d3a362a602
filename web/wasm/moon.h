/* The moon in place of the sun: its light over that of the sun, as the library's `Moon` has it (H. H. Kieffer and T. C.
 * Stone, The spectral irradiance of the Moon, Astronomical Journal 129 (2005), equations 8 and 10 and table 4; the mean
 * of waxing and waning moons, a cubic in the logarithm of the wavelength through the bands; thin crescents after
 * Krisciunas and Schaefer 1991), and a file whose colours are those of moonlight.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef WELKIN_WEB_MOON_H
#define WELKIN_WEB_MOON_H

enum { MOON_BANDS = 32, MOON_TERMS = 4 };

/* Wavelength (nm), coefficients of powers of the phase angle (rad), and of its surge near full moon. */
typedef struct moon_band {
    double wavelength, a[4], d[3];
} moon_band;

static const moon_band moon_bands[MOON_BANDS] = {
    {350.0, {-2.67511, -1.78539, 0.50612, -0.25578}, {0.34185, 0.01441, -0.01602}},
    {355.1, {-2.71924, -1.74298, 0.44523, -0.23315}, {0.33875, 0.01612, -0.00996}},
    {405.0, {-2.35754, -1.72134, 0.40337, -0.21105}, {0.35235, -0.03818, -0.00006}},
    {412.3, {-2.34185, -1.74337, 0.42156, -0.21512}, {0.36591, -0.05902, 0.00080}},
    {414.4, {-2.43367, -1.72184, 0.43600, -0.22675}, {0.35558, -0.03247, -0.00503}},
    {441.6, {-2.31964, -1.72114, 0.37286, -0.19304}, {0.37935, -0.09562, 0.00970}},
    {465.8, {-2.35085, -1.66538, 0.41802, -0.22541}, {0.33450, -0.02546, -0.00484}},
    {475.0, {-2.28999, -1.63180, 0.36193, -0.20381}, {0.33024, -0.03131, 0.00222}},
    {486.9, {-2.23351, -1.68573, 0.37632, -0.19877}, {0.36590, -0.08945, 0.00678}},
    {544.0, {-2.13864, -1.60613, 0.27886, -0.16426}, {0.37190, -0.10629, 0.01428}},
    {549.1, {-2.10782, -1.66736, 0.41697, -0.22026}, {0.36814, -0.09815, 0.0}},
    {553.8, {-2.12504, -1.65970, 0.38409, -0.20655}, {0.37206, -0.10745, 0.00347}},
    {665.1, {-1.88914, -1.58096, 0.30477, -0.17908}, {0.37141, -0.13514, 0.01248}},
    {693.1, {-1.89410, -1.58509, 0.28080, -0.16427}, {0.39109, -0.17048, 0.01754}},
    {703.6, {-1.92103, -1.60151, 0.36924, -0.20567}, {0.37155, -0.13989, 0.00412}},
    {745.3, {-1.86896, -1.57522, 0.33712, -0.19415}, {0.36888, -0.14828, 0.00958}},
    {763.7, {-1.85258, -1.47181, 0.14377, -0.11589}, {0.39126, -0.16957, 0.03053}},
    {774.8, {-1.80271, -1.59357, 0.36351, -0.20326}, {0.36908, -0.16182, 0.00830}},
    {865.3, {-1.74561, -1.58482, 0.35009, -0.19569}, {0.39200, -0.18837, 0.00978}},
    {872.6, {-1.76779, -1.60345, 0.37974, -0.20625}, {0.39354, -0.19360, 0.00568}},
    {882.0, {-1.73011, -1.61156, 0.36115, -0.19576}, {0.40714, -0.21499, 0.01146}},
    {928.4, {-1.75981, -1.45395, 0.13780, -0.11254}, {0.41900, -0.19963, 0.02940}},
    {939.3, {-1.76245, -1.49892, 0.07956, -0.07546}, {0.47936, -0.29463, 0.04706}},
    {942.1, {-1.66473, -1.61875, 0.14630, -0.09216}, {0.57275, -0.38204, 0.04902}},
    {1059.5, {-1.59323, -1.71358, 0.50599, -0.25178}, {0.48160, -0.29486, 0.00116}},
    {1243.2, {-1.53594, -1.55214, 0.31479, -0.18178}, {0.49040, -0.30970, 0.01237}},
    {1538.7, {-1.33802, -1.46208, 0.15784, -0.11712}, {0.53831, -0.38432, 0.03473}},
    {1633.6, {-1.34567, -1.46057, 0.23813, -0.15494}, {0.54393, -0.37182, 0.01845}},
    {1981.5, {-1.26203, -1.25138, -0.06569, -0.04005}, {0.49099, -0.36092, 0.04707}},
    {2126.3, {-1.18946, -2.55069, 2.10026, -0.87285}, {0.29239, -0.34784, -0.13444}},
    {2250.9, {-1.04232, -1.46809, 0.43817, -0.24632}, {0.38154, -0.28937, -0.01110}},
    {2383.6, {-1.08403, -1.31032, 0.20323, -0.15863}, {0.36134, -0.28408, 0.01010}}};

/* Degrees over which the brightness falls off near full moon, and the largest phase angle that was seen. */
static const double moon_p[4] = {4.06054, 12.8802, -30.5858, 16.7498};
static const double moon_seen = 97;
/* Solid angle of the moon at its mean distance, sr. */
static const double moon_solid_angle = 6.4177e-5;

/* Orthogonal polynomials through the bands. */
typedef struct moon_light {
    double coefficient[MOON_TERMS], middle[MOON_TERMS], share[MOON_TERMS];
} moon_light;

static double moon_coordinate(double wavelength) { return log(wavelength * 1e-3); }

static double moon_logarithm(const moon_band *b, double degrees)
{
    double g = degrees * WELKIN__PI / 180;
    double powers = b->a[0] + g * (b->a[1] + g * (b->a[2] + g * b->a[3]));
    double surge = b->d[0] * exp(-degrees / moon_p[0]) + b->d[1] * exp(-degrees / moon_p[1]);
    return powers + surge + b->d[2] * cos((degrees - moon_p[2]) / moon_p[3]);
}

static double moon_visual(double degrees)
{
    return -0.4 * log(10) * (0.026 * degrees + 4e-9 * degrees * degrees * degrees * degrees);
}

/* At a phase angle in degrees. */
static void moon_prepare(moon_light *m, double degrees)
{
    double x[MOON_BANDS], value[MOON_BANDS], here[MOON_BANDS], before[MOON_BANDS], size_before = 1, seen = fmin(degrees, moon_seen);
    int i, k;
    for (i = 0; i < MOON_BANDS; i++) {
        x[i] = moon_coordinate(moon_bands[i].wavelength);
        value[i] = moon_logarithm(&moon_bands[i], seen);
        here[i] = 1, before[i] = 0;
    }
    for (k = 0; k < MOON_TERMS; k++) {
        double size = 0, along = 0, shifted = 0;
        for (i = 0; i < MOON_BANDS; i++) {
            size += here[i] * here[i];
            along += here[i] * value[i];
            shifted += here[i] * here[i] * x[i];
        }
        m->coefficient[k] = along / size, m->middle[k] = shifted / size, m->share[k] = size / size_before;
        for (i = 0; i < MOON_BANDS; i++) {
            double next = (x[i] - m->middle[k]) * here[i] - m->share[k] * before[i];
            before[i] = here[i], here[i] = next;
        }
        size_before = size;
    }
    m->coefficient[0] += moon_visual(degrees) - moon_visual(seen);
}

/* Spectral irradiance over that of the sun, at mean distance. */
static double moon_relative(const moon_light *m, double wavelength)
{
    double x = moon_coordinate(wavelength), before = 0, here = 1, sum = 0;
    int k;
    for (k = 0; k < MOON_TERMS; k++) {
        double next = (x - m->middle[k]) * here - m->share[k] * before;
        sum += m->coefficient[k] * here;
        before = here, here = next;
    }
    return moon_solid_angle / WELKIN__PI * exp(sum);
}

/* Bytes behind those of a file that its moonlit twin needs. */
enum { MOON_BYTES = 24 * WELKIN_MAX_WAVELENGTHS };

/* The same file with the weights of colours of moonlight, which lie behind its bytes. */
static void moon_file(welkin_file *lit, const welkin_file *file, unsigned char *bytes, const moon_light *m)
{
    uint32_t w, c;
    *lit = *file;
    lit->xyz_at = file->length;
    for (w = 0; w < file->wavelengths; w++)
        for (c = 0; c < 3; c++) {
            size_t at = 8 * (3 * (size_t)w + c);
            double weight = welkin__f64(bytes + file->xyz_at + at) * moon_relative(m, welkin_wavelength(file, w));
            memcpy(bytes + lit->xyz_at + at, &weight, sizeof weight); /* WebAssembly is little-endian, as files are */
        }
}

#endif
