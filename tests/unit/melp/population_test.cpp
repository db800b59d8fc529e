// Coarse particles that come and go as films stretch and shrink.

#include "lamella/solvers/melp/population.h"

#include "lamella/core/parallel.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include <algorithm>

namespace lamella::melp {
namespace {

/// A film in a frame, one side of which moves away: up to 0.1 s.
std::unique_ptr<MelpSolver> drawn_film(const std::string& from, const std::string& speed, const std::string& options) {
    return films("[[film]]\nshape = \"rectangle\"\nu = [0.04, 0.0, 0.0]\nv = [0.0, 0.0, " + from +
                     "]\n[[wire]]\nshape = \"segment\"\nfrom = [0.0, 0.0, " + from + "]\nto = [0.04, 0.0, " + from +
                     "]\nvelocity = [0.0, 0.0, " + speed + "]\nend = 0.1\n",
                 0.003, options);
}

struct Spacings {
    double least, mean, largest;  // over the one at the start
};
Spacings spacings(const MelpSolver& solver) {
    const auto& area = solver.geometry().area;
    const auto [least, largest] = std::minmax_element(area.begin(), area.end());
    const double mean = total(area) / static_cast<double>(area.size()), h = solver.spacing();
    return {std::sqrt(*least) / h, std::sqrt(mean) / h, std::sqrt(*largest) / h};
}

/// Drawn out threefold and back: the spacing stays within a tenth on the mean and a third anywhere, and nothing is
/// lost.
TEST(Population, KeepsTheSpacingOfAFilmThatIsDrawnOutThreefold) {
    for (const bool out : {true, false}) {
        auto solver = drawn_film(out ? "0.03" : "0.09", out ? "0.6" : "-0.6", "fine_ratio = 8\n");
        const double liquid = scalar(*solver, "liquid_mass"), surfactant = scalar(*solver, "surfactant_amount");
        const auto before = static_cast<double>(solver->coarse().size());
        for (const double time : {0.03, 0.06, 0.1, 0.15}) {
            advance_to(*solver, time);
            const Spacings s = spacings(*solver);
            std::printf("t %.2f: %zu coarse, spacing %.3f (%.3f to %.3f)\n", time, solver->coarse().size(), s.mean,
                        s.least, s.largest);
            EXPECT_GT(s.least, 0.67) << time;
            EXPECT_LT(s.largest, 1.33) << time;
            EXPECT_NEAR(s.mean, 1.0, 0.11) << time;
        }
        EXPECT_NEAR(static_cast<double>(solver->coarse().size()) / before, out ? 3.0 : 1.0 / 3.0, out ? 0.6 : 0.08);
        EXPECT_NEAR(scalar(*solver, "liquid_mass") / liquid, 1.0, 1e-12);
        EXPECT_NEAR(scalar(*solver, "surfactant_amount") / surfactant, 1.0, 1e-12);
        EXPECT_EQ(scalar(*solver, "strays"), 0.0);
    }
}

/// Without it the film of the same test has a spacing of 1.7.
TEST(Population, StaysAsItIsWhereItIsToldTo) {
    auto solver = drawn_film("0.03", "0.6", "insertion = false\n");
    const std::size_t before = solver->coarse().size();
    advance_to(*solver, 0.1);
    EXPECT_EQ(solver->coarse().size(), before);
    EXPECT_GT(spacings(*solver).mean, 1.6);
}

/// A bubble that has lost every third of its particles is filled up; its gas, liquid and momentum stay.
TEST(Population, FillsABubbleUpThatFlies) {
    for (const char* ratio : {"0", "8"}) {
        auto solver = films("[[bubble]]\nradius = 0.05\nvelocity = [0.5, 0.0, 0.2]\n", edge_for(900),
                            std::string("fine_ratio = ") + ratio + "\nstart.thickness_noise = 0.3\n");
        test::StateMemory state = state_of(*solver);
        for (const char* name : {"coarse/position", "coarse/frame_normal", "coarse/velocity"}) {
            std::vector<double> kept;
            for (std::size_t i = 0; i < 900; ++i)
                if (i % 3 != 0) kept.insert(kept.end(), &state.reals[name][3 * i], &state.reals[name][3 * i] + 3);
            state.reals[name] = kept;
        }
        state.integers["coarse/region"].resize(600);
        state.integers["coarse/count"] = {600};
        solver->load(state);
        ASSERT_EQ(solver->coarse().size(), 600U);
        const double amount = solver->gas()[0].amount, liquid = scalar(*solver, "liquid_mass");
        const Vec3 momentum{
            {scalar(*solver, "momentum_x"), scalar(*solver, "momentum_y"), scalar(*solver, "momentum_z")}};
        const double size = norm(momentum);
        for (int k = 0; k < 40; ++k) solver->advance(1e9);
        EXPECT_GT(solver->coarse().size(), 740U);
        EXPECT_LT(solver->coarse().size(), 960U);
        EXPECT_EQ(solver->gas()[0].amount, amount);
        EXPECT_NEAR(scalar(*solver, "liquid_mass") / liquid, 1.0, 1e-12);
        EXPECT_EQ(scalar(*solver, "flipped_normals"), 0.0);
        EXPECT_LT(scalar(*solver, "density_spread"), 0.3);
        const Vec3 now{{scalar(*solver, "momentum_x"), scalar(*solver, "momentum_y"), scalar(*solver, "momentum_z")}};
        std::printf("fine_ratio %s: %zu coarse, momentum %.1e\n", ratio, solver->coarse().size(),
                    norm(now - momentum) / size);
        EXPECT_LT(norm(now - momentum) / size, ratio[0] == '0' ? 1e-8 : 1e-7);
    }
}

TEST(Population, GivesTheSameBitsOnAnyNumberOfThreadsAndAfterAResume) {
    constexpr int kSteps = 120;
    std::vector<test::StateMemory> states;
    std::size_t before = 0;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        auto solver = drawn_film("0.03", "0.6", "fine_ratio = 4\n");
        before = solver->coarse().size();
        advance(*solver, kSteps);
        EXPECT_GT(solver->coarse().size(), before);
        states.push_back(state_of(*solver));
    }
    auto first = drawn_film("0.03", "0.6", "fine_ratio = 4\n");
    advance(*first, 77);
    test::StateMemory memory = state_of(*first);
    auto second = drawn_film("0.03", "0.6", "fine_ratio = 4\n");
    second->load(memory);
    advance(*second, kSteps - 77);
    states.push_back(state_of(*second));
    for (std::size_t k : {1, 2}) {
        EXPECT_EQ(states[0].reals, states[k].reals) << k;
        EXPECT_EQ(states[0].integers, states[k].integers) << k;
    }
}

}  // namespace
}  // namespace lamella::melp
