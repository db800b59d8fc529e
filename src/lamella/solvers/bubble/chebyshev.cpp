#include "lamella/solvers/bubble/chebyshev.h"

namespace lamella::bubble::chebyshev {

namespace {
constexpr double kDamping = 2.0 / 13.0;
}

std::vector<StageWeights> stage_weights(int s) {
    const double w0 = 1.0 + kDamping / (s * s);
    // Chebyshev polynomials and their first two derivatives at w0.
    const auto n = static_cast<std::size_t>(s) + 1;
    std::vector<double> t(n), t1(n), t2(n);
    t[0] = 1.0;
    t[1] = w0;
    t1[1] = 1.0;
    for (std::size_t j = 2; j < n; ++j) {
        t[j] = 2.0 * w0 * t[j - 1] - t[j - 2];
        t1[j] = 2.0 * t[j - 1] + 2.0 * w0 * t1[j - 1] - t1[j - 2];
        t2[j] = 4.0 * t1[j - 1] + 2.0 * w0 * t2[j - 1] - t2[j - 2];
    }
    const double w1 = t1[n - 1] / t2[n - 1];
    std::vector<double> b(n);
    for (std::size_t j = 2; j < n; ++j) b[j] = t2[j] / (t1[j] * t1[j]);
    b[0] = b[1] = b[2];
    std::vector<StageWeights> weights(n);
    weights[1] = {0.0, 0.0, 0.0, b[1] * w1};
    for (std::size_t j = 2; j < n; ++j) {
        const double rate = 2.0 * b[j] * w1 / b[j - 1];
        const double a = 1.0 - b[j - 1] * t[j - 1];
        weights[j] = {2.0 * b[j] * w0 / b[j - 1], -b[j] / b[j - 2], rate, -a * rate};
    }
    return weights;
}

}  // namespace lamella::bubble::chebyshev
