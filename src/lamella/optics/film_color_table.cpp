#include "lamella/optics/film_color_table.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace lamella::optics {
namespace {

std::array<float, 3> narrow(const Rgb& color) {
    return {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
}

/// The cosine of the angle inside the film.
double refracted_part(double cosine, double index) { return std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index)); }

/// A place between two entries of a row: the first of them and how far on.
struct Place {
    std::size_t first;
    double rest;
};

Place place(double position, std::size_t entries) {
    const double last = static_cast<double>(entries - 1);
    const double clamped = position > 0.0 ? std::min(position, last) : 0.0;  // NaN becomes 0
    const auto first = std::min(static_cast<std::size_t>(clamped), entries - 2);
    return {first, clamped - static_cast<double>(first)};
}

}  // namespace

FilmColorTable::FilmColorTable(const FilmLight& film, const TableSize& size) : size_(size) {
    if (size.thicknesses < 2 || size.cosines < 2 || !(size.max_thickness > 0.0))
        throw InputError("a table of colors needs two thicknesses, two cosines and a range");
    const FilmColors colors(film);
    reference_index_ = colors.index(35);  // 555 nm, where the eye sees best
    values_.resize((size.thicknesses + 1) * size.cosines);
    parallel_blocks(size.cosines, 1, [&](std::size_t row, std::size_t) {
        const double v = static_cast<double>(row) / static_cast<double>(size.cosines - 1);
        const double longest = size.max_thickness / refracted_part(v * v, reference_index_);
        for (std::size_t t = 0; t < size.thicknesses; ++t) {
            const double u = static_cast<double>(t) / static_cast<double>(size.thicknesses - 1);
            values_[row * size.thicknesses + t] = narrow(colors.reflected(u * u * longest, v * v));
        }
        values_[size.cosines * size.thicknesses + row] = narrow(colors.reflected_by_thick_film(v * v));
    });
}

Rgb FilmColorTable::reflected(double thickness, double cosine) const {
    const double c = std::clamp(cosine, 0.0, 1.0);
    const double x = std::max(0.0, thickness) * refracted_part(c, reference_index_);
    const Place v = place(std::sqrt(c) * static_cast<double>(size_.cosines - 1), size_.cosines);
    const bool thick = x > size_.max_thickness;
    const Place t = place(std::sqrt(x / size_.max_thickness) * static_cast<double>(size_.thicknesses - 1), size_.thicknesses);
    const std::array<float, 3>* row = thick ? &values_[size_.cosines * size_.thicknesses] : &values_[v.first * size_.thicknesses];
    Rgb color;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto along = [&](std::size_t n) {  // of row v.first + n
            if (thick) return static_cast<double>(row[v.first + n][k]);
            const std::array<float, 3>* entry = row + n * size_.thicknesses + t.first;
            return (1.0 - t.rest) * static_cast<double>(entry[0][k]) + t.rest * static_cast<double>(entry[1][k]);
        };
        color[k] = (1.0 - v.rest) * along(0) + v.rest * along(1);
    }
    return color;
}

}  // namespace lamella::optics
