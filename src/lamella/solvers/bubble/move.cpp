#include "lamella/solvers/bubble/move.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/bubble/integrator.h"

#include <fmt/format.h>

#include <cmath>

namespace lamella::bubble {

std::string step_underflow(double error, double tolerance) {
    return fmt::format("the time step fell below 1e-12 (error {} at tolerance {})", error, tolerance);
}

template <int D>
void stage_moved(System<D>& system, const Increment<D>& increment) {
    const Foam<D>& foam = system.foam;
    parallel_for(system.length(), [&](std::size_t i) {
        for (std::size_t k = 0; k < D; ++k)
            system.stage.position[k][i] = foam.position[k][i] + increment.position[k][i];
        set_radius<D>(system.model, foam.size[i] + increment.size[i], foam.alive(i), system.stage.radius[i],
                      system.stage.inverse_radius[i]);
    });
}

template <int D>
void accept_moved(System<D>& system, const Increment<D>& increment) {
    Foam<D>& foam = system.foam;
    parallel_for(foam.slots, [&](std::size_t i) {
        if (!foam.alive(i)) return;
        double squared = 0.0;
        for (std::size_t k = 0; k < D; ++k) {
            const double move = increment.position[k][i];
            squared += move * move;
            double& x = foam.position[k][i];
            x += move;
            if (foam.box.periodic[k]) x = wrapped(x, foam.box.lengths[k], foam.wraps[k][i]);
        }
        foam.path_length[i] += std::sqrt(squared);
        foam.size[i] += increment.size[i];
    });
}

template void stage_moved<2>(System<2>&, const Increment<2>&);
template void stage_moved<3>(System<3>&, const Increment<3>&);
template void accept_moved<2>(System<2>&, const Increment<2>&);
template void accept_moved<3>(System<3>&, const Increment<3>&);

}  // namespace lamella::bubble
