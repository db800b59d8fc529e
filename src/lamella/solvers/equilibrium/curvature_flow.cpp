#include "lamella/solvers/equilibrium/curvature_flow.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/dense.h"
#include "lamella/linalg/ldlt.h"
#include "lamella/mesh/volume.h"

#include <algorithm>
#include <cmath>

namespace lamella::equilibrium {
namespace {

using mesh::FoamMesh;
using mesh::RegionId;
using mesh::VertexId;

/// Numbers of the vertices that may move; -1 on wires and where there is no face.
struct FreeVertices {
    explicit FreeVertices(const FoamMesh& mesh) : number(mesh.position.size(), -1) {
        for (const mesh::Face& face : mesh.faces)
            for (const VertexId v : face.vertices)
                if (mesh.on_wire[v] == 0) number[v] = 0;
        for (int& n : number)
            if (n == 0) n = count++;
    }
    IdVector<VertexId, int> number;
    int count = 0;
};

struct FlowMatrix {
    linalg::SymmetricMatrix matrix;
    std::vector<Vec3> slope;  ///< of the area, per free vertex
};

/// L + M / tau and g.
FlowMatrix flow_matrix(const FoamMesh& mesh, const FreeVertices& free, const Patches& patches, double tau) {
    linalg::Groups groups;
    for (const mesh::Face& face : mesh.faces) {
        for (const VertexId v : face.vertices)
            if (free.number[v] >= 0) groups.member.push_back(free.number[v]);
        groups.close_group();
    }
    FlowMatrix flow{linalg::coupled(static_cast<std::size_t>(free.count), groups),
                    std::vector<Vec3>(static_cast<std::size_t>(free.count))};
    for (const mesh::FaceId f : mesh.faces.ids()) {
        const auto& v = mesh.faces[f].vertices;
        const double tension = patches.tension[index(f)];
        const std::array<Vec3, 3> x{mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]]};
        const double doubled = std::max(norm(cross(x[1] - x[0], x[2] - x[0])), 1e-12 * squared_norm(x[1] - x[0]));
        if (!(doubled > 0.0)) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 to_next = x[(k + 1) % 3] - x[k], to_last = x[(k + 2) % 3] - x[k];
            const double half_cotangent = 0.5 * tension * dot(to_next, to_last) / doubled;
            const std::array<VertexId, 2> ends{v[(k + 1) % 3], v[(k + 2) % 3]};
            const Vec3 along = to_last - to_next;
            for (std::size_t e = 0; e < 2; ++e) {
                const int i = free.number[ends[e]];
                if (i < 0) continue;
                flow.matrix.diagonal(static_cast<std::size_t>(i)) += half_cotangent;
                flow.slope[static_cast<std::size_t>(i)] += (e == 0 ? -half_cotangent : half_cotangent) * along;
            }
            const int i = free.number[ends[0]], j = free.number[ends[1]];
            if (i >= 0 && j >= 0) flow.matrix.value[flow.matrix.slot(i, j)] -= half_cotangent;
            const int own = free.number[v[k]];
            if (own >= 0) flow.matrix.diagonal(static_cast<std::size_t>(own)) += doubled / (6.0 * tau);
        }
    }
    return flow;
}

/// The solution of (L + M / tau) d = right for each of the three axes.
std::vector<Vec3> solve(const linalg::Ldlt& factors, const std::vector<Vec3>& right) {
    std::vector<Vec3> result(right.size());
    std::vector<double> column(right.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < right.size(); ++i) column[i] = right[i][axis];
        factors.solve(column);
        for (std::size_t i = 0; i < right.size(); ++i) result[i][axis] = column[i];
    }
    return result;
}

double inner(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
    return sum;
}

}  // namespace

IdVector<VertexId, Vec3> curvature_flow_step(const FoamMesh& mesh,
                                             const std::vector<FilmTension>& tension,
                                             double tau) {
    IdVector<VertexId, Vec3> displacement(mesh.position.size());
    const FreeVertices free(mesh);
    if (free.count == 0) return displacement;
    const FlowMatrix flow = flow_matrix(mesh, free, flat_patches(mesh, tension), tau);
    linalg::Ldlt factors;
    factors.analyze(flow.matrix);
    if (!factors.factorize(flow.matrix)) return displacement;

    std::vector<RegionId> closed;
    std::vector<double> missing;
    const auto volumes = mesh::region_volumes(mesh);
    for (const RegionId r : mesh.regions.ids())
        if (mesh.regions[r].kind == mesh::RegionKind::kClosed) {
            const double target = mesh.regions[r].target_volume;
            closed.push_back(r);
            missing.push_back(std::clamp(target - volumes[r], -0.1 * target, 0.1 * target));
        }
    const auto gradient = mesh::volume_gradient(mesh);
    std::vector<std::vector<Vec3>> slope(closed.size(), std::vector<Vec3>(static_cast<std::size_t>(free.count)));
    for (std::size_t r = 0; r < closed.size(); ++r)
        for (const VertexId v : mesh.position.ids())
            if (free.number[v] >= 0) slope[r][static_cast<std::size_t>(free.number[v])] = gradient.at(v, closed[r]);

    std::vector<Vec3> down = flow.slope;
    for (Vec3& g : down) g = -g;
    const std::size_t n = closed.size();
    std::vector<std::vector<Vec3>> answer(n + 1);
    parallel_blocks(n + 1, 1, [&](std::size_t r, std::size_t) { answer[r] = solve(factors, r < n ? slope[r] : down); });
    std::vector<double> schur(n * n), right(n);
    for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t s = 0; s <= r; ++s) schur[r * n + s] = inner(slope[r], answer[s]);
        right[r] = missing[r] - inner(slope[r], answer[n]);
    }
    const std::vector<double> pressure = linalg::solve_symmetric(n, schur, right).x;
    for (const VertexId v : mesh.position.ids()) {
        if (free.number[v] < 0) continue;
        const auto i = static_cast<std::size_t>(free.number[v]);
        displacement[v] = answer[n][i];
        for (std::size_t r = 0; r < n; ++r) displacement[v] += pressure[r] * answer[r][i];
    }
    return displacement;
}

}  // namespace lamella::equilibrium
