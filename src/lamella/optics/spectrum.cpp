#include "lamella/optics/spectrum.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace lamella::optics {
namespace {

/// CIE standard illuminant D65, relative spectral power at 380, 385, ... 780 nm; 100 at 560 nm. [CIE15]
constexpr Spectrum kD65 = {
    49.9755, 52.3118, 54.6482, 68.7015, 82.7549, 87.1204, 91.486, 92.4589, 93.4318,
    90.057, 86.6823, 95.7736, 104.865, 110.936, 117.008, 117.41, 117.812, 116.336,
    114.861, 115.392, 115.923, 112.367, 108.811, 109.082, 109.354, 108.578, 107.802,
    106.296, 104.79, 106.239, 107.689, 106.047, 104.405, 104.225, 104.046, 102.023,
    100, 98.1671, 96.3342, 96.0611, 95.788, 92.2368, 88.6856, 89.3459, 90.0062,
    89.8026, 89.5991, 88.6489, 87.6987, 85.4936, 83.2886, 83.4939, 83.6992, 81.863,
    80.0268, 80.1207, 80.2146, 81.2462, 82.2778, 80.281, 78.2842, 74.0027, 69.7213,
    70.6652, 71.6091, 72.979, 74.349, 67.9765, 61.604, 65.7448, 69.8856, 72.4863,
    75.087, 69.3398, 63.5927, 55.0054, 46.4182, 56.6118, 66.8054, 65.0941, 63.3828,
};

/// A Gaussian with one width on each side of its peak.
double lobe(double wavelength_nm, double peak, double left, double right) {
    const double s = (wavelength_nm - peak) / (wavelength_nm < peak ? left : right);
    return std::exp(-0.5 * s * s);
}

/// Planck's law, scaled to 100 at 560 nm.
Spectrum black_body(double temperature) {
    constexpr double kSecondRadiation = 1.438776877e7;  // h c / k_B [nm K]
    const auto power = [&](double nm) {
        return std::pow(560.0 / nm, 5.0) / std::expm1(kSecondRadiation / (nm * temperature));
    };
    Spectrum spectrum{};
    for (std::size_t i = 0; i < kWavelengths; ++i) spectrum[i] = 100.0 * power(wavelength_nm(i)) / power(560.0);
    return spectrum;
}

}  // namespace

Matching color_matching(double nm) {
    return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
                0.065 * lobe(nm, 501.1, 20.4, 26.2),
            0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
            1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

Illuminant illuminant(const std::string& name) {
    if (name == "D65") return {name, kD65};
    // The standard gives A the second radiation constant of its time, 1.435e7 nm K: 2848 K of then are 2855.5 K of now.
    if (name == "A") return {name, black_body(2848.0 * 1.438776877 / 1.435)};
    if (name == "E") {
        Illuminant equal{name, {}};
        equal.power.fill(100.0);
        return equal;
    }
    char* end = nullptr;
    const double temperature = std::strtod(name.c_str(), &end);
    const std::string unit = end;
    if (end != name.c_str() && (unit == " K" || unit == "K")) {
        if (!(temperature >= 1000.0 && temperature <= 25000.0))
            throw InputError(fmt::format("a black body of {} is outside [1000, 25000] K", name));
        return {name, black_body(temperature)};
    }
    throw InputError(fmt::format("there is no light {}; D65, A, E, or a temperature such as \"5000 K\"", name));
}

std::vector<std::string> illuminant_names() { return {"D65", "A", "E"}; }

}  // namespace lamella::optics
