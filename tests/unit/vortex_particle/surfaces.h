#pragma once

// Films with random values on them, for the tests of the flow.

#include "lamella/core/random.h"
#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/shapes/wire_films.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <string>
#include <vector>

namespace lamella::vortex_particle {

/// Even in [-1/2, 1/2], another one for each stream and item.
inline double random_number(std::uint64_t stream, std::size_t i) {
    return uniform01(random_bits(11, RandomStream::kMeshJitter, stream, i)) - 0.5;
}
inline std::vector<double> random_values(std::uint64_t stream, std::size_t count) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = random_number(stream, i);
    return values;
}

/// Every vertex inside is moved by up to `share` of an edge length.
inline mesh::FoamMesh jittered(mesh::FoamMesh mesh, double edge, double share) {
    for (const mesh::VertexId v : mesh.position.ids())
        if (mesh.on_wire[v] == 0)
            mesh.position[v] += share * edge * Vec3{{random_number(1, 3 * index(v)), random_number(1, 3 * index(v) + 1),
                                                     random_number(1, 3 * index(v) + 2)}};
    return mesh;
}

/// A flat ring between two circles, as a catenoid pressed flat.
inline mesh::FoamMesh flat_ring(double inner, double outer, double edge) {
    mesh::FoamMesh ring = mesh::cylinder({}, {{0, 0, 1}}, outer, outer - inner, edge);
    for (Vec3& x : ring.position) {
        const double radius = inner + (x[2] + 0.5 * (outer - inner));
        const double scale = radius / std::hypot(x[0], x[1]);
        x = {{scale * x[0], scale * x[1], 0.0}};
    }
    return ring;
}

struct NamedSurface {
    std::string name;
    Surface surface;
    bool walls;
};
/// Closed, with one wall, with a hole, with corners, in two parts.
inline std::vector<NamedSurface> surfaces_of_every_kind() {
    return {{"sphere", surface_of(jittered(mesh::spheres({{Vec3{}, 1.0}}, 0.3), 0.3, 0.3)), false},
            {"two spheres", surface_of(mesh::spheres({{Vec3{}, 1.0}, {{{3.0, 0.0, 0.0}}, 0.5}}, 0.3)), false},
            {"disk", surface_of(jittered(mesh::disk({}, {{0, 0, 1}}, 1.0, 0.2), 0.2, 0.3)), true},
            {"rectangle", surface_of(mesh::rectangle({}, {{1, 0, 0}}, {{0, 2, 0}}, 0.2)), true},
            {"catenoid", surface_of(mesh::catenoid({}, {{0, 0, 1}}, 1.0, 0.8, 0.2)), true}};
}

}  // namespace lamella::vortex_particle
