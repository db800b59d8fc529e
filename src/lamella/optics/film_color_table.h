#pragma once

#include "lamella/optics/film_colors.h"

#include <array>
#include <cstddef>
#include <vector>

namespace lamella::optics {

/// How fine a FilmColorTable is.
struct TableSize {
    std::size_t thicknesses = 1201;  ///< columns: from 0 to max_thickness
    std::size_t cosines = 97;        ///< rows
    double max_thickness = 4000e-9;  ///< [m]; the fringes of daylight are gone there
};

/// Colors of films for programs that need millions of them: bilinear interpolation between the colors at
///
///   x = max_thickness u^2   where x = h sqrt(1 - (1 - c^2) / n^2) is the thickness that the refracted ray counts,
///   c = v^2                 with u and v even from 0 to 1, n = reference_index().
///
/// With x instead of the thickness h the phase of the interference (but for dispersion) is the same in a whole column.
/// The squares put the entries where colors change fast: in films thinner than the first fringe, and near grazing
/// incidence. Where x > max_thickness the limit of thick films stands. The same values can be handed to a shader.
class FilmColorTable {
public:
    explicit FilmColorTable(const FilmLight& film = {}, const TableSize& size = {});

    const TableSize& size() const { return size_; }
    double reference_index() const { return reference_index_; }
    /// Signed linear sRGB as in FilmColors::reflected. Cosines beyond [0, 1] and thicknesses below 0 count as the nearest.
    Rgb reflected(double thickness, double cosine) const;

    /// cosines rows of thicknesses colors, then one row of the limit: cosines colors.
    const std::vector<std::array<float, 3>>& values() const { return values_; }

private:
    TableSize size_;
    double reference_index_ = 0.0;
    std::vector<std::array<float, 3>> values_;
};

}  // namespace lamella::optics
