#pragma once

#include "lamella/spatial/detail/cluster_tree.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

// Interpolation on a grid of Chebyshev points in the box of a cluster. Along one axis of n points
//     x_i = cos((2 i + 1) pi / (2 n)),   L_i(x) = 1/n + 2/n sum_{m=1}^{n-1} T_m(x_i) T_m(x).

namespace lamella::spatial::detail {

/// Points and the matrix 2/n T_m(x_i) (1/n for m = 0) for every n.
class ChebyshevTable {
public:
    ChebyshevTable() {
        for (std::size_t n = 1; n <= kMostProxies; ++n)
            for (std::size_t i = 0; i < n; ++i) {
                const double angle =
                    (2.0 * static_cast<double>(i) + 1.0) * std::numbers::pi / (2.0 * static_cast<double>(n));
                point_[n][i] = std::cos(angle);
                for (std::size_t m = 0; m < n; ++m)
                    matrix_[n][m][i] =
                        (m == 0 ? 1.0 : 2.0) / static_cast<double>(n) * std::cos(static_cast<double>(m) * angle);
            }
    }

    double point(std::size_t n, std::size_t i) const { return point_[n][i]; }

    /// L_0(x) ... L_{n-1}(x), x in [-1, 1].
    void weights(std::size_t n, double x, double* weight) const {
        double before = 1.0, value = x;
        for (std::size_t i = 0; i < n; ++i) weight[i] = matrix_[n][0][i];
        for (std::size_t m = 1; m < n; ++m) {
            for (std::size_t i = 0; i < n; ++i) weight[i] += matrix_[n][m][i] * value;
            const double next = 2.0 * x * value - before;
            before = value;
            value = next;
        }
    }

private:
    double point_[kMostProxies + 1][kMostProxies] = {};
    double matrix_[kMostProxies + 1][kMostProxies][kMostProxies] = {};
};

/// The weights of one point along the three axes of a cluster.
struct PointWeights {
    double w[3][kMostProxies];

    PointWeights(const ChebyshevTable& table, const Cluster& c, const Vec3& x) {
        for (std::size_t k = 0; k < 3; ++k)
            table.weights(c.proxies[k], c.half[k] > 0.0 ? (x[k] - c.middle[k]) / c.half[k] : 0.0, w[k]);
    }
};

/// Coordinate k of proxy i along axis k.
inline double proxy_coordinate(const ChebyshevTable& table, const Cluster& c, std::size_t k, std::size_t i) {
    return c.middle[k] + c.half[k] * table.point(c.proxies[k], i);
}

/// weight[k][i][j] = value at proxy j of `inner` of the Lagrange polynomial of proxy i of `outer`, along axis k.
struct GridWeights {
    double w[3][kMostProxies][kMostProxies];  // [axis][outer][inner]

    GridWeights(const ChebyshevTable& table, const Cluster& outer, const Cluster& inner) {
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t j = 0; j < inner.proxies[k]; ++j) {
                double column[kMostProxies];
                const double x = proxy_coordinate(table, inner, k, j);
                table.weights(outer.proxies[k], outer.half[k] > 0.0 ? (x - outer.middle[k]) / outer.half[k] : 0.0,
                              column);
                for (std::size_t i = 0; i < outer.proxies[k]; ++i) w[k][i][j] = column[i];
            }
    }
};

/// Carries strengths at the proxies of `inner` up to those of `outer` (added), or values at the proxies of `outer` down
/// to those of `inner` (added): one axis after the other.
void carry_up(const GridWeights& weights, const Cluster& outer, const Cluster& inner, const double* from, double* to);
void carry_down(const GridWeights& weights, const Cluster& outer, const Cluster& inner, const double* from, double* to);

}  // namespace lamella::spatial::detail
