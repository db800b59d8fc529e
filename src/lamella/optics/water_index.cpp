#include "lamella/optics/water_index.h"

#include <cmath>

namespace lamella::optics {

double water_index(double wavelength_nm, double temperature, double density) {
    constexpr double kUltraviolet = 0.2292020, kInfrared = 5.432937;  // resonances, in units of 589 nm
    const double r = density / 1000.0;
    const double t = temperature / 273.15;
    const double l2 = (wavelength_nm / 589.0) * (wavelength_nm / 589.0);
    const double refraction = 0.244257733 + 9.74634476e-3 * r - 3.73234996e-3 * t + 2.68678472e-4 * l2 * t +
                              1.58920570e-3 / l2 + 2.45934259e-3 / (l2 - kUltraviolet * kUltraviolet) +
                              0.900704920 / (l2 - kInfrared * kInfrared) - 1.66626219e-2 * r * r;
    const double x = r * refraction;  // (n^2 - 1) / (n^2 + 2)
    return std::sqrt((1.0 + 2.0 * x) / (1.0 - x));
}

}  // namespace lamella::optics
