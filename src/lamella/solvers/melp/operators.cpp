#include "lamella/solvers/melp/operators.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/loops.h"

#include <algorithm>

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

/// add(i, k) for every picture k that particle i sees.
template <class Add>
void add_over_images(const Geometry& g, Add&& add) {
    if (g.images.empty()) return;
    parallel_blocks(g.size(), 256, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t k = g.images.begin(i); k < g.images.end(i); ++k) add(i, k);
    });
}

Vec3 image_gradient(const Geometry& g, std::span<const Vec3> x, std::size_t i, std::size_t k) {
    return (0.5 * g.area[g.images.index[k]] * g.images.laplacian[k]) * (g.images.place[k] - x[i]);
}

/// The velocity of picture k, and the vector there without the motion of the rim.
Vec3 image_of(const Geometry& g, std::span<const Vec3> w, std::size_t k) {
    return g.images.mirrors[g.images.mirror[k]].velocity(w[g.images.index[k]]);
}
Vec3 turned(const Geometry& g, std::span<const Vec3> w, std::size_t k) {
    return g.images.mirrors[g.images.mirror[k]].map * w[g.images.index[k]];
}

}  // namespace

std::vector<Vec3> gradient(const Geometry& g, std::span<const Vec3> x, std::span<const double> q) {
    auto result = sum_over_neighbors<Vec3>(g, [&](Vec3& sum, std::size_t i, std::size_t j, std::size_t k) {
        sum += (q[j] - q[i]) * weighted_gradient(g, x, i, j, k);
    });
    for_each_particle(result.size(), [&](std::size_t i) { result[i] = g.gradient_map[i] * result[i]; });
    return result;
}

std::vector<Tensor> gradient(const Geometry& g, std::span<const Vec3> x, std::span<const Vec3> w) {
    auto result = sum_over_neighbors<Tensor>(g, [&](Tensor& sum, std::size_t i, std::size_t j, std::size_t k) {
        const Vec3 along = weighted_gradient(g, x, i, j, k);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += (w[j][c] - w[i][c]) * along;
    });
    add_over_images(g, [&](std::size_t i, std::size_t k) {
        const Vec3 along = image_gradient(g, x, i, k);
        const Vec3 more = image_of(g, w, k) - w[i];
        for (std::size_t c = 0; c < 3; ++c) result[i][c] += more[c] * along;
    });
    const std::vector<Tensor>& map = g.images.empty() ? g.gradient_map : g.mirrored_map;
    for_each_particle(result.size(), [&](std::size_t i) {
        for (Vec3& row : result[i]) row = map[i] * row;
    });
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
    auto result = sum_over_neighbors<Vec3>(
        g, [&](Vec3& sum, std::size_t i, std::size_t j, std::size_t k) { sum += weighted_gradient(g, x, i, j, k); });
    add_over_images(g, [&](std::size_t i, std::size_t k) { result[i] += image_gradient(g, x, i, k); });
    return result;
}

std::vector<Vec3> roughness(const Geometry& g, std::span<const Vec3> w, Beyond beyond) {
    auto result = sum_over_neighbors<Vec3>(g, [&](Vec3& sum, std::size_t i, std::size_t j, std::size_t k) {
        sum += (g.area[j] * g.neighbors.same.weight[k]) * (w[i] - w[j]);
    });
    const auto picture = [&](std::size_t k) {
        return beyond == Beyond::kVelocity ? image_of(g, w, k) : turned(g, w, k);
    };
    add_over_images(g, [&](std::size_t i, std::size_t k) {
        result[i] += (g.area[g.images.index[k]] * g.images.weight[k]) * (w[i] - picture(k));
    });
    return result;
}

std::vector<Vec3> steady_normals(const Geometry& g, std::span<const Vec3> last) {
    // How much normals agree over the kernel is 0.87 on the ridge of a Plateau border (cos 30 degrees), 0.82 where a
    // film folds to 110 degrees. An average over the kernel would flatten borders, so it takes over below them only,
    // and in shreds, where fits have few neighbors.
    constexpr double kBorder = 0.86, kSharp = 0.80;
    constexpr std::size_t kFew = 8;
    auto mean = sum_over_neighbors<Vec3>(g, [&](Vec3& sum, std::size_t, std::size_t j, std::size_t k) {
        sum += (g.area[j] * g.neighbors.same.weight[k]) * g.normal[j];
    });
    add_over_images(g, [&](std::size_t i, std::size_t k) {
        mean[i] += (g.area[g.images.index[k]] * g.images.weight[k]) * g.images.normal[k];
    });
    const double own = g.neighbors.same.kernel.value(0.0);
    std::vector<Vec3> result(mean.size());
    for_each_particle(result.size(), [&](std::size_t i) {
        mean[i] += (g.area[i] * own) * g.normal[i];  // weights sum to one: areas are one over their sum
        const double agreement = norm(mean[i]);
        const std::size_t seen =
            g.neighbors.same.end(i) - g.neighbors.same.begin(i) + g.images.end(i) - g.images.begin(i);
        const double sharp = seen < kFew ? 1.0 : std::clamp((kBorder - agreement) / (kBorder - kSharp), 0.0, 1.0);
        const Vec3 fold = ((1.0 - sharp) * agreement) * g.normal[i] + sharp * mean[i];
        const Vec3 between = fold + norm(fold) * last[i];
        const double length = norm(between);
        result[i] = length > 0.0 ? between / length : last[i];
    });
    return result;
}

}  // namespace lamella::melp
