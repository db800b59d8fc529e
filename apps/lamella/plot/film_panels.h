#pragma once

#include "lamella/io/csv.h"

#include "gnuplot.h"
#include "style.h"
#include <vector>

namespace lamella::app {

/// The pictures of a film run: area, volumes, pressures, angles against Plateau's laws, accuracy, mesh. Against time, or
/// against steps where time stands still (films that come to rest). A panel whose columns are empty is left out.
std::vector<Panel> film_panels(Gnuplot& gnuplot, const io::CsvTable& series);

}  // namespace lamella::app
