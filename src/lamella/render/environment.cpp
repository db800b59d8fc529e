#include "lamella/render/environment.h"

#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

namespace lamella::render {
namespace {

using optics::Rgb;
using std::numbers::pi;

constexpr std::size_t kRows = 64, kColumns = 128;  // of the table that directions are drawn from

double smooth_step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// A rectangular lamp far away, as large as it looks: half sizes are tangents of half angles.
struct Lamp {
    double azimuth, elevation;     ///< of its middle [deg]
    double half_width, half_height;
    double softness;               ///< width of its edge, in the same measure
    Rgb light;
    int panes = 1;                 ///< parts it into so many panes, across and down, as a window
};

double box(double x, double half, double softness) {
    return 1.0 - smooth_step(half - 0.5 * softness, half + 0.5 * softness, std::abs(x));
}

Rgb lamp_light(const Lamp& lamp, const Vec3& d) {
    const double az = lamp.azimuth * pi / 180.0, el = lamp.elevation * pi / 180.0;
    const Vec3 middle{{std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)}};
    const Vec3 right{{-std::sin(az), std::cos(az), 0.0}}, up = cross(middle, right);
    const double depth = dot(d, middle);
    if (depth <= 0.05) return {};
    const double x = dot(d, right) / depth, y = dot(d, up) / depth;
    double cover = box(x, lamp.half_width, lamp.softness) * box(y, lamp.half_height, lamp.softness);
    if (cover == 0.0) return {};
    if (lamp.panes > 1) {  // bars between the panes
        constexpr double kBar = 0.05;
        const auto bars = [&](double position, double half) {
            const double pane = 2.0 * half / lamp.panes, at = (position + half) / pane;
            const double from_bar = std::abs(at - std::round(at)) * pane;
            const bool outer = std::round(at) < 0.5 || std::round(at) > lamp.panes - 0.5;
            return outer ? 1.0 : smooth_step(0.5 * kBar * half, kBar * half, from_bar);
        };
        cover *= bars(x, lamp.half_width) * bars(y, lamp.half_height);
    }
    const double falloff = 0.75 + 0.25 * (1.0 - std::hypot(x / lamp.half_width, y / lamp.half_height) / std::numbers::sqrt2);
    return cover * falloff * lamp.light;
}

/// A dark room with one large lamp above left, a strip on the right, a weak fill from behind and below.
Rgb studio(const Vec3& d) {
    const Lamp lamps[] = {{-125.0, 38.0, 0.62, 0.62, 0.10, {{15.0, 14.7, 14.0}}, 2},
                          {-15.0, 18.0, 0.20, 0.95, 0.12, {{9.0, 9.6, 10.5}}},
                          {95.0, 55.0, 0.80, 0.45, 0.35, {{6.0, 6.0, 6.0}}},
                          {150.0, -5.0, 0.22, 0.80, 0.25, {{3.2, 3.0, 2.8}}},
                          {-70.0, -50.0, 0.70, 0.30, 0.50, {{1.6, 1.7, 2.0}}}};
    const double up = 0.5 + 0.5 * d[2];
    Rgb sum = (0.16 + 0.42 * up * up) * Rgb{{0.93, 0.98, 1.08}};
    for (const Lamp& lamp : lamps) sum += lamp_light(lamp, d);
    return sum;
}

/// Hazy sky, brighter near the horizon and around a veiled sun, over gray ground.
Rgb daylight(const Vec3& d) {
    const Vec3 sun{{-0.42, -0.68, 0.60}};
    const double toward = dot(d, sun);
    const Rgb zenith{{0.55, 0.95, 1.75}}, horizon{{1.9, 2.0, 2.1}}, ground{{0.42, 0.40, 0.37}};
    const double height = std::max(d[2], 0.0);
    Rgb sky = horizon + smooth_step(0.0, 0.75, height) * (zenith - horizon);
    sky += (5.0 * std::exp(12.0 * (toward - 1.0)) + 60.0 * smooth_step(0.985, 0.992, toward)) * Rgb{{1.0, 0.95, 0.86}};
    return ground + smooth_step(-0.03, 0.03, d[2]) * (sky - ground);
}

Vec3 direction_at(double row, double column) {  // row from the top, both 0 to 1
    const double polar = pi * row, azimuth = 2.0 * pi * column;
    return {{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)}};
}

}  // namespace

