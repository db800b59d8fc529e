#pragma once

// Films with random values on them, for the tests of the operators.

#include "../../validation/vortex_sheet/sheets.h"

#include "lamella/core/random.h"
#include "lamella/mesh/area.h"
#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/mesh/shapes/wire_films.h"
#include "lamella/solvers/vortex_sheet/operators.h"

#include <string>
#include <vector>

namespace lamella::vortex_sheet {

/// Even in [-1/2, 1/2], another one for each stream and item.
inline double random_number(std::uint64_t stream, std::size_t i) {
    return uniform01(random_bits(11, RandomStream::kMeshJitter, stream, i)) - 0.5;
}
inline Vec3 random_vector(std::uint64_t stream, std::size_t i) {
    return {{random_number(stream, 3 * i), random_number(stream, 3 * i + 1), random_number(stream, 3 * i + 2)}};
}
inline std::vector<double> random_values(std::uint64_t stream, std::size_t count) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = random_number(stream, i);
    return values;
}

/// Every vertex that no wire holds is moved by up to `share` of an edge length.
inline mesh::FoamMesh jittered(mesh::FoamMesh mesh, double edge, double share) {
    for (const mesh::VertexId v : mesh.position.ids())
        if (mesh.on_wire[v] == 0) mesh.position[v] += share * edge * random_vector(1, index(v));
    for (const mesh::RegionId r : mesh.regions.ids())
        if (mesh.regions[r].kind == mesh::RegionKind::kClosed) mesh.regions[r].target_volume = mesh::region_volumes(mesh)[r];
    return mesh;
}

struct NamedMesh {
    std::string name;
    mesh::FoamMesh mesh;
};
/// One of each kind: no junction, a triple line, four points where four regions meet, a film on a wire.
inline std::vector<NamedMesh> films_of_every_kind() {
    return {{"sphere", jittered(mesh::spheres({{Vec3{}, 1.0}}, 0.3), 0.3, 0.3)},
            {"double bubble", jittered(mesh::double_bubble(mesh::double_bubble_of_volumes(1.0, 0.4), 0.2), 0.2, 0.2)},
            {"quadruple bubble", mesh::quadruple_bubble(1.0, 0.25)},
            {"disk", jittered(mesh::disk({}, {{0, 0, 1}}, 1.0, 0.2), 0.2, 0.2)}};
}

}  // namespace lamella::vortex_sheet
