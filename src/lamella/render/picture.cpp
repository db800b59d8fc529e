#include "lamella/render/picture.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/core/random.h"
#include "lamella/render/detail/path_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::render {
namespace {

using optics::Rgb;

/// What is behind everything, by the place in the picture; nothing where the environment is to be seen.
class Backdrop {
public:
    explicit Backdrop(const std::string& name) {
        if (name == "dark") upper_ = {{0.030, 0.034, 0.042}}, lower_ = {{0.0035, 0.0040, 0.0052}};
        else if (name == "light") upper_ = {{0.93, 0.94, 0.95}}, lower_ = {{0.60, 0.61, 0.63}};
        else if (name == "transparent") transparent_ = true;
        else if (name == "environment") shows_environment_ = true;
        else upper_ = lower_ = parse(name);
    }

    bool transparent() const { return transparent_; }
    /// @param x, y  0 to 1 from the upper left corner
    std::optional<Rgb> color(double x, double y) const {
        if (shows_environment_) return std::nullopt;
        const double off_center = std::min(1.0, std::hypot(x - 0.5, y - 0.42) / 0.72);
        const double t = off_center * off_center * (3.0 - 2.0 * off_center);
        return upper_ + t * (lower_ - upper_);
    }

private:
    static Rgb parse(const std::string& text) {
        unsigned value = 0;
        const bool hex = text.size() == 7 && text[0] == '#' && text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
        if (!hex)
            throw InputError(fmt::format("there is no background {}; dark, light, transparent, environment, or a color such as "
                                         "#1a2b3c", text));
        value = static_cast<unsigned>(std::stoul(text.substr(1), nullptr, 16));
        Rgb color;
        for (std::size_t k = 0; k < 3; ++k) color[k] = optics::decode_srgb(static_cast<double>(value >> (16 - 8 * k) & 255) / 255.0);
        return color;
    }

    Rgb upper_, lower_;
    bool transparent_ = false, shows_environment_ = false;
};

/// Places within a pixel that fill it evenly, however many are taken: the R2 sequence, shifted for each pixel, and a tent of two
/// pixels' width around the middle.
Vec2 place_in_pixel(int sample, double shift_x, double shift_y) {
    const auto tent = [](double u) { return u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 - 2.0 * u); };
    const double x = shift_x + 0.7548776662466927 * sample, y = shift_y + 0.5698402909980532 * sample;
    return {{0.5 + tent(x - std::floor(x)), 0.5 + tent(y - std::floor(y))}};
}

constexpr std::size_t kTile = 16;  // pixels along a side

/// Everything that a tile needs.
struct Studio {
    const PictureOptions& options;
    detail::Stage stage;
    Environment environment;
    Backdrop backdrop;
    optics::FilmColorTable colors;
    Camera camera;
    Vec3 camera_place;  ///< on the stage
};

/// The light and opacity of one pixel. Where the first rays meet nothing, the others would not either.
std::array<float, 4> pixel(const Studio& studio, detail::PathTracer& tracer, std::size_t x, std::size_t y) {
    const PictureOptions& options = studio.options;
    const RandomBits shift = random_bits(options.seed, RandomStream::kPicture, 0, y * options.width + x);
    const double w = static_cast<double>(options.width), h = static_cast<double>(options.height);
    constexpr int kProbes = 4;
    Rgb light;
    double alpha = 0.0;
    int taken = 0, empty = 0;
    while (taken < options.samples && !(taken == kProbes && empty == kProbes)) {
        detail::SampleNumbers numbers(shift.half(1) + 0x632BE59BD9B4E019U * static_cast<std::uint64_t>(taken));
        const Vec2 inside = place_in_pixel(taken, uniform01(shift), static_cast<double>(shift.word[0] >> 8) * 0x1.0p-24);
        const double px = static_cast<double>(x) + inside[0], py = static_cast<double>(y) + inside[1];
        const std::optional<Rgb> behind = studio.backdrop.color(px / w, py / h);
        const detail::Seen seen = tracer.look(studio.camera_place, studio.camera.direction(px, py), behind, numbers);
        light += seen.light;
        alpha += seen.alpha;
        empty += seen.empty ? 1 : 0;
        ++taken;
    }
    light = options.exposure / taken * light;
    return {static_cast<float>(light[0]), static_cast<float>(light[1]), static_cast<float>(light[2]),
            static_cast<float>(studio.backdrop.transparent() ? alpha / taken : 1.0)};
}

