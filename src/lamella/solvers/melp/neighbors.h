#pragma once

#include "lamella/core/raw_vector.h"
#include "lamella/core/simd.h"
#include "lamella/core/vec.h"
#include "lamella/solvers/melp/kernel.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// For each coarse particle the others within the kernel's reach, by rows, in the order of a search; pairs are in both
/// rows with the same bits. Built once per step, used by every stage.
struct Neighbors {
    std::vector<std::uint32_t> start;  ///< size + 1
    RawVector<std::uint32_t> index;
    RawVector<double> weight;     ///< W of the pair [1/m^2]
    RawVector<double> laplacian;  ///< FilmKernel::laplacian_weight of the pair [1/m^4]
    FilmKernel kernel{};

    std::size_t size() const { return start.empty() ? 0 : start.size() - 1; }
    /// Positions in index, weight and laplacian that belong to particle i.
    std::size_t begin(std::size_t i) const { return start[i]; }
    std::size_t end(std::size_t i) const { return start[i + 1]; }
};

/// sum_k factor_k value_j over the entries of particle i, eight at a time.
template <class Factors>
double sum_of_products(const Neighbors& list, const Factors& factor, std::span<const double> value, std::size_t i) {
    Simd sum{};
    for (std::size_t k = list.begin(i), end = list.end(i); k < end; k += kLanes) {
        const std::size_t count = std::min(end - k, kLanes);
        sum += load_some(&factor[k], count) * gather_some(value.data(), &list.index[k], count);
    }
    return sum_of_lanes(sum);
}

/// Two such sums with the same values.
template <class Factors>
std::array<double, 2> sums_of_products(const Neighbors& list,
                                       const std::array<const Factors*, 2>& factor,
                                       std::span<const double> value,
                                       std::size_t i) {
    Simd first{}, second{};
    for (std::size_t k = list.begin(i), end = list.end(i); k < end; k += kLanes) {
        const std::size_t count = std::min(end - k, kLanes);
        const Simd gathered = gather_some(value.data(), &list.index[k], count);
        first += load_some(&(*factor[0])[k], count) * gathered;
        second += load_some(&(*factor[1])[k], count) * gathered;
    }
    return {sum_of_lanes(first), sum_of_lanes(second)};
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
