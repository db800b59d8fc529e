#include "lamella/solvers/vortex_sheet/operators.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/dense.h"

#include <algorithm>
#include <cmath>

namespace lamella::vortex_sheet {
namespace {

using mesh::Corner;
using mesh::FaceId;
using mesh::FoamMesh;
using mesh::VertexId;

/// The edge opposite to corner k, in the sense of the face.
Vec3 opposite_edge(const FoamMesh& mesh, FaceId f, std::size_t k) {
    const auto& v = mesh.faces[f].vertices;
    return mesh.position[v[(k + 2) % 3]] - mesh.position[v[(k + 1) % 3]];
}

Vec3 times(const std::array<Vec3, 3>& m, const Vec3& x) { return {{dot(m[0], x), dot(m[1], x), dot(m[2], x)}}; }

/// Pseudo-inverse of sum N N^T at a vertex whose cell has the given area. Directions with less than 1e-7 of the largest
/// eigenvalue count as none: three films of one triple line span two directions to rounding. Eigenvalues are about
/// 2, 1/2 and 1/5 of area^2 on a film, a triple line and where four regions meet; where films are crumpled they are
/// smaller, and bounded from below, or such a vertex would answer to the least pressure with any speed.
std::array<Vec3, 3> pseudo_inverse(std::span<const Vec3> normals, double area) {
    std::array<Vec3, 3> inverse{};
    constexpr double kLeast = 0.01;
    const double least = kLeast * area * area;
    if (normals.size() == 2) {  // on a film the two are opposite
        const double square = squared_norm(normals[0]);
        if (square == 0.0) return inverse;
        for (std::size_t i = 0; i < 3; ++i)
            inverse[i] = (normals[0][i] / (square * std::max(2.0 * square, least))) * normals[0];
        return inverse;
    }
    std::array<Vec3, 3> sum{};
    for (const Vec3& n : normals)
        for (std::size_t i = 0; i < 3; ++i) sum[i] += n[i] * n;
    const linalg::Eigen3 pairs = linalg::eigenpairs(sum);
    constexpr double kCutoff = 1e-7;
    for (std::size_t k = 0; k < 3; ++k) {
        if (pairs.value[k] <= kCutoff * pairs.value[2]) continue;
        for (std::size_t i = 0; i < 3; ++i)
            inverse[i] += (pairs.vector[k][i] / std::max(pairs.value[k], least)) * pairs.vector[k];
    }
    return inverse;
}

constexpr std::size_t kBlock = 512;  // vertices of one task

template <class Body>
void for_each_vertex(const SheetTopology& topology, Body&& body) {
    parallel_blocks(topology.hold.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) body(static_cast<VertexId>(v));
    });
}

}  // namespace

SheetGeometry sheet_geometry(const FoamMesh& mesh, const SheetTopology& topology) {
    SheetGeometry geometry;
    const std::size_t faces = mesh.faces.size();
    geometry.barycenter.resize(faces);
    geometry.area_vector.resize(faces);
    parallel_for(faces, [&](std::size_t i) {
        const auto& v = mesh.faces[static_cast<FaceId>(i)].vertices;
        const Vec3 &a = mesh.position[v[0]], &b = mesh.position[v[1]], &c = mesh.position[v[2]];
        geometry.barycenter[i] = (a + b + c) / 3.0;
        geometry.area_vector[i] = 0.5 * cross(b - a, c - a);
    });
    geometry.outward.resize(topology.size());
    geometry.inverse.resize(mesh.position.size());
    for_each_vertex(topology, [&](VertexId v) {
        double area = 0.0;
        for (const Corner& corner : topology.corners.of(v)) {
            const auto& entry = topology.entry[corner.face][corner.k];
            const Vec3 third = geometry.area_vector[index(corner.face)] / 3.0;
            area += norm(third);
            geometry.outward[entry[0]] += third;
            geometry.outward[entry[1]] -= third;
        }
        geometry.inverse[v] = pseudo_inverse(
            std::span(geometry.outward).subspan(topology.first(v), topology.last(v) - topology.first(v)), area);
    });
    return geometry;
}

std::vector<Vec3> face_strengths(const FoamMesh& mesh, const SheetTopology& topology, const Circulation& phi) {
    std::vector<Vec3> strength(mesh.faces.size());
    parallel_for(strength.size(), [&](std::size_t i) {
        const auto f = static_cast<FaceId>(i);
        const double base = jump(topology, phi, f, 0);  // only differences count: no cancellation
        strength[i] = -0.5 * ((jump(topology, phi, f, 1) - base) * opposite_edge(mesh, f, 1) +
                              (jump(topology, phi, f, 2) - base) * opposite_edge(mesh, f, 2));
    });
    return strength;
}

std::vector<double> fluxes(const FoamMesh& mesh, const SheetTopology& topology, std::span<const Vec3> potential) {
    std::vector<double> flux(topology.size(), 0.0);
    for_each_vertex(topology, [&](VertexId v) {
        for (const Corner& corner : topology.corners.of(v)) {
            const double half = 0.5 * dot(opposite_edge(mesh, corner.face, corner.k), potential[index(corner.face)]);
            const auto& entry = topology.entry[corner.face][corner.k];
            flux[entry[0]] += half;
            flux[entry[1]] -= half;
        }
    });
    return flux;
}

