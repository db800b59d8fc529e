#include "lamella/scene/scene.h"
#include "lamella/solvers/bubble/bubble_solver.h"
#include "lamella/solvers/equilibrium/equilibrium_solver.h"

namespace lamella::scene {

sim::SolverRegistry all_solvers() {
    sim::SolverRegistry registry;
    bubble::register_bubble(registry);
    equilibrium::register_equilibrium(registry);
    return registry;
}

}  // namespace lamella::scene
