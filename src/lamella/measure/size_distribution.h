#pragma once

#include <span>
#include <vector>

namespace lamella::measure {

/// A probability density over bins of equal width.
struct Histogram {
    double low = 0.0;  ///< left edge of the first bin
    double bin_width = 0.0;
    std::vector<double> density;  ///< per bin; sum times bin_width is 1

    double center(std::size_t bin) const { return low + bin_width * (static_cast<double>(bin) + 0.5); }
};

/// Distribution of relative sizes x = R / <R>, from 0 to the largest, over bins of width `bin_width`.
///
/// @param radii      #B radii, all positive and finite
/// @param bin_width  [-], at least 1e-3
/// @returns          an empty density when there are no radii
/// @throws InputError  a radius is not positive and finite, or the bin width is too small
Histogram relative_size_histogram(std::span<const double> radii, double bin_width);

}  // namespace lamella::measure
