// welkin/welkin.hpp: the C interface for C++17. Move-only types own the handles of welkin/capi.h, and errors are
// exceptions of the type welkin::Error. Header-only, no dependency but the library.
//
// What functions mean, their units, frames, shapes and rules for threads: welkin/capi.h. Methods of const objects may
// be called by any number of threads at once.
//
// Objects that were moved from hold no handle and convert to false. To use them, or to hand them over, is an Error with
// the code WELKIN_STATUS_NULL; questions that are noexcept, such as bytes() and is_visible(), answer 0 or false.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef WELKIN_CAPI_HPP
#define WELKIN_CAPI_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <welkin/capi.h>

namespace welkin {

using Vec3 = std::array<float, 3>;    // directions, colours
using Point = std::array<double, 3>;  // m
using Four = std::array<float, 4>;    // hero wavelengths and their radiances
using Stokes = WelkinStokes;
using BakeError = WelkinBakeError;
using Ranges = WelkinRanges;

// The sun's direction of conditions for queries of a sky, and the other way about.
constexpr Vec3 to_vec3(const Point &point) noexcept {
    return {static_cast<float>(point[0]), static_cast<float>(point[1]), static_cast<float>(point[2])};
}
constexpr Point to_point(const Vec3 &vector) noexcept {
    return {static_cast<double>(vector[0]), static_cast<double>(vector[1]), static_cast<double>(vector[2])};
}

// A draw of a SkySampler: a WelkinSample, with arrays that can be handed on.
struct Sample {
    Vec3 direction;     // unit vector
    float pdf;          // density per solid angle, 1/sr
    Vec3 xyz;           // CIE XYZ of sky and, if it is drawn, the sun's disc; Y in cd/m2
    std::int32_t part;  // WELKIN_PART_SKY or WELKIN_PART_SUN
};
static_assert(std::is_standard_layout_v<Sample> && std::is_trivially_copyable_v<Sample>, "as in C");
static_assert(sizeof(Sample) == sizeof(WelkinSample) && alignof(Sample) == alignof(WelkinSample), "the same layout");
static_assert(offsetof(Sample, direction) == offsetof(WelkinSample, direction), "the same layout");
static_assert(offsetof(Sample, pdf) == offsetof(WelkinSample, pdf), "the same layout");
static_assert(offsetof(Sample, xyz) == offsetof(WelkinSample, xyz), "the same layout");
static_assert(offsetof(Sample, part) == offsetof(WelkinSample, part), "the same layout");

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

// Refuses what the C interface is not asked about.
[[noreturn]] inline void refuse(WelkinStatus status, const char *text) {
    WelkinError error{};
    error.status = status;
    std::snprintf(error.text, sizeof error.text, "%s", text);
    throw Error(error);
}

// Where a function writes its result.
template <class T>
inline T *place(T &value) noexcept {
    return &value;
}
template <class T, std::size_t N>
inline T *place(std::array<T, N> &values) noexcept {
    return values.data();
}
inline WelkinSample *place(Sample &sample) noexcept { return reinterpret_cast<WelkinSample *>(&sample); }

// The result of a function that writes it to its last argument but the error.
template <class Out, class Function, class... Arguments>
inline Out result(Function *function, Arguments... arguments) {
    Out out{};
    call(function, arguments..., place(out));
    return out;
}

// Text for C, which ends at a zero.
inline const char *text(const std::string &text) {
    if (text.find('\0') != std::string::npos) refuse(WELKIN_STATUS_ARGUMENT, "text must not contain a zero");
    return text.c_str();
}

// Owns a handle.
template <class T, void (*Free)(T *)>
class Handle {
public:
    const T *get() const noexcept { return handle_.get(); }
    T *get() noexcept { return handle_.get(); }
    // Whether there is one: false after moving it elsewhere.
    explicit operator bool() const noexcept { return handle_ != nullptr; }

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
    template <class Container>
    using Element = std::remove_pointer_t<decltype(std::data(std::declval<Container &>()))>;
    // Of arrays of T alone, and temporary ones only to read.
    template <class Container>
    using If = std::enable_if_t<!std::is_same_v<std::decay_t<Container>, Span> &&
                                std::is_convertible_v<Element<Container> (*)[], T (*)[]> &&
                                (std::is_const_v<T> || std::is_lvalue_reference_v<Container>)>;

public:
    constexpr Span(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
    // From C arrays, std::vector, std::array and whatever else has data() and size().
    template <class Container, class = If<Container>>
    constexpr Span(Container &&container) noexcept : data_(std::data(container)), size_(std::size(container)) {}
    constexpr T *data() const noexcept { return data_; }
    constexpr std::size_t size() const noexcept { return size_; }

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
    explicit constexpr Directions(const float *x_, const float *y_, const float *z_, std::size_t size_) noexcept
        : x(x_), y(y_), z(z_), size(size_) {}
    explicit Directions(Span<const float> x_, Span<const float> y_, Span<const float> z_)
        : x(x_.data()), y(y_.data()), z(z_.data()), size(detail::same(detail::same(x_.size(), y_.size()), z_.size())) {}

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

namespace detail {
inline const WelkinPolarisationFrame *base(const Frame &frame) noexcept { return &frame; }
// Arrays of vectors as the numbers in them.
template <std::size_t N>
inline float *floats(Span<std::array<float, N>> vectors) noexcept {
    return reinterpret_cast<float *>(vectors.data());
}
template <std::size_t N>
inline const float *floats(Span<const std::array<float, N>> vectors) noexcept {
    return reinterpret_cast<const float *>(vectors.data());
}
}  // namespace detail

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
        return detail::result<Point>(welkin_conditions_sun_direction, static_cast<const WelkinConditions *>(this));
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

inline std::uint32_t abi_version() noexcept { return welkin_abi_version(); }
inline std::string library_version() { return welkin_library_version(); }

inline Vec3 from_xyz(Space space, const Vec3 &xyz) {
    return detail::result<Vec3>(welkin_space_from_xyz, static_cast<std::int32_t>(space), xyz.data());
}

// "srgb", "rec2020", "acescg" or "xyz".
inline Space space_by_name(const std::string &name) {
    return static_cast<Space>(detail::result<std::int32_t>(welkin_space_by_name, detail::text(name)));
}
// A row for each component.
inline std::array<Vec3, 3> matrix(Space space) {
    std::array<Vec3, 3> rows{};
    detail::call(welkin_space_matrix, static_cast<std::int32_t>(space), rows[0].data());
    return rows;
}

inline float degree(const Stokes &stokes) noexcept { return welkin_stokes_degree(&stokes); }
inline float angle(const Stokes &stokes) noexcept { return welkin_stokes_angle(&stokes); }
inline float through_polariser(const Stokes &stokes, float angle) noexcept {
    return welkin_stokes_through_polariser(&stokes, angle);
}

// Of a moon in one direction with the sun in another, rad.
inline double moon_phase_angle(const Point &moon, const Point &sun) {
    return detail::result<double>(welkin_moon_phase_angle, moon.data(), sun.data());
}

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
    static Model open(const std::string &path) { return Model(make(welkin_model_open, detail::text(path))); }
    static Model read(const std::string &path) { return Model(make(welkin_model_read, detail::text(path))); }
    static Model from_bytes(Span<const std::uint8_t> bytes) {
        return Model(make(welkin_model_from_bytes, bytes.data(), bytes.size()));
    }
    static Model default_model() { return Model(make(welkin_model_default)); }

    // The same with the moon in place of the sun.
    Model moonlit(const Moon &moon) const {
        return Model(make(welkin_model_moonlit, get(), static_cast<const WelkinMoon *>(&moon)));
    }

    // The same over a ground with an albedo for each wavelength (nm), in place of that of conditions.
    Model over(Span<const double> wavelengths, Span<const double> albedos) const {
        const std::size_t size = detail::same(wavelengths.size(), albedos.size());
        return Model(make(welkin_model_over, get(), wavelengths.data(), albedos.data(), size));
    }

    void verify() const { detail::call(welkin_model_verify, get()); }
    std::vector<double> wavelengths() const {
        std::vector<double> nm(welkin_model_wavelength_count(get()));
        detail::call(welkin_model_wavelengths, get(), nm.data(), nm.size());
        return nm;
    }
    Ranges ranges() const {
        return detail::result<Ranges>(welkin_model_ranges, get());
    }
    // Which quantity the visibilities stand for; an error (missing) where they stand for themselves.
    WelkinAxis axis() const { return detail::result<WelkinAxis>(welkin_model_axis, get()); }
    std::vector<double> axis_values() const {
        std::vector<double> values(static_cast<std::size_t>(axis().nodes));
        detail::call(welkin_model_axis_values, get(), values.data(), values.size());
        return values;
    }
    // The visibility (m) that stands for a value, and the other way round.
    double axis_visibility(double value) const {
        return detail::result<double>(welkin_model_axis_visibility, get(), value);
    }
    double axis_value(double visibility) const {
        return detail::result<double>(welkin_model_axis_value, get(), visibility);
    }
    bool is_polarised() const noexcept { return welkin_model_is_polarised(get()); }
    bool is_moonlit() const noexcept { return welkin_model_is_moonlit(get()); }
    bool has_ground() const noexcept { return welkin_model_has_ground(get()); }
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
        return detail::result<BakeError>(welkin_baked_sky_bake_error, get());
    }
    void radiance(const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_baked_sky_radiance, get(), direction.data(), out.data(), out.size());
    }
    void radiance(Span<const Vec3> directions, Span<float> out) const {
        detail::call(welkin_baked_sky_radiance_batch, get(), detail::floats(directions),
                     directions.size(), out.data(), out.size());
    }
    void radiance(const Directions &d, Span<float> out) const {
        detail::call(welkin_baked_sky_radiance_soa, get(), d.x, d.y, d.z, d.size, out.data(), out.size());
    }
    Four hero(const Vec3 &direction, const Four &wavelengths) const {
        return detail::result<Four>(welkin_baked_sky_hero, get(), direction.data(), wavelengths.data());
    }
    // As many wavelengths and radiances as directions.
    void hero(Span<const Vec3> directions, Span<const Four> wavelengths, Span<Four> radiance) const {
        const std::size_t size = detail::same(detail::same(directions.size(), wavelengths.size()), radiance.size());
        detail::call(welkin_baked_sky_hero_batch, get(), detail::floats(directions), detail::floats(wavelengths), size,
                     detail::floats(radiance));
    }
    void hero(const Directions &d, Span<const Four> wavelengths, Span<Four> radiance) const {
        const std::size_t size = detail::same(detail::same(d.size, wavelengths.size()), radiance.size());
        detail::call(welkin_baked_sky_hero_soa, get(), d.x, d.y, d.z,
                     detail::floats(wavelengths), size, detail::floats(radiance));
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
    std::vector<double> wavelengths() const {
        return detail::wavelengths(welkin_solar_disc_wavelength_count, welkin_solar_disc_wavelengths, get());
    }
    bool is_visible() const noexcept { return welkin_solar_disc_is_visible(get()); }
    double solid_angle() const noexcept { return welkin_solar_disc_solid_angle(get()); }
    Vec3 direction() const {
        return detail::result<Vec3>(welkin_solar_disc_direction, get());
    }
    void radiance(const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_solar_disc_radiance, get(), direction.data(), out.data(), out.size());
    }
    float radiance_at(const Vec3 &direction, double wavelength) const {
        return detail::result<float>(welkin_solar_disc_radiance_at, get(), direction.data(), wavelength);
    }
    Vec3 xyz(const Vec3 &direction) const {
        return detail::result<Vec3>(welkin_solar_disc_xyz, get(), direction.data());
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        return detail::result<Vec3>(welkin_solar_disc_rgb, get(), direction.data(), static_cast<std::int32_t>(space));
    }
    void irradiance(const Vec3 &normal, Span<float> out) const {
        detail::call(welkin_solar_disc_irradiance, get(), normal.data(), out.data(), out.size());
    }
};

