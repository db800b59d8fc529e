#pragma once

// Frequency and amplitude of an oscillation that is seen a few times per period only.

#include <cmath>
#include <vector>

namespace lamella::vortex_sheet {

struct Oscillation {
    double angle;       ///< omega times the time between values
    double first, last;  ///< amplitude at both ends
};

/// Of a_n = A cos(angle n + phase) + constant, by least squares on a_{n+1} + a_{n-1} = 2 cos(angle) a_n + constant.
inline Oscillation oscillation(std::vector<double> a) {
    const std::size_t n = a.size();
    double x = 0, y = 0, xx = 0, xy = 0, count = 0;
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double sum = a[i + 1] + a[i - 1];
        x += a[i];
        y += sum;
        xx += a[i] * a[i];
        xy += a[i] * sum;
        count += 1;
    }
    const double twice = (xy - x * y / count) / (xx - x * x / count);
    const double rest = (y - twice * x) / count / (2.0 - twice);
    for (double& value : a) value -= rest;
    const double c = 0.5 * twice;
    const auto amplitude = [&](double p, double q) { return std::sqrt((p * p + q * q - 2 * c * p * q) / (1 - c * c)); };
    return {std::acos(c), amplitude(a[0], a[1]), amplitude(a[n - 2], a[n - 1])};
}

}  // namespace lamella::vortex_sheet
