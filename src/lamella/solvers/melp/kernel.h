#pragma once

#include "lamella/core/host_device.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace lamella::melp {

/// Powers of max(x, 0): the quintic spline is made of them.
LAMELLA_HOST_DEVICE inline double fourth_power(double x) { return (x * x) * (x * x); }
LAMELLA_HOST_DEVICE inline double fifth_power(double x) { return fourth_power(x) * x; }

/// The quintic spline in the plane, evaluated at the distance in space ('chord') of two particles of a film.
///
///   W(d) = alpha / r^2 M(d / r),   M(q) = (3 - 3q)+^5 - 6 (2 - 3q)+^5 + 15 (1 - 3q)+^5,   alpha = 63 / (478 pi)
///
/// On a sphere the cap within a chord d has area pi d^2 exactly, as the disk has in the plane: areas and curvatures of
/// evenly spread particles come out right there without a correction. [method sheet 3 R, 16.1]
struct FilmKernel {
    double support_radius;  ///< r [m]

    /// W [1/m^2] at squared distance d^2 [m^2].
    LAMELLA_HOST_DEVICE double value(double squared_distance) const {
        const double s = 3.0 * std::sqrt(squared_distance) / support_radius;
        const double m = fifth_power(std::max(3.0 - s, 0.0)) - 6.0 * fifth_power(std::max(2.0 - s, 0.0)) +
                         15.0 * fifth_power(std::max(1.0 - s, 0.0));
        return kAlpha / (support_radius * support_radius) * m;
    }

    /// -2 W'(d) / d [1/m^4], the weight of a pair in the Laplacian; its limit where d = 0.
    ///
    /// grad W = W'(d) / d (x_i - x_j), so half of this weight times (x_j - x_i) is the gradient of W at i.
    LAMELLA_HOST_DEVICE double laplacian_weight(double squared_distance) const {
        const double s = 3.0 * std::sqrt(squared_distance) / support_radius;
        const double scale = kAlpha / (fourth_power(support_radius));
        // Below s = 1 the three terms are one polynomial, 66 - 60 s^2 + 30 s^4 - 10 s^5, which s divides.
        if (s < 1.0) return scale * 18.0 * (120.0 - 120.0 * s * s + 50.0 * s * s * s);
        const double slope = -15.0 * fourth_power(std::max(3.0 - s, 0.0)) + 90.0 * fourth_power(std::max(2.0 - s, 0.0));
        return -2.0 * scale * slope * 3.0 / s;
    }

    /// Both for many pairs, with vector instructions.
    void weigh(std::span<const double> squared_distance, std::span<double> weight, std::span<double> laplacian) const {
        for (std::size_t k = 0; k < weight.size(); ++k) weight[k] = value(squared_distance[k]);
        for (std::size_t k = 0; k < weight.size(); ++k) laplacian[k] = laplacian_weight(squared_distance[k]);
    }

    static constexpr double kAlpha = 63.0 / (478.0 * 3.14159265358979323846);
};

}  // namespace lamella::melp