// Draws directions of sky and sun by luminance.
class SkySampler : public detail::Handle<WelkinSkySampler, welkin_sky_sampler_free> {
public:
    std::size_t bytes() const noexcept { return welkin_sky_sampler_bytes(get()); }
    Sample sample(float a, float b) const {
        const std::array<float, 2> point{a, b};
        return detail::result<Sample>(welkin_sky_sampler_sample, get(), point.data());
    }
    void sample(Span<const std::array<float, 2>> points, Span<Sample> samples) const {
        detail::call(welkin_sky_sampler_sample_batch, get(), detail::floats(points),
                     detail::same(points.size(), samples.size()), reinterpret_cast<WelkinSample *>(samples.data()));
    }
    float pdf(const Vec3 &direction) const {
        return detail::result<float>(welkin_sky_sampler_pdf, get(), direction.data());
    }
    Vec3 xyz(const Vec3 &direction) const {
        return detail::result<Vec3>(welkin_sky_sampler_xyz, get(), direction.data());
    }

private:
    friend class BakedColourSky;
    explicit SkySampler(WelkinSkySampler *handle) noexcept : Handle(handle) {}
};

class BakedColourSky
    : public detail::Prepared<WelkinBakedColourSky, welkin_baked_colour_sky_free, detail::OfBakedColourSky> {
public:
    BakeError bake_error() const {
        return detail::result<BakeError>(welkin_baked_colour_sky_bake_error, get());
    }
    Vec3 xyz(const Vec3 &direction) const {
        return detail::result<Vec3>(welkin_baked_colour_sky_xyz, get(), direction.data());
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        return detail::result<Vec3>(welkin_baked_colour_sky_rgb, get(), direction.data(),
                                    static_cast<std::int32_t>(space));
    }
    // As many colours as directions.
    void xyz(Span<const Vec3> directions, Span<Vec3> out) const {
        detail::call(welkin_baked_colour_sky_xyz_batch, get(), detail::floats(directions),
                     detail::same(directions.size(), out.size()), detail::floats(out));
    }
    void xyz(const Directions &d, Span<Vec3> out) const {
        detail::call(welkin_baked_colour_sky_xyz_soa, get(), d.x, d.y, d.z, detail::same(d.size, out.size()),
                     detail::floats(out));
    }
    void rgb(Span<const Vec3> directions, Span<Vec3> out, Space space = Space::srgb) const {
        detail::call(welkin_baked_colour_sky_rgb_batch, get(), detail::floats(directions),
                     detail::same(directions.size(), out.size()), static_cast<std::int32_t>(space),
                     detail::floats(out));
    }
    void rgb(const Directions &d, Span<Vec3> out, Space space = Space::srgb) const {
        detail::call(welkin_baked_colour_sky_rgb_soa, get(), d.x, d.y, d.z, detail::same(d.size, out.size()),
                     static_cast<std::int32_t>(space), detail::floats(out));
    }
    SkySampler sampler() const {
        return SkySampler(SkySampler::make(welkin_baked_colour_sky_sampler, get(), no_disc()));
    }
    // Of sky and sun; both are to be those of the same conditions.
    SkySampler sampler(const SolarDisc &disc) const {
        if (!disc) detail::refuse(WELKIN_STATUS_NULL, "disc must not be null: was it moved from?");
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
        return detail::result<Vec3>(welkin_sky_sun_direction, get());
    }
    void radiance(const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_sky_radiance, get(), direction.data(), out.data(), out.size());
    }
    void radiance(Span<const Vec3> directions, Span<float> out) const {
        detail::call(welkin_sky_radiance_batch, get(), detail::floats(directions),
                     directions.size(), out.data(), out.size());
    }
    // Per unit of solar spectral irradiance, 1/sr.
    void relative_radiance(const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_sky_relative_radiance, get(), direction.data(), out.data(), out.size());
    }
    float radiance_at(const Vec3 &direction, double wavelength) const {
        return detail::result<float>(welkin_sky_radiance_at, get(), direction.data(), wavelength);
    }
    Vec3 xyz(const Vec3 &direction) const {
        return detail::result<Vec3>(welkin_sky_xyz, get(), direction.data());
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        return detail::result<Vec3>(welkin_sky_rgb, get(), direction.data(), static_cast<std::int32_t>(space));
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
    Vec3 sun_direction() const { return detail::result<Vec3>(welkin_colour_sky_sun_direction, get()); }
    Vec3 xyz(const Vec3 &direction) const {
        return detail::result<Vec3>(welkin_colour_sky_xyz, get(), direction.data());
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        return detail::result<Vec3>(welkin_colour_sky_rgb, get(), direction.data(), static_cast<std::int32_t>(space));
    }
    BakedColourSky bake(double tolerance = WELKIN_BAKE_TOLERANCE) const {
        return BakedColourSky(BakedColourSky::make(welkin_colour_sky_bake, get(), tolerance));
    }
    // Of the next frame under a sun that moves, in half the time. Its bake_error() is that of the other: bake afresh
    // every degree or so.
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
    // Lowest and highest, rad.
    std::array<double, 2> elevations() const {
        return detail::result<std::array<double, 2>>(welkin_sun_course_elevations, get());
    }
    // What interpolation adds to the error of baking.
    BakeError interpolation_error() const {
        return detail::result<BakeError>(welkin_sun_course_interpolation_error, get());
    }
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
    BakeError bake_error() const { return detail::result<BakeError>(welkin_baked_polarised_sky_bake_error, get()); }
    BakeError polarisation_error() const {
        return detail::result<BakeError>(welkin_baked_polarised_sky_polarisation_error, get());
    }
    // Without polarisation.
    void radiance(const Vec3 &direction, Span<float> out) const {
        detail::call(welkin_baked_polarised_sky_radiance, get(), direction.data(), out.data(), out.size());
    }
    // An element per wavelength in each of the outputs, which are of one size.
    void stokes(const Vec3 &direction, const Frame &frame, float *i, float *q, float *u, std::size_t count) const {
        detail::call(welkin_baked_polarised_sky_stokes, get(), direction.data(), detail::base(frame), i, q, u, count);
    }
    void stokes(const Vec3 &direction, const Frame &frame, Span<float> i, Span<float> q, Span<float> u) const {
        const std::size_t size = detail::same(detail::same(i.size(), q.size()), u.size());
        stokes(direction, frame, i.data(), q.data(), u.data(), size);
    }
    // An element per direction and wavelength.
    void stokes(const Directions &d, const Frame &frame, Span<float> i, Span<float> q, Span<float> u) const {
        const std::size_t size = detail::same(detail::same(i.size(), q.size()), u.size());
        detail::call(welkin_baked_polarised_sky_stokes_soa, get(), d.x, d.y, d.z, d.size, detail::base(frame), i.data(),
                     q.data(), u.data(), size);
    }
    std::array<Stokes, 4> hero(const Vec3 &direction, const Frame &frame, const Four &wavelengths) const {
        std::array<Stokes, 4> stokes{};
        detail::call(welkin_baked_polarised_sky_hero, get(), direction.data(), detail::base(frame), wavelengths.data(),
                     stokes.data());
        return stokes;
    }
    // As many wavelengths and Stokes vectors as directions.
    void hero(Span<const Vec3> directions, const Frame &frame, Span<const Four> wavelengths,
              Span<std::array<Stokes, 4>> stokes) const {
        const std::size_t size = detail::same(detail::same(directions.size(), wavelengths.size()), stokes.size());
        detail::call(welkin_baked_polarised_sky_hero_batch, get(), detail::floats(directions), detail::base(frame),
                     detail::floats(wavelengths), size, reinterpret_cast<Stokes *>(stokes.data()));
    }

private:
    friend class PolarisedSky;
    explicit BakedPolarisedSky(WelkinBakedPolarisedSky *handle) noexcept : Prepared(handle) {}
};

