#include "lamella/measure/local_gas_fraction.h"

#include "lamella/core/error.h"
#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/dist/agree.h"
#include "lamella/dist/sum.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace lamella::measure {
namespace {

/// Integral of sqrt(r^2 - t^2) for t from 0 to x, |x| <= r.
double half_disc_integral(double x, double r) {
    const double t = std::clamp(x, -r, r);
    return 0.5 * (t * std::sqrt(std::max(0.0, r * r - t * t)) + r * r * std::asin(t / r));
}

/// Area of the disc of radius r around the origin where X <= x and Y <= y.
///
/// At X the disc reaches Y = +-s(X), s = sqrt(r^2 - X^2); the height below y is 2s where s <= y, y + s where s > |y|,
/// and 0 where s <= -y. s crosses |y| at X = +-a.
double quarter_area(double x, double y, double r) {
    if (x <= -r || y <= -r) return 0.0;
    const double right = std::min(x, r);
    const auto full = [&](double from, double to) {
        return to > from ? 2.0 * (half_disc_integral(to, r) - half_disc_integral(from, r)) : 0.0;
    };
    if (y >= r) return full(-r, right);
    const double a = std::sqrt(std::max(0.0, r * r - y * y));
    double area = 0.0;
    if (y > 0.0) area += full(-r, std::min(right, -a)) + full(a, right);
    const double from = -a;
    const double to = std::min(right, a);
    if (to > from) area += y * (to - from) + half_disc_integral(to, r) - half_disc_integral(from, r);
    return area;
}

struct Interval {
    double low, high;
};

/// Area of the disc of radius r around the origin inside the rectangle x times y.
double disc_in_rectangle(Interval x, Interval y, double r) {
    return quarter_area(x.high, y.high, r) - quarter_area(x.low, y.high, r) - quarter_area(x.high, y.low, r) +
           quarter_area(x.low, y.low, r);
}

/// Volume of the ball of radius r around the origin inside the cuboid: discs stacked along z, Gauss-Legendre.
double ball_in_cuboid(Interval x, Interval y, Interval z, double r) {
    static constexpr std::array<double, 4> kNode{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                                 0.9602898564975363};
    static constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                                   0.1012285362903763};
    const double low = std::max(z.low, -r);
    const double high = std::min(z.high, r);
    if (high <= low) return 0.0;
    const double middle = 0.5 * (low + high);
    const double half = 0.5 * (high - low);
    double volume = 0.0;
    for (std::size_t k = 0; k < kNode.size(); ++k)
        for (const double sign : {-1.0, 1.0}) {
            const double height = middle + sign * half * kNode[k];
            const double disc = std::sqrt(std::max(0.0, r * r - height * height));
            if (disc > 0.0) volume += half * kWeight[k] * disc_in_rectangle(x, y, disc);
        }
    return volume;
}

/// One axis of the grid.
struct Axis {
    double origin, length;
    bool periodic;
    int cells;

    double width() const { return length / cells; }
    /// The cells that [low, high] touches, not wrapped; at walls never beyond the first and last.
    std::pair<int, int> range(double low, double high) const {
        int first = static_cast<int>(std::floor((low - origin) / width()));
        int last = static_cast<int>(std::floor((high - origin) / width()));
        if (!periodic) {
            first = std::clamp(first, 0, cells - 1);
            last = std::clamp(last, 0, cells - 1);
        }
        return {first, last};
    }
    /// What cell `k` covers, relative to `center`; the cells at walls reach out to infinity.
    Interval interval(int k, double center) const {
        constexpr double kInfinity = std::numeric_limits<double>::infinity();
        Interval cell{origin + width() * k - center, origin + width() * (k + 1) - center};
        if (!periodic && k == 0) cell.low = -kInfinity;
        if (!periodic && k == cells - 1) cell.high = kInfinity;
        return cell;
    }
    std::size_t wrapped(int k) const { return static_cast<std::size_t>(((k % cells) + cells) % cells); }
};

using Grid = std::vector<FixedSum>;  ///< volume in each cell

void add_disc(const std::array<Axis, 3>& axes, const Vec3& center, double r, Grid& volume) {
    const auto [x0, x1] = axes[0].range(center[0] - r, center[0] + r);
    const auto [y0, y1] = axes[1].range(center[1] - r, center[1] + r);
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
            volume[axes[1].wrapped(y) * static_cast<std::size_t>(axes[0].cells) + axes[0].wrapped(x)].add(
                disc_in_rectangle(axes[0].interval(x, center[0]), axes[1].interval(y, center[1]), r));
}

