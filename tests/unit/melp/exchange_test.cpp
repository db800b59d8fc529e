// Liquid that passes between the films of two bubbles.

#include "lamella/solvers/melp/exchange.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>

#include "bubbles.h"
#include "same_bits.h"
#include <string>

namespace lamella::melp {
namespace {

constexpr int kSide = 30;

/// Two flat layers in one place, whose normals face each other.
CoarseParticles two_layers() {
    CoarseParticles coarse;
    for (const int layer : {0, 1})
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j) {
                coarse.position.push_back({{i + 0.5 * (j % 2), 0.866 * j, 0.0}});
                coarse.frame_normal.push_back({{0.0, 0.0, layer == 0 ? 1.0 : -1.0}});
                coarse.region.push_back(layer);
            }
    coarse.velocity.resize(coarse.size());
    return coarse;
}

Films even_films(const Geometry& geometry, const CoarseParticles& coarse, double first, double second) {
    Films films;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        films.thickness.push_back(coarse.region[i] == 0 ? first : second);
        films.liquid_volume.push_back(films.thickness[i] * geometry.area[i]);
        films.concentration.push_back(2.0 * films.thickness[i]);
        films.temperature.push_back(coarse.region[i] == 0 ? 300.0 : 310.0);
    }
    films.dry.resize(coarse.size(), 0);
    return films;
}

/// The difference of two even films falls as exp(-rate t), in one long step or many short ones; nothing gets lost.
TEST(Exchange, EvensTwoFilmsFaceToFaceOutAtItsRate) {
    const CoarseParticles coarse = two_layers();
    const Geometry geometry = geometry_of(coarse, 3.0);
    const std::size_t middle = kSide * kSide / 2 + kSide / 2, facing = middle + kSide * kSide;
    std::vector<Vec3> velocity(coarse.size());
    for (std::size_t i = 0; i < coarse.size(); ++i) velocity[i] = {{coarse.region[i] == 0 ? 0.3 : -0.1, 0.2, 0.0}};
    constexpr double kRate = 3.0, kTime = 0.4, kFirst = 5.0, kSecond = 2.0;
    for (const int steps : {1, 4}) {
        Films films = even_films(geometry, coarse, kFirst, kSecond);
        std::vector<Vec3> momentum;  // of the two in the middle
        for (std::size_t i : {middle, facing}) momentum.push_back(films.thickness[i] * velocity[i]);
        std::vector<Vec3> now = velocity;
        double total_gain = 0.0, soap_gain = 0.0, heat_gain = 0.0;
        Vec3 pushed;
        for (int n = 0; n < steps; ++n) {
            const Exchange e = exchange_between(geometry, films, now, {}, kRate, kTime / steps);
            for (std::size_t i = 0; i < coarse.size(); ++i) {
                const double before = films.thickness[i];
                films.thickness[i] += e.liquid_volume[i] / geometry.area[i];
                films.concentration[i] += e.surfactant[i] / geometry.area[i];
                now[i] = (before * now[i] + e.momentum[i] / geometry.area[i]) / films.thickness[i];
                films.temperature[i] =
                    (before * films.temperature[i] + e.heat[i] / geometry.area[i]) / films.thickness[i];
                total_gain += e.liquid_volume[i];
                heat_gain += e.heat[i];
                soap_gain += e.surfactant[i];
                pushed += e.momentum[i];
            }
        }
        const double left = std::exp(-kRate * kTime), mean = 0.5 * (kFirst + kSecond);
        EXPECT_NEAR(films.thickness[middle], mean + 0.5 * left * (kFirst - kSecond), 1e-12);
        EXPECT_NEAR(films.thickness[facing], mean - 0.5 * left * (kFirst - kSecond), 1e-12);
        EXPECT_NEAR(films.concentration[middle] - films.concentration[facing], 2.0 * left * (kFirst - kSecond), 1e-12);
        const Vec3 difference = films.thickness[middle] * now[middle] - films.thickness[facing] * now[facing];
        EXPECT_LT(norm(difference - left * (momentum[0] - momentum[1])), 1e-12);
        EXPECT_NEAR(
            films.thickness[middle] * films.temperature[middle] - films.thickness[facing] * films.temperature[facing],
            left * (kFirst * 300.0 - kSecond * 310.0), 1e-10);
        EXPECT_LT(std::abs(heat_gain), 1e-10 * kFirst * kSide * kSide);
        EXPECT_LT(std::abs(total_gain), 1e-12 * kFirst * kSide * kSide);
        EXPECT_LT(std::abs(soap_gain), 1e-12 * kFirst * kSide * kSide);
        EXPECT_LT(norm(pushed), 1e-12 * kFirst * kSide * kSide);
    }
}

