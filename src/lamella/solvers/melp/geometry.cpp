#include "lamella/solvers/melp/geometry.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/small_cholesky.h"

#include <algorithm>
#include <cmath>

namespace lamella::melp {

Frame frame_of(const Vec3& n) {
    // The branch keeps the divisor away from zero.
    const double sign = n[2] < 0.0 ? -1.0 : 1.0;
    const double a = -1.0 / (sign + n[2]);
    const double b = n[0] * n[1] * a;
    return {{{1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]}}, {{b, sign + n[1] * n[1] * a, -n[1]}}, n};
}

Patch fit_patch(std::span<const Vec3> position,
                const Vec3& frame_normal,
                const Neighbors& neighbors,
                const Images& images,
                std::size_t i,
                FitRow* row) {
    Patch patch{position[i], frame_of(frame_normal)};
    constexpr std::size_t kTerms = Patch::kTerms;
    if (neighbors.end(i) - neighbors.begin(i) + images.end(i) - images.begin(i) + 1 < kTerms) return patch;
    const double unit = neighbors.kernel.support_radius;
    FitMatrix matrix = empty_fit();
    std::array<double, kTerms> right{};
    const auto add = [&](const Vec3& place) {
        const FitPoint point = point_of(patch, place, 1.0 / unit);
        add_to_fit(point, matrix);
        for (std::size_t p = 0; p < kTerms; ++p) right[p] += point.weight * point.term[p] * point.z;
    };
    for (std::size_t k = neighbors.begin(i); k < neighbors.end(i); ++k) add(position[neighbors.index[k]]);
    for (std::size_t k = images.begin(i); k < images.end(i); ++k) add(images.place[k]);
    if (!linalg::factor_positive<kTerms>(matrix)) return patch;
    linalg::solve_factored<kTerms>(matrix, right);
    patch.c = {right[0] * unit, right[1], right[2], right[3] / unit, right[4] / unit, right[5] / unit};
    if (row != nullptr) {
        *row = {1.0};
        linalg::solve_factored<kTerms>(matrix, *row);
    }
    return patch;
}

PatchShape shape_of(const Patch& patch) {
    // Films that are resolved are less steep than this over their smooth normals; the fit at a sharp fold may tilt onto
    // one of its faces, and onto the other one in the next step.
    constexpr double kSteepest = 0.4;
    const auto& c = patch.c;
    const double zu = c[1], zv = c[2], zuu = 2.0 * c[3], zuv = c[4], zvv = 2.0 * c[5];
    const double g = 1.0 + zu * zu + zv * zv;
    const double sum = ((1.0 + zv * zv) * zuu - 2.0 * zu * zv * zuv + (1.0 + zu * zu) * zvv) / (g * std::sqrt(g));
    const double slope = std::sqrt(zu * zu + zv * zv), part = slope > kSteepest ? kSteepest / slope : 1.0;
    const Vec3 normal = patch.frame.normal - part * (zu * patch.frame.e1 + zv * patch.frame.e2);
    return {normal / norm(normal), sum};
}

namespace {

/// (sum_j a_j |grad W_ij| / |t| t t^T)^-1 in the tangent plane: what plain gradients of linear fields have to be
/// multiplied with. [method sheet 3 R]
Tensor gradient_map(std::span<const Vec3> position,
                    std::span<const double> area,
                    const Vec3& normal,
                    const Neighbors& neighbors,
                    const Images& images,
                    std::size_t i) {
    const Frame frame = frame_of(normal);
    double uu = 0.0, uv = 0.0, vv = 0.0;
    const auto add = [&](const Vec3& d, double w) {
        const double u = dot(frame.e1, d), v = dot(frame.e2, d);
        uu += w * u * u;
        uv += w * u * v;
        vv += w * v * v;
    };
    for (std::size_t k = neighbors.begin(i); k < neighbors.end(i); ++k) {
        const std::uint32_t j = neighbors.index[k];
        add(position[j] - position[i], 0.5 * area[j] * neighbors.laplacian[k]);
    }
    for (std::size_t k = images.begin(i); k < images.end(i); ++k)
        add(images.place[k] - position[i], 0.5 * area[images.index[k]] * images.laplacian[k]);
    // In the middle of a film this is the unit matrix. Neighbors on a line leave one direction unseen: no gradient
    // then.
    constexpr double kUnseen = 1e-3;
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > kUnseen * (uu + vv) * (uu + vv))) return {};
    const double iuu = vv / determinant, iuv = -uv / determinant, ivv = uu / determinant;
    const Vec3 row1 = iuu * frame.e1 + iuv * frame.e2, row2 = iuv * frame.e1 + ivv * frame.e2;
    Tensor map;
    for (std::size_t k = 0; k < 3; ++k) map[k] = frame.e1[k] * row1 + frame.e2[k] * row2;
    return map;
}

}  // namespace

Geometry geometry_of(const CoarseParticles& coarse, double support_radius, std::span<const RimPiece> rims) {
    Geometry g;
    g.neighbors = find_neighbors(coarse.position, coarse.frame_normal, coarse.region, support_radius);
    g.images = find_images(rims, coarse.position, coarse.frame_normal, coarse.region, support_radius);
    const Neighbors& same = g.neighbors.same;
    const Neighbors& other = g.neighbors.other;
    const auto meets_others = [&](std::size_t i) { return other.begin(i) != other.end(i); };
    const Images nothing;
    const std::size_t count = coarse.size();
    g.patch.resize(count);
    g.normal.resize(count);
    g.curvature.resize(count);
    g.area.resize(count);
    g.gradient_map.resize(count);
    g.star.resize(count);
    if (!other.index.empty()) g.fit_row.resize(count);
    constexpr std::size_t kBlock = 256;
    parallel_blocks(count, kBlock, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            g.patch[i] = fit_patch(coarse.position, coarse.frame_normal[i], same, g.images, i,
                                   meets_others(i) ? &g.fit_row[i] : nullptr);
            const PatchShape shape = shape_of(g.patch[i]);
            g.normal[i] = shape.normal;
            g.curvature[i] = shape.curvature;
            double density = same.kernel.value(0.0);
            for (std::size_t k = same.begin(i); k < same.end(i); ++k) density += same.weight[k];
            for (std::size_t k = g.images.begin(i); k < g.images.end(i); ++k) density += g.images.weight[k];
            g.area[i] = 1.0 / density;
        }
    });
    if (!g.images.empty()) g.mirrored_map.resize(count);
    parallel_blocks(count, kBlock, [&](std::size_t first, std::size_t last) {
        VoronoiCell cell;
        for (std::size_t i = first; i < last; ++i) {
            if (meets_others(i)) g.star[i] = star_of(coarse.position, g.normal, same, i, cell);
            g.gradient_map[i] = gradient_map(coarse.position, g.area, g.normal[i], same, nothing, i);
            if (!g.images.empty())
                g.mirrored_map[i] = gradient_map(coarse.position, g.area, g.normal[i], same, g.images, i);
        }
    });
    return g;
}

}  // namespace lamella::melp
