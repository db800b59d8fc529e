#include "lamella/spatial/bvh.h"

#include <algorithm>
#include <numeric>

namespace lamella::spatial {

BoxTree::BoxTree(std::vector<Bounds> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(boxes_.size()));
}

std::uint32_t BoxTree::build(std::uint32_t begin, std::uint32_t end) {
    constexpr std::uint32_t kLeaf = 4;
    const auto self = static_cast<std::uint32_t>(nodes_.size());
    Bounds bounds = boxes_[order_[begin]];
    for (std::uint32_t i = begin + 1; i < end; ++i) bounds.enclose(boxes_[order_[i]]);
    nodes_.push_back({bounds, begin, end, 0});
    if (end - begin <= kLeaf) return self;
    const Vec3 side = bounds.high - bounds.low;
    const std::size_t axis = side[0] >= side[1] && side[0] >= side[2] ? 0 : side[1] >= side[2] ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto center = [&](std::uint32_t i) { return boxes_[i].low[axis] + boxes_[i].high[axis]; };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return center(a) != center(b) ? center(a) < center(b) : a < b;
                     });
    build(begin, middle);
    const std::uint32_t right = build(middle, end);
    nodes_[self].right = right;
    return self;
}

bool BoxTree::query(const Bounds& query, const std::function<bool(std::size_t)>& found) const {
    if (nodes_.empty()) return true;
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
        const std::uint32_t at = stack.back();
        stack.pop_back();
        const Node& node = nodes_[at];
        if (!node.bounds.meets(query)) continue;
        if (node.right != 0) {
            stack.push_back(node.right);
            stack.push_back(at + 1);
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            if (boxes_[order_[i]].meets(query) && !found(order_[i])) return false;
    }
    return true;
}

}  // namespace lamella::spatial
