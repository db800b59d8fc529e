#include "lamella/sim/read_options.h"
#include "lamella/solvers/melp/melp_solver.h"

namespace lamella::melp {
namespace {

const sim::ModelUnits kSi{.length = "m", .mass = "kg", .time = "s"};

}  // namespace

void register_melp(sim::SolverRegistry& registry) {
    registry.add(
        {.name = "melp",
         .summary = "thin films and foams by moving Eulerian-Lagrangian particles [Deng22]",
         .films = true,
         .solids = true,
         .bubble_thickness = true,
         .create =
             [](const sim::SolverInput& input) {
                 return std::make_unique<MelpSolver>(sim::read_options<Options>(input.options, kSi), input);
             },
         .describe = [] { return sim::describe_options<Options>(); },
         .resolve =
             [](const sim::Node& options) { return sim::resolve_options(sim::read_options<Options>(options, kSi)); }});
}

}  // namespace lamella::melp
