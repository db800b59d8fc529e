#include "lamella/solvers/vortex_particle/operators.h"

#include "lamella/core/error.h"
#include "lamella/solvers/vortex_particle/flow.h"

#include <gtest/gtest.h>

#include "surfaces.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {
namespace {

std::vector<Vec3> random_velocity(const Surface& s) {
    std::vector<Vec3> u(s.triangles());
    for (std::size_t t = 0; t < u.size(); ++t) {
        u[t] = {{random_number(2, 3 * t), random_number(2, 3 * t + 1), random_number(2, 3 * t + 2)}};
        u[t] -= dot(u[t], s.normal[t]) * s.normal[t];
    }
    return u;
}

std::vector<double> minus_stiffness(const Surface& s, const std::vector<double>& p) {
    std::vector<double> y(p.size(), 0.0);
    add_stiffness(s, -1.0, {}, p, y);
    return y;
}

double largest(const std::vector<double>& values) {
    double most = 0.0;
    for (const double v : values) most = std::max(most, std::abs(v));
    return most;
}

// Values are of order one, and so are slopes times edges: rounding stays below 1e-13.
constexpr double kRounding = 1e-13;

TEST(FilmOperators, GiveTheStiffnessOfAPotentialExactly) {
    for (const auto& [name, s, walls] : surfaces_of_every_kind()) {
        const std::vector<double> p = random_values(3, s.vertices()), k = minus_stiffness(s, p);
        const std::vector<double> d = divergence(s, gradient(s, p)), o = curl(s, rotated_gradient(s, p));
        for (std::size_t v = 0; v < s.vertices(); ++v) {
            EXPECT_NEAR(d[v], k[v], kRounding) << name;
            EXPECT_NEAR(o[v], k[v], kRounding) << name;
        }
    }
}

TEST(FilmOperators, FindNoOutflowOfASwirlAndNoSwirlOfAGradient) {
    for (const auto& [name, s, walls] : surfaces_of_every_kind()) {
        const std::vector<double> p = random_values(3, s.vertices());
        const std::vector<double> d = divergence(s, rotated_gradient(s, p)), open = curl(s, gradient(s, p)),
                                  closed = closed_curl(s, gradient(s, p));
        for (std::size_t v = 0; v < s.vertices(); ++v) {
            EXPECT_NEAR(closed[v], 0.0, kRounding) << name;  // at walls too
            if (s.place[v] != Place::kInside) continue;
            EXPECT_NEAR(d[v], 0.0, kRounding) << name;
            EXPECT_NEAR(open[v], 0.0, kRounding) << name;
        }
    }
}

TEST(FilmOperators, LetNothingOutOfTheFilm) {
    for (const auto& [name, s, walls] : surfaces_of_every_kind()) {
        const std::vector<Vec3> u = random_velocity(s);
        const std::vector<double> d = divergence(s, u), o = curl(s, u);
        EXPECT_NEAR(std::accumulate(d.begin(), d.end(), 0.0), 0.0, kRounding * static_cast<double>(s.vertices()))
            << name;
        if (walls) continue;
        EXPECT_NEAR(std::accumulate(o.begin(), o.end(), 0.0), 0.0, kRounding * static_cast<double>(s.vertices()))
            << name;
    }
}

TEST(FilmOperators, MakeNoTorqueWhereSurfactantFollowsThickness) {
    for (const auto& [name, s, walls] : surfaces_of_every_kind()) {
        std::vector<double> eta = random_values(4, s.vertices()), gamma(s.vertices());
        for (std::size_t v = 0; v < s.vertices(); ++v) gamma[v] = 3.0 * (eta[v] += 1.0);
        EXPECT_LT(largest(surfactant_torque(s, gamma, eta, 1.0)), kRounding) << name;
        const std::vector<double> other = random_values(5, s.vertices());
        const std::vector<double> torque = surfactant_torque(s, other, eta, 1.0);
        EXPECT_GT(largest(torque), 0.01) << name;
        if (walls) continue;
        EXPECT_NEAR(std::accumulate(torque.begin(), torque.end(), 0.0), 0.0, 1e-11) << name;
    }
}

/// Baroclinic source in local form: domega/dt = (2 R T / rho) / eta^2 n . (grad eta x grad Gamma) [method sheet 2].
TEST(FilmOperators, MakeTheTorqueOfTheLocalForm) {
    const Surface s = surface_of(mesh::rectangle({}, {{1, 0, 0}}, {{0, 1, 0}}, 0.05));
    std::vector<double> eta(s.vertices()), gamma(s.vertices());
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        eta[v] = 1.0 + 0.1 * s.position[v][0];
        gamma[v] = 2.0 + 0.3 * s.position[v][1];
    }
    const std::vector<double> torque = surfactant_torque(s, gamma, eta, 2.0);
    // eta changes by 0.1 h over an edge: second differences of 1/eta, and with them the error, are below 1e-4 of it.
    for (std::size_t v = 0; v < s.vertices(); ++v)
        if (s.place[v] == Place::kInside) {
            EXPECT_NEAR(torque[v] / s.vertex_area[v] * eta[v] * eta[v] / (2.0 * 0.1 * 0.3), 1.0, 1e-4);
        }
}

