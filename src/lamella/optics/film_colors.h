#pragma once

#include "lamella/optics/color.h"
#include "lamella/optics/spectrum.h"

#include <array>

namespace lamella::optics {

/// What a film is made of and what light falls on it.
struct FilmLight {
    Illuminant light = illuminant("D65");
    double temperature = 298.15;  ///< of the liquid [K]
    double index_offset = 0.0;    ///< what glycerol or surfactant add to water's refractive index, all wavelengths alike [-]
};

/// The color of a film in white light: for each channel the reflectance averaged over the spectrum,
///
///   C = sum_i w_i R(thickness, cosine, wavelength_i),   sum_i w_i = (1, 1, 1)
///
/// with weights w_i from the illuminant, the color matching functions, adaptation to sRGB's white and the matrix of
/// sRGB. A mirror (R = 1) is (1, 1, 1); what is transmitted is (1, 1, 1) - C. Dispersion is water's.
class FilmColors {
public:
    explicit FilmColors(const FilmLight& film = {});

    /// Signed linear sRGB of unpolarized light reflected by a film. Steps of 5 nm resolve its fringes up to 4 um.
    /// @param thickness  [m]
    /// @param cosine     of the angle of incidence, 0 to 1
    Rgb reflected(double thickness, double cosine) const;

    /// The same of a film too thick for fringes.
    Rgb reflected_by_thick_film(double cosine) const;

    double index(std::size_t i) const { return index_[i]; }  ///< at wavelength_nm(i)

private:
    std::array<Rgb, kWavelengths> weight_;
    Spectrum index_{};
};

}  // namespace lamella::optics
