#include "lamella/measure/measure.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/measure/local_gas_fraction.h"

#include <gtest/gtest.h>

#include "../dist/process_team.h"
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace lamella::measure {
namespace {

constexpr double kPi = std::numbers::pi;

/// Three discs in a 4 x 5 box, every field that a wet foam has.
sim::Frame three_discs() {
    sim::Frame frame;
    frame.solver = "toy";
    frame.time_unit = "-";
    frame.box = sim::Box{.dimension = 2, .origin = {}, .lengths = {{4.0, 5.0, 0.0}}, .periodic = {true, true, false}};
    frame.points.length_unit = "-";
    frame.points.position = {{{1.0, 1.0, 0.0}}, {{2.0, 2.0, 0.0}}, {{3.0, 4.0, 0.0}}};
    frame.points.radius = {0.5, 1.0, 0.3};
    frame.points.fields = {
        {"contacts", "-", 1, true, {2.0, 3.0, 4.0}},
        {"velocity", "-", 3, false, {1.0, 0.0, 0.0, 1.0, 3.0, 0.0, 1.0, 0.0, 0.0}},
        {"path_length", "-", 1, false, {1.0, 2.0, 6.0}},
        {"displacement", "-", 3, false, {1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 4.0}},
    };
    return frame;
}

double value(const sim::Frame& frame, std::string_view name) { return find_value(measure_frame(frame), name).value(); }

TEST(MeasureFrame, GivesTheMeansOfItsDefinition) {
    const sim::Frame frame = three_discs();
    EXPECT_EQ(value(frame, "bubbles"), 3.0);
    EXPECT_NEAR(value(frame, "gas_fraction"), kPi * (0.25 + 1.0 + 0.09) / 20.0, 1e-15);
    EXPECT_NEAR(value(frame, "mean_radius"), 0.6, 1e-15);
    EXPECT_NEAR(value(frame, "mean_square_radius"), 1.34 / 3.0, 1e-15);
    EXPECT_EQ(value(frame, "max_radius"), 1.0);
    EXPECT_NEAR(value(frame, "mean_contacts"), 3.0, 1e-15);
    EXPECT_NEAR(value(frame, "rattlers"), 1.0 / 3.0, 1e-15);     // fewer than 3 contacts in two dimensions
    EXPECT_NEAR(value(frame, "velocity_variance"), 2.0, 1e-14);  // <v^2> = 4, <v> = (1, 1): 4 - 2
    EXPECT_NEAR(value(frame, "mean_path"), 3.0, 1e-15);
    EXPECT_NEAR(value(frame, "mean_square_displacement"), 7.0, 1e-14);
}

TEST(MeasureFrame, CountsVolumesAndRattlersByDimension) {
    sim::Frame frame = three_discs();
    frame.box->dimension = 3;
    frame.box->lengths = {{4.0, 5.0, 6.0}};
    EXPECT_NEAR(value(frame, "gas_fraction"), 4.0 / 3.0 * kPi * (0.125 + 1.0 + 0.027) / 120.0, 1e-15);
    EXPECT_NEAR(value(frame, "rattlers"), 2.0 / 3.0, 1e-15);
}

TEST(MeasureFrame, LeavesOutWhatItCannotMeasure) {
    sim::Frame frame = three_discs();
    frame.points.fields.clear();
    frame.box.reset();
    const auto measures = measure_frame(frame);
    EXPECT_TRUE(find_value(measures, "mean_radius"));
    for (const char* name : {"gas_fraction", "gas_fraction_spread", "mean_contacts", "rattlers", "velocity_variance"})
        EXPECT_FALSE(find_value(measures, name)) << name;
    frame.points.radius.clear();
    EXPECT_TRUE(measure_frame(frame).empty());
    EXPECT_TRUE(measure_frame({}).empty());
}

TEST(MeasureFrame, HasNoNumberForWhatIsNone) {
    sim::Frame frame = three_discs();
    frame.points.fields[1].values[4] = std::nan("");
    frame.points.fields[2].values[0] = std::numeric_limits<double>::infinity();
    frame.points.fields[3].values[0] = 1e200;   // its square is infinite
    frame.points.fields[3].values[4] = 1e-160;  // and this one's has few bits
    EXPECT_TRUE(std::isnan(value(frame, "velocity_variance")));
    EXPECT_TRUE(std::isnan(value(frame, "mean_path")));
    EXPECT_TRUE(std::isnan(value(frame, "mean_square_displacement")));
    EXPECT_NEAR(value(frame, "mean_radius"), 0.6, 1e-15);
    frame.points.fields[3].values.assign(9, 1e-160);
    EXPECT_NEAR(value(frame, "mean_square_displacement"), 0.0, 1e-270);
}

TEST(MeasureFrame, RefusesFieldsThatDoNotFit) {
    sim::Frame frame = three_discs();
    frame.points.fields[0].values.pop_back();
    EXPECT_THROW(measure_frame(frame), InputError);
    frame = three_discs();
    frame.points.radius.pop_back();
    EXPECT_THROW(measure_frame(frame), InputError);
}

/// Random discs or balls in a box of which some axes have walls; they reach across every side.
sim::Frame random_balls(int dimension, std::array<bool, 3> periodic, std::size_t count) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    sim::Frame frame;
    frame.box = sim::Box{.dimension = dimension,
                         .origin = {{-3.0, 2.0, 1.0}},
                         .lengths = {{10.0, 12.0, dimension == 2 ? 0.0 : 9.0}},
                         .periodic = periodic};
    for (std::size_t i = 0; i < count; ++i) {
        Vec3 x = frame.box->origin;
        for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k)
            x[k] += frame.box->lengths[k] * uniform(random);
        frame.points.position.push_back(x);
        frame.points.radius.push_back(0.1 + 2.0 * uniform(random));
    }
    return frame;
}

