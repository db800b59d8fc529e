#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/geometry.h"

#include <span>
#include <vector>

// Derivatives along the film at coarse particles, in difference form: constant fields have exactly none.
// [method sheet 3], chord distances everywhere [method sheet 16.1].

namespace lamella::melp {

/// (grad q)_i = G_i sum_j a_j (q_j - q_i) grad W_ij, tangent to the film; exact for linear fields on a flat film.
/// @param q  per coarse particle  @returns  in the unit of q, per meter
std::vector<Vec3> gradient(const Geometry& geometry, std::span<const Vec3> position, std::span<const double> q);

/// The gradients of the components of a velocity, one row per component. Beyond rims films move as their pictures.
std::vector<Tensor> gradient(const Geometry& geometry, std::span<const Vec3> position, std::span<const Vec3> w);

/// (div w)_i = sum_j a_j (w_j - w_i) . G_i grad W_ij of a full velocity [1/s]. With a part along the normal the film
/// stretches too: a sphere that grows with u has 2 u / R. [method sheet 13, E3]
std::vector<double> divergence(const Geometry& geometry, std::span<const Vec3> position, std::span<const Vec3> w);

/// (lap q)_i = sum_j a_j (q_j - q_i) * 2 |grad W_ij| / d_ij. Symmetric when multiplied with a_i.
std::vector<double> laplacian(const Geometry& geometry, std::span<const double> q);

/// sum_j a_j grad W_ij: zero where particles are evenly spread; at a free edge it points into the film [1/m].
std::vector<Vec3> unevenness(const Geometry& geometry, std::span<const Vec3> position);

/// What a vector field is beyond rims: a velocity, which moving rims add to, or a difference of velocities.
enum class Beyond { kVelocity, kDifference };
/// w minus its average over the kernel: keeps only what varies from particle to particle.
std::vector<Vec3> roughness(const Geometry& geometry, std::span<const Vec3> w, Beyond beyond);

/// Planes for the next fits: unit normals, at sharp folds and in shreds averaged over the kernel, averaged with those of
/// the last fits. In the plane of the fitted normal itself fits swing from face to face of a fold, from one step to the
/// next.
/// @param last  frame normals of the fits that `geometry` comes from
std::vector<Vec3> steady_normals(const Geometry& geometry, std::span<const Vec3> last);

}  // namespace lamella::melp
