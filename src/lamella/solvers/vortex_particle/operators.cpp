#include "lamella/solvers/vortex_particle/operators.h"

#include "lamella/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace lamella::vortex_particle {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Values of vertices, each gathered from the triangles around it in their order.
template <class Term>
std::vector<double> gathered(const Surface& s, Term&& term) {
    std::vector<double> sum(s.vertices());
    parallel_for(s.vertices(), [&](std::size_t v) {
        double total = 0.0;
        for (const Incidence& at : s.around(v)) total += term(at.triangle, at.k);
        sum[v] = total;
    });
    return sum;
}

/// Of each vertex, from along(t, k), the line integral over the edge of t opposite to corner k: a third of the integral
/// around the triangles at the vertex, whose area is three times that of its cell. Walls at the vertex close the loop.
template <class Along>
std::vector<double> circulation_of_rings(const Surface& s, Along&& along) {
    return gathered(s, [&](std::size_t t, std::size_t k) {
        double sum = along(t, k);
        for (const std::size_t wall : {(k + 1) % 3, (k + 2) % 3})
            if (s.neighbor[t][wall] == kNoNeighbor) sum += along(t, wall);
        return sum / 3.0;
    });
}

/// (b - a) / (ln b - ln a), the mean for which the gradient of a logarithm is exact.
double logarithmic_mean(double a, double b) {
    const double x = (b - a) / (b + a);
    if (std::abs(x) < 1e-2) return 0.5 * (a + b) / (1.0 + x * x * (1.0 / 3.0 + x * x * (0.2 + x * x / 7.0)));
    return (b - a) / std::log(b / a);
}

/// The line integral of -strength grad Gamma / eta from a to b.
double along_edge(double surfactant_a, double surfactant_b, double thickness_a, double thickness_b, double strength) {
    return -strength * (surfactant_b - surfactant_a) / logarithmic_mean(thickness_a, thickness_b);
}

}  // namespace

std::vector<Vec3> gradient(const Surface& s, std::span<const double> p) {
    std::vector<Vec3> u(s.triangles());
    parallel_for(s.triangles(), [&](std::size_t t) {
        for (std::size_t k = 0; k < 3; ++k) u[t] += p[s.corner[t][k]] * s.hat_slope[t][k];
    });
    return u;
}

std::vector<Vec3> rotated_gradient(const Surface& s, std::span<const double> p) {
    std::vector<Vec3> u = gradient(s, p);
    parallel_for(s.triangles(), [&](std::size_t t) { u[t] = cross(s.normal[t], u[t]); });
    return u;
}

std::vector<double> divergence(const Surface& s, std::span<const Vec3> u) {
    return gathered(s, [&](std::size_t t, std::size_t k) { return -s.area[t] * dot(s.hat_slope[t][k], u[t]); });
}

std::vector<double> curl(const Surface& s, std::span<const Vec3> u) {
    return gathered(s, [&](std::size_t t, std::size_t k) { return 0.5 * dot(u[t], s.edge(t, k)); });
}

std::vector<double> closed_curl(const Surface& s, std::span<const Vec3> u) {
    return gathered(s, [&](std::size_t t, std::size_t k) {
        double sum = dot(u[t], s.edge(t, k));
        for (const std::size_t wall : {(k + 1) % 3, (k + 2) % 3})
            if (s.neighbor[t][wall] == kNoNeighbor) sum += dot(u[t], s.edge(t, wall));
        return 0.5 * sum;
    });
}

std::vector<double> surfactant_torque(const Surface& s,
                                      std::span<const double> surfactant,
                                      std::span<const double> thickness,
                                      double strength) {
    return circulation_of_rings(s, [&](std::size_t t, std::size_t k) {
        const std::uint32_t a = s.corner[t][(k + 1) % 3], b = s.corner[t][(k + 2) % 3];
        return along_edge(surfactant[a], surfactant[b], thickness[a], thickness[b], strength);
    });
}

