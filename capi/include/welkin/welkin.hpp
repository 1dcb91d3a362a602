// welkin/welkin.hpp: the C interface for C++17. Move-only types own the handles of welkin/capi.h, and errors are
// exceptions of the type welkin::Error. Header-only, no dependency but the library.
//
// What functions mean, their units, frames, shapes and rules for threads: welkin/capi.h. Methods of const objects may
// be called by any number of threads at once. Objects that were moved from hold no handle: to use them is an Error.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef WELKIN_CAPI_HPP
#define WELKIN_CAPI_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <welkin/capi.h>

namespace welkin {

using Vec3 = std::array<float, 3>;    // directions, colours
using Point = std::array<double, 3>;  // m
using Four = std::array<float, 4>;    // hero wavelengths and their radiances
using Stokes = WelkinStokes;
using Sample = WelkinSample;
using BakeError = WelkinBakeError;
using Ranges = WelkinRanges;

// Why a call was refused.
class Error : public std::runtime_error {
public:
    explicit Error(const WelkinError &error)
        : std::runtime_error(error.text), code_(static_cast<WelkinStatus>(error.status)) {}
    WelkinStatus code() const noexcept { return code_; }
    // "range", "direction", …
    const char *name() const noexcept { return welkin_status_name(code_); }

private:
    WelkinStatus code_;
};

namespace detail {

// Calls a function with its arguments and room for an error.
template <class Function, class... Arguments>
inline void call(Function *function, Arguments... arguments) {
    WelkinError error;
    if (function(arguments..., &error) != WELKIN_STATUS_OK) throw Error(error);
}

// Owns a handle.
template <class T, void (*Free)(T *)>
class Handle {
public:
    const T *get() const noexcept { return handle_.get(); }
    T *get() noexcept { return handle_.get(); }

protected:
    struct Deleter {
        void operator()(T *handle) const noexcept { Free(handle); }
    };

    explicit Handle(T *handle) noexcept : handle_(handle) {}

    // Of a function that makes one.
    template <class Function, class... Arguments>
    static T *make(Function *function, Arguments... arguments) {
        T *made = nullptr;
        call(function, arguments..., &made);
        return made;
    }

private:
    std::unique_ptr<T, Deleter> handle_;
};

}  // namespace detail

// An array of the caller, which must stay alive during the call.
template <class T>
class Span {
public:
    Span(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
    // From std::vector, std::array and whatever else has data() and size().
    template <class Container>
    Span(Container &container) noexcept : data_(container.data()), size_(container.size()) {}
    T *data() const noexcept { return data_; }
    std::size_t size() const noexcept { return size_; }

private:
    T *data_;
    std::size_t size_;
};

namespace detail {

// The common size of two arrays.
inline std::size_t same(std::size_t a, std::size_t b) {
    if (a == b) return a;
    WelkinError error{};
    error.status = WELKIN_STATUS_LENGTH;
    std::snprintf(error.text, sizeof error.text, "arrays of %zu and %zu elements belong together", a, b);
    throw Error(error);
}

}  // namespace detail

// Directions as three arrays, the fastest way for batches.
struct Directions {
    const float *x, *y, *z;
    std::size_t size;
};

enum class Space : std::int32_t {
    srgb = WELKIN_SPACE_SRGB,
    rec2020 = WELKIN_SPACE_REC2020,
    acescg = WELKIN_SPACE_ACESCG,
    xyz = WELKIN_SPACE_XYZ,
};

// Where the axis of positive Q stands.
struct Frame : WelkinPolarisationFrame {
    static Frame vertical() noexcept { return Frame(WELKIN_FRAME_VERTICAL, {}); }
    static Frame sun_aligned() noexcept { return Frame(WELKIN_FRAME_SUN_ALIGNED, {}); }
    static Frame along(Vec3 axis) noexcept { return Frame(WELKIN_FRAME_AXIS, axis); }

private:
    Frame(std::int32_t frame_kind, Vec3 vector) noexcept
        : WelkinPolarisationFrame{frame_kind, {vector[0], vector[1], vector[2]}} {}
};

// Light that the air adds, and what it leaves of a thing's own.
struct Seen {
    Vec3 light, factors;
};
struct SeenStokes {
    std::array<Stokes, 3> light;
    Vec3 factors;
};

struct Conditions : WelkinConditions {
    Conditions() : WelkinConditions() {
        detail::call(welkin_conditions_init, static_cast<WelkinConditions *>(this), sizeof(WelkinConditions));
    }

