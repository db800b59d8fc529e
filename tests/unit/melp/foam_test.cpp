// Foams: bubbles that enter, touch, join, rest on walls, burst and become one.

#include "lamella/solvers/melp/foam.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include <algorithm>
#include <string>

namespace lamella::melp {
namespace {

/// Three that touch, 0.2 mm apart at the start.
const std::string kThree = R"(
[material]
surface_tension = 0.025
thickness = 5e-7
[[bubble]]
center = [-0.01, 0.0, 0.0]
radius = 0.0099
[[bubble]]
center = [0.01, 0.0, 0.0]
radius = 0.0099
[[bubble]]
center = [0.0, 0.0173, 0.0]
radius = 0.0099
[resolution]
edge_length = 0.0016
)";

/// Bubbles from a faucet onto a wall; one bursts.
const std::string kPour = R"(
seed = 4
[material]
surface_tension = 0.025
thickness = 5e-7
gravity = [0.0, 0.0, -9.81]
[[faucet]]
center = [0.0, 0.0, 0.013]
velocity = [0.0, 0.0, -0.5]
count = 3
radius = 0.01
radius_spread = 0.1
interval = 0.002
[[wall]]
normal = [0.0, 0.0, 1.0]
[[event]]
region = 0
time = 0.03
[resolution]
edge_length = 0.0015
[melp]
fine_ratio = 2
joining_delay = 0.01
shape_damping = 5000.0
damping = 20.0
steps_per_period = 0
largest_step = 5e-4
)";

/// Sum of the areas between regions a and b, as a has them.
double shared(const MelpSolver& solver, std::size_t a, std::size_t b) {
    return shared_film(solver.coarse(), solver.geometry(), solver.gas().size(), a)[b];
}

/// Between the means of the particles of two regions [m].
double distance(const MelpSolver& solver, std::int32_t a, std::int32_t b) {
    Vec3 sum[2];
    double count[2] = {0.0, 0.0};
    for (std::size_t i = 0; i < solver.coarse().size(); ++i)
        for (const int k : {0, 1})
            if (solver.coarse().region[i] == (k == 0 ? a : b)) {
                sum[k] += solver.coarse().position[i];
                count[k] += 1.0;
            }
    return norm(sum[0] / count[0] - sum[1] / count[1]);
}

/// Two balls touch at a distance of 19.8 mm; as a double bubble their middles are 16 mm apart.
TEST(Foam, JoinsAtOnceAfterADelayOrNever) {
    const std::string melp =
        "[melp]\nfine_ratio = 0\nshape_damping = 2000.0\nsteps_per_period = 0\nlargest_step = 5e-4\n";
    auto at_once = solver_of(kThree + melp), delayed = solver_of(kThree + melp + "joining_delay = 0.01\n"),
         never = solver_of(kThree + melp + "joining = false\n");
    for (MelpSolver* solver : {at_once.get(), delayed.get(), never.get()}) {
        solver->start({});
        advance_to(*solver, 0.009);
    }
    EXPECT_LT(distance(*at_once, 0, 1), 0.019);
    EXPECT_GT(distance(*delayed, 0, 1), 0.0198);
    EXPECT_GT(distance(*never, 0, 1), 0.0198);
    advance_to(*delayed, 0.03);
    EXPECT_LT(distance(*delayed, 0, 1), 0.019);
    advance_to(*never, 0.03);
    EXPECT_GT(distance(*never, 0, 1), 0.0198);
}

