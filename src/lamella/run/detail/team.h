#pragma once

#include "lamella/dist/communicator.h"
#include "lamella/sim/solver.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace lamella::run {

using LastWords = std::function<void(std::string_view)>;
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
    /// @param last_words  hears why this process ends the others: it met an error that they do not know of
    Team(std::shared_ptr<dist::Communicator> processes, LastWords last_words);
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
    LastWords last_words_;
};

/// What every other process does: follows process 0 until that lets it go. @param last_words  as of Team
void follow(const std::shared_ptr<dist::Communicator>& processes, const LastWords& last_words, const MakeSolver& make);

}  // namespace lamella::run
