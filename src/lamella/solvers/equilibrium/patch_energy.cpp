#include "lamella/solvers/equilibrium/patch_energy.h"

#include <cmath>

namespace lamella::equilibrium {
namespace {

/// Where a patch is integrated.
struct Quadrature {
    std::size_t nodes, points;
    std::array<ShapePoint, 7> point;
};

ShapePoint weighted(int nodes, double u, double v, double weight) {
    ShapePoint point = shape_at(nodes, u, v);
    point.weight = weight;
    return point;
}

Quadrature center_rule() {
    Quadrature rule{3, 1, {}};
    rule.point[0] = weighted(3, 1.0 / 3.0, 1.0 / 3.0, 0.5);
    return rule;
}

Quadrature seven_point_rule() {
    const double root = std::sqrt(15.0);
    Quadrature rule{6, 7, {}};
    rule.point[0] = weighted(6, 1.0 / 3.0, 1.0 / 3.0, 9.0 / 80.0);
    std::size_t k = 1;
    for (const double sign : {-1.0, 1.0}) {
        const double a = (6.0 + sign * root) / 21.0;
        const double w = (155.0 + sign * root) / 2400.0;
        rule.point[k++] = weighted(6, a, a, w);
        rule.point[k++] = weighted(6, 1.0 - 2.0 * a, a, w);
        rule.point[k++] = weighted(6, a, 1.0 - 2.0 * a, w);
    }
    return rule;
}

const Quadrature& quadrature(int nodes_per_patch) {
    static const Quadrature center = center_rule();
    static const Quadrature seven = seven_point_rule();
    return nodes_per_patch == 3 ? center : seven;
}

struct LocalFrame {
    Vec3 s, a, b, n;
};

LocalFrame frame_at(const ShapePoint& q, std::size_t nodes, const std::array<Vec3, 6>& x) {
    LocalFrame f;
    for (std::size_t i = 0; i < nodes; ++i) {
        f.s += q.shape[i] * x[i];
        f.a += q.along_u[i] * x[i];
        f.b += q.along_v[i] * x[i];
    }
    f.n = cross(f.a, f.b);
    return f;
}

/// m += [c]x, the matrix of w -> c x w.
void add_cross(Matrix3& m, const Vec3& c) {
    m[0][1] -= c[2];
    m[0][2] += c[1];
    m[1][0] += c[2];
    m[1][2] -= c[0];
    m[2][0] -= c[1];
    m[2][1] += c[0];
}

}  // namespace

ShapePoint shape_at(int nodes_per_patch, double u, double v) {
    const double w = 1.0 - u - v;
    if (nodes_per_patch == 3) return {0.0, {w, u, v}, {-1.0, 1.0, 0.0}, {-1.0, 0.0, 1.0}};
    return {0.0,
            {w * (2.0 * w - 1.0), u * (2.0 * u - 1.0), v * (2.0 * v - 1.0), 4.0 * w * u, 4.0 * u * v, 4.0 * v * w},
            {1.0 - 4.0 * w, 4.0 * u - 1.0, 0.0, 4.0 * (w - u), 4.0 * v, -4.0 * v},
            {1.0 - 4.0 * w, 0.0, 4.0 * v - 1.0, -4.0 * u, 4.0 * u, 4.0 * (w - v)}};
}

std::array<double, 2> node_place(std::size_t k) {
    constexpr std::array<std::array<double, 2>, 6> place{{{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}};
    return place[k];
}

PatchMeasures measure_patch(int nodes_per_patch, const std::array<Vec3, 6>& x) {
    const Quadrature& rule = quadrature(nodes_per_patch);
    PatchMeasures m;
    for (std::size_t p = 0; p < rule.points; ++p) {
        const ShapePoint& q = rule.point[p];
        const LocalFrame f = frame_at(q, rule.nodes, x);
        const double j = norm(f.n);
        m.area += q.weight * j;
        m.volume += q.weight / 3.0 * dot(f.s, f.n);
        m.area_vector += q.weight * f.n;
        const Vec3 normal = (j > 0.0 ? 1.0 / j : 0.0) * f.n;
        const Vec3 along_a = cross(f.b, normal);
        const Vec3 along_b = cross(normal, f.a);
        for (std::size_t i = 0; i < rule.nodes; ++i) {
            m.area_slope[i] += q.weight * (q.along_u[i] * along_a + q.along_v[i] * along_b);
            m.flux[i] += (q.weight * q.shape[i]) * f.n;
        }
    }
    return m;
}

void patch_hessian(int nodes_per_patch,
                   const std::array<Vec3, 6>& x,
                   double tension,
                   double pressure,
                   std::array<Matrix3, 36>& block) {
    const Quadrature& rule = quadrature(nodes_per_patch);
    for (std::size_t i = 0; i < rule.nodes; ++i)
        for (std::size_t j = 0; j <= i; ++j) block[i * 6 + j] = {};
    for (std::size_t p = 0; p < rule.points; ++p) {
        const ShapePoint& q = rule.point[p];
        const LocalFrame f = frame_at(q, rule.nodes, x);
        const double j = norm(f.n);
        const Vec3 normal = (1.0 / j) * f.n;
        const double aa = squared_norm(f.a), bb = squared_norm(f.b), ab = dot(f.a, f.b);
        for (std::size_t k = 0; k < rule.nodes; ++k)
            for (std::size_t l = 0; l <= k; ++l) {
                const double uu = q.along_u[k] * q.along_u[l], vv = q.along_v[k] * q.along_v[l];
                const double uv = q.along_u[k] * q.along_v[l], vu = q.along_v[k] * q.along_u[l];
                const double scale = q.weight * tension / j * (bb * uu + aa * vv - ab * (uv + vu));
                Matrix3& m = block[k * 6 + l];
                for (std::size_t r = 0; r < 3; ++r) m[r] += (scale * normal[r]) * normal;
                // The rest are cross products: (a_k, b_l) -[N]x, (b_k, a_l) +[N]x, and d flux_k / d x_l, made symmetric.
                Vec3 turn = (-q.weight * tension * (uv - vu)) * normal;
                const double sa = q.shape[k] * q.along_u[l] - q.along_u[k] * q.shape[l];
                const double sb = q.shape[k] * q.along_v[l] - q.along_v[k] * q.shape[l];
                turn += (q.weight * 0.5 * pressure) * (sa * f.b - sb * f.a);
                add_cross(m, turn);
            }
    }
}

}  // namespace lamella::equilibrium
