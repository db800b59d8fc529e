#pragma once

namespace lamella::optics {

/// One number for each polarization of the light.
struct Polarized {
    double s = 0.0;  ///< electric field parallel to the film
    double p = 0.0;  ///< electric field in the plane of incidence

    double mean() const { return 0.5 * (s + p); }  ///< for unpolarized light
};

/// A film without absorption, with air of index 1 on both sides, as seen by one plane wave.
struct FilmWave {
    double index = 1.333;         ///< n of the liquid [-]
    double thickness = 0.0;       ///< h [m], at least 0
    double cosine = 1.0;          ///< of the angle of incidence in air, 0 (grazing) to 1 (normal)
    double wavelength_nm = 555.0; ///< in vacuum
};

/// The amplitude that one air-liquid interface reflects, r_s and r_p (Fresnel); -1 and 1 at grazing incidence.
Polarized interface_amplitude(double index, double cosine);

/// The fraction of the power that a film reflects, all reflections inside it summed (Airy):
///
///   R = 4 r^2 sin^2(d) / ((1 - r^2)^2 + 4 r^2 sin^2(d)),   d = 2 pi n h cos(theta_t) / wavelength
///
/// R = 0 without thickness (the two interfaces reflect with opposite signs: a thin film is black) and wherever
/// n h cos(theta_t) is a multiple of half a wavelength; R = 4 r^2 / (1 + r^2)^2 halfway between.
/// @see [BornWolf99, section 7.6.1]
Polarized film_reflectance(const FilmWave& wave);

/// The fraction that goes through, from the sum of the transmitted amplitudes on its own (not as 1 - R).
Polarized film_transmittance(const FilmWave& wave);

/// What a film reflects whose fringes are too fine to be seen: the mean of R over the phase, 2 r^2 / (1 + r^2).
Polarized thick_film_reflectance(double index, double cosine);

}  // namespace lamella::optics
