#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lamella/core/aligned.h"
#include "lamella/core/simd.h"
#include "lamella/core/vec.h"
#include "lamella/spatial/periodic_box.h"

namespace lamella::spatial {

/// Number of entries that a column of `count` balls needs: whole groups of kLanes, with at least one spare entry
/// at the end. The spare entries are balls of radius 0 that touch nothing; index `count` fills the gaps of lists.
inline std::size_t padded(std::size_t count) { return (count / kLanes + 1) * kLanes; }

/// For each ball the balls that it may touch, both ways, in the order of their ids.
///
/// Balls are taken in groups of kLanes. The lists of one group are as long as the longest of them and interleaved:
/// entry k of lane l stands at index[group_start[g] + k * kLanes + l]; shorter ones are filled with the index of a
/// ball of radius 0. The order by id makes sums over a list independent of how balls are stored.
template <int D>
struct NeighborList {
    std::vector<std::uint64_t> group_start;  ///< padded(count) / kLanes + 1 entries
    AlignedVector<std::uint32_t> index;
    /// In a box so small that two balls can touch through more than one periodic image, the image of each entry:
    /// how many box lengths to subtract from the separation x_i - x_j. Otherwise empty: take the nearest image.
    std::array<Column, D> image;

    /// The first of groups() whose balls may have copies of other processes' balls in their lists.
    std::size_t interior_groups = 0;

    bool by_image = false;  ///< there are images: the same for all processes, also where one has no balls
    bool has_images() const { return by_image; }
    std::size_t groups() const { return group_start.empty() ? 0 : group_start.size() - 1; }
};

template <int D>
struct NeighborSearch {
    std::vector<std::uint32_t> order;  ///< new -> old index: balls that are near in space stand near in memory
    NeighborList<D> list;              ///< in new indices
};

/// Balls of other processes among those searched.
struct Copies {
    std::size_t count = 0;  ///< the last so many balls are copies: they get no lists, but stand in those of others
    double largest_radius = 0.0;  ///< over all processes; where there is but one, it need not be given
};

/// Finds every pair (and image) nearer than R_i + R_j + skin.
///
/// In the lists the copies are balls padded(n), padded(n) + 1, ... with n the number of other balls, in the order
/// given. Balls that have copies in their lists come last in `order`.
///
/// @param position  D columns, `radius`, `id`: at least `count` entries each; ids are distinct
/// Costs about (reach / cell)^D candidates per ball with reach = R_i + R_max + skin.
template <int D>
NeighborSearch<D> find_neighbors(const PeriodicBox<D>& box,
                                 std::array<const double*, D> position,
                                 const double* radius,
                                 const std::int64_t* id,
                                 std::size_t count,
                                 double skin,
                                 const Copies& copies = {});

}  // namespace lamella::spatial