    Point sun_direction() const {
        Point sun{};
        detail::call(welkin_conditions_sun_direction, static_cast<const WelkinConditions *>(this), sun.data());
        return sun;
    }
};

struct Moon : WelkinMoon {
    Moon() : WelkinMoon() { detail::call(welkin_moon_init, static_cast<WelkinMoon *>(this), sizeof(WelkinMoon)); }
};

struct Budget : WelkinBudget {
    Budget() : WelkinBudget() {
        struct_size = sizeof(WelkinBudget);
        tolerance = WELKIN_BAKE_TOLERANCE;
    }
};

struct CameraVolume : WelkinCameraVolume {
    CameraVolume() : WelkinCameraVolume() { struct_size = sizeof(WelkinCameraVolume); }
};

// Whether the library that runs serves the header that this was compiled with; throws if not.
inline void check_abi() {
    const WelkinAbi compiled = {WELKIN_ABI_SIZES};
    detail::call(welkin_check_abi, &compiled);
}

inline std::string library_version() { return welkin_library_version(); }

inline Vec3 from_xyz(Space space, const Vec3 &xyz) {
    Vec3 rgb{};
    detail::call(welkin_space_from_xyz, static_cast<std::int32_t>(space), xyz.data(), rgb.data());
    return rgb;
}

inline float degree(const Stokes &stokes) noexcept { return welkin_stokes_degree(&stokes); }
inline float angle(const Stokes &stokes) noexcept { return welkin_stokes_angle(&stokes); }

class Plan : public detail::Handle<WelkinPlan, welkin_plan_free> {
public:
    WelkinPlanSummary summary() const {
        WelkinPlanSummary summary{};
        summary.struct_size = sizeof summary;
        detail::call(welkin_plan_summary, get(), &summary);
        return summary;
    }

private:
    friend class Model;
    explicit Plan(WelkinPlan *handle) noexcept : Handle(handle) {}
};

class Model : public detail::Handle<WelkinModel, welkin_model_free> {
public:
    static Model open(const std::string &path) { return Model(make(welkin_model_open, path.c_str())); }
    static Model read(const std::string &path) { return Model(make(welkin_model_read, path.c_str())); }
    static Model from_bytes(Span<const std::uint8_t> bytes) {
        return Model(make(welkin_model_from_bytes, bytes.data(), bytes.size()));
    }
    static Model default_model() { return Model(make(welkin_model_default)); }

    // The same with the moon in place of the sun.
    Model moonlit(const Moon &moon) const {
        return Model(make(welkin_model_moonlit, get(), static_cast<const WelkinMoon *>(&moon)));
    }

    void verify() const { detail::call(welkin_model_verify, get()); }
    std::vector<double> wavelengths() const {
        std::vector<double> nm(welkin_model_wavelength_count(get()));
        detail::call(welkin_model_wavelengths, get(), nm.data(), nm.size());
        return nm;
    }
    Ranges ranges() const {
        Ranges ranges{};
        detail::call(welkin_model_ranges, get(), &ranges);
        return ranges;
    }
    bool is_polarised() const noexcept { return welkin_model_is_polarised(get()); }
    bool is_moonlit() const noexcept { return welkin_model_is_moonlit(get()); }
    std::size_t file_bytes() const noexcept { return welkin_model_file_bytes(get()); }
    std::size_t touched_bytes() const noexcept { return welkin_model_touched_bytes(get()); }

