#include "lamella/spatial/detail/cluster_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lamella::spatial::detail {

ClusterTree::ClusterTree(const std::vector<Vec3>& points, const ClusterRule& rule)
    : points_(points), rule_(rule), order_(points.size()), keys_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (!points.empty()) build(0, static_cast<std::uint32_t>(points.size()), 0);
}

std::uint32_t ClusterTree::build(std::uint32_t begin, std::uint32_t end, std::size_t depth) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec3 low{{kInfinity, kInfinity, kInfinity}}, high = -low;
    for (std::uint32_t i = begin; i < end; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], points_[order_[i]][k]);
            high[k] = std::max(high[k], points_[order_[i]][k]);
        }
    Cluster cluster;
    cluster.begin = begin;
    cluster.end = end;
    cluster.middle = 0.5 * (low + high);
    cluster.half = 0.5 * (high - low);
    cluster.radius = norm(cluster.half);
    place_proxies(cluster);

    const auto self = static_cast<std::uint32_t>(clusters_.size());
    clusters_.push_back(cluster);
    if (levels_.size() <= depth) levels_.resize(depth + 1);
    levels_[depth].push_back(self);
    if (cluster.count() <= rule_.leaf_size || cluster.radius == 0.0) return self;

    const auto axis = static_cast<std::size_t>(std::max_element(cluster.half.v, cluster.half.v + 3) - cluster.half.v);
    for (std::uint32_t i = begin; i < end; ++i) keys_[i] = {points_[order_[i]][axis], order_[i]};
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(keys_.begin() + begin, keys_.begin() + half, keys_.begin() + end);
    for (std::uint32_t i = begin; i < end; ++i) order_[i] = keys_[i].second;
    const std::uint32_t left = build(begin, half, depth + 1);
    const std::uint32_t right = build(half, end, depth + 1);
    clusters_[self].left = left;
    clusters_[self].right = right;
    return self;
}

/// Chebyshev interpolation on [-a, a] of a function that is analytic up to the distance d from the middle errs by
/// rho^-n, rho = d/a + sqrt((d/a)^2 - 1). For two clusters of equal radius r at the limit of the rule d = (2/opening -
/// 1) r. The points along each axis are chosen for the error that `order` of them have in a cube.
void ClusterTree::place_proxies(Cluster& cluster) {
    const auto digits = [](double z) { return std::log(z + std::sqrt(z * z - 1.0)); };
    const double reach = std::max(2.0 / rule_.opening - 1.0, 1.0);
    const double wanted = static_cast<double>(rule_.order) * digits(reach * std::sqrt(3.0));
    for (std::size_t k = 0; k < 3; ++k) {
        double n = 1.0;
        if (cluster.half[k] > 0.0) n = std::ceil(wanted / digits(reach * cluster.radius / cluster.half[k]) - 1e-9);
        cluster.proxies[k] = static_cast<std::uint8_t>(std::clamp(n, 1.0, static_cast<double>(kMostProxies)));
    }
    cluster.first_proxy = static_cast<std::uint32_t>(proxy_count_);
    proxy_count_ += cluster.proxy_count();
}

}  // namespace lamella::spatial::detail
