#pragma once

#include "lamella/core/fixed_sum.h"
#include "lamella/solvers/bubble/model.h"
#include "lamella/solvers/bubble/shape.h"

#include <cmath>
#include <numbers>

namespace lamella::bubble {

/// Gas exchange of one bubble once the sums over all bubbles are known.
///   dV_i/dt = K film_i + c w_i (1/rho - 1/R_i),   1/rho = sum(w/R) / sum(w)      [Lankinen20, eq. 2.23, 2.27, 2.28]
/// and dq/dt = (dV/dt) / kVolume.
struct GasExchange {
    double film_factor = 0.0;    ///< K / kVolume
    double medium_factor = 0.0;  ///< c / kVolume
    double inverse_rho = 0.0;

    template <class Real>
    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real size_rate(const Real& film,
                                                             const Real& weight,
                                                             const Real& inverse_radius) const {
        return film_factor * film + medium_factor * weight * (inverse_rho - inverse_radius);
    }
};

/// The sums over the foam that close the exchange of gas; exact in any order.
struct GasSums {
    FixedSum weight;          ///< sum w
    FixedSum weight_by_size;  ///< sum w/R
    FixedSum scale;           ///< sum A or sum R

    LAMELLA_HOST_DEVICE GasSums& operator+=(const GasSums& other) {
        weight += other.weight;
        weight_by_size += other.weight_by_size;
        scale += other.scale;
        return *this;
    }
};

/// Bounds of the sums from N and Q = sum q by the power-mean inequality: sum R^p <= N^(1 - p/d) Q^(p/d).
template <int D>
GasSums empty_gas_sums(const Model& m) {
    const auto power_sum = [&](double p) {
        return std::pow(m.largest_count, 1.0 - p / D) * std::pow(m.total_size, p / D);
    };
    GasSums sums;
    const double surface = Shape<D>::kSurface * power_sum(D - 1);
    if (m.medium_scaling == MediumScaling::kLsw) {
        sums.weight = FixedSum(power_sum(1));
        sums.weight_by_size = FixedSum(m.largest_count);
    } else {
        sums.weight = FixedSum(surface);
        sums.weight_by_size = FixedSum(Shape<D>::kSurface * power_sum(D - 2));
    }
    sums.scale = FixedSum(m.medium_scaling == MediumScaling::kRadius ? power_sum(1) : surface);
    return sums;
}

/// The exchange that follows from the sums. @param live  number of bubbles
template <int D>
LAMELLA_HOST_DEVICE GasExchange close_exchange(const Model& m, const GasSums& sums, double live) {
    GasExchange gas;
    gas.film_factor = m.exchange_rate / Shape<D>::kVolume;
    const double weight = sums.weight.value();
    if (weight <= 0.0 || m.medium_ratio == 0.0) return gas;  // no free surface: nothing reaches the liquid
    gas.inverse_rho = sums.weight_by_size.value() / weight;
    const double mean_scale = sums.scale.value() / live;
    double factor = m.medium_ratio * m.exchange_rate;
    switch (m.medium_scaling) {
        case MediumScaling::kArea:
            factor *= m.initial_mean_surface / mean_scale;
            break;
        case MediumScaling::kRadius:
            factor *= m.initial_mean_radius / mean_scale;
            break;
        case MediumScaling::kLsw:
            factor *= 4.0 * std::numbers::pi * m.input_mean_radius;
            break;
    }
    gas.medium_factor = factor / Shape<D>::kVolume;
    return gas;
}

/// What exchange of gas adds to the bound of the relaxation rate: 2 K (1 + kappa) / R_min^2.
template <int D>
LAMELLA_HOST_DEVICE double exchange_stiffness(const Model& m) {
    const double min_radius = Shape<D>::radius(m.min_size);
    return 2.0 * m.exchange_rate * (1.0 + m.medium_ratio) / (min_radius * min_radius);
}

}  // namespace lamella::bubble