TEST(FlowSolver, FindsTheCirculationAndOutflowThatItWasGiven) {
    for (const auto& [name, s, walls] : surfaces_of_every_kind()) {
        const FlowSolver solver(s);
        const std::vector<double> p = random_values(6, s.vertices());
        std::vector<double> omega = curl(s, rotated_gradient(s, p)),
                            outflow = divergence(s, gradient(s, random_values(7, s.vertices())));
        const std::vector<double> hole(s.loops.size(), 0.0);
        const std::vector<Vec3> swirl = rotated_gradient(s, solver.stream_function(s, omega, hole));
        const std::vector<Vec3> away = gradient(s, solver.potential(s, outflow));
        const std::vector<double> o = curl(s, swirl), d = divergence(s, away), none = divergence(s, swirl);
        for (std::size_t v = 0; v < s.vertices(); ++v) {
            EXPECT_NEAR(d[v], outflow[v], 1e-11) << name;
            EXPECT_NEAR(none[v], 0.0, 1e-11) << name;  // at walls too: the flow runs along them
            if (s.place[v] != Place::kInside) continue;
            EXPECT_NEAR(o[v], omega[v], 1e-11) << name;
        }
    }
}

/// u = C / (2 pi r) around the hole of a flat ring; the error of the flux through a cut falls with the square of edges.
TEST(FlowSolver, LetsTheFlowGoAroundAHole) {
    const double circulation = 2.0, pi = 3.14159265358979323846;
    std::vector<double> error;
    for (const double edge : {0.1, 0.05, 0.025}) {
        const Surface s = surface_of(flat_ring(0.5, 1.0, edge));
        ASSERT_EQ(s.loops.size(), 2u);
        const double up = s.normal[0][2];  // of the ring as built: the sense of 'counterclockwise'
        const std::vector<double> none(s.vertices(), 0.0), hole(2, circulation);
        const std::vector<double> psi = FlowSolver(s).stream_function(s, none, hole);
        double worst = 0.0;
        for (std::size_t v = 0; v < s.vertices(); ++v) {
            // Psi = 0 on the outer wall: Psi = C / (2 pi) ln r, whichever way is up.
            worst = std::max(worst, std::abs(psi[v] - circulation / (2.0 * pi) * std::log(norm(s.position[v]))));
        }
        error.push_back(worst);
        const std::vector<Vec3> u = rotated_gradient(s, psi);
        for (std::size_t t = 0; t < s.triangles(); ++t) {
            const Vec3 x = s.point(t, {1.0 / 3, 1.0 / 3, 1.0 / 3});
            const Vec3 exact = up * circulation / (2.0 * pi * squared_norm(x)) * cross({{0, 0, 1}}, x);
            EXPECT_LT(norm(u[t] - exact), 1.5 * edge) << edge;  // first order in a triangle
        }
    }
    EXPECT_GT(std::log2(error[0] / error[1]), 1.8);
    EXPECT_GT(std::log2(error[1] / error[2]), 1.8);
}

TEST(FilmSurface, RefusesWhatItCannotHold) {
    mesh::FoamMesh turned = mesh::rectangle({}, {{1, 0, 0}}, {{0, 1, 0}}, 0.5);
    std::swap(turned.faces[mesh::FaceId{0}].vertices[0], turned.faces[mesh::FaceId{0}].vertices[1]);
    EXPECT_THROW(surface_of(turned), InputError);
    EXPECT_THROW(surface_of(mesh::frame_cone(mesh::FrameShape::kCube, {}, 1.0, 0.3)), InputError);
}

TEST(FilmSurface, KnowsItsWalls) {
    const Surface s = surface_of(mesh::rectangle({}, {{1, 0, 0}}, {{0, 2, 0}}, 0.25));
    ASSERT_EQ(s.loops.size(), 1u);
    EXPECT_NEAR(s.loops[0].length, 6.0, 1e-12);
    EXPECT_EQ(std::count(s.place.begin(), s.place.end(), Place::kStill), 4);
    EXPECT_NEAR(s.total_area, 2.0, 1e-12);
}

}  // namespace
}  // namespace lamella::vortex_particle
