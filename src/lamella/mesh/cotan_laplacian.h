#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <cstddef>
#include <vector>

namespace lamella::mesh {

/// A symmetric matrix over vertices in compressed rows; columns of a row ascend and include the diagonal.
struct VertexMatrix {
    std::vector<std::size_t> start;  ///< #V + 1
    std::vector<VertexId> column;
    std::vector<double> value;

    /// The product with one value per vertex, of a type with + and a product with a number.
    template <class T>
    IdVector<VertexId, T> operator*(const IdVector<VertexId, T>& x) const {
        IdVector<VertexId, T> y(x.size());
        for (const VertexId v : x.ids())
            for (std::size_t i = start[index(v)]; i < start[index(v) + 1]; ++i) y[v] += value[i] * x[column[i]];
        return y;
    }
};

/// Stiffness matrix of linear elements on the films: the cotangent Laplacian without a mass matrix.
///
///   L_ij = -1/2 sum cot(angle opposite to edge ij, in each face at it),   L_ii = -sum_j L_ij
///
/// Positive semi-definite, rows sum to zero, x L x / 2 is the Dirichlet energy. All faces at an edge count, so at a
/// triple line it is the Laplacian of a function that is continuous across all three films. Its product with the
/// positions is the area gradient (unless the foam is periodic). A face without area contributes nothing. A vertex
/// without faces has an empty row.
/// @see [PinkallPolthier93]
VertexMatrix cotan_laplacian(const FoamMesh& mesh);

}  // namespace lamella::mesh
