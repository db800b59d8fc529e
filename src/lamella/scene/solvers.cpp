#include "lamella/scene/scene.h"

namespace lamella::scene {

sim::SolverRegistry all_solvers() {
    sim::SolverRegistry registry;
    return registry;
}

}  // namespace lamella::scene
