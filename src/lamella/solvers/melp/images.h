#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/neighbors.h"
#include "lamella/solvers/melp/rims.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// What coarse particles near a rim see beyond it: pictures of themselves and of their neighbors. Rows as of Neighbors;
/// weights are symmetric, w of (i, picture of j) = w of (j, picture of i), by the mean of the two squared distances:
/// for straight wires and plates these are equal. Behind balls and sticks they are narrowed as the pictures are.
struct Images {
    std::vector<std::uint32_t> start;  ///< size + 1, or empty where no film has a rim
    std::vector<std::uint32_t> index;  ///< whose picture
    std::vector<double> weight;        ///< as in Neighbors
    std::vector<double> laplacian;
    std::vector<Vec3> place;  ///< of the picture [m]
    std::vector<Vec3> normal;
    std::vector<std::uint32_t> mirror;  ///< place in `mirrors`
    /// How far the picture moves, over how far its particle does along a ball or stick; 1 behind wires and plates. Of
    /// both pictures of a pair together, the geometric mean.
    std::vector<double> follow;
    std::vector<Mirror> mirrors;
    std::vector<std::uint32_t> source;  ///< per mirror: the particle that it makes a picture of

    std::size_t begin(std::size_t i) const { return start.empty() ? 0 : start[i]; }
    std::size_t end(std::size_t i) const { return start.empty() ? 0 : start[i + 1]; }
    bool empty() const { return index.empty(); }
};

Images find_images(std::span<const RimPiece> pieces,
                   std::span<const Vec3> position,
                   std::span<const Vec3> normal,
                   std::span<const std::int32_t> region,
                   double support_radius);

}  // namespace lamella::melp
