#include "lamella/sim/read_options.h"
#include "lamella/solvers/bubble/bubble_solver.h"

namespace lamella::bubble {

void register_bubble(sim::SolverRegistry& registry) {
    registry.add({.name = "bubble",
                  .summary = "wet foam of discs or balls with gas exchange [Lankinen20]",
                  .time_unit = "-",
                  .cuda = true,
                  .processes = true,
                  .create = [](const sim::SolverInput& input) -> std::unique_ptr<sim::Solver> {
                      const auto options = sim::read_options<Options>(input.options);
                      if (options.dimension == 2) return std::make_unique<BubbleSolver<2>>(options, input);
                      return std::make_unique<BubbleSolver<3>>(options, input);
                  },
                  .describe = [] { return sim::describe_options<Options>(); },
                  .resolve = [](const sim::Node& options) {
                      return sim::resolve_options(sim::read_options<Options>(options));
                  }});
}

}  // namespace lamella::bubble
