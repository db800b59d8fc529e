#include "lamella/render/detail/curved_film.h"

#include "lamella/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace lamella::render::detail {
namespace {

using Ends = std::array<std::uint32_t, 2>;

/// The inner control points of a border edge's cubic, beside its first and its second end.
struct BorderCurve {
    Ends ends;
    Vec3 first, second;
};

std::array<float, 3> narrow(const Vec3& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// Tangents at the points of the borders where just two edges meet without a corner: along the line from the point
/// before to the point after. Elsewhere the edge bends as its other end says.
std::vector<BorderCurve> border_curves(const FilmPatches& patches) {
    std::vector<std::vector<std::uint32_t>> neighbors(patches.point.size());
    for (const BorderEdge& edge : patches.borders)
        for (std::size_t k = 0; k < 2; ++k) neighbors[edge.ends[k]].push_back(edge.ends[1 - k]);
    const auto tangent = [&](std::uint32_t from,
                             std::uint32_t to) -> Vec3 {  // unit, towards `to`; zero: none of its own
        if (neighbors[from].size() != 2) return {};
        const std::uint32_t before = neighbors[from][0] == to ? neighbors[from][1] : neighbors[from][0];
        const Vec3 in = patches.point[from] - patches.point[before], out = patches.point[to] - patches.point[from];
        constexpr double kCorner = 0.7;  // cosine: a polygon of 8 corners is a circle, a square is a square
        if (dot(in, out) < kCorner * norm(in) * norm(out)) return {};
        const Vec3 along = in / norm(in) + out / norm(out);
        return along / norm(along);
    };
    std::vector<BorderCurve> curves;
    for (const BorderEdge& edge : patches.borders) {
        const Vec3 a = patches.point[edge.ends[0]], b = patches.point[edge.ends[1]];
        const Vec3 chord = b - a;
        const Vec3 straight = chord / norm(chord);
        Vec3 at_a = tangent(edge.ends[0], edge.ends[1]), at_b = -tangent(edge.ends[1], edge.ends[0]);
        const auto mirrored = [&](const Vec3& t) { return 2.0 * dot(t, straight) * straight - t; };
        const bool free_a = squared_norm(at_a) == 0.0, free_b = squared_norm(at_b) == 0.0;
        if (free_a) at_a = free_b ? straight : mirrored(at_b);
        if (free_b) at_b = free_a ? straight : mirrored(at_a);
        curves.push_back({edge.ends, a + norm(chord) / 3.0 * at_a, b - norm(chord) / 3.0 * at_b});
    }
    return curves;  // in the order of the edges, which is sorted by ends
}

const BorderCurve* find_curve(const std::vector<BorderCurve>& curves, const Ends& ends) {
    const auto it = std::lower_bound(curves.begin(), curves.end(), ends,
                                     [](const BorderCurve& c, const Ends& e) { return c.ends < e; });
    return it != curves.end() && it->ends == ends ? &*it : nullptr;
}

/// Ten control points of a cubic triangle: corners, two per edge, one in the middle.
struct Patch {
    std::array<Vec3, 3> corner, normal;
    std::array<std::array<Vec3, 2>, 3> edge;  ///< edge k runs from corner k to corner k + 1
    Vec3 middle;

    Vec3 at(double u, double v) const {  // weights of corners 1 and 2
        const double w = 1.0 - u - v;
        const std::array<double, 3> b{w, u, v};
        Vec3 p = 6.0 * b[0] * b[1] * b[2] * middle;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            p += b[k] * b[k] * b[k] * corner[k];
            p += 3.0 * b[k] * b[k] * b[next] * edge[k][0] + 3.0 * b[k] * b[next] * b[next] * edge[k][1];
        }
        return p;
    }
};

Patch curved_patch(const FilmPatches& patches, const std::vector<BorderCurve>& curves, std::size_t t) {
    Patch patch;
    std::array<std::uint32_t, 3> point{};
    for (std::size_t k = 0; k < 3; ++k) {
        point[k] = patches.corner_point[patches.triangles[t][k]];
        patch.corner[k] = patches.point[point[k]];
        patch.normal[k] = patches.corner_normal[patches.triangles[t][k]];
    }
    Vec3 edges, corners;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        const Vec3 &a = patch.corner[k], &b = patch.corner[next];
        const bool forward = point[k] < point[next];
        if (const BorderCurve* curve =
                find_curve(curves, {std::min(point[k], point[next]), std::max(point[k], point[next])})) {
            patch.edge[k] = forward ? std::array{curve->first, curve->second} : std::array{curve->second, curve->first};
        } else {
            patch.edge[k][0] = (2.0 * a + b - dot(b - a, patch.normal[k]) * patch.normal[k]) / 3.0;
            patch.edge[k][1] = (2.0 * b + a - dot(a - b, patch.normal[next]) * patch.normal[next]) / 3.0;
        }
        edges += (patch.edge[k][0] + patch.edge[k][1]) / 6.0;
        corners += patch.corner[k] / 3.0;
    }
    patch.middle = edges + 0.5 * (edges - corners);
    return patch;
}

}  // namespace

