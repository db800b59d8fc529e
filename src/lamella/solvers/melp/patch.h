#pragma once

#include "lamella/core/simd.h"
#include "lamella/core/vec.h"
#include "lamella/solvers/melp/images.h"
#include "lamella/solvers/melp/neighbors.h"

#include <array>
#include <cstddef>
#include <span>

// Films as quadratics around their coarse particles.

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

/// What a place counts for in the fit of a patch, coordinates over the kernel's reach: they are of size 1 and keep the
/// matrix well scaled. Eight places at once where T is lanes.
template <class T>
struct FitPoint {
    T weight;
    std::array<T, Patch::kTerms> term;  ///< 1, u, v, u^2, u v, v^2
    T z;
};
/// @param u, v, z   in the frame of the patch, over the reach
/// @param square    of the distance
template <class T>
FitPoint<T> fit_point(const T& u, const T& v, const T& z, const T& square) {
    return {larger(1.0 - square, T(0.0)), {T(1.0), u, v, u * u, u * v, v * v}, z};
}

/// The first row of the inverse of a fit's matrix: it makes the height of a patch at its origin a sum over places,
/// c0 = sum weight (row . term) z unit.
using FitRow = std::array<double, Patch::kTerms>;

/// The least squares fits of patches to particles, their neighbors of the same region and what they see beyond a rim,
/// weighted with the kernel. Where these are too few for a quadratic (less than six, or on a line) a patch is flat.
/// @param first  of the particles, as many as `patch` has places
/// @param row    of each fit, zeros where the patch is flat; empty: nobody asks
void fit_patches(std::span<const Vec3> position,
                 std::span<const Vec3> frame_normal,
                 const Neighbors& neighbors,
                 const Images& images,
                 std::size_t first,
                 std::span<Patch> patch,
                 std::span<FitRow> row);

/// Normal and curvature of a patch at its origin. A sphere whose normal points outward has curvature -2 / R: this is
/// the K of [method sheet 1], the Laplacian of the height.
struct PatchShape {
    Vec3 normal;
    double curvature = 0.0;  ///< kappa_1 + kappa_2 [1/m]
};
PatchShape shape_of(const Patch& patch);

}  // namespace lamella::melp
