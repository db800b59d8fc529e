#pragma once

// Films as a membrane: the directions in which their vertices move, and what tension does to such motions.

#include "lamella/linalg/definite_solver.h"
#include "lamella/linalg/symmetric_matrix.h"
#include "lamella/mesh/foam_mesh.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella::vortex_particle {

/// One vector for each vertex of the films' mesh.
using Vectors = IdVector<mesh::VertexId, Vec3>;

/// Vertices inside a film move along its normal, those of a triple line any way, those on wires not at all; each such
/// direction is one unknown, a speed. What liquid does along the films is not the membrane's.
class Membrane {
public:
    Membrane(const mesh::FoamMesh& mesh, const Surface& s);

    /// Turns the directions to where the films lie now.
    void aim(const mesh::FoamMesh& mesh);

    std::size_t size() const { return along_.size(); }
    /// Speeds of velocities that an earlier aim gave: a vertex in a film keeps its speed, its normal has turned.
    std::vector<double> speeds(const Vectors& velocity) const;
    Vectors velocities(std::span<const double> speed) const;
    /// Components of forces along the unknowns' directions.
    std::vector<double> components(const Vectors& force) const;
    /// Of values per vertex, one per unknown.
    std::vector<double> values(std::span<const double> at_vertices) const;
    /// The vertex of each unknown.
    std::uint32_t vertex(std::size_t unknown) const { return vertex_[unknown]; }
    const Vec3& along(std::size_t unknown) const { return along_[unknown]; }

    /// How each unknown's inertia grows by what tension takes from it within a step:
    ///
    ///     M' = diag(mass) + dt^2 / 4 S,   S_ab = sum over triangles of tension_t A_t grad phi_i . grad phi_j (a . b)
    ///
    /// @param mass     of vertices [kg]   @param tension  of triangles [N/m]
    void assemble(const Surface& s, std::span<const double> mass, std::span<const double> tension, double dt);
    /// M' as assembled last times x.
    void multiply(std::span<const double> x, std::span<double> y) const { linalg::multiply(matrix_, x, y); }
    double mean_inertia() const;
    /// Keeps the factors of M'; those of another step precondition this one.
    void factorize();
    void solve(std::span<double> x) const { factors_.solve(x); }
    void precondition(std::span<double> x) const { factors_.precondition(x); }

    /// For each vertex the cluster of films that hang together; whether a wire holds it.
    std::span<const std::uint32_t> cluster() const { return cluster_; }
    std::uint32_t clusters() const { return static_cast<std::uint32_t>(held_.size()); }
    bool held(std::uint32_t cluster) const { return held_[cluster] != 0; }

private:
    std::vector<std::size_t> first_;  ///< #V + 1: unknowns of each vertex
    std::vector<std::uint32_t> vertex_;
    std::vector<Vec3> along_;
    std::vector<std::uint32_t> cluster_;
    std::vector<std::uint8_t> held_;
    linalg::SymmetricMatrix matrix_;
    linalg::DefiniteSolver factors_{linalg::Refactored::kOften};
    std::vector<std::size_t> slot_start_;  ///< #T + 1, into the following: pairs of unknowns of each triangle
    struct Pair {
        std::uint8_t k, l;   ///< corners
        std::uint32_t a, b;  ///< unknowns
        std::size_t slot;
    };
    std::vector<Pair> pair_;
};

/// The force of tension on each vertex, minus the gradient of sum tension_t A_t [N].
/// @param tension  of triangles [N/m]
Vectors tension_force(const Surface& s, std::size_t vertices, std::span<const double> tension);

/// How fast the area around each vertex of the surface grows as the films move: of each triangle a third [m^2/s].
std::vector<double> stretch_rate(const Surface& s, const Vectors& velocity);

}  // namespace lamella::vortex_particle
