// What a renderer asks a sky for, in one small picture: a white ball on a grey plain before the sky, lit by sky and
// sun with multiple importance sampling, seen through the air. Writes ball.ppm (or the file that is its argument) and
// prints radiance and polarisation at four hero wavelengths.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <welkin/welkin.hpp>

namespace {

using welkin::Vec3;

constexpr int WIDTH = 96, HEIGHT = 64, SAMPLES = 16;
constexpr float PI = 3.14159265f;
constexpr float RADIUS = 100.0f;                // m
constexpr Vec3 CENTRE = {400.0f, 0.0f, 90.0f};  // m, the ball sinks into the ground a little
constexpr Vec3 CAMERA = {0.0f, 0.0f, 20.0f};    // m

float dot(const Vec3 &a, const Vec3 &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 plus(const Vec3 &a, float s, const Vec3 &b) { return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]}; }
Vec3 unit(const Vec3 &a) { return plus({}, 1.0f / std::sqrt(dot(a, a)), a); }

// A small generator: numbers in 0..1.
struct Random {
    std::uint32_t state = 1;
    float next() {
        state = state * 747796405u + 2891336453u;
        const std::uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
        return static_cast<float>(((word >> 22) ^ word) >> 8) / 16777216.0f;
    }
};

struct Hit {
    float distance;  // m; negative if there is none
    Vec3 normal;
};

Hit trace(const Vec3 &from, const Vec3 &direction) {
    const Vec3 offset = plus(from, -1.0f, CENTRE);
    const float half = dot(offset, direction), rest = dot(offset, offset) - RADIUS * RADIUS;
    const float square = half * half - rest;
    if (square > 0.0f) {
        const float distance = -half - std::sqrt(square);
        if (distance > 0.01f) return {distance, unit(plus(offset, distance, direction))};
    }
    if (direction[2] < 0.0f && from[2] > 0.01f) return {-from[2] / direction[2], {0.0f, 0.0f, 1.0f}};
    return {-1.0f, {}};
}

// A direction in proportion to the cosine with the normal.
Vec3 cosine_direction(const Vec3 &normal, Random &random) {
    const float z = 1.0f - 2.0f * random.next(), a = 2.0f * PI * random.next();
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return unit(plus({r * std::cos(a), r * std::sin(a), z}, 1.0001f, normal));
}

// Light of sky and sun that a white surface sends out, XYZ in cd/m2: half of the directions are the sampler's, half the
// surface's own, weighted by the balance heuristic.
Vec3 lit(const welkin::SkySampler &sampler, const Vec3 &at, const Vec3 &normal, Random &random) {
    Vec3 sum{};
    for (int i = 0; i < SAMPLES; ++i) {
        const bool own = i % 2 == 0;
        const Vec3 drawn =
            own ? cosine_direction(normal, random) : sampler.sample(random.next(), random.next()).direction;
        const float cosine = dot(drawn, normal);
        if (cosine <= 0.0f || trace(plus(at, 0.1f, normal), drawn).distance > 0.0f) continue;
        const float density = 0.5f * (cosine / PI + sampler.pdf(drawn));
        const Vec3 xyz = sampler.xyz(drawn);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += xyz[c] * cosine / PI / density;
    }
    return plus({}, 1.0f / SAMPLES, sum);
}

std::uint8_t encode(float linear) {
    const float value = std::min(std::max(linear, 0.0f), 1.0f);
    const float srgb = value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(255.0f * srgb + 0.5f);
}

void write_ppm(const std::string &path, const std::vector<Vec3> &picture, float white) {
    std::FILE *file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) throw std::runtime_error("cannot write " + path);
    std::fprintf(file, "P6 %d %d 255\n", WIDTH, HEIGHT);
    for (const Vec3 &rgb : picture) {
        std::array<std::uint8_t, 3> bytes{};
        for (std::size_t c = 0; c < 3; ++c) bytes[c] = encode(rgb[c] / white);
        std::fwrite(bytes.data(), 1, bytes.size(), file);
    }
    if (std::fclose(file) != 0) throw std::runtime_error("cannot write " + path);
}

std::vector<Vec3> render(const welkin::BakedColourSky &sky, const welkin::SkySampler &sampler,
                         const welkin::ColourAerialPerspective &air) {
    std::vector<Vec3> picture;
    Random random;
    for (int row = 0; row < HEIGHT; ++row) {
        for (int column = 0; column < WIDTH; ++column) {
            const float x = (static_cast<float>(2 * column + 1) / WIDTH - 1.0f) * 0.6f;
            const float y = (1.0f - static_cast<float>(2 * row + 1) / HEIGHT) * 0.4f + 0.1f;
            const Vec3 view = unit({1.0f, -x, y});
            const Hit hit = trace(CAMERA, view);
            if (hit.distance < 0.0f || hit.distance > 50e3f) {
                picture.push_back(sky.rgb(view));
                continue;
            }
            const Vec3 at = plus(CAMERA, hit.distance, view);
            const float albedo = at[2] > 0.1f ? 0.8f : 0.2f;
            const Vec3 own = welkin::from_xyz(welkin::Space::srgb, lit(sampler, at, hit.normal, random));
            const auto [light, factors] = air.rgb(welkin::to_point(CAMERA), welkin::to_point(at));
            Vec3 seen{};
            for (std::size_t c = 0; c < 3; ++c) seen[c] = light[c] + factors[c] * albedo * own[c];
            picture.push_back(seen);
        }
    }
    return picture;
}

// Four wavelengths of a path, with and without polarisation.
void print_heroes(const welkin::Model &model, const welkin::Conditions &conditions) {
    const welkin::BakedPolarisedSky polarised = welkin::PolarisedSky(model, conditions).bake();
    const welkin::BakedSky spectral = welkin::Sky(model, conditions).bake();
    const Vec3 direction = {-0.3f, 0.4f, 0.8f};
    const welkin::Four wavelengths = {430.0f, 510.0f, 590.0f, 670.0f};
    const welkin::Four radiance = spectral.hero(direction, wavelengths);
    const auto stokes = polarised.hero(direction, welkin::Frame::along({0.0f, 0.0f, 1.0f}), wavelengths);
    for (std::size_t i = 0; i < 4; ++i) {
        std::printf("%.0f nm: %.4f W/(m2 sr nm), degree of polarisation %.2f\n", double(wavelengths[i]),
                    double(radiance[i]), double(welkin::degree(stokes[i])));
    }
}

}  // namespace

int main(int count, char **arguments) {
    try {
        welkin::check_abi();
        const welkin::Model model = welkin::Model::default_model();
        welkin::Conditions conditions;
        conditions.solar_elevation = 0.35;
        conditions.solar_azimuth = 1.9;
        const welkin::BakedColourSky sky = welkin::ColourSky(model, conditions).bake();
        const welkin::SkySampler sampler = sky.sampler(welkin::SolarDisc(model, conditions));
        const welkin::ColourAerialPerspective air(model, conditions);

        const std::vector<Vec3> picture = render(sky, sampler, air);
        write_ppm(count > 1 ? arguments[1] : "ball.ppm", picture, 20e3f);
        print_heroes(model, conditions);
        const bool sound = std::all_of(picture.begin(), picture.end(), [](const Vec3 &rgb) {
            return std::isfinite(rgb[0]) && rgb[1] > 0.0f && rgb[1] < 1e6f && std::isfinite(rgb[2]);
        });
        return sound ? EXIT_SUCCESS : EXIT_FAILURE;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
