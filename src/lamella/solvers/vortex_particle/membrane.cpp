#include "lamella/solvers/vortex_particle/membrane.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/mesh/edge_faces.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

using mesh::VertexId;

/// 0 on wires, 3 on triple lines, else 1; also 0 for vertices without faces.
std::vector<std::size_t> freedoms(const mesh::FoamMesh& mesh) {
    std::vector<std::size_t> free(mesh.position.size(), 0);
    for (const mesh::Face& face : mesh.faces)
        for (const VertexId v : face.vertices) free[index(v)] = 1;
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    for (std::size_t e = 0; e < edges.size(); ++e)
        if (edges.of(e).size() > 2) free[index(edges.edge[e].a)] = free[index(edges.edge[e].b)] = 3;
    for (const VertexId v : mesh.position.ids())
        if (mesh.on_wire[v] != 0) free[index(v)] = 0;
    return free;
}

}  // namespace

Membrane::Membrane(const mesh::FoamMesh& mesh, const Surface& s) {
    const std::vector<std::size_t> free = freedoms(mesh);
    first_.assign(1, 0);
    for (std::uint32_t v = 0; v < free.size(); ++v) {
        first_.push_back(first_.back() + free[v]);
        vertex_.insert(vertex_.end(), free[v], v);
    }
    along_.resize(first_.back());
    aim(mesh);
    linalg::Groups groups;
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        for (const std::uint32_t corner : s.corner[t])
            for (std::size_t u = first_[s.site[corner]]; u < first_[s.site[corner] + 1]; ++u)
                groups.member.push_back(static_cast<int>(u));
        groups.close_group();
    }
    matrix_ = linalg::coupled(size(), groups);
    slot_start_.assign(1, 0);
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        for (std::uint8_t k = 0; k < 3; ++k)
            for (std::uint8_t l = 0; l < 3; ++l)
                for (std::size_t a = first_[s.site[s.corner[t][k]]]; a < first_[s.site[s.corner[t][k]] + 1]; ++a)
                    for (std::size_t b = first_[s.site[s.corner[t][l]]]; b < first_[s.site[s.corner[t][l]] + 1]; ++b)
                        if (a >= b)
                            pair_.push_back({k, l, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                             matrix_.slot(static_cast<int>(a), static_cast<int>(b))});
        slot_start_.push_back(pair_.size());
    }
    if (size() > 0) factors_.analyze(matrix_);
    // Clusters: vertices of one face hang together.
    std::vector<std::uint32_t> parent(mesh.position.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (const mesh::Face& face : mesh.faces)
        for (const std::size_t k : {1U, 2U}) {
            const auto a = root(static_cast<std::uint32_t>(index(face.vertices[0])));
            const auto b = root(static_cast<std::uint32_t>(index(face.vertices[k])));
            parent[std::max(a, b)] = std::min(a, b);
        }
    cluster_.resize(parent.size());
    for (std::uint32_t v = 0; v < parent.size(); ++v) {
        const std::uint32_t r = root(v);
        if (r == v) {
            cluster_[v] = clusters();
            held_.push_back(0);
        } else {
            cluster_[v] = cluster_[r];
        }
        if (mesh.on_wire[static_cast<VertexId>(v)] != 0) held_[cluster_[v]] = 1;
    }
}

