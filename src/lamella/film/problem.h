#pragma once

#include "lamella/core/vec.h"
#include "lamella/film/solid.h"
#include "lamella/film/wire.h"
#include "lamella/mesh/foam_mesh.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lamella::film {

/// [material]: a common soap solution in air.
struct Material {
    double surface_tension = 0.025;  ///< of ONE liquid-air interface; a film has two [N/m]
    double air_density = 1.2;        ///< [kg/m^3]
    double thickness = 400e-9;       ///< of the film [m]
    Vec3 gravity{};                  ///< [m/s^2]

    double liquid_density = 1000.0;     ///< of the liquid in the film [kg/m^3]
    double kinematic_viscosity = 1e-6;  ///< of that liquid [m^2/s]
    double surface_viscosity = 0.0;     ///< of each of the two interfaces [kg/s]
    double temperature = 298.15;        ///< [K]
    double surfactant = 0.0;            ///< Gamma_0, per area of ONE interface [mol/m^2]; this, or
    double elasticity = 0.0;            ///< E = R T Gamma_0 [N/m], or
    double elastic_wave_speed = 0.0;    ///< c = sqrt(2 E / (liquid_density thickness)) [m/s]: film/surfactant.h

    double film_tension() const { return 2.0 * surface_tension; }  ///< [N/m]
};

/// What swirls in a film at the start: [[vortex]] of a scene. Its vorticity omega [1/s] is positive counterclockwise
/// seen from the tip of the film's normal; r is the distance from `center`.
struct Vortex {
    enum class Profile {
        kGauss,     ///< omega = circulation / (pi a^2) exp(-(r / a)^2)
        kTaylor,    ///< omega = (speed / a) (2 - (r / a)^2) exp((1 - (r / a)^2) / 2): no net circulation, fastest at a
        kRotation,  ///< a rigid rotation: omega = 2 rate (axis . n)
        kRossbyHaurwitz,  ///< on a sphere around center: omega = -20 circulation z (x^3 - 3 x y^2) / R^6, z along axis
        kHole,            ///< circulation around the hole of the film that is nearest to center
    };
    Profile profile = Profile::kGauss;
    Vec3 center;  ///< [m]
    Vec3 axis{{0.0, 0.0, 1.0}};
    double radius = 0.0;       ///< a [m]
    double circulation = 0.0;  ///< [m^2/s]
    double speed = 0.0;        ///< [m/s]
    double rate = 0.0;         ///< [rad/s]
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
    enum class Kind { kPop, kInflate, kPuncture, kSpot };
    Kind kind = Kind::kPop;
    double time = 0.0;                       ///< [s]
    mesh::RegionId region = mesh::kOutside;  ///< which bubble
    mesh::RegionId into = kLargestNeighbor;  ///< pop: the region it joins
    double volume = 0.0;                     ///< inflate: its new volume [m^3]
    double duration = 0.0;                   ///< inflate: how long it takes, for the solvers that move [s]
    Vec3 center{};                           ///< puncture: the film nearest to it gets a hole; spot: likewise [m]
    double radius = 0.0;  ///< puncture: of the hole; 0: as small as can be resolved; spot: of black film [m]
    double spread = 0.0;  ///< spot: at some film that is drawn within this of center; 0: at the nearest [m]
};

/// A plane that bubbles rest on without wetting it; they stay on the side that the normal points to. [[wall]] of a
/// scene.
struct Wall {
    Vec3 point;           ///< [m]
    Vec3 normal;          ///< unit
    bool bursts = false;  ///< bubbles that touch it burst
};

/// A bubble that enters on the way: one of those of a [[faucet]] of a scene. Its region has no faces at the start.
struct Release {
    double time = 0.0;  ///< or later, once its place is free [s]
    mesh::RegionId region = mesh::kOutside;
    Vec3 center;          ///< [m]
    double radius = 0.0;  ///< [m]
    Vec3 velocity;        ///< [m/s]
};

/// What every film solver starts from, whatever its method: scene tables [material], [[bubble]], [[film]], [[wire]],
/// [foam], [resolution], [[event]], [[vortex]], [[solid]], [[wall]], [[faucet]].
struct Problem {
    Material material;
    mesh::FoamMesh mesh;       ///< the films at the start
    double edge_length = 0.0;  ///< wanted length of an edge [m]
    std::vector<FilmTension> tensions;
    std::vector<Wire> wires;                         ///< those that move
    IdVector<mesh::VertexId, std::int32_t> wire_of;  ///< which of them holds a vertex; -1: none, or it is at rest
    IdVector<mesh::RegionId, Vec3> velocity;         ///< of each bubble at the start [m/s]
    IdVector<mesh::RegionId, double> thickness;      ///< of each bubble's film; 0: the material's [m]
    std::vector<Event> events;                       ///< in order of time
    std::vector<Vortex> vortices;
    std::vector<Solid> solids;
    std::vector<Wall> walls;
    std::vector<Release> releases;  ///< in order of time

    /// Closed regions, those that faucets let in counted.
    std::int64_t bubble_count() const {
        return std::count_if(mesh.regions.begin(), mesh.regions.end(),
                             [](const mesh::Region& r) { return r.kind == mesh::RegionKind::kClosed; });
    }
};

}  // namespace lamella::film
