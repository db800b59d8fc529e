#include "lamella/solvers/melp/operators.h"

#include "lamella/core/parallel.h"

namespace lamella::melp {
namespace {

/// result[i] = term summed over the neighbors j of i; term(i, j, k) with k the place of the pair in the list.
template <class Value, class Term>
std::vector<Value> sum_over_neighbors(const Geometry& geometry, Term&& term) {
    const Neighbors& same = geometry.neighbors.same;
    std::vector<Value> result(geometry.size());
    parallel_blocks(geometry.size(), 256, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            Value sum{};
            for (std::size_t k = same.begin(i); k < same.end(i); ++k) term(sum, i, std::size_t{same.index[k]}, k);
            result[i] = sum;
        }
    });
    return result;
}

/// a_j grad W_ij, the gradient taken at i [1/m].
Vec3 weighted_gradient(const Geometry& g, std::span<const Vec3> x, std::size_t i, std::size_t j, std::size_t k) {
    return (0.5 * g.area[j] * g.neighbors.same.laplacian[k]) * (x[j] - x[i]);
}

}  // namespace

std::vector<Vec3> gradient(const Geometry& g, std::span<const Vec3> x, std::span<const double> q) {
    auto result = sum_over_neighbors<Vec3>(g, [&](Vec3& sum, std::size_t i, std::size_t j, std::size_t k) {
        sum += (q[j] - q[i]) * weighted_gradient(g, x, i, j, k);
    });
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = g.gradient_map[i] * result[i];
    return result;
}

std::vector<Tensor> gradient(const Geometry& g, std::span<const Vec3> x, std::span<const Vec3> w) {
    auto result = sum_over_neighbors<Tensor>(g, [&](Tensor& sum, std::size_t i, std::size_t j, std::size_t k) {
        const Vec3 along = weighted_gradient(g, x, i, j, k);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += (w[j][c] - w[i][c]) * along;
    });
    for (std::size_t i = 0; i < result.size(); ++i)
        for (Vec3& row : result[i]) row = g.gradient_map[i] * row;
    return result;
}

std::vector<double> divergence(const Geometry& g, std::span<const Vec3> x, std::span<const Vec3> w) {
    const std::vector<Tensor> rows = gradient(g, x, w);
    std::vector<double> result(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) result[i] = rows[i][0][0] + rows[i][1][1] + rows[i][2][2];
    return result;
}

std::vector<double> laplacian(const Geometry& g, std::span<const double> q) {
    return sum_over_neighbors<double>(g, [&](double& sum, std::size_t i, std::size_t j, std::size_t k) {
        sum += g.area[j] * g.neighbors.same.laplacian[k] * (q[j] - q[i]);
    });
}

std::vector<Vec3> unevenness(const Geometry& g, std::span<const Vec3> x) {
    return sum_over_neighbors<Vec3>(
        g, [&](Vec3& sum, std::size_t i, std::size_t j, std::size_t k) { sum += weighted_gradient(g, x, i, j, k); });
}

std::vector<Vec3> roughness(const Geometry& g, std::span<const Vec3> w) {
    return sum_over_neighbors<Vec3>(g, [&](Vec3& sum, std::size_t i, std::size_t j, std::size_t k) {
        sum += (g.area[j] * g.neighbors.same.weight[k]) * (w[i] - w[j]);
    });
}

}  // namespace lamella::melp
