// One sky and one model used by several threads at once without a lock: each gets what a single thread gets.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>
#include <vector>

#include <welkin/welkin.hpp>

namespace {

constexpr int THREADS = 4, DIRECTIONS = 2000;

welkin::Vec3 direction(int i) {
    const float a = 0.7f * static_cast<float>(i), z = std::sin(1.3f * static_cast<float>(i));
    return {std::cos(a), std::sin(a), z};
}

struct Answers {
    std::vector<welkin::Vec3> colours;
    std::vector<float> radiance;
    bool operator==(const Answers &other) const { return colours == other.colours && radiance == other.radiance; }
};

// Prepares a sky of the shared model, and asks the shared baked sky and air.
Answers ask(const welkin::Model &model, const welkin::BakedColourSky &sky, const welkin::AerialPerspective &air) {
    Answers answers;
    for (int i = 0; i < DIRECTIONS; ++i) answers.colours.push_back(sky.rgb(direction(i)));
    welkin::Conditions conditions;
    conditions.visibility = 30e3;
    const welkin::Sky own(model, conditions);
    answers.radiance.resize(own.wavelengths().size());
    own.radiance(direction(1), answers.radiance);
    answers.colours.push_back(air.rgb({0.0, 0.0, 2.0}, {20e3, 5e3, 900.0}).light);
    return answers;
}

}  // namespace

int main() {
    try {
        welkin::check_abi();
        const welkin::Model model = welkin::Model::default_model();
        const welkin::Conditions conditions;
        const welkin::BakedColourSky sky = welkin::ColourSky(model, conditions).bake();
        const welkin::AerialPerspective air(model, conditions);

        std::array<Answers, THREADS> found;
        std::vector<std::thread> threads;
        for (Answers &answers : found) {
            threads.emplace_back([&] { answers = ask(model, sky, air); });
        }
        for (std::thread &thread : threads) thread.join();
        const Answers expected = ask(model, sky, air);
        for (const Answers &answers : found) {
            if (!(answers == expected)) return EXIT_FAILURE;
        }
        std::printf("%d threads agree on %d directions\n", THREADS, DIRECTIONS);
        return EXIT_SUCCESS;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
