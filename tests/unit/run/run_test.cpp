#include "lamella/run/run.h"

#include "lamella/core/parallel.h"
#include "lamella/io/csv.h"
#include "lamella/io/frame_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "temporary_folder.h"
#include "toy_foam.h"
#include <cmath>
#include <csignal>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

namespace lamella::run {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

/// What must be the same however a run went: every file that holds results.
std::map<std::string, std::string> results(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const char* name : {"scene.toml", "series.csv", "events.csv", "frames.pvd"})
        files[name] = contents(folder / name);
    for (const auto& entry : fs::directory_iterator(folder / "frames"))
        files["frames/" + entry.path().filename().string()] = contents(entry.path());
    return files;
}

/// 41 steps, 5 frames, 13 rows.
const std::string kScene = R"(
title = "a toy"
solver = "toy_foam"
seed = 3
[time]
end = 0.5
frame_rate = 8.0
series_rate = 20.0
[output]
checkpoint_interval = 1e-9   # after every step
[toy_foam]
count = 40
)";

class RunTest : public testing::Test {
protected:
    scene::Scene scene(const std::vector<std::string>& overrides = {}) const {
        return scene::parse_scene(kScene, "toy.toml", overrides, registry_);
    }
    fs::path folder(const std::string& name = "run") const { return temporary_.path() / name; }
    RunResult run(const fs::path& path,
                  const std::vector<std::string>& overrides = {},
                  RunSettings settings = {}) const {
        return run_scene(scene(overrides), registry_, path, settings);
    }
    RunResult resume(const fs::path& path, RunSettings settings = {}) const {
        return resume_run(path, registry_, settings);
    }

    TemporaryFolder temporary_;
    std::shared_ptr<ToyHooks> hooks_ = std::make_shared<ToyHooks>();
    sim::SolverRegistry registry_ = toy_registry(hooks_);
};

TEST_F(RunTest, WritesWhatTheRunFolderPromises) {
    const RunResult result = run(folder());
    EXPECT_TRUE(result.finished);
    EXPECT_EQ(result.time, 0.5);
    EXPECT_EQ(result.frames, 5);
    for (const char* name :
         {"scene.toml", "run.json", "series.csv", "events.csv", "frames.pvd", "checkpoint.h5", "log.txt"})
        EXPECT_TRUE(fs::is_regular_file(folder() / name)) << name;

    const auto entries = io::read_pvd(folder() / "frames.pvd");
    ASSERT_EQ(entries.size(), 5u);
    for (std::size_t k = 0; k < entries.size(); ++k) {
        EXPECT_EQ(entries[k].time, static_cast<double>(k) / 8.0);
        EXPECT_EQ(io::read_vtp(folder() / entries[k].file).time, entries[k].time);
    }
}

TEST_F(RunTest, HitsEveryOutputTimeExactly) {
    run(folder());
    const io::CsvTable series = io::read_csv(folder() / "series.csv");
    std::set<double> expected{0.0, 0.5};
    for (int k = 0; k <= 4; ++k) expected.insert(k / 8.0);
    for (int k = 0; k <= 10; ++k) expected.insert(k / 20.0);
    ASSERT_EQ(series.rows.size(), expected.size());
    auto time = expected.begin();
    for (const auto& row : series.rows) EXPECT_EQ(row[0], *time++);
}

TEST_F(RunTest, RecordsWhereTheResultsComeFrom) {
    const RunResult result = run(folder());
    const auto json = nlohmann::json::parse(contents(folder() / "run.json"));
    EXPECT_EQ(json.at("solver"), "toy_foam");
    EXPECT_EQ(json.at("seed"), 3);
    EXPECT_EQ(json.at("title"), "a toy");
    EXPECT_EQ(json.at("state"), "finished");
    EXPECT_EQ(json.at("stop_reason"), "the end time 0.5 is reached");
    EXPECT_EQ(json.at("steps"), result.steps_taken);
    EXPECT_EQ(json.at("device"), "cpu");
    EXPECT_EQ(json.at("threads"), thread_count());
    for (const char* stage : {"start", "advance", "output", "checkpoint"}) {
        EXPECT_GE(json.at("wall_seconds").at(stage).get<double>(), 0.0) << stage;
        EXPECT_GE(json.at("cpu_seconds").at(stage).get<double>(), 0.0) << stage;
    }
    EXPECT_EQ(json.at("sessions").size(), 1u);
}

