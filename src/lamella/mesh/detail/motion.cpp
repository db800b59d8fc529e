#include "lamella/mesh/detail/motion.h"

#include "lamella/core/parallel.h"
#include "lamella/geometry/distance.h"
#include "lamella/mesh/detail/face_pairs.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella::mesh::detail {
namespace {

constexpr double kTogether = 0.9;
constexpr double kFloor = 1e-7;  // of the longest step

/// Whether the boxes of two sets of points come closer than `reach` along every axis. It spares most exact distances:
/// of the primitives of two faces whose boxes meet nine in ten are farther apart than they move.
template <std::size_t N, std::size_t M>
bool boxes_near(const std::array<Vec3, N>& a, const std::array<Vec3, M>& b, double reach) {
    bool near = true;
    for (std::size_t k = 0; k < 3; ++k) {
        double low_a = a[0][k], high_a = a[0][k], low_b = b[0][k], high_b = b[0][k];
        for (std::size_t i = 1; i < N; ++i) {
            low_a = std::min(low_a, a[i][k]);
            high_a = std::max(high_a, a[i][k]);
        }
        for (std::size_t i = 1; i < M; ++i) {
            low_b = std::min(low_b, b[i][k]);
            high_b = std::max(high_b, b[i][k]);
        }
        near &= (low_a - high_b <= reach) & (low_b - high_a <= reach);
    }
    return near;
}

using Pair = MotionLimit::Pair;
using Lengths = IdVector<VertexId, double>;

/// Of the first `first` points and the others.
double squared_distance(const std::array<Vec3, 4>& p, std::uint8_t first) {
    return first == 1 ? geometry::squared_distance_to_triangle(p[0], p[1], p[2], p[3])
                      : geometry::squared_distance_of_segments(p[0], p[1], p[2], p[3]);
}

double squared_distance(const EditMesh& mesh, const Pair& pair) {
    const auto& v = pair.vertex;
    return squared_distance({mesh.at(v[0]), mesh.at(v[1]), mesh.at(v[2]), mesh.at(v[3])}, pair.first);
}

/// How far the two primitives go together at most: the sum over both of the farthest vertex.
double together(const Pair& pair, const Lengths& length) {
    const double a = length[pair.vertex[0]], b = length[pair.vertex[1]], c = length[pair.vertex[2]],
                 d = length[pair.vertex[3]];
    return pair.first == 1 ? a + std::max({b, c, d}) : std::max(a, b) + std::max(c, d);
}

/// How far two primitives may move together [m].
double room(double squared_distance) { return kTogether * std::sqrt(squared_distance); }

/// Each vertex and each edge belongs to the lowest face that has it, so that every pair is looked at once.
struct Owned {
    std::uint8_t vertices = 0, edges = 0;  // bit k: corner k, edge from corner k to the next
};

/// Which pairs are in danger when the vertices go as far as `length`.
class DangerousPairs {
public:
    DangerousPairs(const EditMesh& mesh, const Lengths& length, double floor);
    /// Appends those of two faces.
    void of_faces(FaceId f, FaceId g, std::vector<Pair>& found) const;
    /// Every face in a box that meets the box of each face it could reach.
    std::vector<FacePairs::Item> boxes() const;

private:
    double most(const Face& face) const {
        return std::max({length_[face.vertices[0]], length_[face.vertices[1]], length_[face.vertices[2]]});
    }
    bool in_danger(const Pair& pair, double way) const {
        const double d2 = squared_distance(mesh_, pair);
        return way > std::min(room(d2), std::sqrt(d2) - floor_);
    }
    void vertices_against_face(FaceId f, FaceId g, std::vector<Pair>& found) const;

    const EditMesh& mesh_;
    const Lengths& length_;
    double floor_;
    IdVector<FaceId, Owned> owned_;
};

DangerousPairs::DangerousPairs(const EditMesh& mesh, const Lengths& length, double floor)
    : mesh_(mesh), length_(length), floor_(floor), owned_(mesh.mesh().faces.size()) {
    parallel_for(owned_.size(), [&](std::size_t i) {
        const FaceId f = static_cast<FaceId>(i);
        const auto& u = mesh_.face(f).vertices;
        for (std::size_t k = 0; k < 3; ++k) {
            if (mesh_.faces_at(u[k])[0] == f) owned_[f].vertices |= static_cast<std::uint8_t>(1U << k);
            for (const FaceId g : mesh_.faces_at(u[k]))
                if (mesh_.face(g).has(u[(k + 1) % 3])) {
                    if (g == f) owned_[f].edges |= static_cast<std::uint8_t>(1U << k);
                    break;
                }
        }
    });
}

void DangerousPairs::vertices_against_face(FaceId f, FaceId g, std::vector<Pair>& found) const {
    if (owned_[f].vertices == 0) return;
    const Face& face = mesh_.face(g);
    const auto t = mesh_.corners(g);
    for (std::size_t k = 0; k < 3; ++k) {
        const VertexId v = mesh_.face(f).vertices[k];
        if (!((owned_[f].vertices >> k) & 1U) || face.has(v)) continue;
        const Pair pair{{v, face.vertices[0], face.vertices[1], face.vertices[2]}, 1};
        const double way = together(pair, length_);
        if (boxes_near<1, 3>({mesh_.at(v)}, t, way / kTogether + floor_) && in_danger(pair, way)) found.push_back(pair);
    }
}

void DangerousPairs::of_faces(FaceId f, FaceId g, std::vector<Pair>& found) const {
    vertices_against_face(f, g, found);
    vertices_against_face(g, f, found);
    if (owned_[f].edges == 0 || owned_[g].edges == 0) return;
    const auto& u = mesh_.face(f).vertices;
    const auto& v = mesh_.face(g).vertices;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!((owned_[f].edges >> i) & 1U)) continue;
        const VertexId a = u[i], b = u[(i + 1) % 3];
        for (std::size_t j = 0; j < 3; ++j) {
            const VertexId c = v[j], d = v[(j + 1) % 3];
            if (!((owned_[g].edges >> j) & 1U) || a == c || a == d || b == c || b == d) continue;
            const Pair pair{{a, b, c, d}, 2};
            const double way = together(pair, length_);
            if (boxes_near<2, 2>({mesh_.at(a), mesh_.at(b)}, {mesh_.at(c), mesh_.at(d)}, way / kTogether + floor_) &&
                in_danger(pair, way))
                found.push_back(pair);
        }
    }
}