TEST(Foam, KeepsBubblesApartThatFlyAtEachOtherAndMustNotJoin) {
    auto solver = solver_of(R"(
[[bubble]]
center = [-0.0115, 0.0, 0.0]
radius = 0.01
velocity = [2.0, 0.0, 0.0]
[[bubble]]
center = [0.0115, 0.001, 0.0]
radius = 0.01
velocity = [-2.0, 0.0, 0.0]
[resolution]
edge_length = 0.0016
[melp]
fine_ratio = 0
joining = false
)");
    solver->start({});
    double nearest = 1.0;
    while (solver->time() < 0.03) {
        solver->advance(0.03);
        nearest = std::min(nearest, distance(*solver, 0, 1));
    }
    EXPECT_GT(nearest, 0.01);
    EXPECT_LT(nearest, 0.02);  // they have met
    Vec3 first, second;
    for (std::size_t i = 0; i < solver->coarse().size(); ++i)
        (solver->coarse().region[i] == 0 ? first : second) += solver->coarse().velocity[i];
    EXPECT_LT(first[0], 0.0);  // they have bounced off each other
    EXPECT_GT(second[0], 0.0);
    EXPECT_EQ(scalar(*solver, "flipped_normals"), 0.0);
    EXPECT_LT(std::abs(scalar(*solver, "momentum_x")), 1e-9);
}

TEST(Foam, GivesTheLiquidOfABubbleThatBurstsToItsNeighborsAndTheAir) {
    for (const char* fine : {"0", "4"}) {
        auto solver =
            solver_of(kThree + "[[event]]\nregion = 3\ninto = 0\ntime = 0.02\n[melp]\nshape_damping = 5000.0\n" +
                      "steps_per_period = 0\nlargest_step = 5e-4\nfine_ratio = " + fine + "\n");
        solver->start({});
        advance_to(*solver, 0.0199);
        const double before = scalar(*solver, "liquid_mass");
        const double share = (shared(*solver, 2, 0) + shared(*solver, 2, 1)) /
                             (shared(*solver, 2, 0) + shared(*solver, 2, 1) + shared(*solver, 2, 2));
        advance_to(*solver, 0.03);
        EXPECT_EQ(scalar(*solver, "bubbles"), 2.0);
        EXPECT_NEAR(scalar(*solver, "liquid_error"), 0.0, 1e-12);
        const double left = scalar(*solver, "liquid_left");
        EXPECT_NEAR(left / (before / 3.0), 1.0 - share, 0.05);
        EXPECT_NEAR(scalar(*solver, "liquid_mass") + left, before, 1e-12 * before);
        EXPECT_EQ(scalar(*solver, "flipped_normals"), 0.0);
        advance_to(*solver, 0.06);
        EXPECT_LT(scalar(*solver, "density_spread"), 0.4);
    }
}

/// Gas is kept: p V of the one that two have become is the sum of theirs; at rest its pressure is that of a sphere.
TEST(Foam, MakesOneBubbleOfTwoWhoseFilmBursts) {
    for (const char* fine : {"0", "4"}) {
        auto solver = solver_of(R"(
[material]
surface_tension = 0.025
thickness = 5e-7
[[bubble]]
center = [-0.01, 0.0, 0.0]
radius = 0.0099
[[bubble]]
center = [0.01, 0.0, 0.0]
radius = 0.0099
[[event]]
region = 1
into = 2
time = 0.015
[resolution]
edge_length = 0.0016
[melp]
shape_damping = 2000.0
steps_per_period = 0
largest_step = 5e-4
air_drag = 0.1
fine_ratio = )" + std::string(fine) +
                                "\n");
        solver->start({});
        const double amount = solver->gas()[0].amount + solver->gas()[1].amount;
        advance_to(*solver, 0.1);
        EXPECT_EQ(scalar(*solver, "bubbles"), 1.0);
        EXPECT_EQ(scalar(*solver, "liquid_left"), 0.0);
        EXPECT_NEAR(scalar(*solver, "liquid_error"), 0.0, 1e-12);
        EXPECT_EQ(scalar(*solver, "flipped_normals"), 0.0);
        const Gas& gas = solver->gas()[1];
        EXPECT_EQ(gas.amount, amount);
        const double radius = gas.radius();
        EXPECT_NEAR(radius / (0.0099 * std::cbrt(2.0)), 1.0, 0.01);
        Vec3 center;
        for (const Vec3& x : solver->coarse().position) center += x / static_cast<double>(solver->coarse().size());
        double farthest = 0.0;
        for (const Vec3& x : solver->coarse().position)
            farthest = std::max(farthest, std::abs(norm(x - center) / radius - 1.0));
        EXPECT_LT(farthest, 0.03);
        // The surfactant of the partition is on the bubble now, and lowers its tension.
        double tension = 0.0;
        for (const double sigma : solver->films().tension) tension += sigma;
        tension /= static_cast<double>(solver->films().tension.size());
        EXPECT_NEAR(gas.balanced * radius / (4.0 * tension), 1.0, 0.005);
        EXPECT_LT(scalar(*solver, "max_velocity"), 0.03);
    }
}

