#include "lamella/render/environment.h"

#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"
#include "lamella/core/parallel.h"
#include "lamella/render/detail/lamps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::render {

using detail::smooth_step;
using optics::Rgb;
using std::numbers::pi;

namespace {

constexpr std::size_t kRows = 64, kColumns = 128;           // of the table that directions are drawn from
constexpr std::size_t kMatteRows = 33, kMatteColumns = 64;  // of the table of matte surfaces; rows from pole to pole

/// Hazy sky, brighter near the horizon and around a veiled sun, over gray ground.
Rgb daylight(const Vec3& d) {
    const Vec3 sun{{-0.42, -0.68, 0.60}};
    const double toward = dot(d, sun);
    const Rgb zenith{{0.55, 0.95, 1.75}}, horizon{{1.9, 2.0, 2.1}}, ground{{0.42, 0.40, 0.37}};
    const double height = std::max(d[2], 0.0);
    Rgb sky = horizon + smooth_step(0.0, 0.75, height) * (zenith - horizon);
    sky += (5.0 * std::exp(12.0 * (toward - 1.0)) + 40.0 * smooth_step(0.985, 0.994, toward)) * Rgb{{1.0, 0.95, 0.86}};
    return ground + smooth_step(-0.03, 0.03, d[2]) * (sky - ground);
}

Vec3 direction_at(double row, double column) {  // row from the top, both 0 to 1
    const double polar = pi * row, azimuth = 2.0 * pi * column;
    return {{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)}};
}

std::vector<detail::Lamp> hung(std::initializer_list<detail::LampPlan> plans) { return {plans.begin(), plans.end()}; }

}  // namespace

/// Walls whose light changes from the floor up, and lamps before them.
struct Environment::Room {
    Rgb floor, ceiling;
    std::vector<detail::Lamp> lamps;
    bool sky = false;

    Rgb light(const Vec3& d) const {
        if (sky) return daylight(d);
        const double up = 0.5 + 0.5 * d[2];
        Rgb sum = floor + up * up * (ceiling - floor);
        for (const detail::Lamp& lamp : lamps) sum += lamp.light(d);
        return sum;
    }

    static std::unique_ptr<Room> named(const std::string& name) {
        Room room;
        if (name == "studio") {  // one large soft box above left, a strip on the right, weak ones from behind and below
            room.floor = {{0.13, 0.14, 0.16}};
            room.ceiling = {{0.50, 0.53, 0.58}};
            room.lamps = hung({{-125.0, 36.0, 0.62, 0.78, 0.14, 0.10, {{8.8, 8.6, 8.3}}},
                               {-12.0, 20.0, 0.22, 1.00, 0.10, 0.10, {{6.4, 6.7, 7.3}}},
                               {95.0, 58.0, 0.85, 0.50, 0.20, 0.30, {{5.0, 5.0, 5.0}}},
                               {150.0, -2.0, 0.24, 0.90, 0.12, 0.20, {{3.4, 3.2, 3.0}}},
                               {-70.0, -52.0, 0.80, 0.34, 0.20, 0.40, {{1.7, 1.8, 2.1}}}});
        } else if (name == "window") {
            room.floor = {{0.20, 0.17, 0.14}};
            room.ceiling = {{0.62, 0.58, 0.52}};
            room.lamps = hung({{-118.0, 28.0, 0.50, 0.72, 0.02, 0.03, {{10.5, 11.1, 12.0}}, 2, 3},
                               {25.0, 24.0, 0.36, 0.54, 0.02, 0.04, {{5.2, 5.5, 6.1}}, 2, 3},
                               {120.0, 40.0, 0.90, 0.60, 0.25, 0.50, {{3.0, 2.6, 2.1}}}});
        } else if (name == "daylight") {
            room.sky = true;
        } else if (name == "gray") {
            room.floor = room.ceiling = {{1.0, 1.0, 1.0}};
        } else {
            return nullptr;
        }
        return std::make_unique<Room>(std::move(room));
    }
};

const std::vector<std::string>& Environment::names() {
    static const std::vector<std::string> names{"studio", "window", "daylight", "gray"};
    return names;
}

Environment::~Environment() = default;
Environment::Environment(Environment&&) noexcept = default;
Environment& Environment::operator=(Environment&&) noexcept = default;

Environment::Environment(const std::string& name) : room_(Room::named(name)) {
    if (room_ == nullptr) {
        if (!name.ends_with(".hdr") && !name.ends_with(".exr") && !name.ends_with(".pic")) {
            const auto near = nearest_word(name, names());
            throw InputError(
                fmt::format("there is no environment {}{}; studio, window, daylight, gray, or a file that ends in "
                            ".hdr or .exr",
                            name, near ? fmt::format("; did you mean {}?", *near) : ""));
        }
        picture_ = io::read_light_image(name);
    }
    prepare_sampling();
    prepare_matte();
}

Rgb Environment::light(const Vec3& d) const { return room_ != nullptr ? room_->light(d) : painted(d); }