std::vector<double> wall_torque(const Surface& s,
                                std::span<const double> surfactant,
                                std::span<const double> thickness,
                                double strength) {
    std::vector<double> sum(s.loops.size(), 0.0);
    for (std::size_t t = 0; t < s.triangles(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            if (s.neighbor[t][k] != kNoNeighbor) continue;
            const std::uint32_t a = s.corner[t][(k + 1) % 3], b = s.corner[t][(k + 2) % 3];
            sum[static_cast<std::size_t>(s.loop[a])] +=
                along_edge(surfactant[a], surfactant[b], thickness[a], thickness[b], strength);
        }
    return sum;
}

std::vector<Vec3> vertex_velocity(const Surface& s, std::span<const Vec3> u) {
    std::vector<Vec3> mean(s.vertices());
    parallel_for(s.vertices(), [&](std::size_t v) {
        if (s.place[v] == Place::kStill) return;
        for (const Incidence& at : s.around(v)) mean[v] += s.area[at.triangle] * u[at.triangle];
        mean[v] *= 1.0 / (3.0 * s.vertex_area[v]);
        mean[v] -= dot(mean[v], s.vertex_normal[v]) * s.vertex_normal[v];
        mean[v] -= dot(mean[v], s.wall_normal[v]) * s.wall_normal[v];
    });
    return mean;
}

std::vector<double> gaussian_curvature(const Surface& s) {
    std::vector<double> at_vertex(s.vertices());
    parallel_for(s.vertices(), [&](std::size_t v) {
        if (s.loop[v] >= 0) return;
        double defect = 2.0 * kPi;
        for (const auto& [t, k] : s.around(v)) {
            const Vec3 a = s.edge(t, (k + 2) % 3), b = -s.edge(t, (k + 1) % 3);
            defect -= std::atan2(norm(cross(a, b)), dot(a, b));
        }
        at_vertex[v] = defect / s.vertex_area[v];
    });
    std::vector<double> curvature(s.triangles());
    for (std::size_t t = 0; t < s.triangles(); ++t)
        for (const std::uint32_t v : s.corner[t]) curvature[t] += at_vertex[v] / 3.0;
    return curvature;
}

VertexMatrix::VertexMatrix(const Surface& s, std::vector<int> unknown) : unknown_(std::move(unknown)) {
    linalg::Groups groups;
    int most = -1;
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        for (const std::uint32_t v : s.corner[t])
            if (unknown_[v] >= 0) groups.member.push_back(unknown_[v]);
        groups.close_group();
    }
    for (const int u : unknown_) most = std::max(most, u);
    matrix_ = linalg::coupled(static_cast<std::size_t>(most + 1), groups);
    slot_.resize(s.triangles());
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        const auto place = [&](std::size_t k, std::size_t l) -> std::int64_t {
            const int a = unknown_[s.corner[t][k]], b = unknown_[s.corner[t][l]];
            return a < 0 || b < 0 ? -1 : static_cast<std::int64_t>(matrix_.slot(a, b));
        };
        slot_[t] = {place(0, 0), place(1, 1), place(2, 2), place(1, 2), place(2, 0), place(0, 1)};
    }
}

void VertexMatrix::assemble(
    const Surface& s, double scale, std::span<const double> weight, std::span<const double> mass, double tie) {
    std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        const double w = scale * s.area[t] * (weight.empty() ? 1.0 : weight[t]), bond = tie * s.area[t];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
            if (slot_[t][k] >= 0)
                matrix_.value[static_cast<std::size_t>(slot_[t][k])] +=
                    w * squared_norm(s.hat_slope[t][k]) - 2.0 * bond;
            if (slot_[t][3 + k] < 0) continue;
            // Two corners with one unknown: both halves of the pair fall on its diagonal.
            const double twice = unknown_[s.corner[t][a]] == unknown_[s.corner[t][b]] ? 2.0 : 1.0;
            matrix_.value[static_cast<std::size_t>(slot_[t][3 + k])] +=
                twice * (w * dot(s.hat_slope[t][a], s.hat_slope[t][b]) + bond);
        }
    }
    for (std::size_t v = 0; v < mass.size(); ++v)
        if (unknown_[v] >= 0) matrix_.diagonal(static_cast<std::size_t>(unknown_[v])) += mass[v];
}

std::vector<double> VertexMatrix::sums(std::span<const double> at_vertices) const {
    std::vector<double> x(size(), 0.0);
    for (std::size_t v = 0; v < at_vertices.size(); ++v)
        if (unknown_[v] >= 0) x[static_cast<std::size_t>(unknown_[v])] += at_vertices[v];
    return x;
}

std::vector<double> VertexMatrix::spread(std::span<const double> x) const {
    std::vector<double> at_vertices(vertices(), 0.0);
    for (std::size_t v = 0; v < at_vertices.size(); ++v)
        if (unknown_[v] >= 0) at_vertices[v] = x[static_cast<std::size_t>(unknown_[v])];
    return at_vertices;
}

void add_ties(const Surface& s, double tie, std::span<const double> x, std::span<double> y) {
    parallel_for(s.vertices(), [&](std::size_t v) {
        double sum = 0.0;
        for (const auto& [t, k] : s.around(v))
            sum += s.area[t] * (x[s.corner[t][(k + 1) % 3]] + x[s.corner[t][(k + 2) % 3]] - 2.0 * x[v]);
        y[v] += tie * sum;
    });
}

void add_stiffness(
    const Surface& s, double scale, std::span<const double> weight, std::span<const double> x, std::span<double> y) {
    std::vector<Vec3> flux = gradient(s, x);
    parallel_for(s.triangles(),
                 [&](std::size_t t) { flux[t] *= scale * s.area[t] * (weight.empty() ? 1.0 : weight[t]); });
    parallel_for(s.vertices(), [&](std::size_t v) {
        for (const auto& [t, k] : s.around(v)) y[v] += dot(s.hat_slope[t][k], flux[t]);
    });
}

}  // namespace lamella::vortex_particle