class LocalGasFraction : public testing::TestWithParam<std::pair<int, bool>> {};

TEST_P(LocalGasFraction, LosesNoGas) {
    const auto [dimension, periodic] = GetParam();
    const sim::Frame frame = random_balls(dimension, {periodic, true, periodic}, 60);
    const std::vector<double> local = local_gas_fraction(frame.points, *frame.box, 10);
    ASSERT_EQ(local.size(), dimension == 2 ? 100u : 1000u);
    double mean = 0.0;
    for (const double fraction : local) mean += fraction / static_cast<double>(local.size());
    // Rounding: each disc is a difference of areas of its own size.
    EXPECT_NEAR(mean, value(frame, "gas_fraction"), 1e-12);
}
INSTANTIATE_TEST_SUITE_P(
    BothDimensionsPeriodicAndWalled,
    LocalGasFraction,
    testing::Values(std::pair{2, true}, std::pair{2, false}, std::pair{3, true}, std::pair{3, false}));

/// The share of cell `cell` of a disc or ball by counting points.
double counted_fraction(const sim::Points& ball, const sim::Box& box, int cells, std::size_t cell) {
    const auto n = static_cast<std::size_t>(cells);
    const std::array<std::size_t, 3> index{cell % n, cell / n % n, cell / n / n};
    constexpr int kPoints = 60;
    const int depth = box.dimension == 2 ? 1 : kPoints;
    int inside = 0;
    for (int a = 0; a < kPoints; ++a)
        for (int b = 0; b < kPoints; ++b)
            for (int c = 0; c < depth; ++c) {
                const std::array<double, 3> offset{(a + 0.5) / kPoints, (b + 0.5) / kPoints, (c + 0.5) / depth};
                double squared = 0.0;
                for (std::size_t k = 0; k < static_cast<std::size_t>(box.dimension); ++k) {
                    const double x =
                        box.origin[k] + box.lengths[k] / cells * (static_cast<double>(index[k]) + offset[k]);
                    double d = x - ball.position[0][k];
                    d -= box.lengths[k] * std::round(d / box.lengths[k]);
                    squared += d * d;
                }
                if (squared < ball.radius[0] * ball.radius[0]) ++inside;
            }
    return static_cast<double>(inside) / (kPoints * kPoints * depth);
}

