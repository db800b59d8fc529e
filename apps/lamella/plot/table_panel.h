#pragma once

#include "lamella/io/csv.h"

#include "gnuplot.h"
#include "style.h"
#include <string>

namespace lamella::app {

/// What to draw of a table that `lamella sweep collect` wrote.
struct TablePlot {
    std::string x;  ///< column; "": time where a task has several rows, else the first key with numbers
    std::string y;  ///< column
    bool log_x = false, log_y = false;
};

/// One column against another, a color for each combination of the other keys. Of tasks that differ in their seed
/// alone: along a key their mean, with bars from the least to the largest; along time a line each.
/// @throws InputError  no such column, or one without numbers
Panel table_panel(Gnuplot& gnuplot, const io::CsvTextTable& table, const TablePlot& plot);

}  // namespace lamella::app
