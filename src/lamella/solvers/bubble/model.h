#pragma once

#include <cmath>

#include "lamella/solvers/bubble/options.h"
#include "lamella/solvers/bubble/shape.h"

namespace lamella::bubble {

/// The constants of the equations, derived once from the options and the initial foam.
struct Model {
    double push_rate = 1.0;       ///< F_0/mu_0 = sigma_0 <R_in>/mu_0   [length^2/time]
    double energy_scale = 1.0;    ///< sigma_0 <R_in>
    double exchange_rate = 0.0;   ///< K
    double medium_ratio = 0.0;    ///< kappa
    MediumScaling medium_scaling = MediumScaling::kArea;
    bool wall_blocks_gas = false;
    double input_mean_radius = 1.0;      ///< <R_in>, the input
    double initial_mean_radius = 1.0;    ///< of the first, sampled radii
    double initial_mean_surface = 1.0;   ///< <A_in> of the first, sampled radii
    double min_size = 0.0;        ///< q at which a bubble vanishes
    double floor_size = 0.0;      ///< least q that a radius is taken of inside a step
    double largest_count = 1.0;   ///< bubbles at the start: bounds every sum
    double total_size = 1.0;      ///< sum of q, constant

    static Model from(const Options& o) {
        Model m;
        m.energy_scale = o.surface_tension * o.mean_radius;
        m.push_rate = m.energy_scale / o.viscosity;
        m.exchange_rate = o.gas.exchange_rate;
        m.medium_ratio = o.gas.medium_ratio;
        m.medium_scaling = o.gas.medium_scaling;
        m.wall_blocks_gas = o.wall_blocks_gas;
        m.input_mean_radius = m.initial_mean_radius = o.mean_radius;
        const double min_radius = o.min_radius * o.mean_radius;
        m.min_size = std::pow(min_radius, o.dimension);
        // A bubble that dies within a step passes q = 0; its radius is then taken as a tenth of the least one.
        m.floor_size = std::pow(0.1 * min_radius, o.dimension);
        return m;
    }

    LAMELLA_HOST_DEVICE bool exchanges_gas() const { return exchange_rate > 0.0; }
    /// tau = K t / <R_in>^2: scaled time per time.
    double scaled_time_rate() const { return exchange_rate / (input_mean_radius * input_mean_radius); }
};

}  // namespace lamella::bubble
