/* The disc of the sun as the library has it: limb darkening after Neckel & Labs 1994, the transmittance of the air before
 * each part of it, and black below the geometric horizon. Format specification, section 7.8.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef WELKIN_WEB_SUN_H
#define WELKIN_WEB_SUN_H

enum { SUN_ROWS = 65, SUN_TERMS = 6, SUN_FLOATS = 4 * SUN_ROWS * SUN_TERMS, SUN_HEADER = 4, LIMB_ROWS = 30 };

/* Wavelength, nm, and coefficients of I(mu)/I(1) = sum A_k mu^k; Solar Physics 153, 91, Table 1. */
static const double LIMB[LIMB_ROWS][1 + SUN_TERMS] = {
    {303.327, 0.08011, 0.70695, 0.49910, -0.31080, -0.02177, 0.04642},
    {310.843, 0.08160, 0.71609, 0.69685, -0.87703, 0.47008, -0.08760},
    {320.468, 0.08833, 0.77285, 0.65382, -1.04647, 0.72921, -0.19775},
    {329.897, 0.09188, 0.92459, 0.19604, -0.39546, 0.23599, -0.05303},
    {349.947, 0.11012, 1.02168, -0.10924, -0.00055, -0.08688, 0.06487},
    {365.875, 0.12828, 1.04969, 0.17482, -1.13371, 1.23882, -0.45990},
    {374.086, 0.12579, 0.85402, 0.54601, -1.15048, 0.88928, -0.26462},
    {390.915, 0.12995, 0.91836, -0.07566, 0.19149, -0.28712, 0.12298},
    {401.970, 0.12323, 1.08648, -0.43974, 0.45912, -0.32759, 0.09850},
    {416.319, 0.12814, 1.19947, -0.84407, 1.07201, -0.79537, 0.23982},
    {427.930, 0.14249, 1.28796, -1.19564, 1.68603, -1.36658, 0.44572},
    {443.885, 0.16220, 1.24893, -0.92165, 0.89978, -0.50148, 0.11220},
    {445.125, 0.15248, 1.38517, -1.49615, 1.99886, -1.48155, 0.44119},
    {457.345, 0.16604, 1.38544, -1.52275, 2.00232, -1.45969, 0.42864},
    {477.427, 0.19571, 1.30551, -1.25845, 1.50626, -1.05472, 0.30570},
    {492.905, 0.20924, 1.30798, -1.20411, 1.21505, -0.67196, 0.14381},
    {519.930, 0.23695, 1.29927, -1.28034, 1.37760, -0.85054, 0.21706},
    {541.760, 0.26073, 1.27428, -1.30352, 1.47085, -0.96618, 0.26384},
    {559.950, 0.26892, 1.34319, -1.58427, 1.91271, -1.31350, 0.37295},
    {579.880, 0.28392, 1.36896, -1.75998, 2.22154, -1.56074, 0.44630},
    {610.975, 0.30854, 1.36620, -1.83572, 2.33221, -1.63082, 0.45959},
    {640.970, 0.33644, 1.30590, -1.79238, 2.45040, -1.89979, 0.59943},
    {669.400, 0.34685, 1.37539, -2.04425, 2.70493, -1.94290, 0.55999},
    {700.875, 0.37885, 1.25553, -1.70908, 2.19647, -1.59554, 0.47378},
    {748.710, 0.40627, 1.22842, -1.67877, 2.05535, -1.39972, 0.38845},
    {811.760, 0.42977, 1.25182, -1.85164, 2.31949, -1.59101, 0.44155},
    {869.600, 0.45396, 1.25101, -2.02958, 2.75410, -2.02287, 0.59338},
    {948.850, 0.47855, 1.19813, -1.86296, 2.36939, -1.64367, 0.46056},
    {1046.600, 0.49870, 1.21429, -2.06976, 2.80703, -2.05247, 0.60221},
    {1098.950, 0.51149, 1.19354, -2.00174, 2.66936, -1.94981, 0.57715}};

/* Coefficients at a wavelength, of mean 1 over the disc: linear between those published, constant beyond them. */
static void limb_profile(double wavelength, double profile[SUN_TERMS])
{
    uint32_t i = 0, k;
    double t, mean = 0;
    while (i < LIMB_ROWS - 2 && LIMB[i + 1][0] <= wavelength) i++;
    t = fmin(fmax((wavelength - LIMB[i][0]) / (LIMB[i + 1][0] - LIMB[i][0]), 0), 1);
    for (k = 0; k < SUN_TERMS; k++) {
        profile[k] = LIMB[i][1 + k] + t * (LIMB[i + 1][1 + k] - LIMB[i][1 + k]);
        mean += 2 * profile[k] / (k + 2.0);
    }
    for (k = 0; k < SUN_TERMS; k++) profile[k] /= mean;
}

/* X, Y and Z of the coefficients at an elevation, [term][4]. */
static welkin_error sun_row(const welkin_transmittance_profile *air, double altitude, double elevation, float *out)
{
    const double solid_angle = 4 * WELKIN__PI * sin(WELKIN__SUN_RADIUS / 2) * sin(WELKIN__SUN_RADIUS / 2);
    double direction[3] = {cos(elevation), 0, sin(elevation)}, profile[WELKIN_MAX_WAVELENGTHS][SUN_TERMS], xyz[3];
    float through[WELKIN_MAX_WAVELENGTHS], part[WELKIN_MAX_WAVELENGTHS];
    uint32_t w, k, c, nw = air->file->wavelengths;
    welkin_error error = welkin_transmittance(air, altitude, direction, 2e7, through);
    for (w = 0; w < nw; w++) limb_profile(welkin_wavelength(air->file, w), profile[w]);
    for (k = 0; k < SUN_TERMS && !error; k++) {
        for (w = 0; w < nw; w++) part[w] = (float)((double)through[w] * profile[w][k] / solid_angle);
        welkin_xyz(air->file, part, xyz);
        for (c = 0; c < 3; c++) out[4 * k + c] = (float)xyz[c];
        out[4 * k + 3] = 0;
    }
    return error;
}

/* Fills [elevation][term][4], from the lowest to the highest elevation of the disc that is seen; the header says where
 * the first row is and how many there are to a radian (0: the sun has set), and below which elevation the disc is hidden. */
static welkin_error sun_fill(const welkin_file *file, const welkin_conditions *c, float *out, float *head)
{
    welkin_transmittance_profile air;
    double dip = atan(sqrt(c->altitude * (2 * file->planet_radius + c->altitude)) / file->planet_radius);
    double low = fmax(c->solar_elevation - WELKIN__SUN_RADIUS, -dip);
    double high = fmin(c->solar_elevation + WELKIN__SUN_RADIUS, WELKIN__HALF_PI);
    welkin_error error = welkin_transmittance_prepare(&air, file, c->visibility);
    uint32_t i;
    memset(out, 0, SUN_FLOATS * sizeof *out);
    head[0] = (float)low;
    head[1] = high > low ? (float)((SUN_ROWS - 1) / (high - low)) : 0;
    head[2] = (float)-dip;
    head[3] = (float)(2 * sin(WELKIN__SUN_RADIUS / 2));
    for (i = 0; i < SUN_ROWS && high > low && !error; i++)
        error = sun_row(&air, c->altitude, low + (high - low) * i / (SUN_ROWS - 1), out + 4 * SUN_TERMS * i);
    return error;
}

#endif
