// Spots of black film against closed forms.

#include "lamella/solvers/melp/black_film.h"

#include <gtest/gtest.h>

#include "../../unit/melp/bubbles.h"

namespace lamella::melp {
namespace {

constexpr double kLine = 2e-6, kLimit = 1e-7, kGas = 8.31446261815324 * 298.15;

std::unique_ptr<MelpSolver> spot(double edge, const std::string& options, const std::string& material = "") {
    return films("[[film]]\nshape = \"disk\"\nradius = 0.04\n", edge,
                 "steps_per_period = 0.0\nlargest_step = 2e-3\nair_drag = 5e-3\nstart.spots = 1\n"
                 "start.spot_thickness = 4e-8\nstart.spot_radius = 0.012\n" +
                     options,
                 material);
}
const std::string kTense = "black_film.thickness = 1e-7\nblack_film.line_tension = 2e-6\n";

struct Shape {
    double area = 0.0;       ///< [m^2]
    Vec3 center{};           ///< [m]
    double long_axis = 0.0;  ///< root of the moment along x over that along y
};
Shape shape_of_spot(const MelpSolver& solver) {
    const std::vector<double> chi = blackness(solver.films().thickness, kLimit);
    const auto& x = solver.coarse().position;
    Shape s;
    for (std::size_t i = 0; i < chi.size(); ++i) {
        s.area += chi[i] * solver.geometry().area[i];
        s.center += (chi[i] * solver.geometry().area[i]) * x[i];
    }
    s.center = s.center / s.area;
    double xx = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < chi.size(); ++i) {
        const Vec3 d = x[i] - s.center;
        xx += chi[i] * solver.geometry().area[i] * d[0] * d[0];
        yy += chi[i] * solver.geometry().area[i] * d[1] * d[1];
    }
    s.long_axis = std::sqrt(xx / yy);
    return s;
}

/// What the border of a round spot presses its film with, times its radius over the line tension.
double pressure_of_border(double edge) {
    auto solver = spot(edge, kTense);
    advance_to(*solver, 0.6);
    double inside = 0.0, in = 0.0, outside = 0.0, out = 0.0;
    const Shape shape = shape_of_spot(*solver);
    const double radius = std::sqrt(shape.area / std::numbers::pi);
    for (std::size_t i = 0; i < solver->coarse().size(); ++i) {
        const double r = norm(solver->coarse().position[i] - shape.center), a = solver->geometry().area[i];
        const double pressure = 2.0 * kGas * solver->films().concentration[i];
        if (r < 0.3 * radius) inside += a * pressure, in += a;
        if (r > 2.0 * radius) outside += a * pressure, out += a;
    }
    const double ratio = (inside / in - outside / out) * radius / kLine;
    std::printf("spot, %zu coarse: radius %.2f mm, pressure of its border %.4f of the closed form, fastest %.1e\n",
                solver->coarse().size(), 1e3 * radius, ratio, scalar(*solver, "max_velocity"));
    std::fflush(stdout);
    EXPECT_NEAR(scalar(*solver, "liquid_error"), 0.0, 1e-12);
    return ratio;
}

/// Line tension presses the film in a round spot with line_tension / R: its surfactant holds that. A border is as wide
/// as the kernels.
TEST(BlackFilm, OfARoundSpotIsPressedByItsBorder) {
    for (const double edge : {0.003, 0.002}) EXPECT_NEAR(pressure_of_border(edge), 1.0, 0.1);
}

/// The same film with its liquid where the spot has been drawn out twofold along x.
TEST(BlackFilm, OfALongSpotGetsRound) {
    for (const bool tense : {true, false}) {
        auto solver = spot(0.002, tense ? kTense : "black_film.thickness = 1e-7\n");
        test::StateMemory state = state_of(*solver);
        for (std::size_t p = 0; p < solver->fine().size(); ++p) {
            const Vec3& x = solver->fine().position[p];
            const double u = x[0] / 0.017, v = x[1] / 0.0085, old = state.reals["fine/thickness"][p];
            const double now = u * u + v * v < 1.0 ? 4e-8 : 5e-7;
            state.reals["fine/liquid_volume"][p] *= now / old;
            state.reals["fine/thickness"][p] = now;
        }
        solver->load(state);
        const double before = shape_of_spot(*solver).long_axis;
        advance_to(*solver, 0.6);
        const double after = shape_of_spot(*solver).long_axis;
        std::printf("long spot, %s line tension: axes %.3f, then %.3f\n", tense ? "with" : "without", before, after);
        EXPECT_GT(before, 1.6);
        if (tense)
            EXPECT_NEAR(after, 1.0, 0.15);
        else
            EXPECT_GT(after, 1.5);
    }
}

/// In an upright film a spot is lighter than what it lies in.
TEST(BlackFilm, OfASpotRises) {
    auto solver = spot(0.002, "start.surfactant = \"uniform\"\n" + kTense, "gravity = [0.0, -9.81, 0.0]");
    const double before = shape_of_spot(*solver).center[1];
    advance_to(*solver, 0.1);
    EXPECT_GT(shape_of_spot(*solver).center[1], before + 0.003);
}

}  // namespace
}  // namespace lamella::melp