/// A frame's balls from `first` on, up to `end`.
sim::Frame stretch(const sim::Frame& frame, std::size_t first, std::size_t end) {
    sim::Frame part = frame;
    const auto cut = [&](auto& values, std::size_t components) {
        values.erase(values.begin() + static_cast<std::ptrdiff_t>(end * components), values.end());
        values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first * components));
    };
    cut(part.points.position, 1);
    cut(part.points.radius, 1);
    for (sim::Field& field : part.points.fields) cut(field.values, static_cast<std::size_t>(field.components));
    return part;
}

TEST(MeasureFrame, GivesTheSameBitsForSharesOfProcesses) {
    for (const int dimension : {2, 3}) {
        constexpr std::size_t kCount = 9000;
        sim::Frame frame = random_balls(dimension, {true, false, true}, kCount);
        std::vector<double> speed(3 * kCount);
        for (std::size_t n = 0; n < speed.size(); ++n) speed[n] = std::sin(0.7 * static_cast<double>(n * n));
        frame.points.fields = {{"velocity", "-", 3, false, speed}};
        const auto whole = measure_frame(frame);
        EXPECT_GE(whole.size(), 7U);
        test::as_processes(3, [&](const auto& processes) {  // the second has none
            const std::array<std::size_t, 4> cut{0, 5000, 5000, kCount};
            const auto rank = static_cast<std::size_t>(processes->rank());
            const auto shared = measure_frame(stretch(frame, cut[rank], cut[rank + 1]), *processes);
            ASSERT_EQ(shared.size(), whole.size());
            for (std::size_t k = 0; k < whole.size(); ++k)
                EXPECT_EQ(shared[k].value, whole[k].value) << whole[k].name << ", process " << rank;
        });
    }
}

TEST(LocalGasFractionOfOneBall, IsThatOfCountedPoints) {
    for (const int dimension : {2, 3}) {
        sim::Box box{
            .dimension = dimension, .origin = {}, .lengths = {{4.0, 4.0, 4.0}}, .periodic = {true, true, true}};
        sim::Points ball;
        ball.position = {{{0.3, 3.1, 1.9}}};
        ball.radius = {1.3};
        const std::vector<double> local = local_gas_fraction(ball, box, 4);
        for (std::size_t cell = 0; cell < local.size(); ++cell)
            EXPECT_NEAR(local[cell], counted_fraction(ball, box, 4, cell), 0.01) << dimension << "D cell " << cell;
    }
}

TEST(LocalGasFractionOfOneBall, RefusesWhatCannotBe) {
    sim::Frame frame = random_balls(2, {true, true, false}, 2);
    EXPECT_THROW(local_gas_fraction(frame.points, *frame.box, 0), InputError);
    sim::Points bad = frame.points;
    bad.position[0][0] = std::nan("");
    EXPECT_THROW(local_gas_fraction(bad, *frame.box, 10), InputError);
    bad = frame.points;
    bad.radius[1] = 1e9;
    EXPECT_THROW(local_gas_fraction(bad, *frame.box, 10), InputError);
    frame.box->lengths[1] = 0.0;
    EXPECT_THROW(local_gas_fraction(frame.points, *frame.box, 10), InputError);
}

TEST(MeasureFrame, IsTheSameOnAnyNumberOfThreads) {
    const sim::Frame frame = random_balls(2, {true, true, false}, 20000);
    std::vector<std::vector<sim::Scalar>> results;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        results.push_back(measure_frame(frame));
    }
    for (const auto& result : results)
        for (std::size_t i = 0; i < result.size(); ++i)
            EXPECT_EQ(result[i].value, results[0][i].value) << result[i].name;  // to the last bit
}

}  // namespace
}  // namespace lamella::measure
