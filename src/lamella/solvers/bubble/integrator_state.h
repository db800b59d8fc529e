#pragma once

namespace lamella::bubble {

/// What an integrator of one step carries from step to step, beside the foam's own rates.
struct IntegratorState {
    double next_step = 0.0;      ///< that the next attempt would like to take
    double stiffness = 0.0;      ///< bound of the relaxation rates at the current state
    bool rates_current = false;  ///< the foam's velocities and size rates belong to its current state
};

}  // namespace lamella::bubble
