#include "lamella/mesh/detail/face_pairs.h"

#include <functional>

namespace lamella::mesh::detail {
namespace {

constexpr std::size_t kMostWide = 8;
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

/// The width that all but the widest few do not exceed.
double common_width(const std::vector<FacePairs::Item>& items) {
    std::vector<double> widths;
    widths.reserve(items.size());
    for (const auto& item : items) widths.push_back(width(item.box));
    const std::size_t few = std::min(kMostWide, widths.size() - 1);
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
    box_.reserve(items.size());
    for (const Keyed& keyed : order) {
        key_.push_back(keyed.key);
        face_.push_back(items[keyed.item].face);
        box_.push_back(items[keyed.item].box);
    }
}

}  // namespace lamella::mesh::detail