Rgb Environment::painted(const Vec3& d) const {
    const double row = std::acos(std::clamp(d[2], -1.0, 1.0)) / pi;
    const double column = std::atan2(d[1], d[0]) / (2.0 * pi);
    const double y =
        std::clamp(row * static_cast<double>(picture_.height) - 0.5, 0.0, static_cast<double>(picture_.height - 1));
    double x = (0.5 - column) * static_cast<double>(picture_.width) - 0.5;  // the middle of the picture is azimuth 0
    if (x < 0.0) x += static_cast<double>(picture_.width);
    const auto x0 = static_cast<std::size_t>(x) % picture_.width, x1 = (x0 + 1) % picture_.width;
    const auto y0 = static_cast<std::size_t>(y), y1 = std::min(y0 + 1, picture_.height - 1);
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    Rgb sum;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto value = [&](std::size_t a, std::size_t b) { return static_cast<double>(picture_.pixel(a, b)[k]); };
        sum[k] = (1.0 - fy) * ((1.0 - fx) * value(x0, y0) + fx * value(x1, y0)) +
                 fy * ((1.0 - fx) * value(x0, y1) + fx * value(x1, y1));
    }
    return sum;
}

/// The mean light of one cell of the table: from as many places as show every pixel of a picture.
Rgb Environment::cell_light(std::size_t row, std::size_t column) const {
    const std::size_t n = std::clamp<std::size_t>((picture_.width + kColumns - 1) / kColumns, 2, 64);
    Rgb sum;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) {
            const double y = static_cast<double>(row) + (static_cast<double>(i) + 0.5) / static_cast<double>(n);
            const double x = static_cast<double>(column) + (static_cast<double>(j) + 0.5) / static_cast<double>(n);
            sum += light(direction_at(y / kRows, x / kColumns));
        }
    return sum / static_cast<double>(n * n);
}

void Environment::prepare_sampling() {
    cell_.resize(kRows * kColumns);
    parallel_blocks(cell_.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) cell_[i] = cell_light(i / kColumns, i % kColumns);
    });
    row_sum_.assign(kRows + 1, 0.0);
    cell_sum_.assign(kRows * (kColumns + 1), 0.0);
    for (std::size_t r = 0; r < kRows; ++r) {
        double* cells = &cell_sum_[r * (kColumns + 1)];
        for (std::size_t c = 0; c < kColumns; ++c) {
            const double y = optics::luminance(cell_[r * kColumns + c]);
            cells[c + 1] = cells[c] + std::max(y, 0.0) + 0.05;  // no direction is left out
        }
        row_sum_[r + 1] = row_sum_[r] + cells[kColumns] * std::sin(pi * (static_cast<double>(r) + 0.5) / kRows);
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
    const double row = (static_cast<double>(r) + in_row) / kRows,
                 column = (static_cast<double>(c) + in_cell) / kColumns;
    const Vec3 direction = direction_at(row, column);
    return {direction, light(direction), cell_density(r, c, pi * row)};
}

double Environment::density(const Vec3& d) const {
    const double polar = std::acos(std::clamp(d[2], -1.0, 1.0)), around = std::atan2(d[1], d[0]) / (2.0 * pi);
    const auto r = std::min(static_cast<std::size_t>(polar / pi * kRows), kRows - 1);
    const auto c = std::min(static_cast<std::size_t>((around < 0.0 ? around + 1.0 : around) * kColumns), kColumns - 1);
    return cell_density(r, c, polar);
}

/// By the table's cell and the angle from the z axis.
double Environment::cell_density(std::size_t r, std::size_t c, double polar) const {
    const double* cells = &cell_sum_[r * (kColumns + 1)];
    const double probability =
        (row_sum_[r + 1] - row_sum_[r]) / row_sum_[kRows] * (cells[c + 1] - cells[c]) / cells[kColumns];
    return probability / (2.0 * pi * pi / (kRows * kColumns) * std::max(std::sin(polar), 1e-9));
}

void Environment::prepare_matte() {
    matte_.resize(kMatteRows * kMatteColumns);
    std::vector<Vec3> from;
    std::vector<Rgb> light_there;  // times the solid angle
    for (std::size_t r = 0; r < kRows; ++r)
        for (std::size_t c = 0; c < kColumns; ++c) {
            const double row = (static_cast<double>(r) + 0.5) / kRows;
            from.push_back(direction_at(row, (static_cast<double>(c) + 0.5) / kColumns));
            light_there.push_back(2.0 * pi * pi / (kRows * kColumns) * std::sin(pi * row) * cell_[r * kColumns + c]);
        }
    parallel_blocks(matte_.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 normal = direction_at(static_cast<double>(i / kMatteColumns) / (kMatteRows - 1),
                                             static_cast<double>(i % kMatteColumns) / kMatteColumns);
            Rgb sum;
            for (std::size_t k = 0; k < from.size(); ++k) sum += std::max(0.0, dot(normal, from[k])) * light_there[k];
            matte_[i] = sum / pi;
        }
    });
    for (const Rgb& m : matte_) brightest_matte_ = std::max(brightest_matte_, optics::luminance(m));
}

Rgb Environment::matte(const Vec3& normal) const {
    const double row = std::acos(std::clamp(normal[2], -1.0, 1.0)) / pi * (kMatteRows - 1);
    double column = std::atan2(normal[1], normal[0]) / (2.0 * pi) * kMatteColumns;
    if (column < 0.0) column += kMatteColumns;
    const auto r = std::min(static_cast<std::size_t>(row), kMatteRows - 2),
               c = static_cast<std::size_t>(column) % kMatteColumns;
    const double fr = row - static_cast<double>(r), fc = column - std::floor(column);
    const auto along = [&](std::size_t at) {
        return (1.0 - fc) * matte_[at * kMatteColumns + c] + fc * matte_[at * kMatteColumns + (c + 1) % kMatteColumns];
    };
    return (1.0 - fr) * along(r) + fr * along(r + 1);
}

}  // namespace lamella::render
