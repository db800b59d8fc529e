// Black film: what its border may and may not do. Closed forms: tests/validation/melp/black_film_test.cpp.

#include "lamella/solvers/melp/black_film.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include "same_bits.h"
#include <algorithm>
#include <cstdio>

namespace lamella::melp {
namespace {

constexpr const char* kFrame = "[[film]]\nshape = \"rectangle\"\nu = [0.06, 0.0, 0.0]\nv = [0.0, 0.0, 0.05]\n";
const std::string kSpots =
    "steps_per_period = 0.0\nlargest_step = 2e-3\nair_drag = 1e-3\nfine_ratio = 8\nstart.spots = 4\n"
    "start.spot_radius = 0.007\nstart.spot_center = [0.03, 0.0, 0.01]\nstart.spot_spread = 0.015\n"
    "black_film.thickness = 1e-7\nblack_film.line_tension = 1e-6\n";

TEST(BlackFilm, IsWhatIsThin) {
    const std::vector<double> chi = blackness(std::vector<double>{1e-8, 1e-7, 5e-7}, 1e-7);
    EXPECT_NEAR(chi[0], 1.0, 1e-3);
    EXPECT_NEAR(chi[1], 0.5, 1e-12);
    EXPECT_NEAR(chi[2], 0.0, 2e-3);
}

TEST(BlackFilm, HasABorderThatPushesNothingAsAWhole) {
    const auto solver = films(kFrame, 0.003, kSpots, "gravity = [0.0, 0.0, -9.81]");
    const std::vector<double> chi = blackness(solver->films().thickness, 1e-7);
    EXPECT_GT(*std::max_element(chi.begin(), chi.end()), 0.8);
    Vec3 sum;
    double size = 0.0;
    for (const Vec3& f : line_pull(solver->geometry(), solver->coarse().position, chi, 1e-6)) {
        sum += f;
        size += norm(f);
    }
    EXPECT_GT(size, 1e-8);
    EXPECT_LT(norm(sum), 1e-12 * size);
}

TEST(BlackFilm, GivesTheSameBitsOnAnyNumberOfThreadsAndAfterAResume) {
    expect_same_bits([] { return films(kFrame, 0.003, kSpots, "gravity = [0.0, 0.0, -9.81]"); }, 40, 23);
}

TEST(BlackFilm, KeepsTheSurfactantOfTheFilmInItsSpots) {
    const auto with = films(kFrame, 0.003, kSpots), without = films(kFrame, 0.003, "fine_ratio = 8\n");
    EXPECT_NEAR(scalar(*with, "surfactant_amount") / scalar(*without, "surfactant_amount"), 1.0, 1e-12);
    EXPECT_LT(scalar(*with, "liquid_mass"), 0.95 * scalar(*without, "liquid_mass"));
}

/// Spots that come on the way: liquid and momentum go to the film around them, surfactant stays.
TEST(BlackFilm, ComesToAFilmOnTheWay) {
    const std::string event =
        "[[event]]\nkind = \"spot\"\ntime = 0.004\ncenter = [0.03, 0.0, 0.02]\nradius = 0.007\n"
        "spread = 0.01\nrepeat = 2\ninterval = 0.01\n";
    const auto scene = [&] {
        return films(kFrame + event, 0.003, "fine_ratio = 8\nblack_film.thickness = 1e-7\n",
                     "gravity = [0.0, 0.0, -9.81]");
    };
    const auto solver = scene();
    const double liquid = scalar(*solver, "liquid_mass"), surfactant = scalar(*solver, "surfactant_amount");
    advance_to(*solver, 0.004);
    EXPECT_LT(scalar(*solver, "film_thickness_min"), 1e-7);
    advance_to(*solver, 0.02);
    const auto events = solver->take_events();
    ASSERT_EQ(events.size(), 2U);
    for (const auto& e : events) {
        EXPECT_EQ(e.kind, "spot");
        EXPECT_LT(norm(e.position - Vec3{{0.03, 0.0, 0.02}}), 0.0101);
    }
    EXPECT_GT(norm(events[0].position - events[1].position), 1e-4);
    EXPECT_NEAR(scalar(*solver, "liquid_mass") / liquid, 1.0, 1e-12);
    EXPECT_NEAR(scalar(*solver, "surfactant_amount") / surfactant, 1.0, 1e-12);
    expect_same_bits(scene, 12, 5);
    EXPECT_THROW(films(kFrame + event, 0.004, "fine_ratio = 8\n"), InputError);  // too small a spot
    EXPECT_THROW(films(kFrame + event, 0.003, "fine_ratio = 0\n"), InputError);
    EXPECT_THROW(films(kFrame + std::string("[[event]]\nkind = \"spot\"\n"), 0.003, ""), InputError);
}

/// Borders a thousand times as tense as real ones squeeze spots until coarse particles have no liquid: these went at
/// 85 m/s when the films around them pulled them.
TEST(BlackFilm, ThrowsNothingThatItsBorderSqueezesDry) {
    const auto solver =
        films(kFrame + std::string("[[event]]\nkind = \"spot\"\ntime = 0.0\nrepeat = 6\ninterval = 0.02\n"
                                   "center = [0.03, 0.0, 0.0]\nspread = 0.025\nradius = 0.006\n"),
              0.003,
              "steps_per_period = 0.0\nlargest_step = 4e-3\nair_drag = 1e-3\nfine_ratio = 8\n"
              "start.surfactant = \"uniform\"\nblack_film.thickness = 1e-7\n"
              "black_film.line_tension = 1e-6\n",
              "gravity = [0.0, 0.0, -9.81]");
    std::size_t dry = 0;
    double fastest = 0.0;
    while (solver->time() < 0.3) {
        solver->advance(0.3);
        dry += static_cast<std::size_t>(std::count(solver->films().dry.begin(), solver->films().dry.end(), 1));
        fastest = std::max(fastest, scalar(*solver, "max_velocity"));
    }
    std::printf("squeezed spots: fastest %.2f m/s, %zu times a particle without liquid\n", fastest, dry);
    EXPECT_GT(dry, 0U);
    EXPECT_LT(fastest, 1.0);
    for (const double eta : solver->fine().thickness) {
        EXPECT_GT(eta, 1e-9);
        EXPECT_LT(eta, 1e-4);
    }
}

TEST(BlackFilm, IsRefusedWhereItMakesNoSense) {
    EXPECT_THROW(films(kFrame, 0.003, kSpots + "start.spot_thickness = 0.0\n"), InputError);
    EXPECT_THROW(films(kFrame, 0.004, kSpots), InputError);  // spots too small for that
    EXPECT_THROW(films(kFrame, 0.003, "fine_ratio = 0\nstart.spots = 1\nstart.spot_radius = 0.01\n"), InputError);
    EXPECT_THROW(films(kFrame, 0.003, "black_film.line_tension = 1e-6\n"), InputError);
}

}  // namespace
}  // namespace lamella::melp
