#include "foam_panels.h"

#include "lamella/measure/local_gas_fraction.h"
#include "lamella/measure/measure.h"
#include "lamella/measure/size_distribution.h"

#include <fmt/format.h>

#include "frame_source.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::app {
namespace {

constexpr const char* kBlue = "#2c728e";
constexpr const char* kGreen = "#28ae80";
constexpr const char* kPurple = "#440154";
constexpr const char* kGuide = "#888888";
constexpr const char* kTimeLabel = "set xlabel 'scaled time τ'\n";

/// The time axis of a foam: scaled time where the series has it.
std::optional<std::vector<double>> foam_time(const io::CsvTable& series) {
    auto time = find_column(series, "scaled_time");
    return time ? time : find_column(series, "time");
}

struct Extent {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void include(double value) {
        if (!std::isfinite(value)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

/// The rows of two columns where both are positive: what a doubly logarithmic plot can show.
Columns positive_rows(const std::vector<double>& x, const std::vector<double>& y) {
    Columns columns(2);
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!(x[i] > 0.0 && y[i] > 0.0 && std::isfinite(x[i]) && std::isfinite(y[i]))) continue;
        columns[0].push_back(x[i]);
        columns[1].push_back(y[i]);
    }
    return columns;
}

Extent extent_of(const std::vector<double>& values) {
    Extent extent;
    for (const double value : values) extent.include(value);
    return extent;
}

/// "plot" with one curve per frame, colored by its place in the list, titled by its time.
std::string curves_by_time(const std::vector<std::string>& data, const std::vector<double>& times) {
    std::string script = "plot ";
    for (std::size_t k = 0; k < data.size(); ++k) {
        const double place = data.size() > 1 ? static_cast<double>(k) / static_cast<double>(data.size() - 1) : 0.0;
        script += fmt::format("{}{} using 1:2 with lines lw 1.2 lc rgb '{}' title {}", k == 0 ? "" : ", ", data[k],
                              color_text(map_color(0.9 * place)), gnuplot_text(fmt::format("τ = {:.3g}", times[k])));
    }
    return script + "\n";
}

}  // namespace

std::optional<Panel> growth_panel(Gnuplot& gnuplot, const io::CsvTable& series) {
    const auto time = foam_time(series);
    auto radius = find_column(series, "mean_radius");
    if (!time || !radius) return std::nullopt;
    const auto initial = find_column(series, "initial_mean_radius");
    if (initial)
        for (std::size_t i = 0; i < radius->size(); ++i) (*radius)[i] /= (*initial)[i];
    const Columns rows = positive_rows(*time, *radius);
    if (rows[0].size() < 2) return std::nullopt;

    const Extent x = extent_of(rows[0]);
    const Extent y = extent_of(rows[1]);
    const double from = std::max(x.low, x.high / 8.0);
    const double left = std::max(x.low, x.high / 2000.0);  // what came before is the rest of the packing
    const auto guide = [&](double slope, double lift, const char* label) {
        Columns line(2);
        for (const double t : {from, x.high}) {
            line[0].push_back(t);
            line[1].push_back(lift * rows[1].back() * std::pow(t / x.high, slope));
        }
        const double middle = std::sqrt(from * x.high);
        return std::pair{
            gnuplot.data(line),
            fmt::format("set label '{}' at {:.6g},{:.6g} {} tc rgb '{}'\n", label, middle,
                        (lift > 1.0 ? 1.09 : 0.91) * lift * rows[1].back() * std::pow(middle / x.high, slope),
                        lift > 1.0 ? "right" : "left", kGuide)};
    };
    const auto [half, half_label] = guide(0.5, 1.30, "1/2");
    const auto [third, third_label] = guide(1.0 / 3.0, 0.74, "1/3");
    const double low = 0.85 * std::min(y.low, 0.74 * rows[1].back() * std::pow(from / x.high, 1.0 / 3.0));
    const double high = 1.45 * y.high;

    std::string script = panel_style() + kTimeLabel + half_label + third_label;
    script += initial ? "set ylabel '⟨{/:Italic R}⟩ / ⟨{/:Italic R}_{in}⟩'\n" : "set ylabel '⟨{/:Italic R}⟩'\n";
    script += fmt::format("set logscale xy\nset xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n", left,
                          1.15 * x.high, low, high);
    script += log_tics('x', left, 1.15 * x.high) + log_tics('y', low, high) + "unset key\n";
    script += fmt::format(
        "plot {} with lines lw 0.8 dt 2 lc rgb '{}', {} with lines lw 0.8 dt 2 lc rgb '{}', "
        "{} with lines lw 1.6 lc rgb '{}'\n",
        half, kGuide, third, kGuide, gnuplot.data(rows), kPurple);
    return Panel{"growth", script};
}

std::optional<Panel> energy_panel(Gnuplot& gnuplot, const io::CsvTable& series) {
    const auto time = foam_time(series);
    const auto energy = find_column(series, "energy");
    if (!time || !energy || time->size() < 2) return std::nullopt;
    std::string script = panel_style() + kTimeLabel + "set ylabel 'energy {/:Italic E}'\nunset key\n";
    script += fmt::format("set xrange [0:{:.9g}]\nset yrange [0:*]\n", time->back());
    script += fmt::format("plot {} with lines lw 1.2 lc rgb '{}'\n", gnuplot.data({*time, *energy}), kBlue);
    return Panel{"energy", script};
}

std::optional<Panel> avalanche_panel(Gnuplot& gnuplot, const io::CsvTable& series) {
    const auto time = foam_time(series);
    const auto energy = find_column(series, "energy");
    const auto variance = find_column(series, "velocity_variance");
    if (!time || !energy || !variance || time->size() < 3) return std::nullopt;

    // The first row is the packing at rest; what moves there is left over from its making.
    Columns rows(3);
    double most_variance = 0.0;
    double most_release = 0.0;
    for (std::size_t i = 1; i < time->size(); ++i) {
        rows[0].push_back((*time)[i]);
        rows[1].push_back((*variance)[i]);
        // Per unit of time, because the rows of a series need not be evenly spaced.
        rows[2].push_back(std::min(0.0, ((*energy)[i] - (*energy)[i - 1]) / ((*time)[i] - (*time)[i - 1])));
        if (std::isfinite(rows[1].back())) most_variance = std::max(most_variance, rows[1].back());
        if (std::isfinite(rows[2].back())) most_release = std::max(most_release, -rows[2].back());
    }
    if (!(most_variance > 0.0 && most_release > 0.0)) return std::nullopt;
    for (double& value : rows[1]) value /= most_variance;
    for (double& value : rows[2]) value /= most_release;

    const std::string data = gnuplot.data(rows);
    std::string script = panel_style() + kTimeLabel + "set ylabel 'normalized'\nset key top right\n";
    script += fmt::format("set xrange [0:{:.9g}]\nset yrange [-1.15:1.3]\nset ytics 0.5\n", time->back());
    script += "set arrow from graph 0,first 0 to graph 1,first 0 nohead lw 0.5 lc rgb '#333333'\n";
    script += fmt::format(
        "plot {0} using 1:2 with lines lw 0.7 lc rgb '{1}' title 'velocity variance', "
        "{0} using 1:3 with lines lw 0.7 lc rgb '{2}' title 'energy release rate'\n",
        data, kBlue, kPurple);
    return Panel{"avalanches", script};
}

std::optional<Panel> count_panel(Gnuplot& gnuplot, const io::CsvTable& series) {
    const auto time = foam_time(series);
    const auto bubbles = find_column(series, "bubbles");
    if (!time || !bubbles) return std::nullopt;
    const Columns rows = positive_rows(*time, *bubbles);
    if (rows[0].size() < 2) return std::nullopt;
    const Extent x = extent_of(rows[0]);
    const Extent y = extent_of(rows[1]);
    const double low = 0.7 * y.low;
    const double high = 1.4 * y.high;
    std::string script = panel_style() + kTimeLabel;
    script +=
        fmt::format("set ylabel 'bubbles left {{/:Italic N}}' tc rgb '{}'\nset logscale xy\nunset key\n", kPurple);
    script += fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n", x.low, x.high, low, high);
    script += log_tics('x', x.low, x.high) + log_tics('y', low, high);
    std::string plot = fmt::format("plot {} with lines lw 1.6 lc rgb '{}'", gnuplot.data(rows), kPurple);
    if (const auto contacts = find_column(series, "mean_contacts")) {
        const Columns contact_rows = positive_rows(*time, *contacts);
        const Extent z = extent_of(contact_rows[1]);
        const double margin = std::max(0.1, 0.3 * (z.high - z.low));
        script += fmt::format(
            "set y2label 'contacts per bubble ⟨{{/:Italic Z}}⟩' tc rgb '{}'\nset y2tics\n"
            "set y2range [{:.9g}:{:.9g}]\n",
            kGreen, z.low - margin, z.high + margin);
        plot += fmt::format(", {} axes x1y2 with lines lw 1.2 lc rgb '{}'", gnuplot.data(contact_rows), kGreen);
    }
    return Panel{"bubbles", script + plot + "\n"};
}

std::optional<Panel> size_panel(Gnuplot& gnuplot, const std::vector<sim::Frame>& frames) {
    std::vector<std::string> data;
    std::vector<double> times;
    for (const sim::Frame& frame : frames) {
        const std::vector<double>& radii = frame.points.radius;
        if (radii.empty()) continue;
        // Few bubbles need wide bins: relative noise of a bin is about 1 / sqrt(N times its share).
        const double width = std::clamp(1.6 / std::cbrt(static_cast<double>(radii.size())), 0.05, 0.4);
        const measure::Histogram histogram = measure::relative_size_histogram(radii, width);
        Columns curve{{0.0}, {0.0}};
        for (std::size_t bin = 0; bin < histogram.density.size(); ++bin) {
            curve[0].push_back(histogram.center(bin));
            curve[1].push_back(histogram.density[bin]);
        }
        curve[0].push_back(histogram.center(histogram.density.size()));
        curve[1].push_back(0.0);
        data.push_back(gnuplot.data(curve));
        times.push_back(frame.time);
    }
    if (data.empty()) return std::nullopt;
    std::string script = panel_style();
    script += "set xlabel 'relative size {/:Italic R} / ⟨{/:Italic R}⟩'\nset ylabel 'probability density'\n";
    script += "set xrange [0:*]\nset yrange [0:*]\nset key top right\n" + curves_by_time(data, times);
    return Panel{"sizes", script};
}

std::optional<Panel> homogeneity_panel(Gnuplot& gnuplot, const std::vector<sim::Frame>& frames) {
    std::vector<std::vector<double>> deviations;  // of every cell, per frame
    std::vector<double> times;
    double largest = 0.0;
    for (const sim::Frame& frame : frames) {
        if (!frame.box || frame.points.radius.empty()) continue;
        std::vector<double> local = measure::local_gas_fraction(frame.points, *frame.box, measure::kGasFractionCells);
        const auto global = measure::find_value(measure::measure_frame(frame), "gas_fraction");
        for (double& value : local) largest = std::max(largest, value = std::abs(value - *global));
        deviations.push_back(std::move(local));
        times.push_back(frame.time);
    }
    if (!(largest > 0.0)) return std::nullopt;

    constexpr double kBins = 16.0;
    const double width = largest / kBins;
    std::vector<std::string> data;
    for (const std::vector<double>& cells : deviations) {
        Columns curve(2, std::vector<double>(static_cast<std::size_t>(kBins) + 2, 0.0));
        for (std::size_t bin = 0; bin < curve[0].size(); ++bin)
            curve[0][bin] = width * (static_cast<double>(bin) + 0.5);
        for (const double value : cells)
            curve[1][static_cast<std::size_t>(value / width)] += 1.0 / static_cast<double>(cells.size());
        data.push_back(gnuplot.data(curve));
    }
    std::string script = panel_style();
    script += "set xlabel '|local − global gas fraction|'\nset ylabel 'share of the cells'\n";
    script += "set xrange [0:*]\nset yrange [0:*]\nset key top right\n" + curves_by_time(data, times);
    return Panel{"gas_fraction", script};
}

std::vector<Panel> series_panels(Gnuplot& gnuplot, const io::CsvTable& series) {
    std::vector<Panel> panels;
    const auto time = find_column(series, "time");
    if (!time) return panels;
    for (std::size_t column = 0; column < series.header.size(); ++column) {
        const std::string& header = series.header[column];
        if (header.starts_with("time[")) continue;
        std::vector<double> values;
        bool any = false;
        for (const auto& row : series.rows) {
            values.push_back(row[column]);
            any = any || std::isfinite(values.back());
        }
        if (!any) continue;
        const std::string name = header.substr(0, header.find('['));
        std::string label = header;
        std::replace(label.begin(), label.end(), '_', ' ');
        if (label.ends_with("[-]")) label.resize(label.size() - 3);
        const std::string time_label = series.header[static_cast<std::size_t>(series.column("time"))];
        std::string script = panel_style() + "unset key\n";
        script += fmt::format("set xlabel {} noenhanced\nset title {} noenhanced\n",
                              gnuplot_text(time_label.ends_with("[-]") ? "time" : time_label), gnuplot_text(label));
        script += fmt::format("plot {} with lines lw 1.2 lc rgb '{}'\n", gnuplot.data({*time, values}), kPurple);
        panels.push_back({name, script});
    }
    return panels;
}

}  // namespace lamella::app
