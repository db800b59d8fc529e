#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lamella/core/device.h"
#include "lamella/dist/communicator.h"
#include "lamella/film/problem.h"
#include "lamella/sim/node.h"
#include "lamella/sim/options.h"
#include "lamella/sim/solver.h"

namespace lamella::sim {

/// One option of a solver, as `lamella explain` and the docs show it.
struct OptionInfo {
    std::string name;      ///< "flow.velocity"
    std::string type;      ///< "number", "integer", "boolean", "word", "text", "3 numbers", "3 booleans";
                           ///< "group": a table, the options in it follow
    std::string default_text;
    std::string allowed;   ///< "[0, 1]", "background | pairwise", ""
    Doc doc;
};

/// A table of numbers from a file that the user named.
struct NumberTable {
    std::vector<std::string> header;
    std::vector<std::vector<double>> rows;
};

/// What a solver is made from: the part of a scene that concerns it.
struct SolverInput {
    std::uint64_t seed = 1;
    double end_time = 0.0;    ///< in the solver's time unit
    /// Reads a CSV file with a header line. @throws IoError, InputError
    std::function<NumberTable(const std::string& file)> read_table;
    Node options;             ///< the solver's own table; an empty table where the scene has none
    std::shared_ptr<const film::Problem> films = nullptr;  ///< of a film solver; empty for others
    Device device = Device::kCpu;
    /// The processes that compute together; empty where it is one. Only for solvers that can (SolverEntry::processes).
    std::shared_ptr<dist::Communicator> processes = nullptr;
};

struct SolverEntry {
    std::string name;
    std::string summary;
    std::string time_unit = "s";
    bool films = false;  ///< starts from the film tables of a scene (SolverInput::films)
    bool cuda = false;   ///< can compute on a GPU
    bool processes = false;  ///< several processes can compute one run; Solver says how its functions then work
    bool vortices = false;  ///< uses [[vortex]]
    bool solids = false;    ///< uses [[solid]]
    bool bubble_thickness = false;  ///< uses bubble.thickness
    std::function<std::unique_ptr<Solver>(const SolverInput&)> create;  ///< checks the options, does no work
    std::function<std::vector<OptionInfo>()> describe;
    std::function<Node(const Node& options)> resolve;  ///< the options with every default filled in
};

/// The solvers of this build. A value, filled by plain calls (scene/solvers.cpp).
class SolverRegistry {
public:
    void add(SolverEntry entry);
    /// nullptr when there is none of that name.
    const SolverEntry* find(std::string_view name) const;
    const std::vector<SolverEntry>& entries() const { return entries_; }

private:
    std::vector<SolverEntry> entries_;
};

}  // namespace lamella::sim
