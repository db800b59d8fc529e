#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::vortex_particle {

inline constexpr std::uint32_t kGone = 0xffffffffU;  ///< the triangle of a particle that has left the film

/// Pieces of the film that move along it; one entry per particle in every column. Liquid and surfactant of a particle
/// are constant, and its area follows the flow: thickness and concentration are what it has over its area, so the film
/// gains and loses neither.
struct Particles {
    std::vector<std::uint32_t> triangle;       ///< ascending after sort_by_triangle
    std::vector<std::array<double, 3>> place;  ///< barycentric coordinates in it
    std::vector<double> circulation;           ///< Omega_p in [Tao24] [m^2/s]
    std::vector<double> volume;                ///< of liquid [m^3]
    std::vector<double> amount;                ///< of surfactant on one interface [mol]
    std::vector<double> area;                  ///< [m^2]
    std::vector<Vec3> velocity;                ///< u_p in [Tao24] [m/s]

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

/// Points of the unit square that fill it more evenly than any others known, however many are taken: steps of 1/g and
/// 1/g^2, g the plastic number, g^3 = g + 1.
class EvenPoints {
public:
    /// @param u, v  the first of them
    EvenPoints(double u, double v) : u_(u), v_(v) {}
    std::array<double, 2> next() {
        constexpr double kStepU = 0.75487766624669276, kStepV = 0.56984029099805327;
        const double u = u_ + kStepU * taken_, v = v_ + kStepV * taken_;
        taken_ += 1.0;
        return {u - std::floor(u), v - std::floor(v)};
    }

private:
    double u_, v_, taken_ = 0.0;
};

/// Where the particles of each triangle are: [start[t], start[t + 1]).
using Bins = std::vector<std::size_t>;

/// Sorts the particles by triangle; those of one triangle keep their order.
Bins sort_by_triangle(Particles& particles, std::size_t triangles);

/// Takes out those that have left the film. @returns the liquid that they had [m^3]
double remove_gone(Particles& particles);

/// Where a triangle has more than `most` particles, those closest to each other become one until it has no more: with
/// the sum of what they have, at their center of mass, which hat functions cannot tell from both, and with their
/// momentum. Of more than 64 the closest of each group of neighbors do.
void merge_crowds(const Surface& s, std::size_t most, Particles& particles, Bins& bins);

/// Each triangle without particles gets one in its middle, half of the largest one of its neighbors: nothing is made
/// and nothing lost. Where the neighbors are empty too it takes another round, of which there are a few.
void fill_empty_triangles(const Surface& s, Particles& particles, Bins& bins);

/// `per_triangle` particles in each triangle, spread evenly by a sequence of low discrepancy with a start of its own in
/// each [Roberts18]; area is the triangle's in equal shares, all else is zero.
Particles spread_particles(const Surface& s, int per_triangle, std::uint64_t seed);

}  // namespace lamella::vortex_particle
