// Warm films against closed forms.

#include <gtest/gtest.h>

#include "../../unit/melp/bubbles.h"

namespace lamella::melp {
namespace {

constexpr double kRest = 298.15;  // [K]

/// A film comes to the temperature of air that is equally warm everywhere as 1 - exp(-t / time).
TEST(Heat, ReachesFilmsWithinItsTime) {
    auto solver =
        bubble(300,
               "steps_per_period = 0\nlargest_step = 0.01\n[melp.heat]\nsource = \"below\"\ntemperature = 303.15\n"
               "center = [0.0, 0.0, 1.0]\nreach = 0.5\ntime = 0.2\n");
    for (const double time : {0.1, 0.2}) {
        advance_to(*solver, time);
        const double expected = kRest + 5.0 * (1.0 - std::exp(-time / 0.2));
        for (const double t : solver->fine().temperature) EXPECT_NEAR(t, expected, 1e-9);
        for (const double t : solver->films().temperature) EXPECT_NEAR(t, expected, 1e-9);
    }
}

/// Without weight a film comes to rest where its tension is the same everywhere: what warmth takes from it, less
/// surfactant gives back, d(R T Gamma) / dT = d sigma / dT.
TEST(Heat, DrivesSurfactantUntilTheTensionIsEven) {
    constexpr double kSlope = -5e-5, kWarmer = 2.0;
    auto solver =
        films("[[film]]\nshape = \"rectangle\"\nu = [0.08, 0.0, 0.0]\nv = [0.0, 0.0, 0.06]\n", 0.004,
              "steps_per_period = 0.0\nlargest_step = 5e-3\nair_drag = 3e-3\n[melp.heat]\nsource = \"below\"\n"
              "center = [0.0, 0.0, 0.06]\nreach = 0.06\ntime = 0.05\ntension_slope = " +
                  std::to_string(kSlope) + "\ntemperature = " + std::to_string(kRest + kWarmer));
    const double soap = scalar(*solver, "surfactant_amount");
    advance_to(*solver, 2.0);
    double n = 0.0, t1 = 0.0, t2 = 0.0, p1 = 0.0, tp = 0.0, least = 1.0, most = 0.0;
    for (std::size_t i = 0; i < solver->coarse().size(); ++i) {
        const double t = solver->films().temperature[i] - kRest;
        const double p = 8.31446261815324 * (kRest + t) * solver->films().concentration[i];
        n += 1.0;
        t1 += t;
        t2 += t * t;
        p1 += p;
        tp += t * p;
        least = std::min(least, solver->films().tension[i]);
        most = std::max(most, solver->films().tension[i]);
    }
    const double slope = (tp - t1 * p1 / n) / (t2 - t1 * t1 / n);
    std::printf(
        "heat, %.0f coarse: slope of R T Gamma %.4f of d sigma / dT, tension uneven by %.2f %% of what warmth "
        "takes, fastest %.1e\n",
        n, slope / kSlope, 100.0 * (most - least) / std::abs(kSlope * kWarmer), scalar(*solver, "max_velocity"));
    EXPECT_NEAR(slope / kSlope, 1.0, 0.02);
    EXPECT_NEAR(scalar(*solver, "surfactant_amount") / soap, 1.0, 1e-12);
    EXPECT_NEAR(scalar(*solver, "liquid_error"), 0.0, 1e-12);
}

/// A warm spot beside a floating bubble thins the film, which then rises. Pulls of the film on itself turn nothing, nor
/// do forces along the normals of a sphere: about its center only the weight of the liquid turns it, and the drag.
TEST(Heat, OfAWarmSpotMakesFilmRise) {
    constexpr double kDrag = 2e-4, kFrom = 0.4, kTo = 0.6;
    auto solver = bubble(800,
                         "floating = true\nsteps_per_period = 0.0\nlargest_step = 5e-3\nair_drag = 2e-4\n"
                         "[melp.heat]\nsource = \"ball\"\ncenter = [0.035, 0.0, -0.035]\nreach = 0.025\n"
                         "temperature = 299.15\n",
                         "gravity = [0.0, 0.0, -9.81]");
    struct Turn {
        double momentum = 0.0, weight = 0.0, drag = 0.0;
    };
    const auto turn_about_y = [&] {
        const CoarseParticles& coarse = solver->coarse();
        const Films& film = solver->films();
        Vec3 center;
        for (std::size_t i = 0; i < coarse.size(); ++i)
            center += coarse.position[i] / static_cast<double>(coarse.size());
        Turn turn;
        for (std::size_t i = 0; i < coarse.size(); ++i) {
            const Vec3 arm = coarse.position[i] - center;
            const double mass = 1000.0 * film.liquid_volume[i];
            turn.momentum += mass * cross(arm, film.along[i])[1];
            turn.weight += mass * 9.81 * arm[0];
            turn.drag += kDrag * solver->geometry().area[i] * cross(arm, film.along[i])[1];
        }
        return turn;
    };
    advance_to(*solver, kFrom);
    const Turn first = turn_about_y();
    Turn before = first, sum;
    for (double time = kFrom; time < kTo; time = solver->time()) {
        solver->advance(kTo);
        const Turn now = turn_about_y();
        sum.weight += 0.5 * (solver->time() - time) * (before.weight + now.weight);
        sum.drag += 0.5 * (solver->time() - time) * (before.drag + now.drag);
        before = now;
    }
    double warm = 0.0, rise = 0.0;
    for (std::size_t i = 0; i < solver->coarse().size(); ++i) {
        const double heat = (solver->films().temperature[i] - kRest) * solver->films().liquid_volume[i];
        warm += heat;
        rise += heat * solver->films().along[i][2];
    }
    const double balance = (before.momentum - first.momentum + sum.drag) / sum.weight;
    std::printf("warm spot: what turns the film %.4f of the weight, warm film rises at %.3f m/s\n", balance,
                rise / warm);
    EXPECT_NEAR(balance, 1.0, 0.05);
    EXPECT_GT(rise / warm, 0.1);
}

/// Air that turns as a whole takes a disk of film along: its angular velocity is W (1 - exp(-drag t / (rho eta))).
TEST(Wind, ThatTurnsSpinsAFilmUp) {
    constexpr double kSpin = 4.0, kTime = 0.4, kDrag = 1e-3;
    auto solver =
        films("[[film]]\nshape = \"disk\"\nradius = 0.05\n", 0.004,
              "steps_per_period = 0.0\nlargest_step = 2.5e-3\nair_drag = 1e-3\nwind_spin = [0.0, 0.0, 4.0]\n");
    advance_to(*solver, kTime);
    double turn = 0.0, inertia = 0.0;
    for (std::size_t i = 0; i < solver->coarse().size(); ++i) {
        const Vec3& x = solver->coarse().position[i];
        turn += solver->films().liquid_volume[i] * cross(x, solver->films().along[i])[2];
        inertia += solver->films().liquid_volume[i] * (x[0] * x[0] + x[1] * x[1]);
    }
    const double expected = kSpin * (1.0 - std::exp(-kDrag * kTime / kFilmMass));
    std::printf("spin, %zu coarse: %.4f of the closed form\n", solver->coarse().size(), turn / inertia / expected);
    EXPECT_NEAR(turn / inertia / expected, 1.0, 0.02);
}

}  // namespace
}  // namespace lamella::melp
