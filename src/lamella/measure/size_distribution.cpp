#include "lamella/measure/size_distribution.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::measure {

Histogram relative_size_histogram(std::span<const double> radii, double bin_width) {
    if (!(bin_width >= 1e-3)) throw InputError(fmt::format("a bin width of {} is too small", bin_width));
    Histogram histogram;
    histogram.bin_width = bin_width;
    if (radii.empty()) return histogram;

    const double mean =
        parallel_sum(radii.size(), [&](std::size_t i) { return radii[i]; }) / static_cast<double>(radii.size());
    double largest = 0.0;
    for (const double radius : radii) {
        if (!(radius > 0.0 && std::isfinite(radius))) throw InputError(fmt::format("a radius is {}", radius));
        largest = std::max(largest, radius / mean);
    }
    constexpr double kMostBins = 1e6;  // a frame with one giant among specks must not take all memory
    if (largest / bin_width > kMostBins) throw InputError("the radii differ too much for a histogram");

    histogram.density.assign(static_cast<std::size_t>(largest / bin_width) + 1, 0.0);
    const double weight = 1.0 / (static_cast<double>(radii.size()) * bin_width);
    for (const double radius : radii) histogram.density[static_cast<std::size_t>(radius / mean / bin_width)] += weight;
    return histogram;
}

}  // namespace lamella::measure
