#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/kernel.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// For each coarse particle the others within the kernel's reach, by rows, in the order of a search; pairs are in both
/// rows with the same bits. Built once per step, used by every stage.
struct Neighbors {
    std::vector<std::uint32_t> start;  ///< size + 1
    std::vector<std::uint32_t> index;
    std::vector<double> weight;     ///< W of the pair [1/m^2]
    std::vector<double> laplacian;  ///< FilmKernel::laplacian_weight of the pair [1/m^4]
    FilmKernel kernel{};

    std::size_t size() const { return start.empty() ? 0 : start.size() - 1; }
    /// Positions in index, weight and laplacian that belong to particle i.
    std::size_t begin(std::size_t i) const { return start[i]; }
    std::size_t end(std::size_t i) const { return start[i + 1]; }
};

/// sum_k factor_k value_j over the entries of particle i, in four sums: a single one would wait for each addition.
template <class Factor>
double sum_of_products(const Neighbors& list,
                       const std::vector<Factor>& factor,
                       std::span<const double> value,
                       std::size_t i) {
    constexpr std::size_t kSums = 4;
    std::array<double, kSums> sum{};
    std::size_t k = list.begin(i);
    const std::size_t end = list.end(i);
    for (; k + kSums <= end; k += kSums)
        for (std::size_t s = 0; s < kSums; ++s) sum[s] += double{factor[k + s]} * value[list.index[k + s]];
    for (; k < end; ++k) sum[0] += double{factor[k]} * value[list.index[k]];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// Two regions, the smaller one first.
using RegionPair = std::array<std::int32_t, 2>;

/// Pairs of one region whose normals agree (n_i . n_j > 0.2): the two sides of a film that is nearly pinched do not see
/// each other. Pairs of two regions, whatever their normals, stand in `other`.
struct NeighborLists {
    Neighbors same;                      ///< of one region
    Neighbors other;                     ///< of two regions
    std::vector<RegionPair> touching{};  ///< every two regions that have a pair in `other`, ascending
};
NeighborLists find_neighbors(std::span<const Vec3> position,
                             std::span<const Vec3> normal,
                             std::span<const std::int32_t> region,
                             double support_radius);

}  // namespace lamella::melp
