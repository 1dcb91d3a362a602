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

// Calls that are all refused, as what they use was moved from.
template <class... Bodies>
void expect_nulls(Bodies... bodies) {
    (expect_error(WELKIN_STATUS_NULL, bodies), ...);
}

// One that was moved from.
template <class T>
T hollow(T full) {
    const T elsewhere = std::move(full);
    EXPECT(elsewhere && !full);
    return full;
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
    EXPECT(moved && moved.bytes() > 1000 && prepared.bytes() == 0 && prepared.get() == nullptr && !prepared);
    expect_error(WELKIN_STATUS_NULL, [&] { prepared.conditions(); });
    expect_error(WELKIN_STATUS_NULL, [&] { prepared.set_solar_azimuth(0.0); });
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
    std::vector<float> relative(nm.size());
    sky.relative_radiance(UP, relative);
    EXPECT(relative[3] > 0.0f && relative[3] < one[3] + 1.0f && relative != one);
    EXPECT(one[3] == two[3] && one[3] > 0.0f && sky.radiance_at(UP, 550.0) > 0.0f);
    expect_error(WELKIN_STATUS_LENGTH, [&] { sky.radiance(UP, two); });
    expect_error(WELKIN_STATUS_DIRECTION, [&] { sky.xyz({}); });
    EXPECT(from_xyz(Space::rec2020, sky.xyz(UP)) == sky.rgb(UP, Space::rec2020));
    EXPECT(std::abs(sky.sun_direction()[2] - float(conditions.sun_direction()[2])) < 1e-6f);

    const BakedSky baked = sky.bake();
    const std::array<float, 2> x = {0.0f, 0.3f}, y = {0.0f, 0.1f}, z = {1.0f, 0.9f};
    const Directions arrays(x, y, z);
    expect_error(WELKIN_STATUS_LENGTH, [&] { Directions(x, y, one); });
    EXPECT(Directions(x.data(), y.data(), z.data(), 2).size == arrays.size);
    baked.radiance(directions, two);
    baked.radiance(arrays, other);
    baked.radiance(UP, one);
    EXPECT(two == other && one[3] == two[3] && baked.wavelengths() == nm);
    const std::array<Four, 2> heroes = {HEROES, HEROES};
    std::array<Four, 2> radiances{};
    baked.hero(arrays, heroes, radiances);
    EXPECT(radiances[0] == baked.hero(UP, HEROES) && radiances[1] != radiances[0]);
    std::array<Four, 2> interleaved{};
    baked.hero(directions, heroes, interleaved);
    EXPECT(interleaved == radiances);
    std::array<Four, 3> many{};
    expect_error(WELKIN_STATUS_LENGTH, [&] { baked.hero(arrays, heroes, many); });
    baked.irradiance(UP, one);
    EXPECT(one[3] > 0.0f && baked.bake_error().p95 <= WELKIN_BAKE_TOLERANCE);

    const ColourSky colour_sky(model, conditions);
    BakedColourSky colour = colour_sky.bake();
    std::array<Vec3, 2> rgb{}, same{};
    colour.rgb(directions, rgb, Space::acescg);
    colour.rgb(arrays, same, Space::acescg);
    std::array<Vec3, 2> xyz{}, same_xyz{};
    colour.xyz(directions, xyz);
    colour.xyz(arrays, same_xyz);
    EXPECT(xyz == same_xyz && xyz[1] == colour.xyz(directions[1]) && colour_sky.sun_direction() == sky.sun_direction());
    EXPECT(rgb == same && rgb[0] == colour.rgb(UP, Space::acescg) && colour_sky.rgb(UP)[1] > 0.0f);
    EXPECT(sky.bake_colour().xyz(UP)[1] > 0.0f && colour_sky.bake_like(colour).xyz(UP) == colour.xyz(UP));
    EXPECT(colour.bake_error().p95 <= WELKIN_BAKE_TOLERANCE && colour_sky.xyz(UP)[1] > 0.0f);

    const SolarDisc disc(model, conditions);
    EXPECT(disc.is_visible() && disc.solid_angle() > 6e-5 && disc.rgb(disc.direction())[0] > 1e6f);
    disc.radiance(disc.direction(), one);
    EXPECT(one[3] > 0.0f && disc.radiance_at(disc.direction(), 550.0) > 0.0f);
    disc.irradiance(UP, one);
    EXPECT(disc.wavelengths() == nm && from_xyz(Space::srgb, disc.xyz(disc.direction())) == disc.rgb(disc.direction()));
    const SkySampler sampler = colour.sampler(disc);
    EXPECT(sampler.bytes() > 1000);
    const Sample sample = sampler.sample(0.001f, 0.5f);
    EXPECT(sample.part == WELKIN_PART_SUN && colour.sampler().sample(0.001f, 0.5f).part == WELKIN_PART_SKY);
    EXPECT(sampler.pdf(sample.direction) == sample.pdf && sampler.xyz(sample.direction) == sample.xyz);
    expect_error(WELKIN_STATUS_RANGE, [&] { sampler.sample(std::nanf(""), 0.5f); });
    const std::array<std::array<float, 2>, 2> points = {{{0.001f, 0.5f}, {0.7f, 0.2f}}};
    std::array<Sample, 2> samples{};
    sampler.sample(points, samples);
    EXPECT(samples[0].pdf == sample.pdf && samples[0].xyz == sample.xyz && samples[0].part == WELKIN_PART_SUN);
    BakedColourSky turned = sky.bake_colour();
    turned.set_solar_azimuth(conditions.solar_azimuth + 0.1);
    expect_error(WELKIN_STATUS_RANGE, [&] { turned.sampler(disc); });

    const SunCourse course(model, conditions, {0.3, 0.4});
    course.write(0.35, 0.0, colour);
    EXPECT(colour.xyz(UP) == course.at(0.35, 0.0).xyz(UP) && course.skies() > 1 && course.bytes() > 1000);
    EXPECT(course.elevations()[1] == 0.4 && course.interpolation_error().p95 <= WELKIN_BAKE_TOLERANCE);
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
    EXPECT(sky.xyz(UP, Frame::vertical())[1].i > 0.0f);
    const float brightest = 0.5f * stokes.i * (1.0f + degree(stokes));
    EXPECT(std::abs(through_polariser(stokes, angle(stokes)) / brightest - 1.0f) < 1e-4f);
    const BakedPolarisedSky baked = sky.bake();
    EXPECT(baked.bake_error().p95 <= WELKIN_BAKE_TOLERANCE && baked.polarisation_error().p95 > 0.0);
    EXPECT(baked.hero({0.1f, 0.5f, 0.6f}, Frame::along(UP), HEROES)[2].i > 0.0f);
    std::vector<float> i(baked.wavelengths().size()), q(i.size()), u(i.size());
    baked.stokes(UP, Frame::vertical(), i.data(), q.data(), u.data(), i.size());
    EXPECT(std::abs(i[3] / all[3].i - 1.0f) < 0.01f);
    std::vector<float> same_i(i.size()), same_q(i.size()), same_u(i.size());
    baked.stokes(UP, Frame::vertical(), same_i, same_q, same_u);
    EXPECT(same_i == i && same_q == q && same_u == u);
    const float x[] = {0.0f}, y[] = {0.0f}, z[] = {1.0f};
    baked.stokes(Directions(x, y, z), Frame::vertical(), same_i, same_q, same_u);
    EXPECT(std::abs(same_i[3] / i[3] - 1.0f) < 1e-5f);
    baked.radiance(UP, same_i);
    EXPECT(std::abs(same_i[3] / i[3] - 1.0f) < 1e-5f);
    const Vec3 directions[] = {UP};
    std::array<Stokes, 4> heroes[1] = {};
    baked.hero(directions, Frame::vertical(), std::vector<Four>{HEROES}, heroes);
    EXPECT(heroes[0][2].i == baked.hero(UP, Frame::vertical(), HEROES)[2].i);
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
    EXPECT(light == left && transmittance.wavelengths() == model.wavelengths() && transmittance.bytes() > 1000);
    EXPECT(transmittance.to_space_at(from, up, 600.0) == transmittance.to_end_at(from, up, 600.0));

    const AerialPerspective aerial(model, conditions);
    const Sky sky(model, conditions);
    aerial.in_scattering(from, to, light, left);
    EXPECT(light[3] > 0.0f && aerial.in_scattering_at(from, to, 600.0) > 0.0f);
    std::vector<float> more(light.size()), more_left(light.size());
    aerial.in_scattering(from, std::array<Point, 1>{to}, more, more_left);
    EXPECT(more == light && more_left == left);
    const double lengths[] = {1e3};
    aerial.in_scattering_along(from, up, lengths, more, more_left);
    aerial.in_scattering(from, {0.0, 0.0, from[2] + 1e3}, light, left);
    EXPECT(std::abs(more[3] / light[3] - 1.0f) < 1e-2f && std::abs(more_left[3] - left[3]) < 1e-4f);
    std::vector<float> q(light.size()), u(light.size());
    aerial.in_scattering_stokes(from, to, Frame::vertical(), more, q, u, more_left);
    EXPECT(more[3] > 0.0f && q != u);
    aerial.to_end(from, up, more, more_left);
    EXPECT(more[3] > light[3] && aerial.reach() > 0.01);
    aerial.joined(sky, std::array<Point, 1>{to}, more, more_left);
    aerial.joined(sky, to, light, left);
    EXPECT(more == light && more_left == left);
    EXPECT(aerial.wavelengths().size() == light.size() && aerial.joined_rgb(sky, to).light[1] > 0.0f);
    EXPECT(aerial.joined_rgb(sky, to, Space::xyz).light == aerial.joined_xyz(sky, to).light);
    EXPECT(aerial.rgb(from, to, Space::xyz).light == aerial.xyz(from, to).light);
    const PolarisedSky polarised(model, conditions);
    const Stokes joined = aerial.joined_srgb_stokes(polarised, to, Frame::vertical()).light[1];
    EXPECT(std::abs(joined.i / aerial.joined_rgb(sky, to).light[1] - 1.0f) < 1e-3f);
    const Seen seen = aerial.rgb(from, to);
    EXPECT(seen.factors[2] < seen.factors[0]);
    EXPECT(std::abs(aerial.rgb_stokes(from, to, Frame::vertical()).light[1].i / seen.light[1] - 1.0f) < 1e-3f);
    std::vector<float> few(3);
    expect_error(WELKIN_STATUS_LENGTH, [&] { aerial.in_scattering(from, to, light, few); });

    const ColourAerialPerspective colour(model, conditions);
    EXPECT(std::abs(colour.rgb(from, to).light[1] / seen.light[1] - 1.0f) < 1e-3f);
    EXPECT(colour.rgb(from, to, Space::xyz).light == colour.xyz(from, to).light);
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

    budget.channels = WELKIN_CHANNELS_STOKES;
    const PolarisedPointQuery polarised(model, model.plan(budget));
    const Stokes stokes = polarised.stokes_at(conditions, UP, Frame::vertical(), 600.0);
    EXPECT(std::abs(stokes.i / query.radiance_at(conditions, UP, 600.0) - 1.0f) < 1e-2f);

    const Moon moon;
    EXPECT(std::abs(moon_phase_angle({0.0, 0.0, 1.0}, {0.0, 0.0, -1.0})) < 0.01);
    const SkySum sum(model, conditions, moon);
    sum.radiance(UP, radiance);
    EXPECT(from_xyz(Space::srgb, sum.xyz(UP)) == sum.rgb(UP) && sum.rgb(UP)[1] > 0.0f);
    EXPECT(model.moonlit(moon).is_moonlit());

    const std::vector<double> wavelengths{450.0, 680.0, 750.0}, albedos{0.04, 0.05, 0.45};
    const Model meadow = model.over(wavelengths, albedos);
    EXPECT(meadow.has_ground() && !model.has_ground());
    const double black[] = {0.0, 0.0, 0.0};
    const Model coal = meadow.over(wavelengths, black);
    EXPECT(Sky(meadow, conditions).radiance_at(UP, 740.0) > Sky(coal, conditions).radiance_at(UP, 740.0));
    expect_error(WELKIN_STATUS_LENGTH, [&] { model.over(wavelengths, std::vector<double>{0.1}); });
}

