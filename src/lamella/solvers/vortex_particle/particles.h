#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::vortex_particle {

/// Pieces of the film that move along it; one entry per particle in every column. Liquid and surfactant of a particle
/// are constant, and its area follows the flow: thickness and concentration are what it has over its area, so the film
/// gains and loses neither.
struct Particles {
    std::vector<std::uint32_t> triangle;          ///< ascending after sort_by_triangle
    std::vector<std::array<double, 3>> place;     ///< barycentric coordinates in it
    std::vector<double> circulation;              ///< Omega_p in [Tao24] [m^2/s]
    std::vector<double> volume;                   ///< of liquid [m^3]
    std::vector<double> amount;                   ///< of surfactant on one interface [mol]
    std::vector<double> area;                     ///< [m^2]
    std::vector<Vec3> velocity;                   ///< u_p in [Tao24] [m/s]

    std::size_t size() const { return triangle.size(); }

    /// The one list of columns: sorting, saving and growing use it.
    template <class Self, class Visitor>
    static void for_each_column(Self& self, Visitor&& visit) {
        visit("triangle", self.triangle);
        visit("place", self.place);
        visit("circulation", self.circulation);
        visit("volume", self.volume);
        visit("amount", self.amount);
        visit("area", self.area);
        visit("velocity", self.velocity);
    }
};

/// Where the particles of each triangle are: [start[t], start[t + 1]).
using Bins = std::vector<std::size_t>;

/// Sorts the particles by triangle; those of one triangle keep their order.
Bins sort_by_triangle(Particles& particles, std::size_t triangles);

/// Each triangle without particles gets one in its middle, half of the largest one of its neighbors: nothing is made and
/// nothing lost. Where the neighbors are empty too it takes another round, of which there are a few.
void fill_empty_triangles(const Surface& s, Particles& particles, Bins& bins);

/// `per_triangle` particles in each triangle, spread evenly by a sequence of low discrepancy with a start of its own in
/// each [Roberts18]; area is the triangle's in equal shares, all else is zero.
Particles spread_particles(const Surface& s, int per_triangle, std::uint64_t seed);

}  // namespace lamella::vortex_particle