void add_ball(const std::array<Axis, 3>& axes, const Vec3& center, double r, Grid& volume) {
    struct Share {
        std::size_t cell;
        double volume;
    };
    std::vector<Share> shares;
    const auto [x0, x1] = axes[0].range(center[0] - r, center[0] + r);
    const auto [y0, y1] = axes[1].range(center[1] - r, center[1] + r);
    const auto [z0, z1] = axes[2].range(center[2] - r, center[2] + r);
    const auto cells = static_cast<std::size_t>(axes[0].cells);
    double total = 0.0;
    for (int z = z0; z <= z1; ++z)
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const double part = ball_in_cuboid(axes[0].interval(x, center[0]), axes[1].interval(y, center[1]),
                                                   axes[2].interval(z, center[2]), r);
                shares.push_back(
                    {(axes[2].wrapped(z) * cells + axes[1].wrapped(y)) * cells + axes[0].wrapped(x), part});
                total += part;
            }
    const double scale = ball_volume(r, 3) / total;
    for (const Share& share : shares) volume[share.cell].add(scale * share.volume);
}

void check(const sim::Points& balls, const sim::Box& box, int cells) {
    if (cells < 1) throw InputError("a grid needs at least one cell");
    if (balls.radius.size() != balls.size()) throw InputError("local gas fraction needs a radius for every point");
    const auto axes = static_cast<std::size_t>(box.dimension);
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < axes; ++k) shortest = std::min(shortest, box.lengths[k]);
    if (!(shortest > 0.0) || !std::isfinite(1e20 * box_volume(box))) throw InputError("the box has no volume");
    // A ball may reach half a box beyond every side: more would make the cells it touches a matter of memory.
    for (std::size_t i = 0; i < balls.size(); ++i) {
        bool good = balls.radius[i] > 0.0 && balls.radius[i] <= shortest;
        for (std::size_t k = 0; k < axes; ++k) {
            const double from_origin = balls.position[i][k] - box.origin[k];
            good = good && from_origin >= -box.lengths[k] && from_origin <= 2.0 * box.lengths[k];
        }
        if (!good) throw InputError(fmt::format("ball {} is not inside the box, or larger than it", i));
    }
}

}  // namespace

double ball_volume(double radius, int dimension) {
    return dimension == 2 ? std::numbers::pi * radius * radius
                          : 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

double box_volume(const sim::Box& box) {
    return box.lengths[0] * box.lengths[1] * (box.dimension == 2 ? 1.0 : box.lengths[2]);
}

std::vector<double> local_gas_fraction(const sim::Points& balls, const sim::Box& box, int cells) {
    dist::Alone alone;
    return local_gas_fraction(balls, box, cells, alone);
}

std::vector<double> local_gas_fraction(const sim::Points& share,
                                       const sim::Box& box,
                                       int cells,
                                       dist::Communicator& processes) {
    dist::together(processes, [&] { check(share, box, cells); });
    std::array<Axis, 3> axes{};
    for (std::size_t k = 0; k < 3; ++k) axes[k] = {box.origin[k], box.lengths[k], box.periodic[k], cells};
    const auto per_axis = static_cast<std::size_t>(cells);
    const std::size_t size = box.dimension == 2 ? per_axis * per_axis : per_axis * per_axis * per_axis;

    // No cell holds more than all balls do; the sum is of integers, so that neither threads nor processes show.
    const double all = dist::exact_sum(processes, share.size(), kMostTerms,
                                       [&](std::size_t i) { return ball_volume(share.radius[i], box.dimension); });
    const Grid empty(size, FixedSum(all));
    const std::size_t few_blocks = std::max(kParallelBlock, share.size() / 64 + 1);
    Grid grid = parallel_reduce(
        share.size(), empty,
        [&](std::size_t begin, std::size_t end) {
            Grid part = empty;
            for (std::size_t i = begin; i < end; ++i) {
                if (box.dimension == 2)
                    add_disc(axes, share.position[i], share.radius[i], part);
                else
                    add_ball(axes, share.position[i], share.radius[i], part);
            }
            return part;
        },
        [](Grid sum, const Grid& part) {
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += part[k];
            return sum;
        },
        few_blocks);
    dist::sum(processes, grid);
    const double cell_volume = box_volume(box) / static_cast<double>(size);
    std::vector<double> fraction(size);
    for (std::size_t k = 0; k < size; ++k) fraction[k] = grid[k].value() / cell_volume;
    return fraction;
}

}  // namespace lamella::measure
