#include "lamella/solvers/melp/geometry.h"

#include "lamella/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace lamella::melp {

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
        const std::span<FitRow> row = other.index.empty() ? std::span<FitRow>{} : std::span(g.fit_row);
        fit_patches(coarse.position, coarse.frame_normal, same, g.images, first,
                    std::span(g.patch).subspan(first, last - first), row.empty() ? row : row.subspan(first));
        for (std::size_t i = first; i < last; ++i) {
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
