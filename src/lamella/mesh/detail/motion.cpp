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
constexpr std::size_t kFacesPerBlock = 256;

/// Whether the boxes of two sets of points come closer than `reach` along every axis. It spares most exact distances: of
/// the primitives of two faces whose boxes meet nine in ten are farther apart than they move.
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

struct Limit {
    VertexId vertex;
    double distance;
};

/// Each vertex and each edge belongs to the lowest face that has it, so that every pair is looked at once.
struct Owned {
    std::uint8_t vertices = 0, edges = 0;  // bit k: corner k, edge from corner k to the next
};

class PairLimits {
public:
    PairLimits(const EditMesh& mesh, const IdVector<VertexId, double>& length);
    /// Appends the limits that two faces put on each other.
    void of_pair(FaceId f, FaceId g, std::vector<Limit>& limits) const;
    /// Every face in a box that meets the box of each face it could reach.
    std::vector<FacePairs::Item> boxes() const;

private:
    double most(const Face& face) const {
        return std::max({length_[face.vertices[0]], length_[face.vertices[1]], length_[face.vertices[2]]});
    }
    void vertices_against_face(FaceId f, FaceId g, std::vector<Limit>& limits) const;

    const EditMesh& mesh_;
    const IdVector<VertexId, double>& length_;
    IdVector<FaceId, Owned> owned_;
};

PairLimits::PairLimits(const EditMesh& mesh, const IdVector<VertexId, double>& length)
    : mesh_(mesh), length_(length), owned_(mesh.mesh().faces.size()) {
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

void PairLimits::vertices_against_face(FaceId f, FaceId g, std::vector<Limit>& limits) const {
    if (owned_[f].vertices == 0) return;
    const Face& face = mesh_.face(g);
    const auto t = mesh_.corners(g);
    const double most_g = most(face);
    for (std::size_t k = 0; k < 3; ++k) {
        const VertexId v = mesh_.face(f).vertices[k];
        if (!((owned_[f].vertices >> k) & 1U) || face.has(v)) continue;
        const double together = length_[v] + most_g;
        if (!boxes_near<1, 3>({mesh_.at(v)}, t, together / kTogether)) continue;
        const double squared = geometry::squared_distance_to_triangle(mesh_.at(v), t[0], t[1], t[2]);
        if (together * together <= kTogether * kTogether * squared) continue;
        const double allowed = 0.5 * kTogether * std::sqrt(squared);
        for (const VertexId w : {v, face.vertices[0], face.vertices[1], face.vertices[2]})
            limits.push_back({w, allowed});
    }
}

void PairLimits::of_pair(FaceId f, FaceId g, std::vector<Limit>& limits) const {
    vertices_against_face(f, g, limits);
    vertices_against_face(g, f, limits);
    if (owned_[f].edges == 0 || owned_[g].edges == 0) return;
    const auto& u = mesh_.face(f).vertices;
    const auto& v = mesh_.face(g).vertices;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!((owned_[f].edges >> i) & 1U)) continue;
        const VertexId a = u[i];
        const VertexId b = u[(i + 1) % 3];
        const double most_f = std::max(length_[a], length_[b]);
        for (std::size_t j = 0; j < 3; ++j) {
            const VertexId c = v[j];
            const VertexId d = v[(j + 1) % 3];
            if (!((owned_[g].edges >> j) & 1U) || a == c || a == d || b == c || b == d) continue;
            const double together = most_f + std::max(length_[c], length_[d]);
            if (!boxes_near<2, 2>({mesh_.at(a), mesh_.at(b)}, {mesh_.at(c), mesh_.at(d)}, together / kTogether)) continue;
            const double squared =
                geometry::squared_distance_of_segments(mesh_.at(a), mesh_.at(b), mesh_.at(c), mesh_.at(d));
            if (together * together <= kTogether * kTogether * squared) continue;
            const double allowed = 0.5 * kTogether * std::sqrt(squared);
            for (const VertexId w : {a, b, c, d}) limits.push_back({w, allowed});
        }
    }
}

std::vector<FacePairs::Item> PairLimits::boxes() const {
    const std::size_t faces = mesh_.mesh().faces.size();
    std::vector<FacePairs::Item> items(faces);
    parallel_for(faces, [&](std::size_t i) {
        const FaceId f = static_cast<FaceId>(i);
        items[i] = {f, mesh_.box(f).inflated(most(mesh_.face(f)) / kTogether)};
    });
    return items;
}

}  // namespace

std::size_t limit_displacement(const EditMesh& mesh, double longest, IdVector<VertexId, Vec3>& displacement) {
    IdVector<VertexId, double> length(displacement.size());
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
    const PairLimits limits_of(mesh, length);
    const FacePairs pairs(limits_of.boxes());
    std::vector<std::vector<Limit>> limits((pairs.size() + kFacesPerBlock - 1) / kFacesPerBlock);
    parallel_blocks(pairs.size(), kFacesPerBlock, [&](std::size_t begin, std::size_t end) {
        auto& block = limits[begin / kFacesPerBlock];
        pairs.for_each(begin, end, [&](FaceId f, FaceId g) { limits_of.of_pair(f, g, block); });
    });
    IdVector<VertexId, double> allowed = length;
    for (const auto& block : limits)
        for (const Limit& limit : block) allowed[limit.vertex] = std::min(allowed[limit.vertex], limit.distance);
    std::size_t count = 0;
    for (const VertexId v : displacement.ids()) {
        if (allowed[v] < length[v]) {
            displacement[v] *= allowed[v] / length[v];
            held[index(v)] = 1;
        }
        count += held[index(v)];
    }
    return count;
}

}  // namespace lamella::mesh::detail
