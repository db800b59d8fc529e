#include "lamella/run/series.h"

#include "lamella/core/error.h"
#include "lamella/measure/measure.h"

#include <gtest/gtest.h>

#include "temporary_folder.h"
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace lamella::run {
namespace {

TEST(LocalExponent, IsTheSlopeOfAPowerLaw) {
    std::vector<double> times, values;
    for (int i = 1; i <= 40; ++i) {
        times.push_back(0.25 * i);
        values.push_back(3.0 * std::pow(times.back(), 0.42));
    }
    EXPECT_NEAR(local_exponent(times, values), 0.42, 1e-12);
}

TEST(LocalExponent, LooksAtTheLastHalfOfTheTimeOnly) {
    const std::vector<double> times{1, 2, 3, 4.9, 5, 6, 7, 8, 9, 10};
    std::vector<double> values;
    for (const double t : times) values.push_back(t < 5.0 ? 100.0 : std::sqrt(t));
    EXPECT_NEAR(local_exponent(times, values), 0.5, 1e-12);
}

TEST(LocalExponent, IsNanWhereThereIsNoSlope) {
    EXPECT_TRUE(std::isnan(local_exponent({}, {})));
    EXPECT_TRUE(std::isnan(local_exponent(std::vector{5.0, 6.0, 7.0}, std::vector{1.0, 2.0, 3.0})));  // three rows
    EXPECT_TRUE(std::isnan(local_exponent(std::vector{0.0, 0.0, 0.0, 0.0}, std::vector{1.0, 1.0, 1.0, 1.0})));
    EXPECT_TRUE(std::isnan(local_exponent(std::vector{5.0, 6.0, 7.0, 8.0}, std::vector{1.0, 0.0, 1.0, 1.0})));
}

std::string contents(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

sim::Frame frame_at(double time) {
    sim::Frame frame;
    frame.time = time;
    frame.time_unit = "-";
    frame.points.length_unit = "-";
    frame.points.position = {{{1.0, 0.0, 0.0}}, {{2.0, 0.0, 0.0}}};
    frame.points.radius = {1.0 + time, 2.0 + time * time};
    frame.scalars = {{"energy", "J", 5.0 - time}, {"bubbles", "-", 77.0}};
    return frame;
}

void append(Series& series, const sim::Frame& frame) { series.append(frame, measure::measure_frame(frame)); }

TEST(Series, WritesTimeScalarsMeasuresAndExponent) {
    const TemporaryFolder folder;
    Series series(folder.path() / "series.csv");
    append(series, frame_at(0.0));
    append(series, frame_at(0.5));
    const io::CsvTable table = io::read_csv(folder.path() / "series.csv");
    const std::vector<std::string> header{
        "time[-]",       "energy[J]",  "bubbles[-]", "mean_radius[-]", "mean_square_radius[-]",
        "max_radius[-]", "exponent[-]"};
    EXPECT_EQ(table.header, header);
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.rows[1][0], 0.5);
    EXPECT_EQ(table.rows[1][1], 4.5);
    EXPECT_EQ(table.rows[1][2], 77.0);  // the solver's own word stands
    EXPECT_EQ(table.rows[1][3], 0.5 * (1.5 + 2.25));
    EXPECT_TRUE(std::isnan(table.rows[1][6]));
}

TEST(Series, WritesNanForWhatARowLacks) {
    const TemporaryFolder folder;
    Series series(folder.path() / "series.csv");
    append(series, frame_at(0.0));
    sim::Frame without = frame_at(1.0);
    without.scalars.clear();
    append(series, without);
    const io::CsvTable table = io::read_csv(folder.path() / "series.csv");
    EXPECT_TRUE(std::isnan(table.rows[1][1]));
    EXPECT_EQ(table.rows[1][2], 2.0);  // now the measure
}

TEST(Series, ContinuesAsIfItHadNeverStopped) {
    const TemporaryFolder folder;
    const auto whole = folder.path() / "whole.csv";
    const auto cut = folder.path() / "cut.csv";
    const auto write = [](Series& series, int from, int to) {
        for (int i = from; i < to; ++i) append(series, frame_at(0.3 * i));
    };
    Series uninterrupted(whole);
    write(uninterrupted, 0, 20);
    for (int at = 0; at <= 20; ++at) {
        std::uint64_t offset = 0;
        {
            Series first(cut);
            write(first, 0, at);
            offset = first.sync();
            write(first, at, 20);  // lost work
        }
        Series second(cut, offset);
        write(second, at, 20);
        EXPECT_EQ(contents(cut), contents(whole)) << "resumed at row " << at;
    }
}

TEST(Series, RefusesAFileThatIsShorterThanTheCheckpointSays) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "series.csv";
    Series series(path);
    append(series, frame_at(0.0));
    const std::uint64_t offset = series.sync();
    EXPECT_THROW(Series(path, offset + 100), InputError);
}

}  // namespace
}  // namespace lamella::run
