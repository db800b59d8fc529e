#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/tensor.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

namespace lamella::melp {

/// Eulerian particles: few, evenly spread, they carry the shape of the films. Every column has one entry per particle.
///
/// Only what a step starts from; all else that a coarse particle has (area, thickness, curvature, the velocity along
/// the film) follows from these and from the fine particles, see Films.
struct CoarseParticles {
    std::vector<Vec3> position;        ///< [m]
    std::vector<Vec3> frame_normal;    ///< unit normal before the last move: sets the sign of the new one
    std::vector<Vec3> velocity;        ///< of the film [m/s]; its part along the film is that of the fine particles
    std::vector<std::int32_t> region;  ///< whose surface it belongs to: an index of Sheets

    std::size_t size() const { return position.size(); }

    /// The one list of columns: resizing, saving and reordering use it.
    template <class Self, class Visitor>
    static void for_each_column(Self& self, Visitor&& visit) {
        visit("position", self.position);
        visit("frame_normal", self.frame_normal);
        visit("velocity", self.velocity);
        visit("region", self.region);
    }
};

/// Lagrangian particles: many, they are the liquid and move with it.
struct FineParticles {
    std::vector<Vec3> position;         ///< [m]
    std::vector<Vec3> normal;           ///< of the film there
    std::vector<Vec3> velocity;         ///< [m/s]
    std::vector<Tensor> gradient;       ///< of the velocity along the film, one row per component [1/s]
    std::vector<double> liquid_volume;  ///< [m^3]
    std::vector<double> surfactant;     ///< per interface [mol]
    std::vector<double> thickness;      ///< of the film there: what is seen [m]
    std::vector<double> temperature;    ///< [K]
    std::vector<std::int32_t> region;   ///< as of coarse particles

    std::size_t size() const { return position.size(); }

    template <class Self, class Visitor>
    static void for_each_column(Self& self, Visitor&& visit) {
        visit("position", self.position);
        visit("normal", self.normal);
        visit("velocity", self.velocity);
        visit("gradient", self.gradient);
        visit("liquid_volume", self.liquid_volume);
        visit("surfactant", self.surfactant);
        visit("thickness", self.thickness);
        visit("temperature", self.temperature);
        visit("region", self.region);
    }
};

/// A region of films and the gas that they close in, if they do: isothermal, ideal, of one pressure.
struct Gas {
    std::int32_t region = 0;   ///< its number in the scene
    double amount = 0.0;       ///< pressure * volume, constant [J]
    double volume = 0.0;       ///< what the films have swept; follows the particles' own volume slowly [m^3]
    double calibration = 1.0;  ///< true volume at the start / the particles' own volume then
    double balanced = 0.0;     ///< gauge pressure that the films have moved to in the last step: what is reported [Pa]
    bool closed = true;        ///< false: a film on a wire or one that has burst, the same air on both sides
    bool held = false;         ///< by rims: it does not fly
    bool burst = false;        ///< its film has a hole
    bool gone = false;         ///< it has burst at once, or is a part of another bubble now
    double cell = 0.0;         ///< area per coarse particle at the start [m^2]
    double film_radius = 0.0;  ///< of the disk that has the area of a film without gas [m]

    /// Above that of the outside air [Pa].
    double gauge_pressure(double outside) const { return closed ? amount / volume - outside : 0.0; }

    /// Of the bubble, or of half a one on a plate, or of a disk as large as an open film [m].
    double radius() const { return closed ? std::cbrt((held ? 1.5 : 0.75) * volume / std::numbers::pi) : film_radius; }
};

/// Takes away particles that are marked.
template <class Particles>
void remove(Particles& particles, std::span<const std::uint8_t> marked) {
    Particles::for_each_column(particles, [&](const char*, auto& column) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < column.size(); ++i)
            if (marked[i] == 0) column[kept++] = column[i];
        column.resize(kept);
    });
}

}  // namespace lamella::melp
