#include "lamella/scene/scene.h"
#include "lamella/solvers/bubble/bubble_solver.h"

namespace lamella::scene {

sim::SolverRegistry all_solvers() {
    sim::SolverRegistry registry;
    bubble::register_bubble(registry);
    return registry;
}

}  // namespace lamella::scene
