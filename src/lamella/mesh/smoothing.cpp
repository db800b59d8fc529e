#include "lamella/mesh/smoothing.h"

#include "lamella/mesh/detail/face_shape.h"

#include <algorithm>
#include <array>
#include <vector>

namespace lamella::mesh {
namespace {

/// What the faces around a vertex add up to.
struct Surroundings {
    Vec3 normal, centroid;  // weighted by twice the area
    double weight = 0.0;
    RegionId back{}, front{};
    bool film = true;  // all faces lie between the same two regions
    bool seen = false;

    void add(const Face& face, const Vec3& middle, const Vec3& area_vector) {
        if (!seen) {
            back = face.back;
            front = face.front;
            seen = true;
        }
        const bool alike = face.back == back && face.front == front;
        film = film && (alike || (face.back == front && face.front == back));
        const double face_weight = norm(area_vector);
        normal += (alike ? 1.0 : -1.0) * area_vector;
        centroid += face_weight * middle;
        weight += face_weight;
    }
    /// Towards the centroid, in the film's plane.
    Vec3 pull(const Vec3& at) const {
        const double squared = squared_norm(normal);
        if (squared == 0.0) return {};
        const Vec3 towards = (1.0 / weight) * centroid - at;
        return towards - (dot(towards, normal) / squared) * normal;
    }
};

/// The neighbors of a vertex along triple lines: those at the other end of an edge with three or more faces.
struct LineNeighbors {
    std::array<VertexId, 2> vertices{};
    int count = 0;

    void add(VertexId w) {
        if (count < 2) vertices[static_cast<std::size_t>(count)] = w;
        ++count;
    }
};

IdVector<VertexId, LineNeighbors> line_neighbors(const FoamMesh& mesh, const IdVector<VertexId, Surroundings>& around) {
    std::vector<std::pair<VertexId, VertexId>> edges;
    for (const Face& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId v = face.vertices[k];
            const VertexId w = face.vertices[(k + 1) % 3];
            if (!around[v].film && !around[w].film) edges.emplace_back(std::min(v, w), std::max(v, w));
        }
    std::sort(edges.begin(), edges.end());
    IdVector<VertexId, LineNeighbors> neighbors(mesh.position.size());
    for (std::size_t first = 0; first < edges.size();) {
        std::size_t last = first + 1;
        while (last < edges.size() && edges[last] == edges[first]) ++last;
        if (last - first > 2) {
            neighbors[edges[first].first].add(edges[first].second);
            neighbors[edges[first].second].add(edges[first].first);
        }
        first = last;
    }
    return neighbors;
}

}  // namespace

IdVector<VertexId, Vec3> tangential_smoothing(const FoamMesh& mesh, double strength) {
    IdVector<VertexId, Surroundings> around(mesh.position.size());
    for (const Face& face : mesh.faces) {
        const Vec3& a = mesh.position[face.vertices[0]];
        const Vec3& b = mesh.position[face.vertices[1]];
        const Vec3& c = mesh.position[face.vertices[2]];
        const Vec3 normal = detail::area_vector(a, b, c);
        for (const VertexId v : face.vertices) around[v].add(face, (1.0 / 3.0) * (a + b + c), normal);
    }
    const auto lines = line_neighbors(mesh, around);
    IdVector<VertexId, Vec3> step(mesh.position.size());
    for (const VertexId v : step.ids()) {
        if (mesh.on_wire[v] != 0 || !around[v].seen) continue;
        if (around[v].film) {
            step[v] = 1.5 * strength * around[v].pull(mesh.position[v]);
        } else if (lines[v].count == 2) {
            const Vec3& before = mesh.position[lines[v].vertices[0]];
            const Vec3& after = mesh.position[lines[v].vertices[1]];
            const Vec3 along = after - before;
            const Vec3 towards = 0.5 * (before + after) - mesh.position[v];
            if (squared_norm(along) > 0.0) step[v] = (strength * dot(towards, along) / squared_norm(along)) * along;
        }
    }
    return step;
}

}  // namespace lamella::mesh