/// It is as flat there as its pressure needs to carry its weight.
TEST(Foam, RestsABubbleOnAWall) {
    auto solver = solver_of(R"(
[material]
surface_tension = 0.025
thickness = 1e-5
gravity = [0.0, 0.0, -9.81]
[[bubble]]
center = [0.0, 0.0, 0.0101]
radius = 0.01
[[wall]]
[resolution]
edge_length = 0.001
[melp]
fine_ratio = 0
damping = 50.0
steps_per_period = 0
largest_step = 1e-3
)");
    solver->start({});
    advance_to(*solver, 1.0);
    EXPECT_LT(scalar(*solver, "max_velocity"), 1e-3);
    const double weight = scalar(*solver, "liquid_mass") * 9.81;
    double lowest = 1.0, flat = 0.0;
    for (std::size_t i = 0; i < solver->coarse().size(); ++i) {
        lowest = std::min(lowest, solver->coarse().position[i][2]);
        if (solver->coarse().position[i][2] < 0.0) flat += solver->geometry().area[i];
    }
    EXPECT_GT(lowest, -1e-4);
    EXPECT_NEAR(flat * solver->gas()[0].balanced / weight, 1.0, 0.15);  // a particle more or less
}

TEST(Foam, BurstsBubblesOnAWallThatDoes) {
    auto solver = solver_of(R"(
[[bubble]]
center = [0.0, 0.0, 0.0102]
radius = 0.01
velocity = [0.0, 0.0, -0.5]
[[bubble]]
center = [0.0, 0.0, 0.0405]
radius = 0.01
[[wall]]
bursts = true
[resolution]
edge_length = 0.0016
[melp]
fine_ratio = 0
)");
    solver->start({});
    EXPECT_EQ(scalar(*solver, "bubbles"), 2.0);
    advance_to(*solver, 0.002);
    EXPECT_EQ(scalar(*solver, "bubbles"), 1.0);
    EXPECT_NEAR(scalar(*solver, "liquid_left"), scalar(*solver, "liquid_mass"), 1e-9 * scalar(*solver, "liquid_mass"));
}

TEST(Foam, LetsBubblesInWhenTheirPlaceIsFree) {
    auto solver = solver_of(kPour);
    solver->start({});
    EXPECT_EQ(scalar(*solver, "bubbles"), 1.0);
    advance_to(*solver, 0.004);  // the first has not gone far enough
    EXPECT_EQ(scalar(*solver, "bubbles"), 1.0);
    advance_to(*solver, 0.029);
    EXPECT_GE(scalar(*solver, "bubbles"), 1.0);
    EXPECT_NEAR(scalar(*solver, "liquid_error"), 0.0, 1e-12);
    const double before = scalar(*solver, "bubbles");
    advance_to(*solver, 0.031);
    EXPECT_NEAR(scalar(*solver, "liquid_error"), 0.0, 1e-12);
    EXPECT_GT(scalar(*solver, "liquid_left"), 0.0);
    EXPECT_LE(scalar(*solver, "bubbles"), before);
}