TEST_F(RunTest, OfItsResolvedSceneGivesTheSameBits) {
    run(folder("a"));
    const scene::Scene resolved = scene::load_scene(folder("a") / "scene.toml", {}, registry_);
    run_scene(resolved, registry_, folder("b"), {});
    EXPECT_EQ(results(folder("a")), results(folder("b")));
}

TEST_F(RunTest, IsTheSameOnAnyNumberOfThreads) {
    const std::vector<std::string> large{"toy_foam.count=20000", "time.end=0.1"};
    for (const int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        run(folder(std::to_string(threads)), large);
    }
    EXPECT_EQ(results(folder("1")), results(folder("2")));
}

/// Thrown by a hook in place of a crash: the loop must not get to do anything any more.
struct Crash : std::exception {};

TEST_F(RunTest, ResumesBitForBitFromACrashAtEveryStep) {
    const std::string end = "time.end=0.3";
    const std::int64_t steps = run(folder("whole"), {end}).steps_taken;
    ASSERT_GT(steps, 20);
    const auto expected = results(folder("whole"));
    for (const char* interval : {"1e-9", "0"}) {  // a checkpoint after every step; none before the end
        for (std::int64_t at = 0; at < steps; ++at) {
            const std::string interval_option = std::string("output.checkpoint_interval=") + interval;
            hooks_->before_step = [&](std::int64_t step) {
                if (step == at) throw Crash();
            };
            EXPECT_THROW(run(folder("cut"), {end, interval_option}, {.existing = Existing::kOverwrite}), Crash);
            hooks_->before_step = [](std::int64_t) {};
            EXPECT_TRUE(resume(folder("cut")).finished);
            auto found = results(folder("cut"));
            found["scene.toml"] = expected.at("scene.toml");  // differs in the interval
            EXPECT_EQ(found, expected) << "crash before step " << at << ", interval " << interval;
        }
    }
}

TEST_F(RunTest, ResumesBitForBitFromAnOlderCheckpoint) {
    run(folder("whole"));
    // A clock that ticks once a step, and a checkpoint every 7 ticks: the crash is in the middle.
    double clock = 0.0;
    hooks_->before_step = [&](std::int64_t step) {
        clock += 1.0;
        if (step == 26) throw Crash();
    };
    RunSettings settings;
    settings.wall_clock = [&] { return clock; };
    EXPECT_THROW(run(folder("cut"), {"output.checkpoint_interval=7"}, settings), Crash);
    hooks_->before_step = [](std::int64_t) {};
    // Leftovers of a killed process do no harm.
    std::ofstream(folder("cut") / "frames" / "000099.vtp") << "half a frame";
    std::ofstream(folder("cut") / "frames" / "000003.vtp.tmp") << "half a frame";
    const RunResult result = resume(folder("cut"));
    EXPECT_GT(result.steps_taken, 5);
    EXPECT_LT(result.steps_taken, result.step);  // it did not start over
    auto found = results(folder("cut"));
    found["scene.toml"] = contents(folder("whole") / "scene.toml");
    EXPECT_EQ(found, results(folder("whole")));
    EXPECT_EQ(nlohmann::json::parse(contents(folder("cut") / "run.json")).at("sessions").size(), 2u);
}

