#include "lamella/optics/thin_film.h"

#include <cmath>
#include <complex>
#include <numbers>

namespace lamella::optics {
namespace {

double cosine_inside(double index, double cosine) {
    const double sine_squared = (1.0 - cosine * cosine) / (index * index);
    return std::sqrt(1.0 - sine_squared);
}

/// d: half the phase that one way to and fro in the film adds.
double half_phase(const FilmWave& wave) {
    return 2.0 * std::numbers::pi * wave.index * wave.thickness * 1e9 * cosine_inside(wave.index, wave.cosine) /
           wave.wavelength_nm;
}

template <class Function>
Polarized for_both(const Polarized& amplitude, Function&& function) {
    return {function(amplitude.s), function(amplitude.p)};
}

}  // namespace

Polarized interface_amplitude(double index, double cosine) {
    const double inside = cosine_inside(index, cosine);
    return {(cosine - index * inside) / (cosine + index * inside), (index * cosine - inside) / (index * cosine + inside)};
}

Polarized film_reflectance(const FilmWave& wave) {
    const double sine = std::sin(half_phase(wave));
    return for_both(interface_amplitude(wave.index, wave.cosine), [&](double r) {
        const double fringes = 4.0 * r * r * sine * sine;
        const double floor = (1.0 - r * r) * (1.0 - r * r);
        return fringes + floor > 0.0 ? fringes / (fringes + floor) : 1.0;  // 0/0 only at grazing incidence
    });
}

Polarized film_transmittance(const FilmWave& wave) {
    const double d = half_phase(wave);
    return for_both(interface_amplitude(wave.index, wave.cosine), [&](double r) {
        const double through = 1.0 - r * r;  // t_in t_out
        if (through == 0.0) return 0.0;
        return std::norm(through / (1.0 - r * r * std::polar(1.0, 2.0 * d)));
    });
}

Polarized thick_film_reflectance(double index, double cosine) {
    return for_both(interface_amplitude(index, cosine), [](double r) { return 2.0 * r * r / (1.0 + r * r); });
}

}  // namespace lamella::optics
