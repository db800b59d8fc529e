#pragma once

// Between particles and the mesh, both ways with the same weights w_ip, which sum to one over the vertices i of each
// particle p: what is put on the mesh is neither more nor less than what the particles have.

#include "lamella/solvers/vortex_particle/particles.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::vortex_particle {

/// How far a particle reaches.
enum class Reach {
    kHat,     ///< to the corners of its triangle: barycentric weights
    kKernel,  ///< to all vertices within a radius: (1 - d^2 / r^2)^3, as published [Tao24, eq. 9]
};

/// What the particles put on the vertices.
struct Deposit {
    std::vector<double> circulation;  ///< Omega_i = sum_p w_ip Omega_p [m^2/s]
    std::vector<double> volume;       ///< of liquid [m^3]
    std::vector<double> amount;       ///< of surfactant on one interface [mol]
    std::vector<double> area;         ///< that the particles say they have [m^2]
};

class Transfer {
public:
    /// @param radius  of the kernel [m]; none for kHat
    Transfer(const Surface& s, Reach reach, double radius);

    /// Sums over the particles of each vertex.
    Deposit deposit(const Surface& s, const Particles& particles, const Bins& bins) const;

    /// One sum alone: sum_p w_ip value_p.
    std::vector<double> deposit(const Surface& s, const Particles& particles, const Bins& bins,
                                std::span<const double> value) const;

    /// Values of vertices at the particles, sum_i w_ip value_i.
    std::vector<double> gather(const Surface& s, const Particles& particles, std::span<const double> value) const;

private:
    /// calls use(i, weight) for each vertex of a particle; the weights sum to one
    template <class Use>
    void each_vertex(const Surface& s, const Particles& particles, std::size_t p, Use&& use) const;
    template <std::size_t Columns>
    void sum_to_vertices(const Surface& s, const Particles& particles, const Bins& bins,
                         const std::array<std::span<const double>, Columns>& value,
                         const std::array<std::span<double>, Columns>& sum) const;

    Reach reach_;
    double radius_;
    // The kernel's lists, once per mesh: which triangles may hold particles that reach a vertex, and the reverse.
    std::vector<std::size_t> triangle_start_, vertex_start_;
    std::vector<std::uint32_t> triangle_, vertex_;
};

/// The mean velocity of the particles of each triangle, weighted with their areas; where there are none, `before`.
std::vector<Vec3> triangle_velocity(const Surface& s, const Particles& particles, const Bins& bins,
                                    std::span<const Vec3> before);

}  // namespace lamella::vortex_particle
