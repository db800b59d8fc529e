#pragma once

// Shapes of bubbles that touch, for the tests of melp.

#include "lamella/linalg/dense.h"

#include "../../unit/melp/bubbles.h"
#include <cmath>
#include <numbers>
#include <vector>

namespace lamella::melp {

struct Cap {
    Vec3 center;
    double radius = 0.0;
};

/// The sphere through the particles that `chosen(i)` says, by least squares: |x|^2 = 2 c . x + d.
template <class Chosen>
Cap sphere_through(const MelpSolver& solver, Chosen&& chosen) {
    std::vector<double> matrix(16, 0.0), right(4, 0.0);
    Vec3 middle;
    double count = 0.0;
    for (std::size_t i = 0; i < solver.coarse().size(); ++i)
        if (chosen(i)) {
            middle += solver.coarse().position[i];
            count += 1.0;
        }
    middle = middle / count;
    for (std::size_t i = 0; i < solver.coarse().size(); ++i) {
        if (!chosen(i)) continue;
        const Vec3 x = solver.coarse().position[i] - middle;
        const double term[] = {2.0 * x[0], 2.0 * x[1], 2.0 * x[2], 1.0};
        for (std::size_t a = 0; a < 4; ++a) {
            right[a] += term[a] * squared_norm(x);
            for (std::size_t b = 0; b < 4; ++b) matrix[4 * a + b] += term[a] * term[b];
        }
    }
    const std::vector<double> z = linalg::solve_symmetric(4, matrix, right).x;
    const Vec3 center{{z[0], z[1], z[2]}};
    return {center + middle, std::sqrt(z[3] + squared_norm(center))};
}

/// Through the particles of a region that see no other bubble.
inline Cap cap_of(const MelpSolver& solver, std::int32_t region) {
    const Neighbors& other = solver.geometry().neighbors.other;
    return sphere_through(
        solver, [&](std::size_t i) { return solver.coarse().region[i] == region && other.begin(i) == other.end(i); });
}

/// Curvature of the film between two regions, the mean of its two layers, each a sphere through particles farther than
/// a kernel's reach from the border [1/m].
inline double partition_curvature(const MelpSolver& solver, std::int32_t p, std::int32_t q) {
    const Neighbors& other = solver.geometry().neighbors.other;
    const std::vector<Vec3>& x = solver.coarse().position;
    const double far = 1.8 * other.kernel.support_radius;  // caps see the partition from a reach beyond the border
    const auto is_free = [&](std::size_t i) { return other.begin(i) == other.end(i); };
    const auto curvature_of = [&](std::int32_t region) {
        const Cap layer = sphere_through(solver, [&](std::size_t i) {
            if (solver.coarse().region[i] != region || is_free(i)) return false;
            for (std::size_t j = 0; j < x.size(); ++j)
                if (is_free(j) && norm(x[j] - x[i]) < far) return false;
            return true;
        });
        return 1.0 / layer.radius;
    };
    return 0.5 * (curvature_of(p) + curvature_of(q));
}

/// Bubbles without fine particles that settle as clusters of films of 72.5 mN/m and 500 nm, started.
inline std::unique_ptr<MelpSolver> settling_cluster(const std::vector<Cap>& balls, double edge_length) {
    std::string scene = "[material]\nsurface_tension = 0.0725\nthickness = 5e-7\n";
    for (const Cap& ball : balls) {
        scene += "[[bubble]]\nradius = " + std::to_string(ball.radius) + "\ncenter = [";
        for (std::size_t k = 0; k < 3; ++k) scene += std::to_string(ball.center[k]) + (k < 2 ? ", " : "]\n");
    }
    scene += "[resolution]\nedge_length = " + std::to_string(edge_length) +
             "\n[melp]\nfine_ratio = 0\ntheta = 1.0\ndamping = 500.0\nsteps_per_period = 90.0\n";
    auto solver = solver_of(scene);
    solver->start({});
    return solver;
}

/// At which the films of two caps meet, from their spheres [degrees].
inline double angle_between(const Cap& p, const Cap& q) {
    const double cosine =
        (p.radius * p.radius + q.radius * q.radius - squared_norm(p.center - q.center)) / (2.0 * p.radius * q.radius);
    return 180.0 - 180.0 / std::numbers::pi * std::acos(cosine);
}

}  // namespace lamella::melp
