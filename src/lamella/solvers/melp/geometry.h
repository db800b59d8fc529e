#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/images.h"
#include "lamella/solvers/melp/neighbors.h"
#include "lamella/solvers/melp/particles.h"
#include "lamella/solvers/melp/tensor.h"
#include "lamella/solvers/melp/voronoi.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lamella::melp {

/// A tangent frame: right-handed, orthonormal.
struct Frame {
    Vec3 e1, e2, normal;
};
/// Some frame of a unit normal; it depends on nothing else.
Frame frame_of(const Vec3& normal);

/// The film around a coarse particle, a quadratic over the tangent plane of its frame:
///
///   z(u, v) = c0 + c1 u + c2 v + c3 u^2 + c4 u v + c5 v^2,   (u, v, z) = (e1, e2, normal) . (x - origin)
struct Patch {
    static constexpr std::size_t kTerms = 6;

    Vec3 origin;  ///< the particle [m]
    Frame frame;
    std::array<double, kTerms> c{};  ///< [m], [-], [1/m]

    double height(double u, double v) const { return c[0] + u * (c[1] + c[3] * u + c[4] * v) + v * (c[2] + c[5] * v); }
    /// How far `x` stands above the patch, along the frame's normal [m].
    double above(const Vec3& x) const {
        const Vec3 d = x - origin;
        return dot(frame.normal, d) - height(dot(frame.e1, d), dot(frame.e2, d));
    }
};

/// What a place counts for in the fit of a patch, coordinates over the kernel's reach, 1 / `per_unit`: they are of size
/// 1 and keep the matrix well scaled.
struct FitPoint {
    double weight;
    std::array<double, Patch::kTerms> term;  ///< 1, u, v, u^2, u v, v^2
    double z;
};
inline FitPoint point_of(const Patch& patch, const Vec3& place, double per_unit) {
    const Vec3 d = per_unit * (place - patch.origin);
    const double u = dot(patch.frame.e1, d), v = dot(patch.frame.e2, d);
    return {std::max(1.0 - squared_norm(d), 0.0), {1.0, u, v, u * u, u * v, v * v}, dot(patch.frame.normal, d)};
}

/// Of the normal equations of a fit, the lower triangle row by row. It starts with the particle itself, at the origin.
using FitMatrix = std::array<double, Patch::kTerms * Patch::kTerms>;
inline FitMatrix empty_fit() { return {1.0}; }
inline void add_to_fit(const FitPoint& point, FitMatrix& matrix) {
    for (std::size_t p = 0; p < Patch::kTerms; ++p) {
        const double weighted = point.weight * point.term[p];
        for (std::size_t q = 0; q <= p; ++q) matrix[p * Patch::kTerms + q] += weighted * point.term[q];
    }
}

/// The first row of the inverse of a fit's matrix: it makes the height of a patch at its origin a sum over places,
/// c0 = sum weight (row . term) z unit.
using FitRow = std::array<double, Patch::kTerms>;

/// The least squares fit of a patch to a particle, its neighbors of the same region and what it sees beyond a rim,
/// weighted with the kernel. Where they are too few for a quadratic (less than six, or on a line) the patch is flat.
/// @param row  of the fit, if asked for; zeros where the patch is flat
Patch fit_patch(std::span<const Vec3> position,
                const Vec3& frame_normal,
                const Neighbors& neighbors,
                const Images& images,
                std::size_t i,
                FitRow* row = nullptr);

/// Normal and curvature of a patch at its origin. A sphere whose normal points outward has curvature -2 / R: this is
/// the K of [method sheet 1], the Laplacian of the height.
struct PatchShape {
    Vec3 normal;
    double curvature = 0.0;  ///< kappa_1 + kappa_2 [1/m]
};
PatchShape shape_of(const Patch& patch);

/// What follows from where the coarse particles are.
struct Geometry {
    NeighborLists neighbors;
    Images images;  ///< what lies beyond rims
    std::vector<Patch> patch;
    std::vector<FitRow> fit_row;  ///< of particles near films of other regions, zeros elsewhere; empty: no such films
    std::vector<Vec3> normal;
    std::vector<double> curvature;     ///< measured, for reports; no force comes from it [1/m]
    std::vector<double> area;          ///< 1 / sum W, the particle itself counted [m^2]
    std::vector<Star> star;            ///< of particles near films of other regions, nothing elsewhere
    std::vector<Tensor> gradient_map;  ///< makes gradients of linear fields exact, and tangent: see gradient()
    std::vector<Tensor> mirrored_map;  ///< the same with what lies beyond rims; empty where there are none

    std::size_t size() const { return normal.size(); }
};

/// Neighbors, patches with normals whose sign follows the frame normals, areas. [method sheet 4, 16.1]
/// @param rims  that hold the films, where they are now
Geometry geometry_of(const CoarseParticles& coarse, double support_radius, std::span<const RimPiece> rims = {});

}  // namespace lamella::melp
