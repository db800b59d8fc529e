#pragma once

#include "lamella/core/parallel.h"
#include "lamella/mesh/detail/edit_mesh.h"

#include <algorithm>
#include <vector>

namespace lamella::mesh::detail {

/// An edge that a pass may change.
struct CandidateEdge {
    double squared_length;
    VertexId v, w;  ///< v < w
};

/// Edges that some face at them wants changed: wanted(squared length, v, w, opposite vertex). Each once, in the order
/// of their lengths, ids as tie breakers. Edges of wires are left out.
template <class Wanted, class Before>
std::vector<CandidateEdge> candidate_edges(const EditMesh& mesh, Wanted&& wanted, Before&& before) {
    const auto collect = [&](std::size_t begin, std::size_t end) {
        std::vector<CandidateEdge> found;
        for (std::size_t i = begin; i < end; ++i) {
            const auto f = static_cast<FaceId>(i);
            if (!mesh.alive(f)) continue;
            const auto& u = mesh.face(f).vertices;
            for (std::size_t k = 0; k < 3; ++k) {
                const VertexId v = u[k];
                const VertexId w = u[(k + 1) % 3];
                if (mesh.on_wire(v) && mesh.on_wire(w)) continue;
                // From the lower end, so that all faces of an edge see the same bits.
                const double squared = squared_norm(mesh.at(std::max(v, w)) - mesh.at(std::min(v, w)));
                if (wanted(squared, v, w, u[(k + 2) % 3])) found.push_back({squared, std::min(v, w), std::max(v, w)});
            }
        }
        return found;
    };
    const auto join = [](std::vector<CandidateEdge> a, const std::vector<CandidateEdge>& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    };
    constexpr std::size_t kBlock = 2048;
    std::vector<CandidateEdge> edges =
        parallel_reduce(mesh.mesh().faces.size(), std::vector<CandidateEdge>{}, collect, join, kBlock);
    std::sort(edges.begin(), edges.end(), [&](const CandidateEdge& a, const CandidateEdge& b) {
        if (a.squared_length != b.squared_length) return before(a.squared_length, b.squared_length);
        return a.v != b.v ? a.v < b.v : a.w < b.w;
    });
    const auto same = [](const CandidateEdge& a, const CandidateEdge& b) { return a.v == b.v && a.w == b.w; };
    edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
    return edges;
}

}  // namespace lamella::mesh::detail