std::vector<FacePairs::Item> DangerousPairs::boxes() const {
    const std::size_t faces = mesh_.mesh().faces.size();
    std::vector<FacePairs::Item> items(faces);
    parallel_for(faces, [&](std::size_t i) {
        const FaceId f = static_cast<FaceId>(i);
        items[i] = {f, mesh_.box(f).inflated(most(mesh_.face(f)) / kTogether + 0.5 * floor_)};
    });
    return items;
}

std::vector<Pair> dangerous_pairs(const EditMesh& mesh, const Lengths& length, double floor) {
    const DangerousPairs dangerous(mesh, length, floor);
    return FacePairs(dangerous.boxes()).collect<Pair>([&](FaceId f, FaceId g, std::vector<Pair>& found) {
        dangerous.of_faces(f, g, found);
    });
}

/// How far each vertex may go of its `length`.
Lengths held_by(const std::vector<Pair>& pairs, const EditMesh& mesh, const Lengths& length) {
    std::vector<double> rooms(pairs.size());
    parallel_for(pairs.size(), [&](std::size_t i) { rooms[i] = room(squared_distance(mesh, pairs[i])); });
    Lengths allowed = length;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (together(pairs[i], length) <= rooms[i]) continue;
        const double half = 0.5 * rooms[i];
        for (const VertexId v : pairs[i].vertex) allowed[v] = std::min(allowed[v], half);
    }
    return allowed;
}

double squared_distance_after(const EditMesh& mesh,
                              const Pair& pair,
                              const IdVector<VertexId, Vec3>& displacement,
                              const Lengths& length,
                              const Lengths& allowed) {
    std::array<Vec3, 4> p;
    for (std::size_t k = 0; k < 4; ++k) {
        const VertexId v = pair.vertex[k];
        p[k] = mesh.at(v);
        if (allowed[v] > 0.0) p[k] += allowed[v] / length[v] * displacement[v];
    }
    return squared_distance(p, pair.first);
}

/// Stops the vertices of pairs that are nearer than `floor` and would come nearer still. Step after step would else
/// take its share of their distance until the rest is lost in rounding: wires do that to a film that they crumple.
/// Where one pair stops another may have to, so this goes on until none does.
void stop_at(double floor,
             const std::vector<Pair>& pairs,
             const EditMesh& mesh,
             const IdVector<VertexId, Vec3>& displacement,
             const Lengths& length,
             Lengths& allowed) {
    std::vector<Pair> near;
    for (const Pair& pair : pairs)
        if (std::sqrt(squared_distance(mesh, pair)) - together(pair, allowed) < floor) near.push_back(pair);
    std::vector<VertexId> stopped;
    do {
        stopped.clear();
        for (const Pair& pair : near) {
            const double after = squared_distance_after(mesh, pair, displacement, length, allowed);
            if (after >= floor * floor || after >= squared_distance(mesh, pair)) continue;
            for (const VertexId v : pair.vertex)
                if (allowed[v] > 0.0) stopped.push_back(v);
        }
        for (const VertexId v : stopped) allowed[v] = 0.0;
    } while (!stopped.empty());
}

}  // namespace

bool MotionLimit::within_reach(const IdVector<VertexId, double>& length) const {
    if (reach_.size() != length.size()) return false;
    for (const VertexId v : length.ids())
        if (length[v] > reach_[v]) return false;
    return true;
}

std::size_t MotionLimit::apply(const EditMesh& mesh,
                               double longest,
                               const IdVector<VertexId, double>& later,
                               IdVector<VertexId, Vec3>& displacement) {
    Lengths length(displacement.size());
    std::vector<std::uint8_t> held(displacement.size(), 0);
    for (const VertexId v : displacement.ids()) {
        double d = norm(displacement[v]);
        if (d > longest) {
            displacement[v] *= longest / d;
            held[index(v)] = 1;
            d = longest;
        }
        length[v] = d;
    }
    const double floor = kFloor * longest;
    if (!within_reach(length)) {
        constexpr double kRounding = 1e-9;  // of places and lengths, far above it
        reach_ = length;
        for (const VertexId v : later.ids()) reach_[v] += later[v];
        for (double& d : reach_) d *= 1.0 + 2.0 * kRounding;
        pairs_ = dangerous_pairs(mesh, reach_, floor);
        for (double& d : reach_) d /= 1.0 + kRounding;
    }
    Lengths allowed = held_by(pairs_, mesh, length);
    stop_at(floor, pairs_, mesh, displacement, length, allowed);
    for (const VertexId v : displacement.ids()) {
        if (allowed[v] < length[v]) {
            displacement[v] *= allowed[v] / length[v];
            held[index(v)] = 1;
        }
        reach_[v] -= allowed[v];
    }
    return static_cast<std::size_t>(std::count(held.begin(), held.end(), 1));
}

}  // namespace lamella::mesh::detail
