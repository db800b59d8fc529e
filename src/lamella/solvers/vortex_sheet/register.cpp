#include "lamella/sim/read_options.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

namespace lamella::vortex_sheet {

void register_vortex_sheet(sim::SolverRegistry& registry) {
    registry.add({.name = "vortex_sheet",
                  .summary = "films and foams in air: vortex sheets driven by surface tension [Da15]",
                  .films = true,
                  .cuda = true,
                  .create =
                      [](const sim::SolverInput& input) {
                          return std::make_unique<VortexSheetSolver>(sim::read_options<Options>(input.options, {.length = "m", .mass = "kg", .time = "s"}), input);
                      },
                  .describe = [] { return sim::describe_options<Options>(); },
                  .resolve =
                      [](const sim::Node& options) {
                          return sim::resolve_options(sim::read_options<Options>(options, {.length = "m", .mass = "kg", .time = "s"}));
                      }});
}

}  // namespace lamella::vortex_sheet