FineFilms refine_films(const FilmPatches& patches, const std::vector<std::array<double, 3>>& value, int pieces) {
    const std::vector<BorderCurve> curves = border_curves(patches);
    const auto n = static_cast<std::size_t>(pieces);
    const std::size_t points = (n + 1) * (n + 2) / 2, parts = n * n;
    FineFilms fine;
    fine.position.resize(points * patches.triangles.size());
    fine.normal.resize(fine.position.size());
    fine.value.resize(fine.position.size());
    fine.triangles.resize(parts * patches.triangles.size());
    fine.coarse.resize(fine.triangles.size());
    parallel_for(patches.triangles.size(), [&](std::size_t t) {
        const Patch patch = curved_patch(patches, curves, t);
        std::size_t p = points * t, f = parts * t;
        const auto first = static_cast<std::uint32_t>(p);
        const auto number = [&](std::size_t i, std::size_t j) {  // row i of n + 1 has n + 1 - i points
            return first + static_cast<std::uint32_t>(i * (n + 1) + j - (i > 0 ? i * (i - 1) / 2 : 0));
        };
        for (std::size_t i = 0; i <= n; ++i)
            for (std::size_t j = 0; j + i <= n; ++j, ++p) {
                const double v = static_cast<double>(i) / static_cast<double>(n),
                             u = static_cast<double>(j) / static_cast<double>(n);
                const double w = 1.0 - u - v;
                const Vec3 normal = w * patch.normal[0] + u * patch.normal[1] + v * patch.normal[2];
                fine.position[p] = narrow(patch.at(u, v));
                fine.normal[p] = narrow(normal / std::max(norm(normal), 1e-30));
                fine.value[p] = static_cast<float>(w * value[t][0] + u * value[t][1] + v * value[t][2]);
                if (i == n || i + j == n) continue;
                fine.coarse[f] = static_cast<std::uint32_t>(t);
                fine.triangles[f++] = {number(i, j), number(i, j + 1), number(i + 1, j)};
                if (i + j + 1 == n) continue;
                fine.coarse[f] = static_cast<std::uint32_t>(t);
                fine.triangles[f++] = {number(i, j + 1), number(i + 1, j + 1), number(i + 1, j)};
            }
    });
    return fine;
}

std::vector<Thread> refine_borders(const FilmPatches& patches, int pieces) {
    const std::vector<BorderCurve> curves = border_curves(patches);
    std::vector<Thread> threads;
    for (std::size_t e = 0; e < curves.size(); ++e) {
        const Vec3 a = patches.point[curves[e].ends[0]], b = patches.point[curves[e].ends[1]];
        Thread thread;
        thread.wire = patches.borders[e].on_wire;
        thread.rim = patches.borders[e].films == 1 && !thread.wire;
        for (int i = 0; i <= pieces; ++i) {
            const double s = static_cast<double>(i) / pieces, r = 1.0 - s;
            thread.points.push_back(r * r * r * a + 3.0 * r * r * s * curves[e].first +
                                    3.0 * r * s * s * curves[e].second + s * s * s * b);
        }
        threads.push_back(std::move(thread));
    }
    return threads;
}

}  // namespace lamella::render::detail
