#include "lamella/mesh/detail/face_pairs.h"

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
    std::uint64_t key;
    std::uint32_t item;
    friend bool operator<(const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.item < b.item; }
};

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

}  // namespace

FacePairs::FacePairs(const std::vector<Item>& items) {
    if (items.empty()) return;
    Box all = items[0].box;
    for (const Item& item : items) {
        all.include(item.box.low);
        all.include(item.box.high);
    }
    const double common = common_width(items);
    // A little wider than the boxes: centers are rounded.
    const double cell = std::max({1.0001 * common, width(all) / kMostCells, 1e-300});
    std::vector<Keyed> order;
    order.reserve(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        std::uint64_t key = ~std::uint64_t{0};
        if (width(items[i].box) <= common) {
            const Vec3 center = (0.5 / cell) * (items[i].box.low + items[i].box.high - 2.0 * all.low);
            key = 0;
            for (std::size_t k = 3; k-- > 0;) key = (key << kBits) + static_cast<std::uint64_t>(center[k]) + 1;
            ++small_;
        }
        order.push_back({key, static_cast<std::uint32_t>(i)});
    }
    std::sort(order.begin(), order.end());
    key_.reserve(items.size());
    face_.reserve(items.size());
    for (const Keyed& keyed : order) {
        key_.push_back(keyed.key);
        face_.push_back(items[keyed.item].face);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        low_[k].assign(items.size() + Lanes::size(), kInfinity);
        high_[k].assign(items.size() + Lanes::size(), -kInfinity);
        for (std::size_t i = 0; i < order.size(); ++i) {
            const Box& box = items[order[i].item].box;
            low_[k][i] = rounded_down(box.low[k] - all.low[k]);
            high_[k][i] = rounded_up(box.high[k] - all.low[k]);
        }
    }
}

}  // namespace lamella::mesh::detail