TEST(Exchange, DoesNothingBetweenFilmsThatHaveNotJoinedOrDoNotFaceEachOther) {
    CoarseParticles coarse = two_layers();
    Geometry geometry = geometry_of(coarse, 3.0);
    const std::vector<double> apart(geometry.neighbors.other.index.size(), 0.0);
    const Films films = even_films(geometry, coarse, 5.0, 2.0);
    const auto gains = [&](std::span<const double> joined) {
        double most = 0.0;
        for (const double v : exchange_between(geometry, films, coarse.velocity, joined, 1.0, 1.0).liquid_volume)
            most = std::max(most, std::abs(v));
        return most;
    };
    EXPECT_GT(gains({}), 0.1);
    EXPECT_EQ(gains(apart), 0.0);
    for (Vec3& n : coarse.frame_normal) n = {{0.0, 0.0, 1.0}};
    geometry = geometry_of(coarse, 3.0);
    EXPECT_EQ(gains({}), 0.0);
}

/// Two bubbles that have just touched, with 600 and 300 nm of film.
std::string uneven_pair(const std::string& options) {
    return R"(
[material]
surface_tension = 0.025
thickness = 5e-7
surfactant = 1e-6
[[bubble]]
center = [-0.01004, 0.0, 0.0]
radius = 0.01
thickness = 6e-7
[[bubble]]
center = [0.01004, 0.0, 0.0]
radius = 0.01
thickness = 3e-7
[resolution]
edge_length = 0.0016
[melp]
fine_ratio = 8
shape_damping = 2000.0
steps_per_period = 0
largest_step = 5e-4
)" + options;
}

TEST(Exchange, EvensBubblesOutThroughTheirPartitionAndLosesNothing) {
    for (const double rate : {0.0, 100.0}) {
        auto solver = started(uneven_pair("exchange_rate = " + std::to_string(rate) + "\n"));
        const auto of = [&](const char* name) { return scalar(*solver, name); };
        const double first = of("liquid_mass_1"), second = of("liquid_mass_2");
        EXPECT_NEAR(first / second, 2.0, 1e-9);
        const double soap = of("surfactant_amount");
        advance_to(*solver, 0.08);
        EXPECT_NEAR(of("liquid_error"), 0.0, 1e-12);
        EXPECT_NEAR(of("surfactant_amount") / soap, 1.0, 1e-12);
        std::printf("rate %g: %.4f of the liquid on the first\n", rate, of("liquid_mass_1") / (first + second));
        if (rate == 0.0) {
            EXPECT_NEAR(of("liquid_mass_1") / first, 1.0, 1e-12);
        } else {
            EXPECT_LT(of("liquid_mass_1") / (first + second), 0.6);
            EXPECT_GT(of("liquid_mass_1") / (first + second), 0.5);
        }
        EXPECT_EQ(of("strays"), 0.0);
    }
}

TEST(Exchange, GivesTheSameBitsOnAnyNumberOfThreadsAndAfterAResume) {
    expect_same_bits([] { return started(uneven_pair("exchange_rate = 100.0\njoining_delay = 0.004\n")); }, 50, 31);
}

TEST(Exchange, IsRefusedWithoutFineParticles) {
    EXPECT_THROW(solver_of("[[bubble]]\nradius = 0.01\n[melp]\nfine_ratio = 0\nexchange_rate = 1.0\n"), InputError);
    EXPECT_THROW(solver_of("[[bubble]]\nradius = 0.01\n[melp]\nexchange_rate = -1.0\n"), InputError);
}

}  // namespace
}  // namespace lamella::melp
