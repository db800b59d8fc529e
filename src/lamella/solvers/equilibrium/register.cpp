#include "lamella/sim/read_options.h"
#include "lamella/solvers/equilibrium/equilibrium_solver.h"

namespace lamella::equilibrium {

void register_equilibrium(sim::SolverRegistry& registry) {
    registry.add({.name = "equilibrium",
                  .summary = "films and foams at rest: least area at given volumes",
                  .films = true,
                  .create =
                      [](const sim::SolverInput& input) {
                          return std::make_unique<EquilibriumSolver>(sim::read_options<Options>(input.options), input);
                      },
                  .describe = [] { return sim::describe_options<Options>(); },
                  .resolve =
                      [](const sim::Node& options) {
                          return sim::resolve_options(sim::read_options<Options>(options));
                      }});
}

}  // namespace lamella::equilibrium
