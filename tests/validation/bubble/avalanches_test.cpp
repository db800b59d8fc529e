// Avalanches: near jamming a foam creeps, then rearranges in bursts that release energy. [Lankinen20, figs 4.2-4.5]

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "../../unit/bubble/foams.h"

namespace lamella::bubble {
namespace {

using namespace test;

struct Bursts {
    double correlation;  // of the energy released in an interval with the variance of the velocity at its end
    double top_share;    // of all energy released, in the top 1 % of the intervals
};

double mean(const std::vector<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size()); }

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
    const double mx = mean(x);
    const double my = mean(y);
    double xx = 0.0, yy = 0.0, xy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mx) * (x[i] - mx);
        yy += (y[i] - my) * (y[i] - my);
        xy += (x[i] - mx) * (y[i] - my);
    }
    return xy / std::sqrt(xx * yy);
}

double velocity_variance(const BubbleSolver<2>& solver) {
    const Foam<2>& foam = solver.system().foam;
    double sum[2] = {}, squares = 0.0;
    for (std::size_t i = 0; i < foam.slots; ++i) {
        if (!foam.alive(i)) continue;
        for (std::size_t k = 0; k < 2; ++k) {
            sum[k] += foam.velocity[k][i];
            squares += foam.velocity[k][i] * foam.velocity[k][i];
        }
    }
    const auto n = static_cast<double>(foam.live);
    return (squares - (sum[0] * sum[0] + sum[1] * sum[1]) / n) / n;
}

Bursts bursts(double gas_fraction) {
    auto solver = start_solver<2>(coarsening(2, 1600, gas_fraction));
    run_to(*solver, 2.0);
    std::vector<double> released, variance;
    double energy = scalar(*solver, "energy");
    constexpr double kInterval = 0.005;
    for (int k = 1; k <= 1600; ++k) {
        run_to(*solver, 2.0 + k * kInterval);
        const double now = scalar(*solver, "energy");
        released.push_back(std::max(energy - now, 0.0));
        variance.push_back(velocity_variance(*solver));
        energy = now;
    }
    Bursts result{correlation(released, variance), 0.0};
    std::sort(released.rbegin(), released.rend());
    const double all = std::accumulate(released.begin(), released.end(), 0.0);
    const auto top = static_cast<std::ptrdiff_t>(released.size() / 100);
    result.top_share = std::accumulate(released.begin(), released.begin() + top, 0.0) / all;
    return result;
}

TEST(Avalanches, ReleaseTheEnergyWhereTheFoamMovesAndLessSoTheWetterItIs) {
    // Method sheet, 10.7. Over five choices of size (1600, 4096) and interval (0.001 to 0.02) the correlation falls
    // from 0.89-0.91 at 1.00 to 0.55-0.72 at 0.87. The share of the top 1 %, 3 to 9 %, shows no trend with the gas
    // fraction; evenly spread it would be 1 %.
    std::vector<double> correlations;
    for (const double gas_fraction : {1.00, 0.95, 0.90, 0.87}) {
        const Bursts b = bursts(gas_fraction);
        std::printf("gas fraction %.2f: correlation %.3f, top 1 %% of intervals release %.1f %%\n", gas_fraction,
                    b.correlation, 100.0 * b.top_share);
        EXPECT_GT(b.correlation, 0.4) << "gas fraction " << gas_fraction;
        EXPECT_GT(b.top_share, 0.02) << "gas fraction " << gas_fraction;
        correlations.push_back(b.correlation);
    }
    EXPECT_GT(correlations.front(), 0.8);
    EXPECT_LT(correlations.back(), correlations.front() - 0.1);
}

}  // namespace
}  // namespace lamella::bubble
