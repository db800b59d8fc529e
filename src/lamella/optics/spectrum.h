#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace lamella::optics {

/// Visible light in steps of 5 nm: 380, 385, ... 780 nm.
inline constexpr std::size_t kWavelengths = 81;
using Spectrum = std::array<double, kWavelengths>;

constexpr double wavelength_nm(std::size_t i) { return 380.0 + 5.0 * static_cast<double>(i); }

/// The CIE 1931 color matching functions of the standard observer (2 degrees) as sums of two-sided Gaussian lobes:
/// within the scatter of the observers that the standard averages. [Wyman13, table 1, multi-lobe fit]
struct Matching {
    double x = 0.0, y = 0.0, z = 0.0;
};
Matching color_matching(double wavelength_nm);

/// Light that falls on a film: relative spectral power, any scale.
struct Illuminant {
    std::string name;
    Spectrum power{};
};

/// "D65" (daylight, CIE table), "A" (incandescent, 2856 K), "E" (equal energy), or a black body: "5000 K".
/// @throws InputError  anything else, or a temperature outside 1000 to 25000 K
Illuminant illuminant(const std::string& name);

/// The named ones, for help texts.
std::vector<std::string> illuminant_names();

}  // namespace lamella::optics
