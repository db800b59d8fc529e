#pragma once

#include "lamella/scene/scene.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace lamella::run {

/// What a run spends its time on.
enum class Stage { kStart, kAdvance, kOutput, kCheckpoint };
inline constexpr std::array<const char*, 4> kStageNames{"start", "advance", "output", "checkpoint"};

/// Wall and CPU seconds (of all threads of the process) per stage.
class StageTimes {
public:
    struct Seconds {
        double wall = 0.0;
        double cpu = 0.0;
    };

    /// Does `work` and adds its time to `stage`, also when it throws.
    template <class Work>
    auto measure(Stage stage, Work&& work) {
        const Stopwatch stopwatch(of_[static_cast<std::size_t>(stage)]);
        return work();
    }
    const Seconds& of(Stage stage) const { return of_[static_cast<std::size_t>(stage)]; }

private:
    class Stopwatch {
    public:
        explicit Stopwatch(Seconds& total);
        ~Stopwatch();

    private:
        Seconds& total_;
        Seconds begin_;
    };
    std::array<Seconds, kStageNames.size()> of_{};
};

/// What is known of a run at one moment.
struct RunRecord {
    std::string state;        ///< "running", "finished", "interrupted", "failed"
    std::string stop_reason;  ///< why it is not running any more
    double time = 0.0;
    std::string time_unit = "s";
    std::int64_t step = 0;
    std::int64_t frames = 0;
    std::int64_t steps_taken = 0;  ///< by this process
    std::int64_t evaluations = 0;  ///< by this process
    StageTimes times;
    std::vector<double> peak_memory;       ///< of each process, once it has stopped [bytes]
    std::vector<double> exchange_seconds;  ///< likewise: time with messages and sums, waiting included
    std::vector<std::string> notes;
};

/// RUN/run.json: where the results come from. Kept up to date while the run goes on; each process that worked on the
/// run has its entry in "sessions", and the top level sums them up.
class Provenance {
public:
    /// Takes over the sessions of an existing file; one that cannot be understood is replaced, and `notes` says so.
    Provenance(std::filesystem::path path, const scene::Scene& scene, std::string device, int processes);
    ~Provenance();

    /// Remarks of the scene reader and of taking over the old file.
    const std::vector<std::string>& notes() const;
    /// @throws IoError
    void write(const RunRecord& record);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// What a run.json says of the run's state ("finished", see RunRecord); "" where there is none that can be understood.
std::string recorded_state(const std::filesystem::path& run_json);

}  // namespace lamella::run