TEST_F(RunTest, FallsBackToTheCheckpointBeforeADamagedOne) {
    run(folder("whole"));
    hooks_->before_step = [&](std::int64_t step) {
        if (step == 20) throw Crash();
    };
    EXPECT_THROW(run(folder("cut")), Crash);
    hooks_->before_step = [](std::int64_t) {};
    {
        std::fstream file(folder("cut") / "checkpoint.h5", std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(1000);
        file << "damage";
    }
    EXPECT_TRUE(resume(folder("cut")).finished);
    EXPECT_EQ(results(folder("cut")), results(folder("whole")));
    EXPECT_NE(contents(folder("cut") / "run.json").find("continued from the checkpoint before it"), std::string::npos);
}

TEST_F(RunTest, RefusesToResumeWhenEveryCheckpointIsDamaged) {
    run(folder());
    for (const char* name : {"checkpoint.h5", "checkpoint.h5.previous"}) std::ofstream(folder() / name) << "damage";
    EXPECT_THROW(resume(folder()), InputError);
}

TEST_F(RunTest, StopsOnASignalWithACheckpointAndResumesBitForBit) {
    run(folder("whole"));
    int signal = 0;
    RunSettings settings;
    settings.stop_signal = [&] { return signal; };
    settings.on_progress = [&](const RunProgress& progress) {
        if (progress.step == 17) signal = SIGTERM;
    };
    const RunResult result = run(folder("cut"), {}, settings);
    EXPECT_FALSE(result.finished);
    EXPECT_EQ(result.signal, SIGTERM);
    EXPECT_EQ(result.step, 17);
    EXPECT_EQ(nlohmann::json::parse(contents(folder("cut") / "run.json")).at("state"), "interrupted");
    const RunResult rest = resume(folder("cut"));
    EXPECT_EQ(rest.steps_taken + 17, rest.step);
    EXPECT_EQ(results(folder("cut")), results(folder("whole")));
}

TEST_F(RunTest, StoppedWhileItStartsLeavesAFolderThatStartsOver) {
    run(folder("whole"));
    RunSettings settings;
    settings.stop_signal = [] { return SIGINT; };
    const RunResult result = run(folder("cut"), {}, settings);
    EXPECT_FALSE(result.finished);
    EXPECT_EQ(result.signal, SIGINT);
    EXPECT_FALSE(fs::exists(folder("cut") / "checkpoint.h5"));
    EXPECT_TRUE(resume(folder("cut")).finished);
    EXPECT_EQ(results(folder("cut")), results(folder("whole")));
}

TEST_F(RunTest, EndsWhereTheSolverSaysSo) {
    const RunResult result = run(folder(), {"time.end=0", "toy_foam.end_count=30"});
    EXPECT_TRUE(result.finished);
    EXPECT_NE(result.stop_reason.find("balls are left"), std::string::npos);
    const io::CsvTable series = io::read_csv(folder() / "series.csv");
    EXPECT_EQ(series.rows.back()[0], result.time);                              // the end has a row
    EXPECT_EQ(io::read_pvd(folder() / "frames.pvd").back().time, result.time);  // and a frame
    EXPECT_EQ(resume(folder()).steps_taken, 0);
    EXPECT_EQ(io::read_csv(folder() / "series.csv").rows.size(), series.rows.size());
}

TEST_F(RunTest, RunsUntilATimeAndOnFromThere) {
    run(folder("whole"));
    RunSettings until;
    until.until = 0.25;  // an output time, so that the cut leaves no trace
    EXPECT_EQ(run(folder("cut"), {}, until).time, 0.25);
    EXPECT_EQ(resume(folder("cut")).time, 0.5);
    EXPECT_EQ(results(folder("cut")), results(folder("whole")));
    EXPECT_THROW(resume(folder("cut"), until), InputError);  // it is past that
    until.until = 0.75;
    EXPECT_EQ(resume(folder("cut"), until).time, 0.75);
    EXPECT_EQ(resume(folder("cut")).steps_taken, 0);  // beyond the scene's own end
}

TEST_F(RunTest, SavesTheLastGoodStateOfANumericalFailure) {
    try {
        run(folder(), {"toy_foam.fail_at=0.2"});
        FAIL() << "no error";
    } catch (const NumericalError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("the toy broke"), std::string::npos) << message;
        EXPECT_NE(message.find("checkpoint.h5"), std::string::npos) << message;
    }
    EXPECT_EQ(nlohmann::json::parse(contents(folder() / "run.json")).at("state"), "failed");
    EXPECT_THROW(resume(folder()), NumericalError);  // it fails again, from there
}