void Membrane::aim(const mesh::FoamMesh& mesh) {
    std::vector<Vec3> normal(mesh.position.size());
    std::vector<mesh::RegionId> back(mesh.position.size(), mesh::RegionId{0xffffffffU});
    for (const mesh::Face& face : mesh.faces) {
        const auto& [a, b, c] = face.vertices;
        const Vec3 twice = cross(mesh.position[b] - mesh.position[a], mesh.position[c] - mesh.position[a]);
        for (const VertexId v : face.vertices) {
            mesh::RegionId& behind = back[index(v)];
            if (behind == mesh::RegionId{0xffffffffU}) behind = face.back;
            normal[index(v)] += face.back == behind ? twice : -twice;
        }
    }
    for (std::size_t v = 0; v + 1 < first_.size(); ++v) {
        if (first_[v + 1] == first_[v] + 3)
            for (std::size_t k = 0; k < 3; ++k) {
                along_[first_[v] + k] = {};
                along_[first_[v] + k].v[k] = 1.0;
            }
        if (first_[v + 1] != first_[v] + 1) continue;
        const double length = norm(normal[v]);
        if (!(length > 0.0)) throw NumericalError("vortex_particle: a film folds over itself");
        along_[first_[v]] = normal[v] / length;
    }
}

std::vector<double> Membrane::speeds(const Vectors& velocity) const {
    std::vector<double> speed(size());
    for (std::size_t u = 0; u < size(); ++u) {
        const Vec3& v = velocity.values()[vertex_[u]];
        const bool in_film = first_[vertex_[u] + 1] == first_[vertex_[u]] + 1;
        speed[u] = in_film ? std::copysign(norm(v), dot(v, along_[u])) : dot(v, along_[u]);
    }
    return speed;
}

Vectors Membrane::velocities(std::span<const double> speed) const {
    Vectors velocity(first_.size() - 1);
    for (std::size_t u = 0; u < size(); ++u) velocity.values()[vertex_[u]] += speed[u] * along_[u];
    return velocity;
}

std::vector<double> Membrane::components(const Vectors& force) const {
    std::vector<double> component(size());
    for (std::size_t u = 0; u < size(); ++u) component[u] = dot(force.values()[vertex_[u]], along_[u]);
    return component;
}

std::vector<double> Membrane::values(std::span<const double> at_vertices) const {
    std::vector<double> value(size());
    for (std::size_t u = 0; u < size(); ++u) value[u] = at_vertices[vertex_[u]];
    return value;
}

void Membrane::assemble(const Surface& s, std::span<const double> mass, std::span<const double> tension, double dt) {
    std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        const double w = 0.25 * dt * dt * tension[t] * s.area[t];
        for (std::size_t i = slot_start_[t]; i < slot_start_[t + 1]; ++i) {
            const Pair& p = pair_[i];
            matrix_.value[p.slot] += w * dot(s.hat_slope[t][p.k], s.hat_slope[t][p.l]) * dot(along_[p.a], along_[p.b]);
        }
    }
    for (std::size_t u = 0; u < size(); ++u) matrix_.diagonal(u) += mass[vertex_[u]];
}

double Membrane::mean_inertia() const {
    double sum = 0.0;
    for (std::size_t u = 0; u < size(); ++u) sum += matrix_.value[static_cast<std::size_t>(matrix_.column_start[u])];
    return size() > 0 ? sum / static_cast<double>(size()) : 1.0;
}

void Membrane::factorize() {
    if (size() > 0 && !factors_.factorize(matrix_))
        throw NumericalError("vortex_particle: the membrane's matrix is singular");
}

Vectors tension_force(const Surface& s, std::size_t vertices, std::span<const double> tension) {
    Vectors force(vertices);
    for (std::size_t t = 0; t < s.triangles(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            force.values()[s.site[s.corner[t][k]]] -= (tension[t] * s.area[t]) * s.hat_slope[t][k];
    return force;
}

std::vector<double> stretch_rate(const Surface& s, const Vectors& velocity) {
    std::vector<double> third(s.triangles()), rate(s.vertices());
    parallel_for(s.triangles(), [&](std::size_t t) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 3; ++k) sum += dot(s.hat_slope[t][k], velocity.values()[s.site[s.corner[t][k]]]);
        third[t] = s.area[t] * sum / 3.0;
    });
    parallel_for(s.vertices(), [&](std::size_t v) {
        for (const Incidence& at : s.around(v)) rate[v] += third[at.triangle];
    });
    return rate;
}

}  // namespace lamella::vortex_particle
