#include "lamella/mesh/join.h"

#include "lamella/core/error.h"

namespace lamella::mesh {

void join(FoamMesh& mesh, const FoamMesh& other) {
    if (mesh.periodic() || other.periodic())
        throw InputError("a foam in a periodic box cannot be put together with other films");
    const std::size_t vertices = mesh.position.size(), regions = mesh.regions.size();
    for (const VertexId v : other.position.ids()) mesh.add_vertex(other.position[v], other.on_wire[v] != 0);
    for (const RegionId r : other.regions.ids())
        if (r != kOutside) mesh.regions.push_back(other.regions[r]);
    const auto moved = [&](RegionId r) { return r == kOutside ? r : static_cast<RegionId>(index(r) + regions - 1); };
    for (Face face : other.faces) {
        for (VertexId& v : face.vertices) v = static_cast<VertexId>(index(v) + vertices);
        mesh.faces.push_back({face.vertices, moved(face.back), moved(face.front)});
    }
}

}  // namespace lamella::mesh