    Plan plan(const Budget &budget) const {
        return Plan(Plan::make(welkin_model_plan, get(), static_cast<const WelkinBudget *>(&budget)));
    }
    void load(const Plan &plan) const { detail::call(welkin_model_load, get(), plan.get()); }

private:
    explicit Model(WelkinModel *handle) noexcept : Handle(handle) {}
};

// What the types of skies and air share. `P` names the functions: a struct of pointers to them.
namespace detail {

template <class T, void (*Free)(T *), class P>
class Prepared : public Handle<T, Free> {
public:
    Conditions conditions() const {
        Conditions conditions;
        call(P::conditions, this->get(), static_cast<WelkinConditions *>(&conditions));
        return conditions;
    }
    // Turns it about the vertical: costs no preparation. Not while another thread uses it.
    void set_solar_azimuth(double azimuth) { call(P::set_solar_azimuth, this->get(), azimuth); }
    std::size_t bytes() const noexcept { return P::bytes(this->get()); }

protected:
    explicit Prepared(T *handle) noexcept : Handle<T, Free>(handle) {}
    template <class Function>
    static T *prepare(Function *function, const Model &model, const Conditions &conditions) {
        return Handle<T, Free>::make(function, model.get(), static_cast<const WelkinConditions *>(&conditions));
    }
};

template <class T>
inline std::vector<double> wavelengths(std::size_t (*count)(const T *),
                                       WelkinStatus (*get)(const T *, double *, std::size_t, WelkinError *),
                                       const T *handle) {
    std::vector<double> nm(count(handle));
    call(get, handle, nm.data(), nm.size());
    return nm;
}

#define WELKIN_DETAIL_PREPARED(Name, prefix)                                            \
    struct Name {                                                                       \
        static constexpr auto conditions = prefix##_conditions;                         \
        static constexpr auto set_solar_azimuth = prefix##_set_solar_azimuth;           \
        static constexpr auto bytes = prefix##_bytes;                                   \
    };
WELKIN_DETAIL_PREPARED(OfSky, welkin_sky)
WELKIN_DETAIL_PREPARED(OfColourSky, welkin_colour_sky)
WELKIN_DETAIL_PREPARED(OfPolarisedSky, welkin_polarised_sky)
WELKIN_DETAIL_PREPARED(OfBakedSky, welkin_baked_sky)
WELKIN_DETAIL_PREPARED(OfBakedColourSky, welkin_baked_colour_sky)
WELKIN_DETAIL_PREPARED(OfBakedPolarisedSky, welkin_baked_polarised_sky)
WELKIN_DETAIL_PREPARED(OfAerialPerspective, welkin_aerial_perspective)
WELKIN_DETAIL_PREPARED(OfColourAerialPerspective, welkin_colour_aerial_perspective)
#undef WELKIN_DETAIL_PREPARED

}  // namespace detail

class BakedSky : public detail::Prepared<WelkinBakedSky, welkin_baked_sky_free, detail::OfBakedSky> {
public:
    std::vector<double> wavelengths() const {
        return detail::wavelengths(welkin_baked_sky_wavelength_count, welkin_baked_sky_wavelengths, get());
    }
    BakeError bake_error() const {
        BakeError error{};
        detail::call(welkin_baked_sky_bake_error, get(), &error);
        return error;
    }
    void radiance(const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_baked_sky_radiance, get(), direction.data(), out.data(), out.size());
    }
    void radiance(Span<const Vec3> directions, Span<float> out) const {
        detail::call(welkin_baked_sky_radiance_batch, get(), reinterpret_cast<const float *>(directions.data()),
                     directions.size(), out.data(), out.size());
    }
    void radiance(const Directions &d, Span<float> out) const {
        detail::call(welkin_baked_sky_radiance_soa, get(), d.x, d.y, d.z, d.size, out.data(), out.size());
    }
    Four hero(const Vec3 &direction, const Four &wavelengths) const {
        Four radiance{};
        detail::call(welkin_baked_sky_hero, get(), direction.data(), wavelengths.data(), radiance.data());
        return radiance;
    }
    // As many wavelengths and radiances as directions.
    void hero(const Directions &d, Span<const Four> wavelengths, Span<Four> radiance) const {
        const std::size_t size = detail::same(detail::same(d.size, wavelengths.size()), radiance.size());
        detail::call(welkin_baked_sky_hero_soa, get(), d.x, d.y, d.z,
                     reinterpret_cast<const float *>(wavelengths.data()), size,
                     reinterpret_cast<float *>(radiance.data()));
    }
    void irradiance(const Vec3 &normal, Span<float> out) const {
        detail::call(welkin_baked_sky_irradiance, get(), normal.data(), out.data(), out.size());
    }

private:
    friend class Sky;
    explicit BakedSky(WelkinBakedSky *handle) noexcept : Prepared(handle) {}
};

class SolarDisc : public detail::Handle<WelkinSolarDisc, welkin_solar_disc_free> {
public:
    SolarDisc(const Model &model, const Conditions &conditions)
        : Handle(make(welkin_solar_disc_new, model.get(), static_cast<const WelkinConditions *>(&conditions))) {}
    bool is_visible() const noexcept { return welkin_solar_disc_is_visible(get()); }
    double solid_angle() const noexcept { return welkin_solar_disc_solid_angle(get()); }
    Vec3 direction() const {
        Vec3 direction{};
        detail::call(welkin_solar_disc_direction, get(), direction.data());
        return direction;
    }
    void radiance(const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_solar_disc_radiance, get(), direction.data(), out.data(), out.size());
    }
    float radiance_at(const Vec3 &direction, double wavelength) const {
        float radiance = 0;
        detail::call(welkin_solar_disc_radiance_at, get(), direction.data(), wavelength, &radiance);
        return radiance;
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        Vec3 rgb{};
        detail::call(welkin_solar_disc_rgb, get(), direction.data(), static_cast<std::int32_t>(space), rgb.data());
        return rgb;
    }
    void irradiance(const Vec3 &normal, Span<float> out) const {
        detail::call(welkin_solar_disc_irradiance, get(), normal.data(), out.data(), out.size());
    }
};

