#include "lamella/optics/film_colors.h"

#include "lamella/optics/thin_film.h"
#include "lamella/optics/water_index.h"

namespace lamella::optics {

FilmColors::FilmColors(const FilmLight& film) {
    std::array<Xyz, kWavelengths> part;
    Xyz white;
    for (std::size_t i = 0; i < kWavelengths; ++i) {
        const Matching m = color_matching(wavelength_nm(i));
        part[i] = film.light.power[i] * Xyz{{m.x, m.y, m.z}};
        white += part[i];
        index_[i] = water_index(wavelength_nm(i), film.temperature) + film.index_offset;
    }
    const double scale = 1.0 / white[1];
    Rgb sum;
    for (std::size_t i = 0; i < kWavelengths; ++i) {
        weight_[i] = linear_srgb(adapt_white(scale * part[i], scale * white));
        sum += weight_[i];
    }
    // The white of the standard's matrix is rounded in the fifth digit: white shall be (1, 1, 1) to the last.
    for (Rgb& w : weight_)
        for (std::size_t k = 0; k < 3; ++k) w[k] /= sum[k];
}

Rgb FilmColors::reflected(double thickness, double cosine) const {
    Rgb color;
    for (std::size_t i = 0; i < kWavelengths; ++i)
        color += film_reflectance({index_[i], thickness, cosine, wavelength_nm(i)}).mean() * weight_[i];
    return color;
}

Rgb FilmColors::reflected_by_thick_film(double cosine) const {
    Rgb color;
    for (std::size_t i = 0; i < kWavelengths; ++i)
        color += thick_film_reflectance(index_[i], cosine).mean() * weight_[i];
    return color;
}

}  // namespace lamella::optics