void check(const PictureOptions& options) {
    const auto within = [](const char* name, double value, double low, double high) {
        if (!(value >= low && value <= high)) throw InputError(fmt::format("{} = {:g} is outside [{:g}, {:g}]", name, value, low, high));
    };
    within("width", static_cast<double>(options.width), 1, 16384);
    within("height", static_cast<double>(options.height), 1, 16384);
    within("samples", options.samples, 1, 65536);
    within("elevation", options.view.elevation_deg, -90, 90);
    within("azimuth", options.view.azimuth_deg, -3600, 3600);
    within("zoom", options.view.zoom, 0.01, 100);
    within("field_of_view", options.view.field_of_view_deg, 1, 120);
    within("border_width", options.border_width, 0, 10);
    within("exposure", options.exposure, 1e-6, 1e6);
    within("thickness", options.thickness, 0, 1e-3);
}

}  // namespace

bool can_render() { return detail::can_trace_rays(); }

Picture render_frame(const sim::Frame& frame, const PictureOptions& options, const std::function<void(double)>& progress) {
    check(options);
    Backdrop backdrop(options.background);
    Environment environment(options.environment);
    detail::Stage stage = detail::make_stage(frame, options);
    const Bounds unit{{}, 1.0};
    const Camera camera(options.view, unit, options.width, options.height);
    const Studio studio{options, std::move(stage), std::move(environment), std::move(backdrop),
                        optics::FilmColorTable({}, {.thicknesses = 801, .cosines = 65}), camera, camera.position()};

    Picture picture{{options.width, options.height, 4, {}}, studio.stage.scale};
    picture.light.values.resize(4 * options.width * options.height);
    const std::size_t across = (options.width + kTile - 1) / kTile, tiles = across * ((options.height + kTile - 1) / kTile);
    const std::size_t batch = std::max<std::size_t>(48, 12 * static_cast<std::size_t>(thread_count()));
    for (std::size_t first = 0; first < tiles; first += batch) {
        parallel_blocks(std::min(batch, tiles - first), 1, [&](std::size_t k, std::size_t) {
            detail::PathTracer tracer(studio.stage, studio.environment, studio.colors);
            const std::size_t x0 = (first + k) % across * kTile, y0 = (first + k) / across * kTile;
            for (std::size_t y = y0; y < std::min(y0 + kTile, options.height); ++y)
                for (std::size_t x = x0; x < std::min(x0 + kTile, options.width); ++x)
                    std::ranges::copy(pixel(studio, tracer, x, y), picture.light.pixel(x, y));
        });
        if (progress) progress(static_cast<double>(std::min(tiles, first + batch)) / static_cast<double>(tiles));
    }
    return picture;
}

Canvas develop(const Picture& picture, double exposure) {
    // Linear up to a knee, then an arc that reaches white only for infinite light: highlights keep their shape.
    const auto shoulder = [](double y) {
        constexpr double kKnee = 0.55;
        return y <= kKnee ? y : kKnee + (1.0 - kKnee) * (1.0 - std::exp(-(y - kKnee) / (1.0 - kKnee)));
    };
    Canvas canvas(picture.light.width, picture.light.height, {0, 0, 0, 0});
    for (std::size_t y = 0; y < canvas.height(); ++y)
        for (std::size_t x = 0; x < canvas.width(); ++x) {
            const float* p = picture.light.pixel(x, y);
            const double alpha = static_cast<double>(p[3]);
            Rgb color;
            for (std::size_t k = 0; k < 3; ++k) color[k] = alpha > 1e-4 ? exposure * static_cast<double>(p[k]) / alpha : 0.0;
            const double bright = optics::luminance(color);
            const Rgb shown = optics::desaturate(bright > 0.0 ? shoulder(bright) / bright * color : Rgb{});
            ScreenColor& out = canvas.at(x, y);
            for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<float>(optics::encode_srgb(shown[k]));
            out[3] = static_cast<float>(alpha);
        }
    if (picture.scale) draw_legend(canvas, *picture.scale);
    return canvas;
}

}  // namespace lamella::render
