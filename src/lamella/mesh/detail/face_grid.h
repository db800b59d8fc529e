#pragma once

#include "lamella/core/id_vector.h"
#include "lamella/core/small_vector.h"
#include "lamella/core/vec.h"
#include "lamella/mesh/foam_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lamella::mesh::detail {

struct Box {
    Vec3 low, high;

    bool overlaps(const Box& b) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (low[k] > b.high[k] || b.low[k] > high[k]) return false;
        return true;
    }
    void include(const Vec3& p) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    Box inflated(double by) const {
        const Vec3 margin{{by, by, by}};
        return {low - margin, high + margin};
    }
};

/// Which faces are near a place, while faces come, go and move: a hashed grid of cubic cells; a face stands in every
/// cell that its box touches.
class FaceGrid {
public:
    /// @param cell  side of a cell [m], about the size of a face
    /// @param faces how many faces to expect
    FaceGrid(double cell, std::size_t faces);

    /// Takes all faces out and prepares for about so many.
    void clear(std::size_t faces);
    void insert(FaceId face, const Box& box);
    void erase(FaceId face);
    bool holds(FaceId face) const { return index(face) < boxes_.size() && present_[face] != 0; }
    const Box& box(FaceId face) const { return boxes_[face]; }

    /// Calls found(face) once for every face whose box overlaps `box`, in no particular order.
    template <class Found>
    void query(const Box& box, Found&& found) const {
        const Range r = range(box);
        for (std::int32_t z = r.low[2]; z <= r.high[2]; ++z)
            for (std::int32_t y = r.low[1]; y <= r.high[1]; ++y)
                for (std::int32_t x = r.low[0]; x <= r.high[0]; ++x)
                    for (const FaceId face : buckets_[bucket(x, y, z)]) {
                        const Box& other = boxes_[face];
                        if (!box.overlaps(other)) continue;
                        // In the first cell that both boxes share, and in no other.
                        if (std::max(r.low[0], cell_of(other.low[0])) == x &&
                            std::max(r.low[1], cell_of(other.low[1])) == y &&
                            std::max(r.low[2], cell_of(other.low[2])) == z)
                            found(face);
                    }
    }

private:
    struct Range {
        std::array<std::int32_t, 3> low, high;
    };

    std::int32_t cell_of(double x) const { return static_cast<std::int32_t>(std::floor(x * inverse_cell_)); }
    Range range(const Box& box) const {
        return {{cell_of(box.low[0]), cell_of(box.low[1]), cell_of(box.low[2])},
                {cell_of(box.high[0]), cell_of(box.high[1]), cell_of(box.high[2])}};
    }
    std::size_t bucket(std::int32_t x, std::int32_t y, std::int32_t z) const {
        const auto mix = [](std::int32_t i, std::uint64_t factor) {
            return static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) * factor;
        };
        const std::uint64_t h =
            mix(x, 0x9e3779b97f4a7c15ULL) ^ mix(y, 0xc2b2ae3d27d4eb4fULL) ^ mix(z, 0x165667b19e3779f9ULL);
        return (h ^ (h >> 29)) & mask_;
    }
    template <class Visit>
    void for_each_bucket(const Box& box, Visit&& visit);

    double inverse_cell_;
    std::size_t mask_ = 0;
    std::vector<SmallVector<FaceId, 7>> buckets_;
    IdVector<FaceId, Box> boxes_;
    IdVector<FaceId, std::uint8_t> present_;
};

}  // namespace lamella::mesh::detail
