#include "lamella/mesh/edge_faces.h"

#include <algorithm>
#include <numeric>

namespace lamella::mesh {
namespace {

struct KeyedUse {
    EdgeKey key;
    EdgeUse use;
};

KeyedUse keyed_use(const FoamMesh& mesh, FaceId f, std::uint32_t opposite) {
    const std::size_t tail = (opposite + 1) % 3;
    const std::size_t head = (opposite + 2) % 3;
    const Face& face = mesh.faces[f];
    const bool forward = face.vertices[tail] < face.vertices[head];
    const std::size_t a = forward ? tail : head;
    const std::size_t b = forward ? head : tail;
    KeyedUse keyed{{face.vertices[a], face.vertices[b]}, {f, opposite, forward}};
    if (mesh.periodic())
        for (std::size_t axis = 0; axis < 3; ++axis)
            keyed.key.shift[axis] = static_cast<std::int16_t>(mesh.images[f][b][axis] - mesh.images[f][a][axis]);
    return keyed;
}

/// All uses, ordered by edge, then face: sorted into one row per lower vertex first, as a global sort is slower.
std::vector<KeyedUse> sorted_uses(const FoamMesh& mesh) {
    std::vector<KeyedUse> unsorted;
    unsorted.reserve(3 * mesh.faces.size());
    std::vector<std::size_t> row(mesh.position.size() + 1, 0);
    for (const FaceId f : mesh.faces.ids())
        for (std::uint32_t k = 0; k < 3; ++k) {
            unsorted.push_back(keyed_use(mesh, f, k));
            ++row[index(unsorted.back().key.a) + 1];
        }
    std::partial_sum(row.begin(), row.end(), row.begin());

    std::vector<KeyedUse> sorted(unsorted.size());
    std::vector<std::size_t> next = row;
    for (const KeyedUse& keyed : unsorted) sorted[next[index(keyed.key.a)]++] = keyed;
    for (std::size_t v = 0; v + 1 < row.size(); ++v)
        std::stable_sort(sorted.data() + row[v], sorted.data() + row[v + 1],
                         [](const KeyedUse& p, const KeyedUse& q) { return p.key < q.key; });
    return sorted;
}

}  // namespace

EdgeFaces edge_faces(const FoamMesh& mesh) {
    EdgeFaces edges;
    const std::vector<KeyedUse> uses = sorted_uses(mesh);
    edges.use.reserve(uses.size());
    for (std::size_t i = 0; i < uses.size(); ++i) {
        if (i == 0 || uses[i].key != uses[i - 1].key) {
            edges.edge.push_back(uses[i].key);
            edges.start.push_back(i);
        }
        edges.use.push_back(uses[i].use);
    }
    edges.start.push_back(uses.size());
    return edges;
}

}  // namespace lamella::mesh
