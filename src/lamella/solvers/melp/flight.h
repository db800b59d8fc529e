#pragma once

#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/particles.h"
#include "lamella/solvers/melp/tensor.h"

#include <cstddef>
#include <span>
#include <vector>

// How films fly as a whole when what is known of them is how they move along their normals.

namespace lamella::melp {

/// The uniform velocity of each region that has the momentum of its motion along the normals: the U for which
///
///   sum m (u . n) n = (sum m n n^T) U
class Flight {
public:
    /// @param mass     per coarse particle, in any unit; it has to outlive this
    /// @param regions  how many there are
    Flight(const Geometry& geometry, const CoarseParticles& coarse, std::span<const double> mass, std::size_t regions);

    /// @param along_normal  u . n per coarse particle [m/s]
    /// @returns             U per region; zero where too few normals are left [m/s]
    std::vector<Vec3> of(std::span<const double> along_normal) const;
    /// The same of one region from its sum m (u . n) n.
    Vec3 of_momentum(std::size_t region, const Vec3& momentum) const { return inverse_[region] * momentum; }

    /// How much a region flies when forces along its normals push it, over what a sphere does: mass / 3 times the
    /// inverse of sum m n n^T, to be multiplied with the sum of the forces. Films without fine particles fly as their
    /// normals say, all of a region alike: between bubbles of different shapes forces that cancel push a pair off.
    std::vector<Tensor> over_sphere() const;

private:
    const Geometry& geometry_;
    const CoarseParticles& coarse_;
    std::span<const double> mass_;
    std::vector<Tensor> inverse_;  // of sum m n n^T; zero where that has none
};

}  // namespace lamella::melp
