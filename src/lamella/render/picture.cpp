#include "lamella/render/picture.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/core/random.h"
#include "lamella/render/detail/path_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace lamella::render {
namespace {

using optics::Rgb;

/// What is behind everything, by the place in the picture; nothing where the environment is to be seen.
class Backdrop {
public:
    explicit Backdrop(const std::string& name) {
        if (name == "dark")
            upper_ = {{0.030, 0.034, 0.042}}, lower_ = {{0.0035, 0.0040, 0.0052}};
        else if (name == "light")
            upper_ = {{0.93, 0.94, 0.95}}, lower_ = {{0.60, 0.61, 0.63}};
        else if (name == "transparent")
            transparent_ = true;
        else if (name == "environment")
            shows_environment_ = true;
        else
            upper_ = lower_ = parse(name);
    }

    bool transparent() const { return transparent_; }
    /// How many samples show it well where nothing is before it.
    int samples() const { return shows_environment_ ? 4 : 1; }
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
        const bool hex = text.size() == 7 && text[0] == '#' &&
                         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
        if (!hex)
            throw InputError(
                fmt::format("there is no background {}; dark, light, transparent, environment, or a color such as "
                            "#1a2b3c",
                            text));
        value = static_cast<unsigned>(std::stoul(text.substr(1), nullptr, 16));
        Rgb color;
        for (std::size_t k = 0; k < 3; ++k)
            color[k] = optics::decode_srgb(static_cast<double>(value >> (16 - 8 * k) & 255) / 255.0);
        return color;
    }

    Rgb upper_, lower_;
    bool transparent_ = false, shows_environment_ = false;
};

constexpr std::size_t kTile = 16;  // pixels along a side

/// Everything that a tile needs.
struct Studio {
    const PictureOptions& options;
    detail::Stage stage;
    Environment environment;
    Backdrop backdrop;
    optics::FilmColorTable colors;
    Camera camera;

    std::optional<Rgb> behind(double x, double y) const {
        return backdrop.color(x / static_cast<double>(options.width), y / static_cast<double>(options.height));
    }
};

/// Pixels x0 to x1 - 1 and y0 to y1 - 1.
struct Tile {
    std::size_t x0, y0, x1, y1;
};

/// Linear up to a knee, then an arc that reaches white only for infinite light: highlights keep their shape.
Rgb shoulder(const Rgb& light) {
    constexpr double kKnee = 0.55;
    const double bright = optics::luminance(light);
    if (bright <= kKnee) return light;
    return (kKnee + (1.0 - kKnee) * (1.0 - std::exp(-(bright - kKnee) / (1.0 - kKnee)))) / bright * light;
}

/// Which pixels of a tile may show more than the background: those within two pixels of one that two rays find
/// occupied. The rays of a pixel start up to a pixel beside it, and what two rays miss can reach across half a pixel.
/// What is thinner than a third of a pixel and apart from all else can be missed.
std::vector<std::uint8_t> occupied(const Studio& studio, const Tile& tile) {
    constexpr std::size_t kReach = 2, kWide = 2 * kReach + 1;
    const std::size_t across = tile.x1 - tile.x0 + 2 * kReach, down = tile.y1 - tile.y0 + 2 * kReach;
    std::vector<std::uint8_t> found(across * down, 0);
    const auto probe = [&](double x, double y) {
        return studio.stage.rays->meets_anything(studio.camera.position(), studio.camera.direction(x, y));
    };
    for (std::size_t j = 0; j < down; ++j)
        for (std::size_t i = 0; i < across; ++i) {
            const double x = static_cast<double>(tile.x0 + i) - kReach, y = static_cast<double>(tile.y0 + j) - kReach;
            found[j * across + i] = probe(x + 0.25, y + 0.3) || probe(x + 0.75, y + 0.7) ? 1 : 0;
        }
    const std::size_t width = across - 2 * kReach;
    std::vector<std::uint8_t> near(width * (down - 2 * kReach), 0);
    for (std::size_t k = 0; k < near.size(); ++k)
        for (std::size_t n = 0; n < kWide * kWide; ++n)
            near[k] |= found[(k / width + n / kWide) * across + k % width + n % kWide];
    return near;
}

/// A tent of two pixels' width around the middle of a pixel.
double tent(double u) { return 0.5 + (u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 - 2.0 * u)); }

/// The mean of what the samples of a pixel saw.
void write_pixel(
    const Studio& studio, std::span<const detail::Seen> seen, std::size_t x, std::size_t y, Picture* picture) {
    Rgb light, shown;
    double alpha = 0.0;
    for (const detail::Seen& s : seen) {
        light += studio.options.exposure * s.light;
        shown += shoulder(studio.options.exposure * s.light);
        alpha += s.alpha;
    }
    const auto count = static_cast<double>(seen.size());
    float* linear = picture->light.pixel(x, y);
    float* screen = picture->shown.pixel(x, y);
    for (std::size_t k = 0; k < 3; ++k) {
        linear[k] = static_cast<float>(light[k] / count);
        screen[k] = static_cast<float>(shown[k] / count);
    }
    linear[3] = screen[3] = static_cast<float>(studio.backdrop.transparent() ? alpha / count : 1.0);
}

