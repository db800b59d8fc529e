#include "lamella/scene/scene.h"
#include "lamella/solvers/bubble/bubble_solver.h"
#include "lamella/solvers/equilibrium/equilibrium_solver.h"
#include "lamella/solvers/melp/melp_solver.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

namespace lamella::scene {

sim::SolverRegistry all_solvers() {
    sim::SolverRegistry registry;
    bubble::register_bubble(registry);
    equilibrium::register_equilibrium(registry);
    melp::register_melp(registry);
    vortex_particle::register_vortex_particle(registry);
    vortex_sheet::register_vortex_sheet(registry);
    return registry;
}

}  // namespace lamella::scene
