// The liquid of a vertical film runs down until its surfactant carries it [method sheet 12.1].

#include "films.h"

#include "lamella/film/surfactant.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace lamella::vortex_particle {
namespace {

/// Thickness at rest: eta = c exp(-k z) with k = rho g eta_0 / (2 R T Gamma_0), the constant from the liquid there is.
struct Rest {
    double error;  ///< root mean square over the film, relative to eta_0
    double speed;  ///< largest [m/s]
};
Rest compare(const VortexParticleSolver& solver, double k, double thickness) {
    const Surface& s = solver.surface();
    const MeshFlow& flow = solver.observed();
    double weight = 0.0, square = 0.0;
    for (std::size_t v = 0; v < s.vertices(); ++v) weight += s.vertex_area[v] * std::exp(-k * s.position[v][1]);
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        const double exact = thickness * s.total_area / weight * std::exp(-k * s.position[v][1]);
        square += s.vertex_area[v] * std::pow(flow.thickness[v] - exact, 2);
    }
    return {std::sqrt(square / s.total_area) / thickness, scalar(solver, "max_velocity")};
}

constexpr const char* kRectangle = R"(
[[film]]
shape = "rectangle"
u = [0.5, 0, 0]
v = [0, 1, 0]
)";
constexpr const char* kDisk = R"(
[[film]]
shape = "disk"
radius = 0.5
)";

std::string film(const char* shape, const std::string& soap) {
    return fmt::format(R"(
[material]
thickness = 4e-7
gravity = [0, -9.81, 0]
kinematic_viscosity = 1e-2
{}
{}
[resolution]
edge_length = 0.05
)", soap, shape);
}

TEST(Drainage, EndsInTheExponentialProfileAndStaysThere) {
    struct Case {
        const char* shape;
        std::string soap;
        double k;  ///< [1/m]
    };
    const double strength = 2.0 * film::kGasConstant * 298.15 / (1000.0 * 4e-7);  // c^2 over Gamma_0
    for (const Case& test : {Case{kRectangle, "surfactant = 4e-6", 9.81 / (strength * 4e-6)},
                             Case{kRectangle, "surfactant = 8e-7", 9.81 / (strength * 8e-7)},
                             Case{kDisk, "elasticity = 2e-3", 9.81 / (2.0 * 2e-3 / (1000.0 * 4e-7))}}) {
        auto solver = solver_of(film(test.shape, test.soap));
        solver->start({});
        const double liquid = scalar(*solver, "liquid_volume"), soap = scalar(*solver, "surfactant_amount");
        for (const double time : {20.0, 40.0, 60.0}) {
            run_until(*solver, time);
            const Rest rest = compare(*solver, test.k, 4e-7);
            EXPECT_LT(rest.error, 0.005) << test.soap << " at " << time;
            // Sloshing dies out, down to rounding: no slow growth, which value-carrying particles have [method sheet 12.9].
            EXPECT_LT(rest.speed, time < 30.0 ? 1e-2 : 1e-6) << test.soap << " at " << time;
        }
        EXPECT_NEAR(scalar(*solver, "liquid_volume") / liquid, 1.0, 1e-12);
        EXPECT_NEAR(scalar(*solver, "surfactant_amount") / soap, 1.0, 1e-12);
    }
}

}  // namespace
}  // namespace lamella::vortex_particle
