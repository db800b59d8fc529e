#pragma once

#include <cstdint>
#include <vector>

#include "lamella/core/vec.h"
#include "lamella/film/wire.h"
#include "lamella/mesh/foam_mesh.h"

namespace lamella::film {

/// [material]: a common soap solution in air.
struct Material {
    double surface_tension = 0.025;  ///< of ONE liquid-air interface; a film has two [N/m]
    double air_density = 1.2;        ///< [kg/m^3]
    double thickness = 400e-9;       ///< of the film [m]
    Vec3 gravity{};                  ///< [m/s^2]

    double film_tension() const { return 2.0 * surface_tension; }  ///< [N/m]
};

/// How tense the films between two regions are, relative to the material's film: [[tension]] of a scene.
struct FilmTension {
    mesh::RegionId a, b;
    double factor = 1.0;
};

/// The region that shares most film with the one in question.
inline constexpr mesh::RegionId kLargestNeighbor{0xffffffffU};
/// A bubble drawn at random among those that touch the outside then.
inline constexpr mesh::RegionId kRandomBubble{0xfffffffeU};

/// A change of the regions at a time: [[event]] of a scene.
struct Event {
    enum class Kind { kPop, kInflate };
    Kind kind = Kind::kPop;
    double time = 0.0;                          ///< [s]
    mesh::RegionId region = mesh::kOutside;     ///< which bubble
    mesh::RegionId into = kLargestNeighbor;     ///< pop: the region it joins
    double volume = 0.0;                        ///< inflate: its new volume [m^3]
    double duration = 0.0;                      ///< inflate: how long it takes, for the solvers that move [s]
};

/// What every film solver starts from, whatever its method: scene tables [material], [[bubble]], [[film]], [[wire]],
/// [foam], [resolution], [[event]].
struct Problem {
    Material material;
    mesh::FoamMesh mesh;        ///< the films at the start
    double edge_length = 0.0;   ///< wanted length of an edge [m]
    std::vector<FilmTension> tensions;
    std::vector<Wire> wires;                               ///< those that move
    IdVector<mesh::VertexId, std::int32_t> wire_of;        ///< which of them holds a vertex; -1: none, or it is at rest
    IdVector<mesh::RegionId, Vec3> velocity;               ///< of each bubble at the start [m/s]
    std::vector<Event> events;  ///< in order of time
};

}  // namespace lamella::film