// Draws directions of sky and sun by luminance.
class SkySampler : public detail::Handle<WelkinSkySampler, welkin_sky_sampler_free> {
public:
    Sample sample(float a, float b) const {
        const std::array<float, 2> point{a, b};
        Sample sample{};
        detail::call(welkin_sky_sampler_sample, get(), point.data(), &sample);
        return sample;
    }
    void sample(Span<const std::array<float, 2>> points, Span<Sample> samples) const {
        detail::call(welkin_sky_sampler_sample_batch, get(), reinterpret_cast<const float *>(points.data()),
                     detail::same(points.size(), samples.size()), samples.data());
    }
    float pdf(const Vec3 &direction) const {
        float pdf = 0;
        detail::call(welkin_sky_sampler_pdf, get(), direction.data(), &pdf);
        return pdf;
    }
    Vec3 xyz(const Vec3 &direction) const {
        Vec3 xyz{};
        detail::call(welkin_sky_sampler_xyz, get(), direction.data(), xyz.data());
        return xyz;
    }

private:
    friend class BakedColourSky;
    explicit SkySampler(WelkinSkySampler *handle) noexcept : Handle(handle) {}
};

class BakedColourSky
    : public detail::Prepared<WelkinBakedColourSky, welkin_baked_colour_sky_free, detail::OfBakedColourSky> {
public:
    BakeError bake_error() const {
        BakeError error{};
        detail::call(welkin_baked_colour_sky_bake_error, get(), &error);
        return error;
    }
    Vec3 xyz(const Vec3 &direction) const {
        Vec3 xyz{};
        detail::call(welkin_baked_colour_sky_xyz, get(), direction.data(), xyz.data());
        return xyz;
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        Vec3 rgb{};
        detail::call(welkin_baked_colour_sky_rgb, get(), direction.data(), static_cast<std::int32_t>(space),
                     rgb.data());
        return rgb;
    }
    // As many colours as directions.
    void rgb(Span<const Vec3> directions, Span<Vec3> out, Space space = Space::srgb) const {
        detail::call(welkin_baked_colour_sky_rgb_batch, get(), reinterpret_cast<const float *>(directions.data()),
                     detail::same(directions.size(), out.size()), static_cast<std::int32_t>(space),
                     reinterpret_cast<float *>(out.data()));
    }
    void rgb(const Directions &d, Span<Vec3> out, Space space = Space::srgb) const {
        detail::call(welkin_baked_colour_sky_rgb_soa, get(), d.x, d.y, d.z, detail::same(d.size, out.size()),
                     static_cast<std::int32_t>(space), reinterpret_cast<float *>(out.data()));
    }
    SkySampler sampler() const {
        return SkySampler(SkySampler::make(welkin_baked_colour_sky_sampler, get(), no_disc()));
    }
    SkySampler sampler(const SolarDisc &disc) const {
        return SkySampler(SkySampler::make(welkin_baked_colour_sky_sampler, get(), disc.get()));
    }

private:
    friend class Sky;
    friend class ColourSky;
    friend class SunCourse;
    explicit BakedColourSky(WelkinBakedColourSky *handle) noexcept : Prepared(handle) {}
    static const WelkinSolarDisc *no_disc() noexcept { return nullptr; }
};

