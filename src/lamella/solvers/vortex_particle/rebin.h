#pragma once

// Particles keep to the films when the tracker edits their triangles.

#include "lamella/mesh/tracker.h"
#include "lamella/solvers/vortex_particle/particles.h"
#include "lamella/solvers/vortex_particle/surface.h"
#include "lamella/solvers/vortex_particle/transfer.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella::vortex_particle {

/// A surface and the films that it lies on.
struct Laid {
    const Surface& surface;
    const mesh::FoamMesh& films;
};

/// What an edit did to the triangles.
struct Relaid {
    std::vector<std::uint32_t> kept;  ///< of each former triangle, which one it is now; kNoTriangle: none
    /// Of each triangle now: it lies where one was that faced the other way. The leaf of a bubble in front of a film is
    /// seen from that side; when the bubble opens it becomes the whole film, which is seen from the other.
    std::vector<std::uint8_t> turned;
    std::vector<std::uint8_t> touched;  ///< of each vertex now: something around it is new
    std::vector<std::uint32_t> region;  ///< of each former triangle, which bubble its leaf closes around now
    static constexpr std::uint32_t kNoTriangle = 0xffffffffU;
};
Relaid relaid(const Laid& before,
              const Laid& now,
              const mesh::CompactionMaps& maps,
              std::span<const mesh::TopologyEvent> events);

/// Puts every particle where it belongs: in its own triangle where that is as it was, else to the nearest point of what
/// is new, if possible on the leaf of its own bubble. Liquid, surfactant and circulation go along as they are. What is
/// left of a film that has burst so comes to lie on the borders of those that stay.
/// @returns  the bins of the particles, sorted
Bins rebin(const Laid& before, const Laid& now, const Relaid& edit, Particles& particles);

/// Where triangles are new, areas of particles become those that the mesh has there: liquid stays, thickness follows.
void fit_areas(const Surface& s,
               const Transfer& transfer,
               const Bins& bins,
               const std::vector<std::uint8_t>& touched,
               Particles& particles);

/// On each component without walls circulation has to sum to zero: what particles of other films have brought is spread
/// evenly over its area, with the opposite sign.
void balance_circulation(const Surface& s, const Bins& bins, Particles& particles);

}  // namespace lamella::vortex_particle
