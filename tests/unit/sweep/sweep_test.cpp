#include "lamella/sweep/sweep.h"

#include "lamella/core/error.h"
#include "lamella/sweep/collect.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace lamella::sweep {
namespace {

namespace fs = std::filesystem;

class SweepFile : public testing::Test {
protected:
    SweepFile() : folder_(fs::temp_directory_path() / ("lamella_sweep_" + std::to_string(::getpid()))) {
        fs::create_directories(folder_);
        std::ofstream(folder_ / "foam.toml") << "solver = \"bubble\"\n";
    }
    ~SweepFile() override { fs::remove_all(folder_); }

    Sweep load(const std::string& text) const {
        std::ofstream(folder_ / "sweep.toml") << "scene = \"foam.toml\"\n" << text;
        return load_sweep(folder_ / "sweep.toml");
    }
    static std::set<std::string> names(const Sweep& sweep) {
        std::set<std::string> names;
        for (const Task& task : sweep.tasks) names.insert(task.name);
        return names;
    }

    fs::path folder_;
};

TEST_F(SweepFile, NamesATaskByItsValuesAndNotByTheirOrder) {
    const Sweep one = load("[axes]\nbubble.count = [10, 20]\nbubble.gas_fraction = [0.8, 0.9]\n");
    const Sweep other = load("[axes]\nbubble.gas_fraction = [0.9, 0.8, 0.7]\n\"bubble.count\" = [20, 10]\n");
    ASSERT_EQ(one.tasks.size(), 4u);
    ASSERT_EQ(other.tasks.size(), 6u);
    const auto in_other = names(other);
    for (const std::string& name : names(one)) EXPECT_EQ(in_other.count(name), 1u);
}

TEST_F(SweepFile, RoundsRangesToWhatPeopleWrite) {
    const Sweep sweep = load("[axes]\nbubble.gas_fraction = { from = 0.8, to = 1.0, step = 0.01 }\n");
    ASSERT_EQ(sweep.tasks.size(), 21u);
    EXPECT_EQ(sweep.tasks[3].values, std::vector<std::string>{"0.83"});
    EXPECT_EQ(sweep.tasks[20].overrides, std::vector<std::string>{"bubble.gas_fraction=1.0"});
    const Sweep whole = load("[axes]\nbubble.count = { from = 30, to = 10, step = -10 }\n");
    ASSERT_EQ(whole.tasks.size(), 3u);
    EXPECT_EQ(whole.tasks[2].values, std::vector<std::string>{"10"});
}

TEST_F(SweepFile, WithNothingThatVariesIsOneTask) { EXPECT_EQ(load("[set]\nbubble.count = 10\n").tasks.size(), 1u); }

TEST_F(SweepFile, RefusesMoreRunsThanAnybodyMeans) {
    EXPECT_THROW(load("[axes]\nbubble.count = { from = 1, to = 2000, step = 1 }\n[repeat]\nseeds = 1000\n"),
                 InputError);
}

TEST(At, IsAColumnAndNumbers) {
    EXPECT_EQ(parse_at("time=1,2.5").values, (std::vector<double>{1.0, 2.5}));
    for (const char* wrong : {"time", "=1", "time=", "time=1,", "time=x", "time=nan"})
        EXPECT_THROW(parse_at(wrong), InputError) << wrong;
}

}  // namespace
}  // namespace lamella::sweep
