/* A sun that moves: a course of skies is baked once, then each frame costs microseconds. Also a sky that is baked anew
 * for each frame, to compare. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <welkin/capi.h>

#define FRAMES 24

static const double DEGREE = 0.017453292519943295;

static void check(WelkinStatus status, const WelkinError *error)
{
    if (status != WELKIN_STATUS_OK) {
        fprintf(stderr, "%s: %s\n", welkin_status_name(status), error->text);
        exit(EXIT_FAILURE);
    }
}

/* Luminance of the zenith, cd/m2, of a sky that is prepared and baked for this frame alone. */
static float baked_anew(const WelkinModel *model, WelkinConditions conditions, double elevation)
{
    const float zenith[3] = {0.0f, 0.0f, 1.0f};
    WelkinError error;
    WelkinColourSky *sky;
    WelkinBakedColourSky *baked;
    float xyz[3];
    conditions.solar_elevation = elevation;
    check(welkin_colour_sky_new(model, &conditions, &sky, &error), &error);
    check(welkin_colour_sky_bake(sky, WELKIN_BAKE_TOLERANCE, &baked, &error), &error);
    check(welkin_baked_colour_sky_xyz(baked, zenith, xyz, &error), &error);
    welkin_baked_colour_sky_free(baked);
    welkin_colour_sky_free(sky);
    return xyz[1];
}

int main(void)
{
    WelkinError error;
    check(welkin_check_abi(WELKIN_ABI, &error), &error);
    WelkinModel *model;
    check(welkin_model_default(&model, &error), &error);
    WelkinConditions conditions;
    check(welkin_conditions_init(&conditions, sizeof conditions, &error), &error);

    const double elevations[2] = {5.0 * DEGREE, 30.0 * DEGREE};
    WelkinSunCourse *course;
    check(welkin_sun_course_new(model, &conditions, elevations, WELKIN_BAKE_TOLERANCE, &course, &error), &error);
    printf("%zu skies, %zu kB\n", welkin_sun_course_skies(course), welkin_sun_course_bytes(course) / 1000);

    WelkinBakedColourSky *sky;
    check(welkin_sun_course_at(course, elevations[0], 0.0, &sky, &error), &error);
    int bad = 0;
    for (int frame = 0; frame < FRAMES; ++frame) {
        const double along = (double)frame / (FRAMES - 1);
        const double elevation = elevations[0] + along * (elevations[1] - elevations[0]);
        const double azimuth = -0.5 + along;
        check(welkin_sun_course_write(course, elevation, azimuth, sky, &error), &error);
        const float zenith[3] = {0.0f, 0.0f, 1.0f};
        float xyz[3];
        check(welkin_baked_colour_sky_xyz(sky, zenith, xyz, &error), &error);
        const float anew = baked_anew(model, conditions, elevation);
        const float difference = fabsf(xyz[1] / anew - 1.0f);
        printf("%5.1f degrees: %7.1f cd/m2, baked anew %7.1f\n", elevation / DEGREE, (double)xyz[1], (double)anew);
        bad += !(difference < 0.01f);
    }
    welkin_baked_colour_sky_free(sky);
    welkin_sun_course_free(course);
    welkin_model_free(model);
    return bad == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