class PolarisedSky : public detail::Prepared<WelkinPolarisedSky, welkin_polarised_sky_free, detail::OfPolarisedSky> {
public:
    PolarisedSky(const Model &model, const Conditions &conditions)
        : Prepared(prepare(welkin_polarised_sky_new, model, conditions)) {}
    std::vector<double> wavelengths() const {
        return detail::wavelengths(welkin_polarised_sky_wavelength_count, welkin_polarised_sky_wavelengths, get());
    }
    void stokes(const Vec3 &direction, const Frame &frame, Span<Stokes> out) const {
        detail::call(welkin_polarised_sky_stokes, get(), direction.data(), detail::base(frame), out.data(), out.size());
    }
    Stokes stokes_at(const Vec3 &direction, const Frame &frame, double wavelength) const {
        return detail::result<Stokes>(welkin_polarised_sky_stokes_at, get(), direction.data(), detail::base(frame),
                                      wavelength);
    }
    // Stokes vectors of X, Y and Z.
    std::array<Stokes, 3> xyz(const Vec3 &direction, const Frame &frame) const {
        return detail::result<std::array<Stokes, 3>>(welkin_polarised_sky_xyz, get(), direction.data(),
                                                     detail::base(frame));
    }
    BakedPolarisedSky bake(double tolerance = WELKIN_BAKE_TOLERANCE) const {
        return BakedPolarisedSky(BakedPolarisedSky::make(welkin_polarised_sky_bake, get(), tolerance));
    }
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
    Vec3 xyz(const Vec3 &direction) const {
        return detail::result<Vec3>(welkin_sky_sum_xyz, get(), direction.data());
    }
    Vec3 rgb(const Vec3 &direction, Space space = Space::srgb) const {
        return detail::result<Vec3>(welkin_sky_sum_rgb, get(), direction.data(), static_cast<std::int32_t>(space));
    }
};

