#pragma once

#include "lamella/sim/options.h"
#include "lamella/sim/registry.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lamella::sweep {

/// [task]: what one task asks of the machine.
struct TaskOptions {
    int threads = 1;
    int ranks = 1;
    std::string launcher = "mpirun -np {ranks}";
    std::string memory = "2G";
    std::string wall = "01:00:00";
    int per_job = 1;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("threads", threads, sim::between(1, 4096), {"of each process of a run"});
        option("ranks", ranks, sim::between(1, 1000000),
               {"processes of each run, of solvers that can (docs/clusters.md)"});
        option("launcher", launcher, {"what starts the processes where there are several; {ranks} is their number"});
        option("memory", memory, {"of a job on a cluster, as Slurm writes it"});
        option("wall", wall,
               {"time limit of a job on a cluster, as Slurm writes it; a run that needs longer goes on in the next"});
        option("per_job", per_job, sim::between(1, 1000000),
               {"tasks that one job on a cluster does after one another"});
    }
};

/// One run of a sweep.
struct Task {
    std::string name;                    ///< 16 hexadecimal digits: a hash of its overrides, whatever their order
    std::vector<std::string> values;     ///< of the sweep's keys, as TOML
    std::vector<std::string> overrides;  ///< "bubble.gas_fraction=0.9", for load_scene
};

/// A checked file SWEEP.toml: which runs there are. The axes make an outer product, the last one varies fastest, seeds
/// faster still.
struct Sweep {
    std::filesystem::path scene;    ///< that all tasks start from
    std::vector<std::string> keys;  ///< that vary: columns of the table of tasks
    std::vector<Task> tasks;
    TaskOptions task;
};

/// @throws InputError  with file:line: unknown keys, no task or more than 1e6, two that are the same   @throws IoError
Sweep load_sweep(const std::filesystem::path& path);

}  // namespace lamella::sweep