class Sky : public detail::Prepared<WelkinSky, welkin_sky_free, detail::OfSky> {
public:
    Sky(const Model &model, const Conditions &conditions) : Prepared(prepare(welkin_sky_new, model, conditions)) {}
    std::vector<double> wavelengths() const {
        return detail::wavelengths(welkin_sky_wavelength_count, welkin_sky_wavelengths, get());
    }
    Vec3 sun_direction() const {
        Vec3 sun{};
        detail::call(welkin_sky_sun_direction, get(), sun.data());
        return sun;
    }
    void radiance(const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_sky_radiance, get(), direction.data(), out.data(), out.size());
    }
    void radiance(Span<const Vec3> directions, Span<float> out) const {
        detail::call(welkin_sky_radiance_batch, get(), reinterpret_cast<const float *>(directions.data()),
                     directions.size(), out.data(), out.size());
    }
    float radiance_at(const Vec3 &direction, double wavelength) const {
        float radiance = 0;
        detail::call(welkin_sky_radiance_at, get(), direction.data(), wavelength, &radiance);
        return radiance;
    }
    Vec3 xyz(const Vec3 &direction) const {
        Vec3 xyz{};
        detail::call(welkin_sky_xyz, get(), direction.data(), xyz.data());
        return xyz;
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        Vec3 rgb{};
        detail::call(welkin_sky_rgb, get(), direction.data(), static_cast<std::int32_t>(space), rgb.data());
        return rgb;
    }
    BakedSky bake(double tolerance = WELKIN_BAKE_TOLERANCE) const {
        return BakedSky(BakedSky::make(welkin_sky_bake, get(), tolerance));
    }
    BakedColourSky bake_colour(double tolerance = WELKIN_BAKE_TOLERANCE) const {
        return BakedColourSky(BakedColourSky::make(welkin_sky_bake_colour, get(), tolerance));
    }
};

class ColourSky : public detail::Prepared<WelkinColourSky, welkin_colour_sky_free, detail::OfColourSky> {
public:
    ColourSky(const Model &model, const Conditions &conditions)
        : Prepared(prepare(welkin_colour_sky_new, model, conditions)) {}
    Vec3 xyz(const Vec3 &direction) const {
        Vec3 xyz{};
        detail::call(welkin_colour_sky_xyz, get(), direction.data(), xyz.data());
        return xyz;
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        Vec3 rgb{};
        detail::call(welkin_colour_sky_rgb, get(), direction.data(), static_cast<std::int32_t>(space), rgb.data());
        return rgb;
    }
    BakedColourSky bake(double tolerance = WELKIN_BAKE_TOLERANCE) const {
        return BakedColourSky(BakedColourSky::make(welkin_colour_sky_bake, get(), tolerance));
    }
    // Of the next frame under a sun that moves, in half the time.
    BakedColourSky bake_like(const BakedColourSky &other) const {
        return BakedColourSky(BakedColourSky::make(welkin_colour_sky_bake_like, get(), other.get()));
    }
};

// Skies under every sun of a range of elevations.
class SunCourse : public detail::Handle<WelkinSunCourse, welkin_sun_course_free> {
public:
    SunCourse(const Model &model, const Conditions &conditions, std::array<double, 2> elevations,
              double tolerance = WELKIN_BAKE_TOLERANCE)
        : Handle(make(welkin_sun_course_new, model.get(), static_cast<const WelkinConditions *>(&conditions),
                      static_cast<const double *>(elevations.data()), tolerance)) {}
    std::size_t skies() const noexcept { return welkin_sun_course_skies(get()); }
    std::size_t bytes() const noexcept { return welkin_sun_course_bytes(get()); }
    BakedColourSky at(double elevation, double azimuth) const {
        return BakedColourSky(BakedColourSky::make(welkin_sun_course_at, get(), elevation, azimuth));
    }
    // Into the memory of a sky that is there.
    void write(double elevation, double azimuth, BakedColourSky &sky) const {
        detail::call(welkin_sun_course_write, get(), elevation, azimuth, sky.get());
    }
};