class Transmittance : public detail::Handle<WelkinTransmittance, welkin_transmittance_free> {
public:
    Transmittance(const Model &model, double visibility)
        : Handle(make(welkin_transmittance_new, model.get(), visibility)) {}
    std::size_t bytes() const noexcept { return welkin_transmittance_bytes(get()); }
    std::vector<double> wavelengths() const {
        return detail::wavelengths(welkin_transmittance_wavelength_count, welkin_transmittance_wavelengths, get());
    }
    void between(const Point &from, const Point &to, Span<float> out) const {
        detail::call(welkin_transmittance_between, get(), from.data(), to.data(), out.data(), out.size());
    }
    float between_at(const Point &from, const Point &to, double wavelength) const {
        return detail::result<float>(welkin_transmittance_between_at, get(), from.data(), to.data(), wavelength);
    }
    void optical_depth(const Point &from, const Point &to, Span<float> out) const {
        detail::call(welkin_transmittance_optical_depth, get(), from.data(), to.data(), out.data(), out.size());
    }
    void to_space(const Point &from, const Point &direction, Span<float> out) const {
        detail::call(welkin_transmittance_to_space, get(), from.data(), direction.data(), out.data(), out.size());
    }
    float to_space_at(const Point &from, const Point &direction, double wavelength) const {
        return detail::result<float>(welkin_transmittance_to_space_at, get(), from.data(), direction.data(),
                                     wavelength);
    }
    void to_end(const Point &from, const Point &direction, Span<float> out) const {
        detail::call(welkin_transmittance_to_end, get(), from.data(), direction.data(), out.data(), out.size());
    }
    float to_end_at(const Point &from, const Point &direction, double wavelength) const {
        return detail::result<float>(welkin_transmittance_to_end_at, get(), from.data(), direction.data(), wavelength);
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
    // How far the air of segments may be from the origin, as an angle at the planet's centre, rad.
    double reach() const noexcept { return welkin_aerial_perspective_reach(get()); }
    // Both outputs have an element per wavelength.
    void in_scattering(const Point &from, const Point &to, Span<float> in_scattering, Span<float> transmittance) const {
        detail::call(welkin_aerial_perspective_in_scattering, get(), from.data(), to.data(), in_scattering.data(),
                     transmittance.data(), detail::same(in_scattering.size(), transmittance.size()));
    }
    // Of all of the air in a direction.
    void to_end(const Point &from, const Point &direction, Span<float> in_scattering, Span<float> transmittance) const {
        detail::call(welkin_aerial_perspective_to_end, get(), from.data(), direction.data(), in_scattering.data(),
                     transmittance.data(), detail::same(in_scattering.size(), transmittance.size()));
    }
    // Of many points; both outputs have an element per point and wavelength.
    void in_scattering(const Point &camera, Span<const Point> points, Span<float> in_scattering,
                       Span<float> transmittance) const {
        detail::call(welkin_aerial_perspective_in_scattering_batch, get(), camera.data(), doubles(points),
                     points.size(), in_scattering.data(), transmittance.data(),
                     detail::same(in_scattering.size(), transmittance.size()));
    }
    // Of a ray's points at growing distances; both outputs have an element per distance and wavelength.
    void in_scattering_along(const Point &from, const Point &direction, Span<const double> distances,
                             Span<float> in_scattering, Span<float> transmittance) const {
        detail::call(welkin_aerial_perspective_in_scattering_along, get(), from.data(), direction.data(),
                     distances.data(), distances.size(), in_scattering.data(), transmittance.data(),
                     detail::same(in_scattering.size(), transmittance.size()));
    }
    void in_scattering_stokes(const Point &from, const Point &to, const Frame &frame, Span<float> i, Span<float> q,
                              Span<float> u, Span<float> transmittance) const {
        const std::size_t size = detail::same(detail::same(i.size(), q.size()), u.size());
        detail::call(welkin_aerial_perspective_in_scattering_stokes, get(), from.data(), to.data(), detail::base(frame),
                     i.data(), q.data(), u.data(), transmittance.data(), detail::same(size, transmittance.size()));
    }
    // From where the sky was prepared, and going over into it far away.
    void joined(const Sky &sky, const Point &to, Span<float> in_scattering, Span<float> transmittance) const {
        detail::call(welkin_aerial_perspective_joined_in_scattering, get(), sky.get(), to.data(), in_scattering.data(),
                     transmittance.data(), detail::same(in_scattering.size(), transmittance.size()));
    }
    void joined(const Sky &sky, Span<const Point> points, Span<float> in_scattering, Span<float> transmittance) const {
        detail::call(welkin_aerial_perspective_joined_batch, get(), sky.get(), doubles(points), points.size(),
                     in_scattering.data(), transmittance.data(),
                     detail::same(in_scattering.size(), transmittance.size()));
    }
    float in_scattering_at(const Point &from, const Point &to, double wavelength) const {
        return detail::result<float>(welkin_aerial_perspective_in_scattering_at, get(), from.data(), to.data(),
                                     wavelength);
    }
    Seen rgb(const Point &from, const Point &to, Space space = Space::srgb) const {
        Seen seen{};
        detail::call(welkin_aerial_perspective_rgb, get(), from.data(), to.data(), static_cast<std::int32_t>(space),
                     seen.light.data(), seen.factors.data());
        return seen;
    }
    Seen xyz(const Point &from, const Point &to) const {
        Seen seen{};
        detail::call(welkin_aerial_perspective_xyz, get(), from.data(), to.data(), seen.light.data(),
                     seen.factors.data());
        return seen;
    }
    Seen joined_rgb(const Sky &sky, const Point &to, Space space = Space::srgb) const {
        Seen seen{};
        detail::call(welkin_aerial_perspective_joined_rgb, get(), sky.get(), to.data(),
                     static_cast<std::int32_t>(space), seen.light.data(), seen.factors.data());
        return seen;
    }
    Seen joined_xyz(const Sky &sky, const Point &to) const {
        Seen seen{};
        detail::call(welkin_aerial_perspective_joined_xyz, get(), sky.get(), to.data(), seen.light.data(),
                     seen.factors.data());
        return seen;
    }
    // In linear sRGB.
    SeenStokes joined_srgb_stokes(const PolarisedSky &sky, const Point &to, const Frame &frame) const {
        SeenStokes seen{};
        detail::call(welkin_aerial_perspective_joined_srgb_stokes, get(), sky.get(), to.data(), detail::base(frame),
                     seen.light.data(), seen.factors.data());
        return seen;
    }
    // In linear sRGB.
    SeenStokes rgb_stokes(const Point &from, const Point &to, const Frame &frame) const {
        SeenStokes seen{};
        detail::call(welkin_aerial_perspective_rgb_stokes, get(), from.data(), to.data(),
                     detail::base(frame), seen.light.data(), seen.factors.data());
        return seen;
    }

private:
    static const double *doubles(Span<const Point> points) noexcept {
        return reinterpret_cast<const double *>(points.data());
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
    Seen xyz(const Point &from, const Point &to) const {
        Seen seen{};
        detail::call(welkin_colour_aerial_perspective_xyz, get(), from.data(), to.data(), seen.light.data(),
                     seen.factors.data());
        return seen;
    }
    // As many lights and factors as distances.
    void srgb_along(const Point &from, const Point &direction, Span<const double> distances, Span<Vec3> light,
                    Span<Vec3> factors) const {
        const std::size_t size = detail::same(detail::same(distances.size(), light.size()), factors.size());
        detail::call(welkin_colour_aerial_perspective_srgb_along, get(), from.data(), direction.data(),
                     distances.data(), size, detail::floats(light),
                     detail::floats(factors));
    }
    // Rows × columns × depths lights and factors.
    void srgb_volume(const CameraVolume &volume, Span<Vec3> light, Span<Vec3> factors) const {
        detail::call(welkin_colour_aerial_perspective_srgb_volume, get(),
                     static_cast<const WelkinCameraVolume *>(&volume), detail::floats(light),
                     detail::floats(factors), detail::same(light.size(), factors.size()));
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
        return detail::result<float>(welkin_point_query_radiance_at, get(),
                                     static_cast<const WelkinConditions *>(&conditions), direction.data(), wavelength);
    }
};

// The same with polarisation, within a plan for WELKIN_CHANNELS_STOKES.
class PolarisedPointQuery : public detail::Handle<WelkinPolarisedPointQuery, welkin_polarised_point_query_free> {
public:
    PolarisedPointQuery(const Model &model, const Plan &plan)
        : Handle(make(welkin_polarised_point_query_new, model.get(), plan.get())) {}
    Stokes stokes_at(const Conditions &conditions, const Vec3 &direction, const Frame &frame, double wavelength) const {
        return detail::result<Stokes>(welkin_polarised_point_query_stokes_at, get(),
                                      static_cast<const WelkinConditions *>(&conditions), direction.data(),
                                      detail::base(frame), wavelength);
    }
};

}  // namespace welkin

#endif  // WELKIN_CAPI_HPP
