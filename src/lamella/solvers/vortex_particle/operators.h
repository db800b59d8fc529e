#pragma once

// Differential operators on a film: potentials and densities at vertices, velocities on triangles.
//
// With J a = n x a, omega = n . curl u = -div(J u), theta = div u:
//
//     grad p |_t  = sum_k p_k grad phi_k
//     D_i         = -sum_t A_t grad phi_i . u_t          about the integral of phi_i theta, walls let nothing through
//     Omega_i     =  sum_t 1/2 u_t . e_i(t)              about the integral of phi_i omega, e_i opposite to i
//     K_ij        =  sum_t w_t A_t grad phi_i . grad phi_j
//
// They fit together to the last bit but rounding: div grad p = -K p everywhere; curl(J grad p) = -K p, div(J grad p) =
// 0 and curl(grad p) = 0 inside; the D_i sum to zero; so do the Omega_i where there are no walls [method sheet 4].

#include "lamella/linalg/symmetric_matrix.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace lamella::vortex_particle {

std::vector<Vec3> gradient(const Surface& s, std::span<const double> p);

/// J grad p: the flow of the stream function p, counterclockwise around its minima.
std::vector<Vec3> rotated_gradient(const Surface& s, std::span<const double> p);

/// D: the flow out of the cell of each vertex, where walls let nothing through.
std::vector<double> divergence(const Surface& s, std::span<const Vec3> u);

/// Omega without the stretches of wall that bound the cells of vertices on a wall.
std::vector<double> curl(const Surface& s, std::span<const Vec3> u);

/// Omega with them: each cell's loop is closed, so that a gradient has none, and along walls no sheet of vorticity
/// appears where there is none [method sheet 5.3]. `u` is taken along each edge by the triangle inside of it.
std::vector<double> closed_curl(const Surface& s, std::span<const Vec3> u);

/// The circulation per time that surfactant drives around the closed cell of each vertex:
///
///     dOmega_i / dt = -(2 R T / rho) sum over the loop of (Gamma_k - Gamma_j) / L(eta_j, eta_k)
///
/// with L the logarithmic mean, so that Gamma = c eta drives nothing; sums to zero without walls. Of the loop around
/// all triangles at i, whose integrand is known along edges, a third is taken: the share of the cell in that area. (The
/// published eq. 14 has a length too much.) [Tao24, eq. 14; method sheet 5.3]
/// @param strength  2 R T / rho [m^2/s^2 per mol/m^3]
std::vector<double> surfactant_torque(const Surface& s,
                                      std::span<const double> surfactant,
                                      std::span<const double> thickness,
                                      double strength);

/// The same along each closed wall, in the direction that has the film on its left.
std::vector<double> wall_torque(const Surface& s,
                                std::span<const double> surfactant,
                                std::span<const double> thickness,
                                double strength);

/// Velocity at vertices: the mean of the triangles around, weighted with area, in the tangent plane; on a wall that
/// lets it slip along that, on one that does not zero.
std::vector<Vec3> vertex_velocity(const Surface& s, std::span<const Vec3> u);

/// Gaussian curvature of each triangle [1/m^2]: the mean of its vertices' angle defects over their areas; 0 at walls.
std::vector<double> gaussian_curvature(const Surface& s);

/// Matrices over unknowns that stand for vertices: those of K, with or without weights, plus a diagonal. An unknown may
/// stand for several vertices, and vertices may have none.
class VertexMatrix {
public:
    /// @param unknown  of each vertex; -1: none, its value is given elsewhere
    VertexMatrix(const Surface& s, std::vector<int> unknown);

    /// matrix = sum of `scale` w_t K_t + diag(mass) + `tie` T. @param weight  one per triangle, or empty for 1
    void assemble(
        const Surface& s, double scale, std::span<const double> weight, std::span<const double> mass, double tie = 0.0);

    const linalg::SymmetricMatrix& matrix() const { return matrix_; }
    std::size_t size() const { return matrix_.size(); }
    std::size_t vertices() const { return unknown_.size(); }
    int unknown(std::size_t v) const { return unknown_[v]; }

    /// Adds up what belongs to one unknown.
    std::vector<double> sums(std::span<const double> at_vertices) const;
    /// Gives each vertex its unknown's value, or 0.
    std::vector<double> spread(std::span<const double> x) const;

private:
    std::vector<int> unknown_;
    linalg::SymmetricMatrix matrix_;
    std::vector<std::array<std::int64_t, 6>> slot_;  ///< per triangle: 00, 11, 22, 12, 20, 01; -1: not there
};

/// y += tie T x, (T x)_i the sum over triangles A_t (x_j + x_k - 2 x_i): by 1/12 of it the integrals of phi_i phi_j
/// differ from the vertices' areas.
void add_ties(const Surface& s, double tie, std::span<const double> x, std::span<double> y);

/// y += scale K_w x.
void add_stiffness(
    const Surface& s, double scale, std::span<const double> weight, std::span<const double> x, std::span<double> y);

}  // namespace lamella::vortex_particle