TEST(Foam, GivesTheSameBitsOnAnyNumberOfThreadsAndAfterAResume) {
    constexpr double kEnd = 0.032;
    std::vector<test::StateMemory> states;
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        auto solver = solver_of(kPour);
        solver->start({});
        advance_to(*solver, kEnd);
        states.push_back(state_of(*solver));
    }
    for (const double stop : {0.0005, 0.02}) {
        auto first = solver_of(kPour);
        first->start({});
        while (first->time() < stop) first->advance(kEnd);
        test::StateMemory memory = state_of(*first);
        auto second = solver_of(kPour);
        second->load(memory);
        advance_to(*second, kEnd);
        states.push_back(state_of(*second));
    }
    for (const test::StateMemory& state : states) {
        EXPECT_EQ(state.reals, states[0].reals);
        EXPECT_EQ(state.integers, states[0].integers);
    }
}

TEST(Foam, TellsHowManyBubblesWaitForTheirPlace) {
    auto solver = solver_of(kPour);
    solver->start({});
    EXPECT_EQ(scalar(*solver, "waiting_bubbles"), 0.0);
    advance_to(*solver, 0.005);  // the first has sunk by a quarter of its radius
    EXPECT_EQ(scalar(*solver, "bubbles"), 1.0);
    EXPECT_EQ(scalar(*solver, "waiting_bubbles"), 2.0);
}

/// The mesh of [foam] has cells of up to twice the volumes: bubbles start as balls that just do not touch.
TEST(Foam, StartsFromTheFoamOfAScene) {
    auto solver = solver_of(
        "seed = 1\n[foam]\ncount = 5\nvolume = 4e-6\n[resolution]\nedge_length = 0.0016\n"
        "[melp]\nfine_ratio = 0\n");
    solver->start({});
    EXPECT_EQ(scalar(*solver, "bubbles"), 5.0);
    std::vector<Vec3> center(5);
    std::vector<double> count(5, 0.0);
    for (std::size_t i = 0; i < solver->coarse().size(); ++i) {
        center[static_cast<std::size_t>(solver->coarse().region[i])] += solver->coarse().position[i];
        count[static_cast<std::size_t>(solver->coarse().region[i])] += 1.0;
    }
    double nearest = 1.0;
    for (std::size_t a = 0; a < 5; ++a) {
        EXPECT_NEAR(solver->gas()[a].volume, 4e-6, 1e-12);
        for (std::size_t b = 0; b < a; ++b)
            nearest = std::min(nearest, norm(center[a] / count[a] - center[b] / count[b]));
    }
    EXPECT_NEAR(nearest / (2.0 * solver->gas()[0].radius()), 1.01, 0.005);
}

TEST(Foam, IsRefusedByNameWhereItIsNotBuilt) {
    const auto refused = [](const std::string& scene, const std::string& what) {
        try {
            solver_of(scene);
        } catch (const InputError& error) {
            return std::string(error.what()).find(what) != std::string::npos;
        }
        return false;
    };
    EXPECT_TRUE(refused(kThree + "[[event]]\nkind = \"puncture\"\n", "puncture in scenes of several bubbles"));
    EXPECT_TRUE(refused(kThree + "[[wall]]\nnormal = [0.0, 0.0, 0.0]\n", "wall.normal"));
    EXPECT_TRUE(refused(kThree + "[[wall]]\npoint = [0.0, 0.0, 0.0]\n", "behind [[wall]] 1"));
    EXPECT_TRUE(refused(kThree + "[[wall]]\npoint = [0.0, 0.0, -0.1]\n[[faucet]]\nradius = 0.01\ncenter = [0.0, 0.0, "
                                 "-0.095]\n",
                        "bubble 4 starts 0.005 m behind [[wall]] 1"));
    EXPECT_TRUE(refused(kThree + "[[faucet]]\n", "faucet.radius"));
    EXPECT_TRUE(refused(kThree + "[[faucet]]\nradius = 0.005\n", "too coarse for bubble 4"));
}

}  // namespace
}  // namespace lamella::melp