class BakedPolarisedSky
    : public detail::Prepared<WelkinBakedPolarisedSky, welkin_baked_polarised_sky_free, detail::OfBakedPolarisedSky> {
public:
    std::vector<double> wavelengths() const {
        return detail::wavelengths(welkin_baked_polarised_sky_wavelength_count, welkin_baked_polarised_sky_wavelengths,
                                   get());
    }
    // An element per wavelength in each of the outputs, which are of one size.
    void stokes(const Vec3 &direction, const Frame &frame, float *i, float *q, float *u, std::size_t count) const {
        detail::call(welkin_baked_polarised_sky_stokes, get(), direction.data(), base(frame), i, q, u, count);
    }
    std::array<Stokes, 4> hero(const Vec3 &direction, const Frame &frame, const Four &wavelengths) const {
        std::array<Stokes, 4> stokes{};
        detail::call(welkin_baked_polarised_sky_hero, get(), direction.data(), base(frame), wavelengths.data(),
                     stokes.data());
        return stokes;
    }

private:
    friend class PolarisedSky;
    explicit BakedPolarisedSky(WelkinBakedPolarisedSky *handle) noexcept : Prepared(handle) {}
    static const WelkinPolarisationFrame *base(const Frame &frame) noexcept { return &frame; }
};

class PolarisedSky : public detail::Prepared<WelkinPolarisedSky, welkin_polarised_sky_free, detail::OfPolarisedSky> {
public:
    PolarisedSky(const Model &model, const Conditions &conditions)
        : Prepared(prepare(welkin_polarised_sky_new, model, conditions)) {}
    std::vector<double> wavelengths() const {
        return detail::wavelengths(welkin_polarised_sky_wavelength_count, welkin_polarised_sky_wavelengths, get());
    }
    void stokes(const Vec3 &direction, const Frame &frame, Span<Stokes> out) const {
        detail::call(welkin_polarised_sky_stokes, get(), direction.data(), base(frame), out.data(), out.size());
    }
    Stokes stokes_at(const Vec3 &direction, const Frame &frame, double wavelength) const {
        Stokes stokes{};
        detail::call(welkin_polarised_sky_stokes_at, get(), direction.data(), base(frame), wavelength, &stokes);
        return stokes;
    }
    BakedPolarisedSky bake(double tolerance = WELKIN_BAKE_TOLERANCE) const {
        return BakedPolarisedSky(BakedPolarisedSky::make(welkin_polarised_sky_bake, get(), tolerance));
    }

private:
    static const WelkinPolarisationFrame *base(const Frame &frame) noexcept { return &frame; }
};

// The sky in the light of sun and moon.
class SkySum : public detail::Handle<WelkinSkySum, welkin_sky_sum_free> {
public:
    SkySum(const Model &model, const Conditions &conditions, const Moon &moon)
        : Handle(make(welkin_sky_sum_new, model.get(), static_cast<const WelkinConditions *>(&conditions),
                      static_cast<const WelkinMoon *>(&moon))) {}
    void radiance(const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_sky_sum_radiance, get(), direction.data(), out.data(), out.size());
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        Vec3 rgb{};
        detail::call(welkin_sky_sum_rgb, get(), direction.data(), static_cast<std::int32_t>(space), rgb.data());
        return rgb;
    }
};

class Transmittance : public detail::Handle<WelkinTransmittance, welkin_transmittance_free> {
public:
    Transmittance(const Model &model, double visibility)
        : Handle(make(welkin_transmittance_new, model.get(), visibility)) {}
    void between(const Point &from, const Point &to, Span<float> out) const {
        detail::call(welkin_transmittance_between, get(), from.data(), to.data(), out.data(), out.size());
    }
    float between_at(const Point &from, const Point &to, double wavelength) const {
        float value = 0;
        detail::call(welkin_transmittance_between_at, get(), from.data(), to.data(), wavelength, &value);
        return value;
    }
    void optical_depth(const Point &from, const Point &to, Span<float> out) const {
        detail::call(welkin_transmittance_optical_depth, get(), from.data(), to.data(), out.data(), out.size());
    }
    void to_space(const Point &from, const Point &direction, Span<float> out) const {
        detail::call(welkin_transmittance_to_space, get(), from.data(), direction.data(), out.data(), out.size());
    }
    void to_end(const Point &from, const Point &direction, Span<float> out) const {
        detail::call(welkin_transmittance_to_end, get(), from.data(), direction.data(), out.data(), out.size());
    }
};