/// Draws some rows of a tile after the other, so that many rays are on their way together.
void draw_tile(const Studio& studio, const Tile& tile, Picture* picture) {
    const PictureOptions& options = studio.options;
    const bool everywhere = studio.stage.ground.has_value();
    const std::vector<std::uint8_t> busy = everywhere ? std::vector<std::uint8_t>() : occupied(studio, tile);
    detail::PathTracer tracer(studio.stage, studio.environment, studio.colors);
    std::vector<detail::CameraRay> rays;
    std::vector<detail::Seen> seen;
    std::vector<std::size_t> ends;  // of the rays of each pixel of a row
    for (std::size_t y = tile.y0; y < tile.y1; ++y) {
        rays.clear();
        ends.clear();
        for (std::size_t x = tile.x0; x < tile.x1; ++x) {
            const bool empty = !everywhere && busy[(y - tile.y0) * (tile.x1 - tile.x0) + x - tile.x0] == 0;
            const RandomBits bits = random_bits(options.seed, RandomStream::kPicture, 0, y * options.width + x);
            for (int s = 0; s < (empty ? std::min(studio.backdrop.samples(), options.samples) : options.samples); ++s) {
                const detail::SampleNumbers numbers(bits, s);
                const Vec2 place = numbers.place();
                const double px = static_cast<double>(x) + tent(place[0]), py = static_cast<double>(y) + tent(place[1]);
                rays.push_back({studio.camera.direction(px, py), studio.behind(px, py), numbers});
            }
            ends.push_back(rays.size());
        }
        tracer.look(studio.camera.position(), rays, &seen);
        for (std::size_t x = tile.x0, begin = 0; x < tile.x1; begin = ends[x - tile.x0], ++x)
            write_pixel(studio, std::span(seen).subspan(begin, ends[x - tile.x0] - begin), x, y, picture);
    }
}

void check(const PictureOptions& options) {
    const auto within = [](const char* name, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw InputError(fmt::format("{} = {:g} is outside [{:g}, {:g}]", name, value, low, high));
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

Picture render_frame(const sim::Frame& frame,
                     const PictureOptions& options,
                     const std::function<void(double)>& progress) {
    check(options);
    Backdrop backdrop(options.background);
    Environment environment(options.environment);
    detail::Stage stage = detail::make_stage(frame, options);
    if (stage.ground) {
        const std::optional<Rgb> behind = backdrop.color(0.5, 0.8);
        stage.ground->color = behind ? *behind : environment.light({{0.0, 0.0, -1.0}});
    }
    const Studio studio{options,
                        std::move(stage),
                        std::move(environment),
                        std::move(backdrop),
                        optics::FilmColorTable({}, {.thicknesses = 801, .cosines = 65}),
                        Camera(options.view, {{}, 1.0}, options.width, options.height)};

    Picture picture;
    picture.scale = studio.stage.scale;
    picture.thickness_origin = studio.stage.thickness_origin;
    picture.light = {options.width, options.height, 4, std::vector<float>(4 * options.width * options.height)};
    picture.shown = picture.light;
    const std::size_t across = (options.width + kTile - 1) / kTile,
                      tiles = across * ((options.height + kTile - 1) / kTile);
    const std::size_t batch = std::max<std::size_t>(48, 12 * static_cast<std::size_t>(thread_count()));
    for (std::size_t first = 0; first < tiles; first += batch) {
        parallel_blocks(std::min(batch, tiles - first), 1, [&](std::size_t k, std::size_t) {
            const std::size_t x = (first + k) % across * kTile, y = (first + k) / across * kTile;
            draw_tile(studio, {x, y, std::min(x + kTile, options.width), std::min(y + kTile, options.height)},
                      &picture);
        });
        if (progress) progress(static_cast<double>(std::min(tiles, first + batch)) / static_cast<double>(tiles));
    }
    return picture;
}

Canvas develop(const Picture& picture) {
    Canvas canvas(picture.shown.width, picture.shown.height, {0, 0, 0, 0});
    for (std::size_t y = 0; y < canvas.height(); ++y)
        for (std::size_t x = 0; x < canvas.width(); ++x) {
            const float* p = picture.shown.pixel(x, y);
            const double alpha = static_cast<double>(p[3]);
            Rgb color;
            for (std::size_t k = 0; k < 3; ++k) color[k] = alpha > 1e-4 ? static_cast<double>(p[k]) / alpha : 0.0;
            const Rgb shown = optics::desaturate(color);
            ScreenColor& out = canvas.at(x, y);
            for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<float>(optics::encode_srgb(shown[k]));
            out[3] = static_cast<float>(alpha);
        }
    if (picture.scale) draw_legend(canvas, *picture.scale);
    return canvas;
}

}  // namespace lamella::render
