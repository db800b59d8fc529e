#include "lamella/solvers/equilibrium/normal_space.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/dense.h"
#include "lamella/solvers/equilibrium/patch_energy.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace lamella::equilibrium {
namespace {

/// Which corners (3 f + k) belong to the same sheet: joined across edges with two faces.
class Sheets {
public:
    Sheets(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges) : parent_(3 * mesh.faces.size()) {
        std::iota(parent_.begin(), parent_.end(), 0U);
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const auto uses = edges.of(e);
            if (uses.size() != 2) continue;
            join(corner(uses[0], true), corner(uses[1], true));
            join(corner(uses[0], false), corner(uses[1], false));
        }
    }
    std::uint32_t of(std::uint32_t c) {
        while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
        return c;
    }

private:
    /// The corner of a face at the lower or higher end of an edge.
    static std::uint32_t corner(const mesh::EdgeUse& use, bool low) {
        const std::uint32_t tail = (use.opposite + 1) % 3, head = (use.opposite + 2) % 3;
        return static_cast<std::uint32_t>(3 * index(use.face)) + (use.forward == low ? tail : head);
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = of(a);
        b = of(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }
    std::vector<std::uint32_t> parent_;
};

/// Unknowns per node, by the triple edges at it.
std::vector<std::size_t> dimensions(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, const Patches& patches) {
    std::vector<std::size_t> lines(patches.position.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges.of(e).size() < 3) continue;
        ++lines[index(edges.edge[e].a)];
        ++lines[index(edges.edge[e].b)];
        if (patches.nodes_per_patch == 6) lines[mesh.position.size() + e] = 2;  // of the line through it
    }
    std::vector<std::size_t> dimension(lines.size());
    for (std::size_t node = 0; node < lines.size(); ++node)
        dimension[node] = patches.fixed[node] != 0 ? 0 : lines[node] == 0 ? 1 : lines[node] == 2 ? 2 : 3;
    return dimension;
}

}  // namespace

NormalSpace::NormalSpace(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, const Patches& patches) {
    Sheets sheets(mesh, edges);
    const auto per_patch = static_cast<std::size_t>(patches.nodes_per_patch);
    for (std::size_t p = 0; p < patches.size(); ++p) {
        const auto sign = static_cast<std::int8_t>(patches.back[p] < patches.front[p] ? 1 : -1);
        for (std::size_t k = 0; k < per_patch; ++k) {
            const std::uint32_t node = patches.nodes[p][k];
            if (patches.fixed[node] != 0) continue;
            std::uint32_t sheet = static_cast<std::uint32_t>(p);  // on a triple line every patch is a sheet
            if (k < 3) sheet = sheets.of(static_cast<std::uint32_t>(3 * p + k));
            else if (edges.of(node - mesh.position.size()).size() == 2) sheet = 0;
            corners_.push_back({node, sheet, static_cast<std::uint32_t>(p), static_cast<std::uint8_t>(k), sign});
        }
    }
    std::sort(corners_.begin(), corners_.end(), [](const Corner& a, const Corner& b) {
        return std::tie(a.node, a.sheet, a.patch, a.k) < std::tie(b.node, b.sheet, b.patch, b.k);
    });
    corner_start_.assign(patches.position.size() + 1, 0);
    for (const Corner& c : corners_) ++corner_start_[c.node + 1];
    std::partial_sum(corner_start_.begin(), corner_start_.end(), corner_start_.begin());

    first_.assign(1, 0);
    for (const std::size_t d : dimensions(mesh, edges, patches)) first_.push_back(first_.back() + d);
    // A vertex that no face uses has no directions.
    for (std::size_t node = 0, dropped = 0; node < patches.position.size(); ++node) {
        const std::size_t d = first_[node + 1] - (first_[node] + dropped);
        if (corner_start_[node] == corner_start_[node + 1]) dropped += d;
        first_[node + 1] -= dropped;
    }
    basis_.resize(first_.back());
    update(patches);
}

void NormalSpace::update(const Patches& patches) {
    std::array<ShapePoint, 6> shape;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto [u, v] = node_place(k);
        shape[k] = shape_at(patches.nodes_per_patch, u, v);
    }
    const auto normal_at = [&](const Corner& c) {
        const std::array<Vec3, 6> x = patches.corners(c.patch);
        Vec3 a, b;
        for (std::size_t i = 0; i < static_cast<std::size_t>(patches.nodes_per_patch); ++i) {
            a += shape[c.k].along_u[i] * x[i];
            b += shape[c.k].along_v[i] * x[i];
        }
        return c.sign * cross(a, b);
    };
    parallel_blocks(nodes(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t node = begin; node < end; ++node) {
            const std::size_t d = dimension(node);
            if (d == 3) {
                for (std::size_t k = 0; k < 3; ++k) {
                    basis_[first_[node] + k] = {};
                    basis_[first_[node] + k][k] = 1.0;
                }
                continue;
            }
            if (d == 0) continue;
            Matrix3 spread{};
            for (std::size_t c = corner_start_[node]; c < corner_start_[node + 1];) {
                Vec3 n;
                const std::uint32_t sheet = corners_[c].sheet;
                for (; c < corner_start_[node + 1] && corners_[c].sheet == sheet; ++c) n += normal_at(corners_[c]);
                for (std::size_t r = 0; r < 3; ++r) spread[r] += n[r] * n;
            }
            const linalg::Eigen3 pairs = linalg::eigenpairs(spread);
            for (std::size_t k = 0; k < d; ++k) basis_[first_[node] + k] = pairs.vector[2 - k];
        }
    });
}

std::vector<Vec3> NormalSpace::expand(std::span<const double> x) const {
    std::vector<Vec3> vectors(nodes());
    for (std::size_t node = 0; node < nodes(); ++node)
        for (std::size_t i = first_[node]; i < first_[node + 1]; ++i) vectors[node] += x[i] * basis_[i];
    return vectors;
}

std::vector<double> NormalSpace::restrict(std::span<const Vec3> vectors) const {
    std::vector<double> x(size());
    for (std::size_t node = 0; node < nodes(); ++node)
        for (std::size_t i = first_[node]; i < first_[node + 1]; ++i) x[i] = dot(basis_[i], vectors[node]);
    return x;
}

}  // namespace lamella::equilibrium
