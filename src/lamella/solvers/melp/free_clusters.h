#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/particles.h"
#include "lamella/solvers/melp/rims.h"

#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

// Films as bodies: what may push and twist them as a whole, and what may not.

namespace lamella::melp {

/// A force and its moment over a length.
using Rigid = std::array<double, 6>;

/// Bubbles that touch, free of rims: films push and twist them by nothing as a whole. Forces that have lost their part
/// along the film do, a little. [method sheet 16.4 c'] Half a bubble on a plate is free in some directions.
class FreeCluster {
public:
    /// @param members     coarse particles
    /// @param directions  in which it is free
    /// @param flight      of each region, see Flight::over_sphere(); empty: forces are what counts
    FreeCluster(const CoarseParticles& coarse,
                const Geometry& geometry,
                std::vector<std::size_t> members,
                std::vector<Rigid> directions,
                std::span<const Tensor> flight = {});

    /// Whether it is free in all directions: none of its bubbles sits on a plate.
    bool flies() const { return directions_.size() == std::tuple_size_v<Rigid>; }

    /// Moments count about this point from now on; before, about the members' center.
    void turn_about(const Vec3& point) { center_ = point; }

    /// Takes from values along the normals what pushes and twists: of all changes share_i e_i . z, with e_i the rigid
    /// motions along the normal, the one after which sum_i (values_i n_i + beside_i) has no resultant and no moment.
    void remove_resultant(std::vector<double>& values,
                          std::span<const Vec3> beside,
                          std::span<const double> share) const;

private:
    Rigid rigid(std::size_t i, const Vec3& f) const;

    const CoarseParticles& coarse_;
    const Geometry& geometry_;
    std::vector<std::size_t> members_;
    std::vector<Rigid> directions_;
    std::span<const Tensor> flight_;
    Vec3 center_;
    double length_ = 0.0;
};

/// For each region the smallest one of the cluster that it belongs to by contact.
std::vector<std::size_t> clusters(const Geometry& geometry, std::size_t regions);

/// All that fly, and half bubbles on plates; none that has burst.
/// @param flight  for those that fly, see FreeCluster
std::vector<FreeCluster> free_clusters(const CoarseParticles& coarse,
                                       const Geometry& geometry,
                                       std::span<const Gas> gas,
                                       std::span<const RimPiece> rims,
                                       std::span<const Tensor> flight);

/// The areas that gas pushes on [m^2]: those of kernels, which are right to a ten-thousandth on even layouts; where
/// other bubbles are near, and films fold, those of Voronoi cells. The gas of a closed bubble pushes it nowhere and
/// does not turn it, so that it flies and turns without a change of volume: sums over particles know that to a
/// thousandth, and gas at one atmosphere would move the bubble by what is left. That comes from folds and is taken off
/// there: taken off everywhere it made partitions 6 % flatter than caps and pressures say.
std::vector<double> gas_areas(const CoarseParticles& coarse,
                              const Geometry& geometry,
                              std::span<const Gas> gas,
                              std::span<const RimPiece> rims);

}  // namespace lamella::melp