TEST_F(RunTest, NoticesWhenTimeStandsStill) { EXPECT_THROW(run(folder(), {"toy_foam.stall=true"}), NumericalError); }

TEST_F(RunTest, LeavesNoFolderWhenTheSceneIsWrong) {
    EXPECT_THROW(run(folder(), {"toy_foam.count=-1"}), InputError);
    EXPECT_THROW(run(folder(), {"time.frame_rate=1e20"}), InputError);
    EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(RunTest, RefusesAFolderThatHoldsARun) {
    run(folder());
    const auto before = results(folder());
    EXPECT_THROW(run(folder(), {"seed=4"}), InputError);
    EXPECT_EQ(results(folder()), before);
}

TEST_F(RunTest, ReplacesARunWhenToldToAndNothingElse) {
    run(folder(), {"time.frame_rate=40"});
    std::ofstream(folder() / "notes.txt") << "mine";
    run(folder(), {}, {.existing = Existing::kOverwrite});
    run(folder("fresh"));
    EXPECT_EQ(results(folder()), results(folder("fresh")));
    EXPECT_EQ(contents(folder() / "notes.txt"), "mine");
}

TEST_F(RunTest, NeverTouchesAFolderOfOtherFiles) {
    fs::create_directories(folder());
    std::ofstream(folder() / "thesis.tex") << "years of work";
    EXPECT_THROW(run(folder(), {}, {.existing = Existing::kOverwrite}), InputError);
    EXPECT_THROW(resume(folder()), InputError);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder()), {}), 1);
    std::ofstream(folder("file")) << "a file";
    EXPECT_THROW(run(folder("file"), {}, {.existing = Existing::kOverwrite}), InputError);
}

TEST_F(RunTest, TakesAnEmptyFolder) {
    fs::create_directories(folder());
    EXPECT_TRUE(run(folder()).finished);
}

TEST_F(RunTest, KeepsASecondProcessOut) {
    bool refused = false;
    hooks_->before_step = [&](std::int64_t step) {
        if (step != 5) return;
        try {
            resume_run(folder(), toy_registry(), {});
        } catch (const InputError& error) {
            refused = std::string(error.what()).find("another lamella process") != std::string::npos;
        }
    };
    EXPECT_TRUE(run(folder()).finished);
    EXPECT_TRUE(refused);
}

TEST_F(RunTest, WritesEventsOnce) {
    run(folder(), {"time.end=3"});
    std::istringstream events(contents(folder() / "events.csv"));
    std::string line;
    std::getline(events, line);
    EXPECT_EQ(line, "time[-],kind,x[-],y[-],z[-],detail");
    int removed = 0;
    while (std::getline(events, line)) {
        EXPECT_NE(line.find(",remove,"), std::string::npos);
        EXPECT_NE(line.find("\"\"small\"\""), std::string::npos);  // quoted as CSV wants it
        ++removed;
    }
    const io::CsvTable series = io::read_csv(folder() / "series.csv");
    const auto bubbles = static_cast<std::size_t>(series.column("bubbles"));
    EXPECT_EQ(removed, 40 - static_cast<int>(series.rows.back()[bubbles]));
    EXPECT_GT(removed, 0);
}

TEST_F(RunTest, WritesNoFramesWhenToldNotTo) {
    EXPECT_EQ(run(folder(), {"output.frames=false"}).frames, 0);
    EXPECT_TRUE(fs::is_empty(folder() / "frames"));
    EXPECT_EQ(io::read_csv(folder() / "series.csv").rows.size(), 13u);
}

}  // namespace
}  // namespace lamella::run
