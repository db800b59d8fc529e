#include "lamella/sim/read_options.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

namespace lamella::vortex_particle {

void register_vortex_particle(sim::SolverRegistry& registry) {
    const sim::ModelUnits si{.length = "m", .mass = "kg", .time = "s"};
    registry.add({.name = "vortex_particle",
                  .summary = "the flow inside films: swirls, drainage, fingers, by vortex particles on a mesh [Tao24]",
                  .films = true,
                  .vortices = true,
                  .solids = true,
                  .create =
                      [si](const sim::SolverInput& input) {
                          return std::make_unique<VortexParticleSolver>(sim::read_options<Options>(input.options, si),
                                                                        input);
                      },
                  .describe = [] { return sim::describe_options<Options>(); },
                  .resolve =
                      [si](const sim::Node& options) {
                          return sim::resolve_options(sim::read_options<Options>(options, si));
                      }});
}

}  // namespace lamella::vortex_particle
