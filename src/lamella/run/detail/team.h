#pragma once

#include "lamella/dist/communicator.h"
#include "lamella/sim/solver.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

namespace lamella::run {

using MakeSolver = std::function<std::unique_ptr<sim::Solver>(const std::shared_ptr<dist::Communicator>&)>;

/// What one process has used so far.
struct ProcessReport {
    double peak_memory = 0.0;  ///< resident [bytes]
    double exchange = 0.0;     ///< time spent with messages and sums, waiting included [s]
};

/// Process 0's end of the line to the others: what it does with its solver, all do. It alone decides what is next,
/// reads the clock, hears signals and writes files; the others follow.
class Team {
public:
    /// @param processes  empty: this process is alone
    explicit Team(std::shared_ptr<dist::Communicator> processes);
    ~Team();  ///< lets the others go
    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;

    /// A solver on every process, which make() creates; the one returned calls them all.
    /// @throws  what make() throws on any of them
    std::unique_ptr<sim::Solver> create(const MakeSolver& make);

    /// What is measured on the whole of which the solver's frame() is this process's share: no process holds all of it.
    /// The others have kept theirs since they were asked for it.
    std::vector<sim::Scalar> measure(const sim::Frame& share) const;
    /// Writes the whole as one file.
    void write_frame(const std::filesystem::path& path, const sim::Frame& share) const;

    /// Of each process, by rank.
    std::vector<ProcessReport> report() const;

private:
    std::shared_ptr<dist::Communicator> processes_;
};

/// What every other process does: follows process 0 until that lets it go. @throws  errors that no other process knows
/// of
void follow(const std::shared_ptr<dist::Communicator>& processes, const MakeSolver& make);

}  // namespace lamella::run
