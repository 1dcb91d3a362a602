// The C++ wrapper: every type does something, errors are exceptions, and handles move.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <type_traits>
#include <utility>
#include <vector>

#include <welkin/welkin.hpp>

namespace {

using namespace welkin;

#define EXPECT(condition)                                                 \
    do {                                                                  \
        if (!(condition)) {                                               \
            std::fprintf(stderr, "line %d: %s\n", __LINE__, #condition);  \
            std::exit(EXIT_FAILURE);                                      \
        }                                                                 \
    } while (false)

template <class Body>
void expect_error(WelkinStatus status, Body body) {
    try {
        body();
    } catch (const Error &error) {
        if (error.code() != status) std::fprintf(stderr, "%s: %s\n", error.name(), error.what());
        EXPECT(error.code() == status && error.what()[0] != '\0');
        return;
    }
    EXPECT(status == WELKIN_STATUS_OK);
}

// What all that is prepared has.
template <class T>
void expect_prepared(T &&prepared) {
    using Plain = std::decay_t<T>;
    static_assert(std::is_move_constructible_v<Plain> && !std::is_copy_constructible_v<Plain>);
    prepared.set_solar_azimuth(0.75);
    EXPECT(prepared.conditions().solar_azimuth == 0.75);
    EXPECT(prepared.bytes() > 1000);
    const Plain moved = std::move(prepared);
    EXPECT(moved.bytes() > 1000 && prepared.bytes() == 0 && prepared.get() == nullptr);
    expect_error(WELKIN_STATUS_NULL, [&] { prepared.conditions(); });
}

constexpr Vec3 UP = {0.0f, 0.0f, 1.0f};
constexpr Four HEROES = {430.0f, 510.0f, 590.0f, 670.0f};

void skies(const Model &model, const Conditions &conditions) {
    const Sky sky(model, conditions);
    const std::vector<double> nm = sky.wavelengths();
    EXPECT(nm == model.wavelengths());
    std::vector<float> one(nm.size()), two(2 * nm.size()), other(2 * nm.size());
    const std::array<Vec3, 2> directions = {UP, Vec3{0.3f, 0.1f, 0.9f}};
    sky.radiance(UP, one);
    sky.radiance(directions, two);
    EXPECT(one[3] == two[3] && one[3] > 0.0f && sky.radiance_at(UP, 550.0) > 0.0f);
    expect_error(WELKIN_STATUS_LENGTH, [&] { sky.radiance(UP, two); });
    expect_error(WELKIN_STATUS_DIRECTION, [&] { sky.xyz({}); });
    EXPECT(from_xyz(Space::rec2020, sky.xyz(UP)) == sky.rgb(UP, Space::rec2020));
    EXPECT(std::abs(sky.sun_direction()[2] - float(conditions.sun_direction()[2])) < 1e-6f);

    const BakedSky baked = sky.bake();
    const std::array<float, 2> x = {0.0f, 0.3f}, y = {0.0f, 0.1f}, z = {1.0f, 0.9f};
    const Directions arrays = {x.data(), y.data(), z.data(), 2};
    baked.radiance(directions, two);
    baked.radiance(arrays, other);
    baked.radiance(UP, one);
    EXPECT(two == other && one[3] == two[3] && baked.wavelengths() == nm);
    const std::array<Four, 2> heroes = {HEROES, HEROES};
    std::array<Four, 2> radiances{};
    baked.hero(arrays, heroes, radiances);
    EXPECT(radiances[0] == baked.hero(UP, HEROES) && radiances[1] != radiances[0]);
    std::array<Four, 3> many{};
    expect_error(WELKIN_STATUS_LENGTH, [&] { baked.hero(arrays, heroes, many); });
    baked.irradiance(UP, one);
    EXPECT(one[3] > 0.0f && baked.bake_error().p95 <= WELKIN_BAKE_TOLERANCE);

    const ColourSky colour_sky(model, conditions);
    BakedColourSky colour = colour_sky.bake();
    std::array<Vec3, 2> rgb{}, same{};
    colour.rgb(directions, rgb, Space::acescg);
    colour.rgb(arrays, same, Space::acescg);
    EXPECT(rgb == same && rgb[0] == colour.rgb(UP, Space::acescg) && colour_sky.rgb(UP)[1] > 0.0f);
    EXPECT(sky.bake_colour().xyz(UP)[1] > 0.0f && colour_sky.bake_like(colour).xyz(UP) == colour.xyz(UP));
    EXPECT(colour.bake_error().p95 <= WELKIN_BAKE_TOLERANCE && colour_sky.xyz(UP)[1] > 0.0f);

    const SolarDisc disc(model, conditions);
    EXPECT(disc.is_visible() && disc.solid_angle() > 6e-5 && disc.rgb(disc.direction())[0] > 1e6f);
    disc.radiance(disc.direction(), one);
    EXPECT(one[3] > 0.0f && disc.radiance_at(disc.direction(), 550.0) > 0.0f);
    disc.irradiance(UP, one);
    const SkySampler sampler = colour.sampler(disc);
    const Sample sample = sampler.sample(0.001f, 0.5f);
    EXPECT(sample.part == WELKIN_PART_SUN && colour.sampler().sample(0.001f, 0.5f).part == WELKIN_PART_SKY);
    const Vec3 drawn = {sample.direction[0], sample.direction[1], sample.direction[2]};
    EXPECT(sampler.pdf(drawn) == sample.pdf && sampler.xyz(drawn)[1] == sample.xyz[1]);
    const std::array<std::array<float, 2>, 2> points = {{{0.001f, 0.5f}, {0.7f, 0.2f}}};
    std::array<Sample, 2> samples{};
    sampler.sample(points, samples);
    EXPECT(samples[0].pdf == sample.pdf);

    const SunCourse course(model, conditions, {0.3, 0.4});
    course.write(0.35, 0.0, colour);
    EXPECT(colour.xyz(UP) == course.at(0.35, 0.0).xyz(UP) && course.skies() > 1 && course.bytes() > 1000);
    expect_error(WELKIN_STATUS_RANGE, [&] { course.at(1.0, 0.0); });
    expect_prepared(Sky(model, conditions));
    expect_prepared(ColourSky(model, conditions));
    expect_prepared(sky.bake());
    expect_prepared(std::move(colour));
}

void polarisation(const Model &model, const Conditions &conditions) {
    const PolarisedSky sky(model, conditions);
    const Stokes stokes = sky.stokes_at({0.1f, 0.5f, 0.6f}, Frame::sun_aligned(), 550.0);
    EXPECT(degree(stokes) > 0.01f && std::abs(angle(stokes)) < 1.6f);
    std::vector<Stokes> all(sky.wavelengths().size());
    sky.stokes(UP, Frame::vertical(), all);
    const BakedPolarisedSky baked = sky.bake();
    EXPECT(baked.hero({0.1f, 0.5f, 0.6f}, Frame::along(UP), HEROES)[2].i > 0.0f);
    std::vector<float> i(baked.wavelengths().size()), q(i.size()), u(i.size());
    baked.stokes(UP, Frame::vertical(), i.data(), q.data(), u.data(), i.size());
    EXPECT(std::abs(i[3] / all[3].i - 1.0f) < 0.01f);
    expect_prepared(PolarisedSky(model, conditions));
    expect_prepared(sky.bake());
}

void air(const Model &model, const Conditions &conditions) {
    const Point from = {0.0, 0.0, conditions.altitude}, to = {20e3, 0.0, 900.0}, up = {0.0, 0.0, 1.0};
    std::vector<float> light(model.wavelengths().size()), left(light.size());
    const Transmittance transmittance(model, conditions.visibility);
    transmittance.between(from, to, left);
    EXPECT(left[3] > 0.0f && left[3] < 1.0f && transmittance.between_at(from, to, 600.0) < 1.0f);
    transmittance.optical_depth(from, to, light);
    EXPECT(std::abs(std::exp(-light[3]) - left[3]) < 1e-5f);
    transmittance.to_space(from, up, left);
    transmittance.to_end(from, up, light);
    EXPECT(light == left);

    const AerialPerspective aerial(model, conditions);
    const Sky sky(model, conditions);
    aerial.in_scattering(from, to, light, left);
    EXPECT(light[3] > 0.0f && aerial.in_scattering_at(from, to, 600.0) > 0.0f);
    aerial.joined(sky, to, light, left);
    EXPECT(aerial.wavelengths().size() == light.size() && aerial.joined_srgb(sky, to).light[1] > 0.0f);
    const Seen seen = aerial.rgb(from, to);
    EXPECT(seen.factors[2] < seen.factors[0]);
    EXPECT(std::abs(aerial.rgb_stokes(from, to, Frame::vertical()).light[1].i / seen.light[1] - 1.0f) < 1e-3f);
    std::vector<float> few(3);
    expect_error(WELKIN_STATUS_LENGTH, [&] { aerial.in_scattering(from, to, light, few); });

    const ColourAerialPerspective colour(model, conditions);
    EXPECT(std::abs(colour.rgb(from, to).light[1] / seen.light[1] - 1.0f) < 1e-3f);
    const std::array<double, 2> distances = {1e3, 1e4};
    std::array<Vec3, 2> lights{}, factors{};
    colour.srgb_along(from, to, distances, lights, factors);
    EXPECT(lights[1][1] > lights[0][1]);
    CameraVolume volume;
    volume.from[2] = 2.0;
    volume.axis[0] = 1.0;
    volume.right[1] = -0.5;
    volume.up[2] = 0.5;
    volume.columns = volume.rows = 1;
    volume.depth_count = distances.size();
    volume.depths = distances.data();
    colour.srgb_volume(volume, lights, factors);
    EXPECT(lights[1][1] > lights[0][1] && factors[1][1] < factors[0][1]);
    expect_prepared(AerialPerspective(model, conditions));
    expect_prepared(ColourAerialPerspective(model, conditions));
}

void plans_and_the_moon(const Model &model, const Conditions &conditions) {
    Budget budget;
    budget.altitude[1] = 500.0;
    budget.visibility[0] = budget.visibility[1] = conditions.visibility;
    budget.solar_elevation[1] = 1.0;
    const Plan plan = model.plan(budget);
    EXPECT(plan.summary().file_bytes < model.file_bytes());
    model.load(plan);
    const PointQuery query(model, plan);
    std::vector<float> radiance(model.wavelengths().size());
    query.radiance(conditions, UP, radiance);
    EXPECT(radiance[3] > 0.0f && query.radiance_at(conditions, UP, 600.0) > 0.0f);

    const Moon moon;
    const SkySum sum(model, conditions, moon);
    sum.radiance(UP, radiance);
    EXPECT(sum.rgb(UP)[1] > 0.0f && model.moonlit(moon).is_moonlit());
}

}  // namespace

int main() {
    check_abi();
    EXPECT(!library_version().empty());
    const Model model = Model::default_model();
    Conditions conditions;
    conditions.visibility = 50e3;
    conditions.altitude = 100.0;
    EXPECT(model.is_polarised() && model.ranges().wavelength[0] < 400.0 && model.touched_bytes() > 0);
    expect_error(WELKIN_STATUS_IO, [] { Model::open("/no/such/file"); });
    expect_error(WELKIN_STATUS_IO, [] { Model::read("/no/such/file"); });
    const std::array<std::uint8_t, 8> none{};
    expect_error(WELKIN_STATUS_MAGIC, [&] { Model::from_bytes({none.data(), 0}); });
    skies(model, conditions);
    polarisation(model, conditions);
    air(model, conditions);
    plans_and_the_moon(model, conditions);
    std::puts("the wrapper works");
    return EXIT_SUCCESS;
}