class AerialPerspective
    : public detail::Prepared<WelkinAerialPerspective, welkin_aerial_perspective_free, detail::OfAerialPerspective> {
public:
    AerialPerspective(const Model &model, const Conditions &conditions)
        : Prepared(prepare(welkin_aerial_perspective_new, model, conditions)) {}
    std::vector<double> wavelengths() const {
        return detail::wavelengths(welkin_aerial_perspective_wavelength_count, welkin_aerial_perspective_wavelengths,
                                   get());
    }
    // Both outputs have an element per wavelength.
    void in_scattering(const Point &from, const Point &to, Span<float> in_scattering, Span<float> transmittance) const {
        detail::call(welkin_aerial_perspective_in_scattering, get(), from.data(), to.data(), in_scattering.data(),
                     transmittance.data(), detail::same(in_scattering.size(), transmittance.size()));
    }
    void joined(const Sky &sky, const Point &to, Span<float> in_scattering, Span<float> transmittance) const {
        detail::call(welkin_aerial_perspective_joined_in_scattering, get(), sky.get(), to.data(), in_scattering.data(),
                     transmittance.data(), detail::same(in_scattering.size(), transmittance.size()));
    }
    float in_scattering_at(const Point &from, const Point &to, double wavelength) const {
        float value = 0;
        detail::call(welkin_aerial_perspective_in_scattering_at, get(), from.data(), to.data(), wavelength, &value);
        return value;
    }
    Seen rgb(const Point &from, const Point &to, Space space = Space::srgb) const {
        Seen seen{};
        detail::call(welkin_aerial_perspective_rgb, get(), from.data(), to.data(), static_cast<std::int32_t>(space),
                     seen.light.data(), seen.factors.data());
        return seen;
    }
    Seen joined_srgb(const Sky &sky, const Point &to) const {
        Seen seen{};
        detail::call(welkin_aerial_perspective_joined_srgb, get(), sky.get(), to.data(), seen.light.data(),
                     seen.factors.data());
        return seen;
    }
    SeenStokes rgb_stokes(const Point &from, const Point &to, const Frame &frame) const {
        SeenStokes seen{};
        detail::call(welkin_aerial_perspective_rgb_stokes, get(), from.data(), to.data(),
                     static_cast<const WelkinPolarisationFrame *>(&frame), seen.light.data(), seen.factors.data());
        return seen;
    }
};

class ColourAerialPerspective
    : public detail::Prepared<WelkinColourAerialPerspective, welkin_colour_aerial_perspective_free,
                              detail::OfColourAerialPerspective> {
public:
    ColourAerialPerspective(const Model &model, const Conditions &conditions)
        : Prepared(prepare(welkin_colour_aerial_perspective_new, model, conditions)) {}
    Seen rgb(const Point &from, const Point &to, Space space = Space::srgb) const {
        Seen seen{};
        detail::call(welkin_colour_aerial_perspective_rgb, get(), from.data(), to.data(),
                     static_cast<std::int32_t>(space), seen.light.data(), seen.factors.data());
        return seen;
    }
    // As many lights and factors as distances.
    void srgb_along(const Point &from, const Point &direction, Span<const double> distances, Span<Vec3> light,
                    Span<Vec3> factors) const {
        const std::size_t size = detail::same(detail::same(distances.size(), light.size()), factors.size());
        detail::call(welkin_colour_aerial_perspective_srgb_along, get(), from.data(), direction.data(),
                     distances.data(), size, reinterpret_cast<float *>(light.data()),
                     reinterpret_cast<float *>(factors.data()));
    }
    // Rows × columns × depths lights and factors.
    void srgb_volume(const CameraVolume &volume, Span<Vec3> light, Span<Vec3> factors) const {
        detail::call(welkin_colour_aerial_perspective_srgb_volume, get(),
                     static_cast<const WelkinCameraVolume *>(&volume), reinterpret_cast<float *>(light.data()),
                     reinterpret_cast<float *>(factors.data()), detail::same(light.size(), factors.size()));
    }
};

// Radiance where every direction has conditions of its own.
class PointQuery : public detail::Handle<WelkinPointQuery, welkin_point_query_free> {
public:
    PointQuery(const Model &model, const Plan &plan) : Handle(make(welkin_point_query_new, model.get(), plan.get())) {}
    void radiance(const Conditions &conditions, const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_point_query_radiance, get(), static_cast<const WelkinConditions *>(&conditions),
                     direction.data(), out.data(), out.size());
    }
    float radiance_at(const Conditions &conditions, const Vec3 &direction, double wavelength) const {
        float radiance = 0;
        detail::call(welkin_point_query_radiance_at, get(), static_cast<const WelkinConditions *>(&conditions),
                     direction.data(), wavelength, &radiance);
        return radiance;
    }
};

}  // namespace welkin

#endif  // WELKIN_CAPI_HPP
