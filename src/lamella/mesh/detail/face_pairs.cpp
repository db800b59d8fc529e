#include "lamella/mesh/detail/face_pairs.h"

#include "lamella/core/parallel_sort.h"

#include <cmath>
#include <functional>
#include <limits>

namespace lamella::mesh::detail {
namespace {

constexpr double kMostCells = 1 << 20;  // per axis

double width(const Box& box) {
    const Vec3 size = box.high - box.low;
    return std::max({size[0], size[1], size[2]});
}

struct Keyed {
    std::uint64_t key = 0;
    std::uint32_t item = 0;
    friend bool operator<(const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.item < b.item; }
};

constexpr std::uint64_t kWide = ~std::uint64_t{0};
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float rounded_down(double x) { return std::nextafter(static_cast<float>(x), -kInfinity); }
float rounded_up(double x) { return std::nextafter(static_cast<float>(x), kInfinity); }

/// The width that all but the widest few do not exceed: so few that all they meet is less than the rest.
double common_width(const std::vector<FacePairs::Item>& items) {
    std::vector<double> widths;
    widths.reserve(items.size());
    for (const auto& item : items) widths.push_back(width(item.box));
    constexpr double kWidest = 2.0;
    const double few_in_all = kWidest * std::sqrt(static_cast<double>(widths.size()));
    const std::size_t few = std::min(static_cast<std::size_t>(few_in_all), widths.size() - 1);
    const auto place = widths.begin() + static_cast<std::ptrdiff_t>(few);
    std::nth_element(widths.begin(), place, widths.end(), std::greater<>());
    return *place;
}

/// The items by the cells of their centers, those wider than `common` last.
std::vector<Keyed> in_order(const std::vector<FacePairs::Item>& items, const Box& all, double common) {
    // A little wider than the boxes: centers are rounded.
    const double cell = std::max({1.0001 * common, width(all) / kMostCells, 1e-300});
    std::vector<Keyed> order(items.size());
    parallel_for(items.size(), [&](std::size_t i) {
        const Box& box = items[i].box;
        order[i] = {kWide, static_cast<std::uint32_t>(i)};
        if (width(box) > common) return;
        const Vec3 center = (0.5 / cell) * (box.low + box.high - 2.0 * all.low);
        order[i].key = FacePairs::key(center);
    });
    parallel_sort(order);
    return order;
}

}  // namespace

FacePairs::FacePairs(const std::vector<Item>& items) {
    if (items.empty()) return;
    Box all = items[0].box;
    for (const Item& item : items) {
        all.include(item.box.low);
        all.include(item.box.high);
    }
    const double common = common_width(items);
    const std::vector<Keyed> order = in_order(items, all, common);
    const auto first_wide = std::lower_bound(order.begin(), order.end(), Keyed{kWide, 0});
    small_ = static_cast<std::size_t>(first_wide - order.begin());
    key_.resize(items.size());
    face_.resize(items.size());
    for (std::size_t k = 0; k < 3; ++k) {
        low_[k].assign(items.size() + Lanes::size(), kInfinity);
        high_[k].assign(items.size() + Lanes::size(), -kInfinity);
    }
    parallel_for(items.size(), [&](std::size_t i) {
        const Item& item = items[order[i].item];
        key_[i] = order[i].key;
        face_[i] = item.face;
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k][i] = rounded_down(item.box.low[k] - all.low[k]);
            high_[k][i] = rounded_up(item.box.high[k] - all.low[k]);
        }
    });
}

}  // namespace lamella::mesh::detail