IdVector<VertexId, Vec3> vertex_velocity(const SheetTopology& topology,
                                         const SheetGeometry& geometry,
                                         std::span<const Vec3> face_velocity,
                                         std::span<const double> flux) {
    IdVector<VertexId, Vec3> velocity(topology.hold.size());
    for_each_vertex(topology, [&](VertexId v) {
        Vec3 mean;
        double weight = 0.0;
        for (const Corner& corner : topology.corners.of(v)) {
            const double area = norm(geometry.area_vector[index(corner.face)]);
            mean += area * face_velocity[index(corner.face)];
            weight += area;
        }
        if (weight > 0.0) mean = mean / weight;
        velocity[v] = mean;
        if (topology.hold[v] == Hold::kRim) return;  // half a loop around it has no flux
        Vec3 missing;
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i)
            missing += (flux[i] - dot(geometry.outward[i], mean)) * geometry.outward[i];
        velocity[v] += times(geometry.inverse[v], missing);
    });
    return velocity;
}

namespace {

/// The largest speed at the vertices of the faces around each vertex, its own among them.
std::vector<double> fastest_around(const FoamMesh& mesh,
                                   const SheetTopology& topology,
                                   const IdVector<VertexId, Vec3>& velocity) {
    std::vector<double> fastest(velocity.size(), 0.0);
    for_each_vertex(topology, [&](VertexId v) {
        for (const Corner& corner : topology.corners.of(v))
            for (const VertexId w : mesh.faces[corner.face].vertices)
                fastest[index(v)] = std::max(fastest[index(v)], norm(velocity[w]));
    });
    return fastest;
}

}  // namespace

void carry_fluxes_all_the_way(const FoamMesh& start,
                              const SheetTopology& topology,
                              const SheetGeometry& geometry,
                              std::span<const double> flux,
                              double dt,
                              IdVector<VertexId, Vec3>& velocity) {
    // Each sweep leaves about dt |grad u| of what was missing: three do, but where films snap. Where that is more than
    // all of it, sweeps lead away: a vertex whose correction is no longer small keeps the velocity that it had.
    constexpr double kSmall = 0.5;  // of the largest speed around
    constexpr int kMostSweeps = 8;
    constexpr double kEnough = 1e-5;  // of the largest flux
    double largest = 0.0;
    for (const double w : flux) largest = std::max(largest, std::abs(w));
    std::vector<Vec3> mean(start.faces.size());
    if (topology.hold.empty()) return;
    const IdVector<VertexId, Vec3> first = velocity;
    const std::vector<double> fastest = fastest_around(start, topology, first);
    std::vector<std::uint8_t> settled(topology.hold.size(), 0);
    for (const VertexId v : topology.hold.ids()) settled[index(v)] = topology.hold[v] != Hold::kFree ? 1 : 0;
    std::vector<double> off(topology.hold.size(), 0.0);
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        parallel_for(mean.size(), [&](std::size_t i) {
            const auto& [a, b, c] = start.faces[static_cast<FaceId>(i)].vertices;
            const Vec3 ab = start.position[b] - start.position[a], ac = start.position[c] - start.position[a];
            const Vec3 way_b = dt * (velocity[b] - velocity[a]), way_c = dt * (velocity[c] - velocity[a]);
            mean[i] = 0.5 * cross(ab + 0.5 * way_b, ac + 0.5 * way_c) + cross(way_b, way_c) / 24.0;
        });
        for_each_vertex(topology, [&](VertexId v) {
            if (settled[index(v)] != 0) return;
            Vec3 missing;
            double most = 0.0;
            for (std::size_t i = topology.first(v); i < topology.last(v); ++i) {
                Vec3 normal;
                for (const Corner& corner : topology.corners.of(v)) {
                    const auto& entry = topology.entry[corner.face][corner.k];
                    if (entry[0] == i) normal += mean[index(corner.face)] / 3.0;
                    if (entry[1] == i) normal -= mean[index(corner.face)] / 3.0;
                }
                const double lack = flux[i] - dot(normal, velocity[v]);
                most = std::max(most, std::abs(lack));
                missing += lack * geometry.outward[i];
            }
            off[index(v)] = most;
            velocity[v] += times(geometry.inverse[v], missing);
            if (norm(velocity[v] - first[v]) <= kSmall * fastest[index(v)]) return;
            velocity[v] = first[v];
            off[index(v)] = 0.0;
            settled[index(v)] = 1;
        });
        if (*std::max_element(off.begin(), off.end()) <= kEnough * largest) return;
    }
}

std::vector<double> film_pressures(const SheetTopology& topology,
                                   const SheetGeometry& geometry,
                                   const IdVector<VertexId, Vec3>& force) {
    std::vector<double> pressure(topology.size());
    for_each_vertex(topology, [&](VertexId v) {
        const Vec3 along = times(geometry.inverse[v], force[v]);
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i)
            pressure[i] = dot(geometry.outward[i], along);
    });
    return pressure;
}

}  // namespace lamella::vortex_sheet
