#pragma once

#include "lamella/core/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::spatial::detail {

inline constexpr std::size_t kMostProxies = 16;  ///< along one axis

/// How finely clusters are resolved and how far apart they have to be.
struct ClusterRule {
    std::size_t order;      ///< proxy points along the longest axis of a cluster
    double opening;         ///< two clusters see each other's proxies if the sum of radii < opening * distance
    std::size_t leaf_size;  ///< more points than this are split
};

/// A cluster: points [begin, end) of the tree's order, their tight box, and a grid of Chebyshev points in it that
/// stands for them (its proxies). Thin boxes need fewer points across.
struct Cluster {
    Vec3 middle, half;  ///< of the box
    double radius;      ///< half its diagonal
    std::uint32_t begin, end;
    std::uint32_t left = 0, right = 0;  ///< children; 0, 0: a leaf
    std::uint32_t first_proxy = 0;      ///< of all proxies of the tree
    std::array<std::uint8_t, 3> proxies{};

    bool is_leaf() const { return left == 0; }
    std::size_t count() const { return end - begin; }
    std::size_t proxy_count() const { return std::size_t{proxies[0]} * proxies[1] * proxies[2]; }
};

/// Points halved at the median of the longest side of their box, again and again: the same points give the same tree,
/// and its depth is log2 of their number whatever their places.
class ClusterTree {
public:
    /// @param points  in units of delta
    ClusterTree(const std::vector<Vec3>& points, const ClusterRule& rule);

    const std::vector<Cluster>& clusters() const { return clusters_; }  ///< the root first, parents before children
    const std::vector<std::uint32_t>& order() const { return order_; }  ///< index of the point at each place
    const std::vector<std::vector<std::uint32_t>>& levels() const { return levels_; }  ///< clusters by depth
    std::size_t proxy_count() const { return proxy_count_; }

private:
    std::uint32_t build(std::uint32_t begin, std::uint32_t end, std::size_t depth);
    void place_proxies(Cluster& cluster);

    const std::vector<Vec3>& points_;
    ClusterRule rule_;
    std::vector<std::uint32_t> order_;
    std::vector<std::pair<double, std::uint32_t>> keys_;
    std::vector<Cluster> clusters_;
    std::vector<std::vector<std::uint32_t>> levels_;
    std::size_t proxy_count_ = 0;
};

}  // namespace lamella::spatial::detail
