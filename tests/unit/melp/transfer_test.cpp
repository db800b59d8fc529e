#include "lamella/solvers/melp/transfer.h"

#include "lamella/solvers/melp/films.h"
#include "lamella/solvers/melp/fine_order.h"
#include "lamella/solvers/melp/surfactant.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include <algorithm>

namespace lamella::melp {
namespace {

/// A bubble whose liquid whirls and is uneven.
std::unique_ptr<MelpSolver> stirred_bubble() { return bubble(500, "start.thickness_noise = 0.6\n"); }

FineParticles whirling(FineParticles fine) {
    for (std::size_t p = 0; p < fine.size(); ++p) {
        const Vec3& x = fine.position[p];
        fine.velocity[p] = cross(Vec3{{3.0, 1.0, -2.0}}, x) + Vec3{{x[1] * x[2] / kRadius, 0.4, x[0]}};
        fine.gradient[p] = {Vec3{{0.1, 2.0, 1.0}}, Vec3{{-2.0, 0.5, 3.0}}, Vec3{{0.0, -3.0, 1.0}}};
    }
    return fine;
}

TEST(Transfer, KeepsLiquidSurfactantAndMomentumBothWays) {
    const auto solver = stirred_bubble();
    const CoarseParticles& coarse = solver->coarse();
    FineParticles fine = whirling(solver->fine());
    const Transfer transfer(coarse, solver->geometry().normal, fine, 3.0 * solver->spacing());
    ASSERT_EQ(transfer.strays(), 0U);

    Gathered gathered = transfer.to_coarse(coarse, fine);
    EXPECT_NEAR(total(gathered.liquid_volume) / total(fine.liquid_volume), 1.0, 1e-12);
    EXPECT_NEAR(total(gathered.surfactant) / total(fine.surfactant), 1.0, 1e-12);

    // Velocities of the coarse particles go to the fine ones and come back as the same momentum.
    std::vector<Vec3> velocity;
    Vec3 sent;
    double size = 0.0;
    for (std::size_t e = 0; e < coarse.size(); ++e) {
        velocity.push_back(gathered.momentum[e] / gathered.liquid_volume[e]);
        sent += gathered.momentum[e];
        size += norm(gathered.momentum[e]);
    }
    transfer.to_fine({coarse.position, velocity, solver->films().thickness, solver->films().seen_thickness}, 0.0, fine);
    gathered = transfer.to_coarse(coarse, fine);
    Vec3 back;
    for (const Vec3& p : gathered.momentum) back += p;
    EXPECT_LT(norm(back - sent), 1e-12 * size);
}

TEST(Transfer, KeepsARigidMotionOfABubbleAndItsGradient) {
    const auto solver = stirred_bubble();
    const CoarseParticles& coarse = solver->coarse();
    FineParticles fine = solver->fine();
    const Vec3 speed{{0.3, -0.1, 0.2}};
    std::vector<Vec3> velocity(coarse.size(), speed);
    const Transfer transfer(coarse, solver->geometry().normal, fine, 3.0 * solver->spacing());
    transfer.to_fine({coarse.position, velocity, solver->films().thickness, solver->films().seen_thickness}, 0.0, fine);
    for (std::size_t p = 0; p < fine.size(); ++p) {
        EXPECT_LT(norm(fine.velocity[p] - speed), 1e-13);
        for (const Vec3& row : fine.gradient[p]) EXPECT_LT(norm(row), 1e-11);
    }
}

/// What a flat film turning about a point has around it is kept by affine transfers. [method sheet 14, V9]
TEST(Transfer, KeepsTheAngularMomentumOfAFlatFilmThatTurns) {
    CoarseParticles coarse;
    FineParticles fine;
    for (int i = 0; i < 30; ++i)
        for (int j = 0; j < 30; ++j) coarse.position.push_back({{i + 0.3 * (j % 2), 1.0 * j, 0.0}});
    for (int i = 0; i < 80; ++i)
        for (int j = 0; j < 80; ++j) fine.position.push_back({{4.0 + 0.27 * i, 4.0 + 0.27 * j, 0.0}});
    coarse.region.resize(coarse.size());
    fine.region.resize(fine.size());
    fine.velocity.resize(fine.size());
    fine.gradient.resize(fine.size());
    fine.normal.resize(fine.size(), {{0, 0, 1}});
    fine.liquid_volume.resize(fine.size(), 1.0);
    fine.surfactant.resize(fine.size(), 1.0);
    fine.thickness.resize(fine.size(), 1.0);
    fine.temperature.resize(fine.size(), 300.0);
    sort_fine_particles(fine, 1.0);
    const std::vector<Vec3> normal(coarse.size(), {{0, 0, 1}});
    const Vec3 center{{15, 15, 0}}, spin{{0, 0, 2}};
    std::vector<Vec3> velocity;
    for (const Vec3& x : coarse.position) velocity.push_back(cross(spin, x - center));
    const std::vector<double> even(coarse.size(), 1.0);
    const Transfer transfer(coarse, normal, fine, 3.0);
    transfer.to_fine({coarse.position, velocity, even, even}, 0.0, fine);
    const Gathered gathered = transfer.to_coarse(coarse, fine);
    double sent = 0.0, back = 0.0;
    for (std::size_t e = 0; e < coarse.size(); ++e) {
        sent += gathered.liquid_volume[e] * cross(coarse.position[e] - center, velocity[e])[2];
        back += cross(coarse.position[e] - center, gathered.momentum[e])[2];
    }
    // The floor of the moments takes 1e-4 r^2 / (spread of the kernel, about r^2 / 20), 0.2 %, of the affine part,
    // which is itself the kernel's spread over that of the film, 1 %, of the whole.
    EXPECT_NEAR(back / sent, 1.0, 5e-5);
}

TEST(Transfer, PutsFineParticlesOntoTheSphereThatCoarseOnesLieOn) {
    const auto solver = bubble(1200, "");
    FineParticles fine = solver->fine();
    const Transfer transfer(solver->coarse(), solver->geometry().normal, fine, 3.0 * solver->spacing());
    for (std::size_t p = 0; p < fine.size(); ++p) fine.position[p] *= p % 2 == 0 ? 1.01 : 0.99;
    transfer.project(solver->geometry().patch, solver->geometry().normal, fine);
    for (std::size_t p = 0; p < fine.size(); ++p) {
        EXPECT_NEAR(norm(fine.position[p]) / kRadius, 1.0, 5e-4);
        EXPECT_GT(dot(fine.normal[p], fine.position[p]) / norm(fine.position[p]), 1.0 - 1e-4);
    }
}

TEST(SortFineParticles, OnlyChangesTheirOrder) {
    const auto solver = bubble(300, "");
    FineParticles fine = solver->fine();
    std::reverse(fine.position.begin(), fine.position.end());
    std::reverse(fine.liquid_volume.begin(), fine.liquid_volume.end());
    const auto signature = [](const FineParticles& f) {
        std::vector<std::pair<double, double>> s;
        for (std::size_t p = 0; p < f.size(); ++p) s.emplace_back(f.position[p][0], f.liquid_volume[p]);
        std::sort(s.begin(), s.end());
        return s;
    };
    const auto before = signature(fine);
    sort_fine_particles(fine, solver->spacing());
    EXPECT_EQ(signature(fine), before);
}

/// Coarse particles that no fine one reaches have the film of those around them: with none of their own the surfactant
/// had no solution.
TEST(Films, OfCoarseParticlesWithoutLiquidAreThoseAroundThem) {
    const auto solver = stirred_bubble();
    const CoarseParticles& coarse = solver->coarse();
    const Transfer transfer(coarse, solver->geometry().normal, whirling(solver->fine()), 3.0 * solver->spacing());
    Gathered gathered = transfer.to_coarse(coarse, whirling(solver->fine()));
    std::size_t dry = 0;
    for (std::size_t e = 0; e < coarse.size(); ++e) {
        if (coarse.position[e][2] < 0.6 * kRadius) continue;  // wider than kernels reach
        gathered.liquid_volume[e] = gathered.surfactant[e] = gathered.seen_volume[e] = gathered.heat[e] = 0.0;
        gathered.momentum[e] = {};
        ++dry;
    }
    const film::SurfactantLaw law{kTension, 1e-7};
    const Films films = films_of(solver->geometry(), coarse, gathered, std::vector<EvenFilm>(1), law, {});
    EXPECT_EQ(std::count(films.dry.begin(), films.dry.end(), 1), static_cast<std::ptrdiff_t>(dry));
    EXPECT_GT(dry, 50U);
    double least = 1.0;
    for (std::size_t e = 0; e < coarse.size(); ++e)
        if (films.dry[e] == 0) least = std::min(least, films.pressing[e]);
    for (std::size_t e = 0; e < coarse.size(); ++e) {
        EXPECT_GE(films.pressing[e], least);
        EXPECT_LT(std::abs(dot(films.along[e], solver->geometry().normal[e])), 1e-12);
        EXPECT_TRUE(films.dry[e] == 0 || norm(films.along[e]) > 0.0);
    }
    const SurfactantStep step = solve_surfactant(solver->geometry(), coarse.position, films, films.along, law,
                                                 std::vector<double>(coarse.size(), kFilmMass), 1e-3, 1e-6, 0);
    EXPECT_LT(step.solution.residual, 1e-6);
    for (const double pressing : step.pressing) EXPECT_GT(pressing, 0.0);
}

/// The detail that fine particles have of the film's thickness stays near it, whatever their flow adds up to.
TEST(Transfer, KeepsTheThicknessOfFineParticlesNearTheFilms) {
    const auto solver = stirred_bubble();
    const CoarseParticles& coarse = solver->coarse();
    FineParticles fine = solver->fine();
    fine.thickness[0] = 1.0;
    fine.thickness[1] = -1e-6;
    const Transfer transfer(coarse, solver->geometry().normal, fine, 3.0 * solver->spacing());
    const std::vector<double> film = transfer.at_fine(solver->films().thickness);
    const double other = fine.thickness[2];
    transfer.to_fine({coarse.position, coarse.velocity, solver->films().thickness, solver->films().seen_thickness}, 0.0,
                     fine);
    EXPECT_NEAR(fine.thickness[0] / film[0], 30.0, 1e-9);
    EXPECT_NEAR(fine.thickness[1] / film[1], 1.0 / 30.0, 1e-9);
    EXPECT_EQ(fine.thickness[2], other);
}

/// Steps of a whirl are straight: the thickness that fine particles have goes by how that stretches the film. By the
/// divergence alone it grew at omega^2 dt / 2.
TEST(FineParticles, KeepTheThicknessOfAFilmThatTurns) {
    const auto solver = films("[[film]]\nshape = \"disk\"\nradius = 0.05\n", 0.004,
                              "steps_per_period = 0.0\nlargest_step = 5e-3\ncfl = 2.0\nair_drag = 1e-2\n"
                              "wind_spin = [0.0, 0.0, 40.0]\nwind_radius = 0.015\n");
    advance_to(*solver, 0.6);
    EXPECT_GT(scalar(*solver, "energy_kinetic"), 1e-9);
    for (std::size_t p = 0; p < solver->fine().size(); ++p) {
        EXPECT_GT(solver->fine().thickness[p], 0.8 * 5e-7);
        EXPECT_LT(solver->fine().thickness[p], 1.25 * 5e-7);
    }
}

}  // namespace
}  // namespace lamella::melp
