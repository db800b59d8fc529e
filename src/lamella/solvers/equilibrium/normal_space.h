#pragma once

#include "lamella/mesh/edge_faces.h"
#include "lamella/solvers/equilibrium/patches.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::equilibrium {

/// The directions in which moving a node changes the shape of a film: one inside a film, the two across a triple line,
/// all three where lines meet, none on a wire. Moves along a film or a line only slide the mesh; left among the
/// unknowns they make Newton's method degenerate (docs/equilibrium.md).
///
/// Per node: the faces around it fall into sheets, joined across edges with two faces; each sheet has an area normal
/// n_s; the directions are the leading eigenvectors of sum n_s n_s^T.
class NormalSpace {
public:
    NormalSpace(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, const Patches& patches);

    /// Directions of the patches' present shape. Their number per node never changes.
    void update(const Patches& patches);

    std::size_t size() const { return basis_.size(); }  ///< unknowns
    std::size_t nodes() const { return first_.size() - 1; }
    std::size_t first(std::size_t node) const { return first_[node]; }
    std::size_t dimension(std::size_t node) const { return first_[node + 1] - first_[node]; }
    std::span<const Vec3> at(std::size_t node) const {
        return std::span(basis_).subspan(first_[node], dimension(node));
    }

    /// One displacement per node from one value per unknown.
    std::vector<Vec3> expand(std::span<const double> x) const;
    /// One value per unknown from one vector per node.
    std::vector<double> restrict(std::span<const Vec3> vectors) const;

private:
    /// Node k of a patch, as part of a sheet; ordered by node, then sheet.
    struct Corner {
        std::uint32_t node, sheet, patch;
        std::uint8_t k;
        std::int8_t sign;  // makes the normals of a sheet agree: they point to the region with the higher number
    };
    std::vector<Corner> corners_;
    std::vector<std::size_t> corner_start_;  // per node
    std::vector<std::size_t> first_;         // nodes + 1
    std::vector<Vec3> basis_;
};

}  // namespace lamella::equilibrium
