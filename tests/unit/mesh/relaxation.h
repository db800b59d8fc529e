#pragma once

// What the tracker's tests share: film meshes, an independent audit of their rules, and a flow that minimizes area.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "lamella/geometry/triangle_intersection.h"
#include "lamella/mesh/area.h"
#include "lamella/mesh/smoothing.h"
#include "lamella/mesh/tracker.h"
#include "lamella/mesh/volume.h"

namespace lamella::mesh::test {

/// Adds a sphere: an icosahedron subdivided `levels` times, region `inside` within `outside`.
inline void add_sphere(FoamMesh& mesh, const Vec3& center, double radius, int levels, RegionId inside, RegionId outside) {
    const double t = 0.5 * (1.0 + std::sqrt(5.0));
    std::vector<Vec3> points{{{-1, t, 0}}, {{1, t, 0}}, {{-1, -t, 0}}, {{1, -t, 0}}, {{0, -1, t}}, {{0, 1, t}},
                             {{0, -1, -t}}, {{0, 1, -t}}, {{t, 0, -1}}, {{t, 0, 1}}, {{-t, 0, -1}}, {{-t, 0, 1}}};
    std::vector<std::array<std::size_t, 3>> triangles{
        {0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
        {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<std::size_t, std::size_t>, std::size_t> middles;
        const auto middle = [&](std::size_t a, std::size_t b) {
            const auto [it, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, points.size());
            if (fresh) points.push_back(0.5 * (points[a] + points[b]));
            return it->second;
        };
        std::vector<std::array<std::size_t, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const std::size_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        triangles = finer;
        for (Vec3& p : points) p *= 1.0 / norm(p);
    }
    const std::size_t first = mesh.position.size();
    for (const Vec3& p : points) mesh.add_vertex(center + (radius / norm(p)) * p);
    for (const auto& [a, b, c] : triangles)
        mesh.add_face(VertexId(first + a), VertexId(first + b), VertexId(first + c), inside, outside);
}

/// A film between two rings of radius 1, a cylinder at first: region 1 inside, 0 outside.
inline FoamMesh film_between_rings(double separation, int segments, int rows) {
    FoamMesh mesh;
    mesh.regions.push_back({RegionKind::kOpen, 0.0});
    mesh.regions.push_back({RegionKind::kOpen, 0.0});
    for (int row = 0; row <= rows; ++row)
        for (int s = 0; s < segments; ++s) {
            const double angle = 2.0 * 3.14159265358979 * (s + 0.5 * (row % 2)) / segments;
            mesh.add_vertex({{std::cos(angle), std::sin(angle), separation * (static_cast<double>(row) / rows - 0.5)}},
                            row == 0 || row == rows);
        }
    const auto at = [&](int row, int s) { return static_cast<VertexId>(row * segments + (s + segments) % segments); };
    for (int row = 0; row < rows; ++row)
        for (int s = 0; s < segments; ++s) {
            const int shift = row % 2;
            mesh.add_face(at(row, s), at(row, s + 1), at(row + 1, s + shift), RegionId{1}, kOutside);
            mesh.add_face(at(row, s + 1 - shift), at(row + 1, s + 1), at(row + 1, s), RegionId{1}, kOutside);
        }
    return mesh;
}

inline FoamMesh spheres(const std::vector<std::pair<Vec3, double>>& balls, int levels) {
    FoamMesh mesh;
    mesh.regions.push_back({RegionKind::kOpen, 0.0});
    for (const auto& [center, radius] : balls) {
        const RegionId r = mesh.regions.push_back({RegionKind::kClosed, 4.0 / 3.0 * 3.14159265358979 * std::pow(radius, 3)});
        add_sphere(mesh, center, radius, levels, r, kOutside);
    }
    return mesh;
}

/// What breaks a rule of FoamMesh, written independently of the tracker and of mesh/check.h: by brute force.
inline std::vector<std::string> faults(const FoamMesh& mesh) {
    std::vector<std::string> found;
    std::map<std::pair<VertexId, VertexId>, std::map<RegionId, int>> chain;
    std::map<std::array<VertexId, 3>, int> triples;
    for (const FaceId f : mesh.faces.ids()) {
        const Face& face = mesh.faces[f];
        const std::string name = "face " + std::to_string(index(f));
        if (face.back == face.front) found.push_back(name + " has one region on both sides");
        auto sorted = face.vertices;
        std::sort(sorted.begin(), sorted.end());
        if (sorted[0] == sorted[1] || sorted[1] == sorted[2]) found.push_back(name + " has a vertex twice");
        if (++triples[sorted] > 1) found.push_back(name + " is there twice");
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId v = face.vertices[k];
            const VertexId w = face.vertices[(k + 1) % 3];
            auto& sum = chain[{std::min(v, w), std::max(v, w)}];
            const int s = v < w ? 1 : -1;
            sum[face.back] += s;
            sum[face.front] -= s;
        }
    }
    for (const auto& [edge, sum] : chain) {
        if (mesh.on_wire[edge.first] != 0 && mesh.on_wire[edge.second] != 0) continue;
        for (const auto& [region, count] : sum)
            if (count != 0)
                found.push_back("edge " + std::to_string(index(edge.first)) + "-" + std::to_string(index(edge.second)) +
                                " does not close region " + std::to_string(index(region)));
    }
    std::vector<std::pair<double, FaceId>> order;
    std::vector<std::array<Vec3, 2>> boxes;
    for (const FaceId f : mesh.faces.ids()) {
        std::array<Vec3, 2> box{mesh.corner(f, 0), mesh.corner(f, 0)};
        for (std::size_t c = 1; c < 3; ++c)
            for (std::size_t k = 0; k < 3; ++k) {
                box[0][k] = std::min(box[0][k], mesh.corner(f, c)[k]);
                box[1][k] = std::max(box[1][k], mesh.corner(f, c)[k]);
            }
        boxes.push_back(box);
        order.emplace_back(box[0][0], f);
    }
    std::sort(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size() && order[j].first <= boxes[index(order[i].second)][1][0]; ++j) {
            const FaceId f = order[i].second;
            const FaceId g = order[j].second;
            const auto& a = boxes[index(f)];
            const auto& b = boxes[index(g)];
            if (a[0][1] > b[1][1] || b[0][1] > a[1][1] || a[0][2] > b[1][2] || b[0][2] > a[1][2]) continue;
            std::array<Vec3, 3> s, t;
            std::size_t shared = 0;
            for (std::size_t k = 0; k < 3; ++k)
                if (mesh.faces[g].has(mesh.faces[f].vertices[k])) s[shared] = t[shared] = mesh.corner(f, k), ++shared;
            if (shared == 3) continue;
            std::size_t m = shared, n = shared;
            for (std::size_t k = 0; k < 3; ++k) {
                if (!mesh.faces[g].has(mesh.faces[f].vertices[k])) s[m++] = mesh.corner(f, k);
                if (!mesh.faces[f].has(mesh.faces[g].vertices[k])) t[n++] = mesh.corner(g, k);
            }
            const bool meet = shared == 0 ? geometry::triangles_meet(s, t)
                                          : geometry::triangles_meet_beyond_shared(s, t, static_cast<int>(shared));
            if (meet) found.push_back("faces " + std::to_string(index(f)) + " and " + std::to_string(index(g)) + " meet");
        }
    return found;
}

inline double worst_volume_error(const FoamMesh& mesh) {
    const auto volumes = region_volumes(mesh);
    double worst = 0.0;
    for (const RegionId r : mesh.regions.ids())
        if (mesh.regions[r].kind == RegionKind::kClosed)
            worst = std::max(worst, std::abs(volumes[r] / mesh.regions[r].target_volume - 1.0));
    return worst;
}

/// Steps of area-gradient flow with the volumes of all closed regions held, through the tracker.
struct Flow {
    Tracker tracker;
    double step = 0.2;  // of h^2 per step
    RemeshReport last = {};

    void advance() {
        tracker.move(displacement());
        last = tracker.remesh();
    }

    /// Until the volumes are there: first with remeshing, then the positions alone. Where films are close a step goes
    /// only part of the way, so that it takes several.
    void settle_volumes() {
        for (int round = 0; round < 200 && worst_volume_error(tracker.mesh()) > 1e-3; ++round) advance();
        step = 0.0;
        for (int round = 0; round < 50 && worst_volume_error(tracker.mesh()) > 1e-11; ++round) tracker.move(displacement());
    }

    /// Down the area gradient over lumped masses, tangential smoothing, and the way back to the target volumes.
    IdVector<VertexId, Vec3> displacement() const {
        const FoamMesh& mesh = tracker.mesh();
        const double h = tracker.options().edge_length;
        const auto gradient = area_gradient(mesh);
        const double dt = step * h * h;
        IdVector<VertexId, double> mass(mesh.position.size(), 0.0);
        IdVector<VertexId, double> stiffness(mesh.position.size(), 0.0);
        for (const Face& f : mesh.faces) {
            const Vec3& a = mesh.position[f.vertices[0]];
            const Vec3& b = mesh.position[f.vertices[1]];
            const Vec3& c = mesh.position[f.vertices[2]];
            const double area = 0.5 * norm(cross(b - a, c - a));
            const std::array<double, 3> opposite{squared_norm(c - b), squared_norm(a - c), squared_norm(b - a)};
            for (std::size_t k = 0; k < 3; ++k) {
                mass[f.vertices[k]] += area / 3.0;
                stiffness[f.vertices[k]] += opposite[k] / (4.0 * area);
            }
        }
        IdVector<VertexId, Vec3> d = tangential_smoothing(mesh, step > 0.0 ? 0.15 : 0.0);
        for (const VertexId v : d.ids()) {
            mass[v] = std::max(mass[v], 1.2 * dt * stiffness[v]);
            if (mesh.on_wire[v] == 0) d[v] -= (dt / mass[v]) * gradient[v];
        }
        restore_volumes(mesh, mass, d);
        return d;
    }

    /// Newton: d += M^-1 G mu with volumes of x + d at their targets, at most 3 % of a region per step.
    void restore_volumes(const FoamMesh& mesh, const IdVector<VertexId, double>& mass, IdVector<VertexId, Vec3>& d) const {
        FoamMesh ahead = mesh;
        for (int iteration = 0; iteration < 3; ++iteration) {
            for (const VertexId v : d.ids()) ahead.position[v] = mesh.position[v] + d[v];
            const auto volumes = region_volumes(ahead);
            const auto gradient = volume_gradient(ahead);
            std::vector<RegionId> closed;
            IdVector<RegionId, std::size_t> row(mesh.regions.size(), 0);
            for (const RegionId r : mesh.regions.ids())
                if (mesh.regions[r].kind == RegionKind::kClosed) {
                    row[r] = closed.size();
                    closed.push_back(r);
                }
            const std::size_t n = closed.size();
            std::vector<std::vector<double>> m(n, std::vector<double>(n + 1, 0.0));
            for (std::size_t i = 0; i < n; ++i) {
                const double target = mesh.regions[closed[i]].target_volume;
                m[i][n] = std::clamp(target - volumes[closed[i]], -0.03 * target, 0.03 * target);
            }
            const auto each_pair = [&](auto&& use) {
                for (const VertexId v : d.ids()) {
                    if (mesh.on_wire[v] != 0) continue;
                    for (const RegionId r : closed) {
                        const Vec3 g = gradient.at(v, r);
                        if (squared_norm(g) > 0.0) use(v, r, g);
                    }
                }
            };
            each_pair([&](VertexId v, RegionId r, const Vec3& g) {
                for (const RegionId s : closed) {
                    const Vec3 other = gradient.at(v, s);
                    m[row[r]][row[s]] += dot(g, other) / mass[v];
                }
            });
            for (std::size_t i = 0; i < n; ++i) m[i][i] *= 1.0 + 1e-12;
            const std::vector<double> mu = solve(m);
            each_pair([&](VertexId v, RegionId r, const Vec3& g) { d[v] += (mu[row[r]] / mass[v]) * g; });
        }
    }

    static std::vector<double> solve(std::vector<std::vector<double>> m) {
        const std::size_t n = m.size();
        for (std::size_t k = 0; k < n; ++k) {
            std::size_t pivot = k;
            for (std::size_t i = k + 1; i < n; ++i)
                if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
            std::swap(m[k], m[pivot]);
            for (std::size_t i = k + 1; i < n; ++i) {
                const double factor = m[i][k] / m[k][k];
                for (std::size_t j = k; j <= n; ++j) m[i][j] -= factor * m[k][j];
            }
        }
        std::vector<double> x(n);
        for (std::size_t k = n; k-- > 0;) {
            x[k] = m[k][n];
            for (std::size_t j = k + 1; j < n; ++j) x[k] -= m[k][j] * x[j];
            x[k] /= m[k][k];
        }
        return x;
    }
};

}  // namespace lamella::mesh::test
