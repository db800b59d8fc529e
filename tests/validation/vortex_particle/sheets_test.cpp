// Films that meet in triple lines and flow on into each other there: junction = "sheets".

#include "lamella/film/surfactant.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "films.h"
#include <cmath>
#include <filesystem>
#include <fstream>

namespace lamella::vortex_particle {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// The six films of a tetrahedral frame drain into one profile of thickness, eta = c exp(-k z) [method sheet 12.1],
/// with one constant, from all the liquid that there is: it has run from film to film.
TEST(FilmsInAFrame, DrainIntoOneProfile) {
    auto solver = solver_of(R"(
[material]
surfactant = 8e-7
gravity = [0, 0, -9.81]
kinematic_viscosity = 1e-2
[[film]]
shape = "frame"
frame = "tetrahedron"
edge = 1.0
[resolution]
edge_length = 0.05
[vortex_particle]
junction = "sheets"
)");
    solver->start({});
    const double liquid = scalar(*solver, "liquid_volume"), soap = scalar(*solver, "surfactant_amount");
    run_until(*solver, 20.0);
    EXPECT_NEAR(scalar(*solver, "liquid_volume") / liquid, 1.0, 1e-12);
    EXPECT_NEAR(scalar(*solver, "surfactant_amount") / soap, 1.0, 1e-12);
    EXPECT_LT(scalar(*solver, "max_velocity"), 1e-6);
    const double k = 9.81 / (2.0 * film::kGasConstant * 298.15 / (1000.0 * 4e-7) * 8e-7);
    const Surface& s = solver->surface();
    EXPECT_EQ(s.components, 6U);
    double weight = 0.0, square = 0.0;
    for (std::size_t v = 0; v < s.vertices(); ++v) weight += s.vertex_area[v] * std::exp(-k * s.position[v][2]);
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        const double exact = liquid / weight * std::exp(-k * s.position[v][2]);
        square += s.vertex_area[v] * std::pow(solver->observed().thickness[v] - exact, 2);
    }
    EXPECT_LT(std::sqrt(square / s.total_area) / 4e-7, 5e-3);
}

/// Three strips of length 1 and width `width` that meet at an edge, at 120 degrees: as an OBJ file, each with squares
/// of two triangles.
std::filesystem::path three_strips(int cells, double width) {
    const auto path = std::filesystem::path(testing::TempDir()) / "three_strips.obj";
    std::ofstream file(path);
    const int across = std::max(2, static_cast<int>(std::lround(width * cells)));
    const auto row = [&](int strip, int i) { return i == 0 ? 0 : 1 + strip * cells + i - 1; };  // the first is shared
    for (int r = 0; r <= 3 * cells; ++r)
        for (int j = 0; j <= across; ++j) {
            const int strip = r == 0 ? 0 : (r - 1) / cells, i = r == 0 ? 0 : (r - 1) % cells + 1;
            const double angle = 2.0 * kPi / 3.0 * strip, x = static_cast<double>(i) / cells;
            file << fmt::format("v {:.17g} {:.17g} {:.17g}\n", x * std::cos(angle), x * std::sin(angle),
                                width * j / across);
        }
    for (int strip = 0; strip < 3; ++strip)
        for (int i = 0; i < cells; ++i)
            for (int j = 0; j < across; ++j) {
                const auto at = [&](int di, int dj) { return row(strip, i + di) * (across + 1) + j + dj + 1; };
                file << fmt::format("f {} {} {}\nf {} {} {}\n", at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1),
                                    at(0, 1));
            }
    return path;
}

/// Where one strip is thicker than the others toward its end, a wave of thickness swings between it and the two others,
/// with a node where they meet: its frequency is c pi / (2 L), half of that in a strip by itself.
TEST(ThreeStrips, SwingWithANodeWhereTheyMeet) {
    auto solver = solver_of(fmt::format(R"(
[material]
kinematic_viscosity = 0.0
elastic_wave_speed = 1.0
[[film]]
shape = "mesh"
file = "{}"
[vortex_particle]
junction = "sheets"
largest_step = 0.01
[vortex_particle.start]
thickness = "linear"
thickness_bottom = 3.99e-7
thickness_top = 4.02e-7
up = [1, 0, 0]
surfactant = "proportional"
)",
                                        three_strips(20, 0.2).string()));
    solver->start({});
    const Surface& s = solver->surface();
    ASSERT_EQ(s.components, 3U);
    const auto swing = [&] {  // the part of the lowest such mode
        double sum = 0.0;
        for (std::size_t v = 0; v < s.vertices(); ++v) {
            const Vec3& x = s.position[v];
            const double along = std::hypot(x[0], x[1]), sign = x[0] > 1e-9 ? 1.0 : -0.5;
            sum += sign * std::sin(0.5 * kPi * along) * s.vertex_area[v] * (solver->observed().thickness[v] - 4e-7);
        }
        return sum;
    };
    const double first = swing();
    double before = first, then = 0.0;
    std::vector<double> zeros;
    while (solver->time() < 7.5) {
        solver->advance(7.5);
        const double now = swing();
        if (before * now < 0.0) zeros.push_back(then + (solver->time() - then) * before / (before - now));
        before = now;
        then = solver->time();
    }
    ASSERT_EQ(zeros.size(), 4U);  // at 1, 3, 5, 7 s
    EXPECT_NEAR((zeros[3] - zeros[0]) / 6.0, 1.0, 0.01);
    EXPECT_NEAR(zeros[0], 1.0, 0.03);
}

}  // namespace
}  // namespace lamella::vortex_particle
