#pragma once

#include "lamella/io/csv.h"
#include "lamella/sim/frame.h"

#include "gnuplot.h"
#include "style.h"
#include <optional>
#include <vector>

namespace lamella::app {

/// The pictures of a coarsening foam, after [Lankinen20, chapter 4]. A panel whose columns the series lacks, or that
/// would be empty, is left out.

/// Mean radius against scaled time, both logarithmic, between slopes 1/2 and 1/3 (fig. 4.1).
std::optional<Panel> growth_panel(Gnuplot& gnuplot, const io::CsvTable& series);
/// Energy against time (fig. 4.10).
std::optional<Panel> energy_panel(Gnuplot& gnuplot, const io::CsvTable& series);
/// Velocity variance above, rate of energy release below, both normalized to 1 (figs. 4.2 to 4.5: avalanches).
std::optional<Panel> avalanche_panel(Gnuplot& gnuplot, const io::CsvTable& series);
/// Bubbles left, and contacts per bubble, against time.
std::optional<Panel> count_panel(Gnuplot& gnuplot, const io::CsvTable& series);
/// Distribution of R / <R> at the times of the frames.
std::optional<Panel> size_panel(Gnuplot& gnuplot, const std::vector<sim::Frame>& frames);
/// Distribution of |local - global gas fraction| at the times of the frames (figs. 4.8 and 4.9).
std::optional<Panel> homogeneity_panel(Gnuplot& gnuplot, const std::vector<sim::Frame>& frames);

/// Every column of any series against time, in small panels.
std::vector<Panel> series_panels(Gnuplot& gnuplot, const io::CsvTable& series);

}  // namespace lamella::app
