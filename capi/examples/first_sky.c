/* Opens the embedded model, prepares a sky, bakes it in colour and prints what is seen. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <welkin/capi.h>

/* Ends the program where a call failed. */
static void check(WelkinStatus status, const WelkinError *error)
{
    if (status != WELKIN_STATUS_OK) {
        fprintf(stderr, "%s: %s\n", welkin_status_name(status), error->text);
        exit(EXIT_FAILURE);
    }
}

int main(void)
{
    WelkinError error;
    check(welkin_check_abi(WELKIN_ABI, &error), &error);

    WelkinModel *model;
    check(welkin_model_default(&model, &error), &error); /* or welkin_model_open("file.welkin", &model, &error) */

    WelkinConditions conditions;
    check(welkin_conditions_init(&conditions, sizeof conditions, &error), &error);
    conditions.solar_elevation = 0.1; /* rad */
    conditions.visibility = 40e3;     /* m */

    WelkinColourSky *sky;
    WelkinBakedColourSky *baked;
    check(welkin_colour_sky_new(model, &conditions, &sky, &error), &error);
    check(welkin_colour_sky_bake(sky, WELKIN_BAKE_TOLERANCE, &baked, &error), &error);

    puts("elevation    linear sRGB, cd/m2, away from the sun");
    for (int degrees = 0; degrees <= 90; degrees += 15) {
        const float elevation = (float)degrees * 0.0174532925f;
        const float direction[3] = {-cosf(elevation), 0.0f, sinf(elevation)};
        float rgb[3];
        check(welkin_baked_colour_sky_rgb(baked, direction, WELKIN_SPACE_SRGB, rgb, &error), &error);
        printf("%9d    %8.1f %8.1f %8.1f\n", degrees, (double)rgb[0], (double)rgb[1], (double)rgb[2]);
    }

    /* What the model does not cover is refused. */
    conditions.visibility = 50.0;
    WelkinSky *fog;
    if (welkin_sky_new(model, &conditions, &fog, &error) != WELKIN_STATUS_RANGE || fog != NULL) {
        return EXIT_FAILURE;
    }
    printf("fog: %s\n", error.text);

    welkin_baked_colour_sky_free(baked);
    welkin_colour_sky_free(sky);
    welkin_model_free(model);
    return EXIT_SUCCESS;
}