const std::vector<std::string>& Environment::names() {
    static const std::vector<std::string> names{"studio", "daylight", "gray"};
    return names;
}

Environment::Environment(const std::string& name) {
    if (name == "studio") kind_ = Kind::kStudio;
    else if (name == "daylight") kind_ = Kind::kDaylight;
    else if (name == "gray") kind_ = Kind::kGray;
    else if (name.ends_with(".hdr") || name.ends_with(".exr") || name.ends_with(".pic")) {
        kind_ = Kind::kPicture;
        picture_ = io::read_light_image(name);
    } else {
        const auto near = nearest_word(name, names());
        throw InputError(fmt::format("there is no environment {}{}; studio, daylight, gray, or a file that ends in .hdr or .exr",
                                     name, near ? fmt::format("; did you mean {}?", *near) : ""));
    }
    prepare_sampling();
}

Rgb Environment::light(const Vec3& d) const {
    switch (kind_) {
        case Kind::kStudio: return studio(d);
        case Kind::kDaylight: return daylight(d);
        case Kind::kGray: return {{1.0, 1.0, 1.0}};
        case Kind::kPicture: return painted(d);
    }
    return {};
}

Rgb Environment::painted(const Vec3& d) const {
    const double row = std::acos(std::clamp(d[2], -1.0, 1.0)) / pi;
    const double column = std::atan2(d[1], d[0]) / (2.0 * pi);
    const double y = std::clamp(row * static_cast<double>(picture_.height) - 0.5, 0.0, static_cast<double>(picture_.height - 1));
    double x = (0.5 - column) * static_cast<double>(picture_.width) - 0.5;  // the middle of the picture is azimuth 0
    if (x < 0.0) x += static_cast<double>(picture_.width);
    const auto x0 = static_cast<std::size_t>(x) % picture_.width, x1 = (x0 + 1) % picture_.width;
    const auto y0 = static_cast<std::size_t>(y), y1 = std::min(y0 + 1, picture_.height - 1);
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    Rgb sum;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto value = [&](std::size_t a, std::size_t b) { return static_cast<double>(picture_.pixel(a, b)[k]); };
        sum[k] = (1.0 - fy) * ((1.0 - fx) * value(x0, y0) + fx * value(x1, y0)) + fy * ((1.0 - fx) * value(x0, y1) + fx * value(x1, y1));
    }
    return sum;
}

void Environment::prepare_sampling() {
    row_sum_.assign(kRows + 1, 0.0);
    cell_sum_.assign(kRows * (kColumns + 1), 0.0);
    for (std::size_t r = 0; r < kRows; ++r) {
        const double row = (static_cast<double>(r) + 0.5) / kRows;
        double* cells = &cell_sum_[r * (kColumns + 1)];
        for (std::size_t c = 0; c < kColumns; ++c) {
            const double y = optics::luminance(light(direction_at(row, (static_cast<double>(c) + 0.5) / kColumns)));
            cells[c + 1] = cells[c] + std::max(y, 0.0) + 0.05;  // no direction is left out
        }
        row_sum_[r + 1] = row_sum_[r] + cells[kColumns] * std::sin(pi * row);
    }
}

LightSample Environment::sample(double a, double b) const {
    const auto find = [](const double* sums, std::size_t count, double u, double* rest) {
        const double at = u * sums[count];
        const auto i = static_cast<std::size_t>(std::upper_bound(sums + 1, sums + count, at) - (sums + 1));
        *rest = (at - sums[i]) / (sums[i + 1] - sums[i]);
        return i;
    };
    double in_row = 0.0, in_cell = 0.0;
    const std::size_t r = find(row_sum_.data(), kRows, a, &in_row);
    const double* cells = &cell_sum_[r * (kColumns + 1)];
    const std::size_t c = find(cells, kColumns, b, &in_cell);
    const double row = (static_cast<double>(r) + in_row) / kRows, column = (static_cast<double>(c) + in_cell) / kColumns;
    const double probability = (row_sum_[r + 1] - row_sum_[r]) / row_sum_[kRows] * (cells[c + 1] - cells[c]) / cells[kColumns];
    const double solid_angle = 2.0 * pi * pi / (kRows * kColumns) * std::max(std::sin(pi * row), 1e-9);
    const Vec3 direction = direction_at(row, column);
    return {direction, light(direction), probability / solid_angle};
}

}  // namespace lamella::render
