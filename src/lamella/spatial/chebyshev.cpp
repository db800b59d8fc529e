#include "lamella/spatial/detail/chebyshev.h"

#include <algorithm>

namespace lamella::spatial::detail {

namespace {

using Counts = std::array<std::size_t, 3>;
using Grid = std::array<double, kMostProxies * kMostProxies * kMostProxies>;

Counts counts(const Cluster& c) { return {c.proxies[0], c.proxies[1], c.proxies[2]}; }

/// to[a][b][c] += sum over i, j, k of x(a, i) y(b, j) z(c, k) from[i][j][k].
template <class Weight>
void contract(const Counts& in, const Counts& out, const double* from, double* to, Weight&& weight) {
    Grid first, second;
    for (std::size_t row = 0; row < in[0] * in[1]; ++row)
        for (std::size_t c = 0; c < out[2]; ++c) {
            double sum = 0.0;
            for (std::size_t k = 0; k < in[2]; ++k) sum += weight(2, c, k) * from[row * in[2] + k];
            first[row * out[2] + c] = sum;
        }
    for (std::size_t i = 0; i < in[0]; ++i)
        for (std::size_t b = 0; b < out[1]; ++b) {
            double* sum = &second[(i * out[1] + b) * out[2]];
            std::fill_n(sum, out[2], 0.0);
            for (std::size_t j = 0; j < in[1]; ++j)
                for (std::size_t c = 0; c < out[2]; ++c)
                    sum[c] += weight(1, b, j) * first[(i * in[1] + j) * out[2] + c];
        }
    const std::size_t plane = out[1] * out[2];
    for (std::size_t a = 0; a < out[0]; ++a)
        for (std::size_t i = 0; i < in[0]; ++i)
            for (std::size_t s = 0; s < plane; ++s) to[a * plane + s] += weight(0, a, i) * second[i * plane + s];
}

}  // namespace

void carry_up(const GridWeights& weights, const Cluster& outer, const Cluster& inner, const double* from, double* to) {
    contract(counts(inner), counts(outer), from, to,
             [&](std::size_t axis, std::size_t o, std::size_t i) { return weights.w[axis][o][i]; });
}

void carry_down(
    const GridWeights& weights, const Cluster& outer, const Cluster& inner, const double* from, double* to) {
    contract(counts(outer), counts(inner), from, to,
             [&](std::size_t axis, std::size_t o, std::size_t i) { return weights.w[axis][i][o]; });
}

}  // namespace lamella::spatial::detail