// A span is made of arrays of its elements, of temporary ones only to read.
void spans() {
    static_assert(std::is_convertible_v<std::vector<float> &, Span<float>>);
    static_assert(std::is_convertible_v<float (&)[4], Span<float>>);
    static_assert(std::is_convertible_v<Span<float>, Span<const float>>);
    static_assert(std::is_convertible_v<std::vector<Vec3>, Span<const Vec3>>);
    static_assert(std::is_convertible_v<const std::array<float, 3> &, Span<const float>>);
    static_assert(!std::is_convertible_v<std::vector<float>, Span<float>>);
    static_assert(!std::is_convertible_v<const std::vector<float> &, Span<float>>);
    static_assert(!std::is_convertible_v<std::vector<double> &, Span<const float>>);
    static_assert(!std::is_convertible_v<Vec3 &, Span<const Vec3>> && !std::is_convertible_v<int, Span<float>>);
    float numbers[4] = {};
    EXPECT(Span<float>(numbers).size() == 4 && Span<const float>(Span<float>(numbers)).data() == numbers);
    EXPECT(to_point(to_vec3({1.0, 0.5, -2.0})) == (Point{1.0, 0.5, -2.0}));
}

// What was moved from is refused by all that uses it, and nothing else happens.
void moved_from(const Model &model, const Conditions &conditions) {
    const Sky sky(model, conditions);
    const ColourSky colour_sky(model, conditions);
    const PolarisedSky polarised_sky(model, conditions);
    BakedColourSky colour = colour_sky.bake();
    const SolarDisc disc(model, conditions);
    const AerialPerspective aerial(model, conditions);
    Budget budget;
    budget.visibility[0] = budget.visibility[1] = conditions.visibility;
    budget.solar_elevation[1] = 1.0;
    budget.altitude[1] = 500.0;
    const Plan plan = model.plan(budget);
    const SunCourse course(model, conditions, {0.3, 0.31});

    const Model no_model = hollow(Model::default_model());
    const Plan no_plan = hollow(model.plan(budget));
    const Sky no_sky = hollow(Sky(model, conditions));
    const ColourSky no_colour_sky = hollow(ColourSky(model, conditions));
    const PolarisedSky no_polarised = hollow(PolarisedSky(model, conditions));
    const BakedSky no_baked = hollow(sky.bake());
    BakedColourSky no_colour = hollow(colour_sky.bake());
    const BakedPolarisedSky no_baked_polarised = hollow(polarised_sky.bake());
    const SolarDisc no_disc = hollow(SolarDisc(model, conditions));
    const SkySampler no_sampler = hollow(colour.sampler(disc));
    const SunCourse no_course = hollow(SunCourse(model, conditions, {0.3, 0.31}));
    const SkySum no_sum = hollow(SkySum(model, conditions, Moon()));
    const Transmittance no_transmittance = hollow(Transmittance(model, conditions.visibility));
    const AerialPerspective no_aerial = hollow(AerialPerspective(model, conditions));
    const ColourAerialPerspective no_colour_aerial = hollow(ColourAerialPerspective(model, conditions));
    const PointQuery no_query = hollow(PointQuery(model, plan));
    budget.channels = WELKIN_CHANNELS_STOKES;
    const PolarisedPointQuery no_polarised_query = hollow(PolarisedPointQuery(model, model.plan(budget)));

    std::vector<float> out(model.wavelengths().size()), two(out.size()), three(out.size()), four(out.size());
    const float x[] = {0.0f}, y[] = {0.0f}, z[] = {1.0f};
    const Directions arrays(x, y, z);
    const Vec3 directions[] = {UP};
    const Four heroes[] = {HEROES};
    Four radiance[1] = {};
    Vec3 colours[1] = {}, factors[1] = {};
    const double lengths[] = {1e3};
    const Frame frame = Frame::vertical();
    const Point from = {0.0, 0.0, 10.0}, to = {1e3, 0.0, 10.0};
    const Point points[] = {to};
    const std::array<float, 2> uniform[] = {{0.5f, 0.5f}};
    Sample samples[1] = {};
    std::vector<Stokes> stokes(out.size());
    std::array<Stokes, 4> stokes_of_heroes[1] = {};
    CameraVolume volume;
    volume.axis[0] = volume.right[1] = volume.up[2] = 1.0;
    volume.columns = volume.rows = volume.depth_count = 1;
    volume.depths = lengths;

    expect_nulls(
        [&] { no_model.verify(); }, [&] { no_model.wavelengths(); }, [&] { no_model.ranges(); },
        [&] { no_model.moonlit(Moon()); }, [&] { no_model.over(lengths, lengths); },
        [&] { no_model.plan(budget); }, [&] { no_model.load(plan); },
        [&] { model.load(no_plan); }, [&] { no_plan.summary(); }, [&] { Sky(no_model, conditions); },
        [&] { ColourSky(no_model, conditions); }, [&] { PolarisedSky(no_model, conditions); },
        [&] { SolarDisc(no_model, conditions); }, [&] { SunCourse(no_model, conditions, {0.3, 0.31}); },
        [&] { SkySum(no_model, conditions, Moon()); }, [&] { Transmittance(no_model, 50e3); },
        [&] { AerialPerspective(no_model, conditions); }, [&] { ColourAerialPerspective(no_model, conditions); },
        [&] { PointQuery(no_model, plan); }, [&] { PointQuery(model, no_plan); },
        [&] { PolarisedPointQuery(no_model, plan); }, [&] { PolarisedPointQuery(model, no_plan); },
        [&] { no_query.radiance(conditions, UP, out); }, [&] { no_query.radiance_at(conditions, UP, 600.0); },
        [&] { no_polarised_query.stokes_at(conditions, UP, frame, 600.0); });
    expect_nulls(
        [&] { no_sky.wavelengths(); }, [&] { no_sky.sun_direction(); }, [&] { no_sky.radiance(UP, out); },
        [&] { no_sky.radiance(directions, out); }, [&] { no_sky.relative_radiance(UP, out); },
        [&] { no_sky.radiance_at(UP, 600.0); }, [&] { no_sky.xyz(UP); }, [&] { no_sky.rgb(UP); },
        [&] { no_sky.bake(); }, [&] { no_sky.bake_colour(); }, [&] { no_colour_sky.sun_direction(); },
        [&] { no_colour_sky.xyz(UP); }, [&] { no_colour_sky.rgb(UP); }, [&] { no_colour_sky.bake(); },
        [&] { no_colour_sky.bake_like(colour); }, [&] { colour_sky.bake_like(no_colour); },
        [&] { no_baked.wavelengths(); }, [&] { no_baked.bake_error(); }, [&] { no_baked.radiance(UP, out); },
        [&] { no_baked.radiance(directions, out); }, [&] { no_baked.radiance(arrays, out); },
        [&] { no_baked.hero(UP, HEROES); }, [&] { no_baked.hero(directions, heroes, radiance); },
        [&] { no_baked.hero(arrays, heroes, radiance); }, [&] { no_baked.irradiance(UP, out); });
    expect_nulls(
        [&] { no_colour.bake_error(); }, [&] { no_colour.xyz(UP); }, [&] { no_colour.xyz(directions, colours); },
        [&] { no_colour.xyz(arrays, colours); }, [&] { no_colour.rgb(UP); },
        [&] { no_colour.rgb(directions, colours); }, [&] { no_colour.rgb(arrays, colours); },
        [&] { no_colour.sampler(); }, [&] { no_colour.sampler(disc); }, [&] { colour.sampler(no_disc); },
        [&] { no_disc.wavelengths(); }, [&] { no_disc.direction(); }, [&] { no_disc.radiance(UP, out); },
        [&] { no_disc.radiance_at(UP, 600.0); }, [&] { no_disc.xyz(UP); }, [&] { no_disc.rgb(UP); },
        [&] { no_disc.irradiance(UP, out); }, [&] { no_sampler.sample(0.5f, 0.5f); },
        [&] { no_sampler.sample(uniform, samples); }, [&] { no_sampler.pdf(UP); }, [&] { no_sampler.xyz(UP); },
        [&] { no_course.elevations(); }, [&] { no_course.interpolation_error(); }, [&] { no_course.at(0.3, 0.0); },
        [&] { no_course.write(0.3, 0.0, colour); }, [&] { course.write(0.3, 0.0, no_colour); });
    expect_nulls(
        [&] { no_polarised.wavelengths(); }, [&] { no_polarised.stokes(UP, frame, stokes); },
        [&] { no_polarised.stokes_at(UP, frame, 600.0); }, [&] { no_polarised.xyz(UP, frame); },
        [&] { no_polarised.bake(); }, [&] { no_baked_polarised.wavelengths(); },
        [&] { no_baked_polarised.bake_error(); }, [&] { no_baked_polarised.polarisation_error(); },
        [&] { no_baked_polarised.radiance(UP, out); }, [&] { no_baked_polarised.stokes(UP, frame, out, two, three); },
        [&] { no_baked_polarised.stokes(arrays, frame, out, two, three); },
        [&] { no_baked_polarised.hero(UP, frame, HEROES); },
        [&] { no_baked_polarised.hero(directions, frame, heroes, stokes_of_heroes); },
        [&] { no_sum.radiance(UP, out); }, [&] { no_sum.xyz(UP); }, [&] { no_sum.rgb(UP); });
    expect_nulls(
        [&] { no_transmittance.wavelengths(); }, [&] { no_transmittance.between(from, to, out); },
        [&] { no_transmittance.between_at(from, to, 600.0); }, [&] { no_transmittance.optical_depth(from, to, out); },
        [&] { no_transmittance.to_space(from, to, out); }, [&] { no_transmittance.to_space_at(from, to, 600.0); },
        [&] { no_transmittance.to_end(from, to, out); }, [&] { no_transmittance.to_end_at(from, to, 600.0); },
        [&] { no_aerial.wavelengths(); }, [&] { no_aerial.in_scattering(from, to, out, two); },
        [&] { no_aerial.in_scattering(from, points, out, two); }, [&] { no_aerial.to_end(from, to, out, two); },
        [&] { no_aerial.in_scattering_along(from, to, lengths, out, two); },
        [&] { no_aerial.in_scattering_stokes(from, to, frame, out, two, three, four); },
        [&] { no_aerial.in_scattering_at(from, to, 600.0); }, [&] { no_aerial.xyz(from, to); },
        [&] { no_aerial.rgb(from, to); }, [&] { no_aerial.rgb_stokes(from, to, frame); },
        [&] { no_aerial.joined(sky, to, out, two); }, [&] { aerial.joined(no_sky, to, out, two); },
        [&] { no_aerial.joined(sky, points, out, two); }, [&] { aerial.joined(no_sky, points, out, two); },
        [&] { no_aerial.joined_rgb(sky, to); }, [&] { aerial.joined_rgb(no_sky, to); },
        [&] { no_aerial.joined_xyz(sky, to); }, [&] { aerial.joined_xyz(no_sky, to); },
        [&] { no_aerial.joined_srgb_stokes(polarised_sky, to, frame); },
        [&] { aerial.joined_srgb_stokes(no_polarised, to, frame); }, [&] { no_colour_aerial.xyz(from, to); },
        [&] { no_colour_aerial.rgb(from, to); },
        [&] { no_colour_aerial.srgb_along(from, to, lengths, colours, factors); },
        [&] { no_colour_aerial.srgb_volume(volume, colours, factors); });
    EXPECT(no_model.file_bytes() == 0 && !no_model.is_polarised());
    EXPECT(!no_disc.is_visible() && no_disc.solid_angle() == 0.0);
    EXPECT(no_course.skies() == 0 && no_sampler.bytes() == 0 && no_aerial.reach() == 0.0 && no_aerial.bytes() == 0);
    no_colour = std::move(colour);
    EXPECT(no_colour && !colour && no_colour.xyz(UP)[1] > 0.0f);
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
    expect_error(WELKIN_STATUS_ARGUMENT, [] { Model::open(std::string("/no\0/such", 9)); });
    expect_error(WELKIN_STATUS_ARGUMENT, [] { Model::read(std::string("\0", 1)); });
    EXPECT(abi_version() == WELKIN_ABI_VERSION && space_by_name("acescg") == Space::acescg);
    expect_error(WELKIN_STATUS_VALUE, [] { space_by_name("cmyk"); });
    EXPECT(matrix(Space::xyz)[1] == (Vec3{0.0f, 1.0f, 0.0f}) && matrix(Space::srgb)[0][0] > 3.0f);
    const std::array<std::uint8_t, 8> none{};
    expect_error(WELKIN_STATUS_MAGIC, [&] { Model::from_bytes({none.data(), 0}); });
    skies(model, conditions);
    polarisation(model, conditions);
    air(model, conditions);
    plans_and_the_moon(model, conditions);
    spans();
    moved_from(model, conditions);
    std::puts("the wrapper works");
    return EXIT_SUCCESS;
}
