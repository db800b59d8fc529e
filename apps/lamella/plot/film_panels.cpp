#include "film_panels.h"

#include <fmt/format.h>

#include "frame_source.h"
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace lamella::app {
namespace {

/// What the panels share: the series and the axis along which it is drawn.
struct Axis {
    std::string label;
    std::vector<double> values;
};

std::optional<Axis> axis_of(const io::CsvTable& series) {
    const auto time = find_column(series, "time");
    if (!time || time->empty()) return std::nullopt;
    const auto [first, last] = std::minmax_element(time->begin(), time->end());
    const auto steps = find_column(series, "steps");
    if (*first == *last && steps) return Axis{"steps", *steps};
    return Axis{series.header[static_cast<std::size_t>(series.column("time"))], *time};
}

struct Curve {
    std::string title;
    std::vector<double> values;
};

/// The column as a curve, unless it holds no number.
void add_curve(std::vector<Curve>& curves, const io::CsvTable& series, const std::string& name, std::string title) {
    auto values = find_column(series, name);
    if (!values || std::none_of(values->begin(), values->end(), [](double v) { return std::isfinite(v); })) return;
    curves.push_back({std::move(title), std::move(*values)});
}

/// Every column "volume_3", "pressure_3" ... as a curve.
std::vector<Curve> bubble_curves(const io::CsvTable& series, const std::string& prefix) {
    std::vector<Curve> curves;
    for (const std::string& header : series.header) {
        const std::string name = header.substr(0, header.find('['));
        if (!name.starts_with(prefix)) continue;
        const std::string number = name.substr(prefix.size());
        if (number.find_first_not_of("0123456789") == std::string::npos) add_curve(curves, series, name, "bubble " + number);
    }
    return curves;
}

std::optional<Panel> panel(Gnuplot& gnuplot,
                           const Axis& axis,
                           const std::string& name,
                           const std::string& label,
                           const std::vector<Curve>& curves,
                           bool logarithmic = false) {
    if (curves.empty()) return std::nullopt;
    std::string script = panel_style();
    script += fmt::format("set xlabel {} noenhanced\nset ylabel {} noenhanced\nset key outside top center horizontal noenhanced\n",
                          gnuplot_text(axis.label), gnuplot_text(label));
    if (logarithmic) script += "set logscale y\nset format y '10^{%T}'\n";
    else script += "set autoscale xfix\nset offsets graph 0.03, graph 0.03, graph 0.08, graph 0.08\n";
    script += "plot ";
    for (std::size_t k = 0; k < curves.size(); ++k) {
        std::vector<double> x, y;
        for (std::size_t i = 0; i < axis.values.size(); ++i) {
            const double value = curves[k].values[i];
            if (!std::isfinite(value) || (logarithmic && !(value > 0.0))) continue;
            x.push_back(axis.values[i]);
            y.push_back(value);
        }
        if (x.empty()) x = y = {std::nan("")};
        const double place = curves.size() > 1 ? static_cast<double>(k) / static_cast<double>(curves.size() - 1) : 0.0;
        script += fmt::format("{}{} with linespoints pt 7 ps 0.6 lw 1.4 lc rgb '{}' title {}", k == 0 ? "" : ", ",
                              gnuplot.data({x, y}), color_text(map_color(0.9 * place)), gnuplot_text(curves[k].title));
    }
    return Panel{name, script + "\n"};
}

}  // namespace

std::vector<Panel> film_panels(Gnuplot& gnuplot, const io::CsvTable& series) {
    std::vector<Panel> panels;
    const auto axis = axis_of(series);
    if (!axis) return panels;
    const auto columns = [&](std::initializer_list<std::pair<const char*, const char*>> names) {
        std::vector<Curve> curves;
        for (const auto& [name, title] : names) add_curve(curves, series, name, title);
        return curves;
    };
    const auto add = [&](std::optional<Panel> fresh) {
        if (fresh) panels.push_back(std::move(*fresh));
    };
    add(panel(gnuplot, *axis, "area", "film area [m^2]",
              columns({{"total_area", "flat triangles"}, {"area", "curved triangles, at rest"}})));
    add(panel(gnuplot, *axis, "volumes", "volume [m^3]", bubble_curves(series, "volume_")));
    add(panel(gnuplot, *axis, "pressures", "pressure above the outside [Pa]", bubble_curves(series, "pressure_")));
    add(panel(gnuplot, *axis, "angles", "error of angles [deg]",
              columns({{"edge_angle_mean_error", "between films (120), mean"},
                       {"edge_angle_max_error", "largest"},
                       {"corner_angle_mean_error", "between lines (109.47), mean"},
                       {"corner_angle_max_error", "largest"}}),
              true));
    add(panel(gnuplot, *axis, "thickness", "thickness [m]",
              columns({{"thickness_min", "min"}, {"thickness_mean", "mean"}, {"thickness_max", "max"}})));
    add(panel(gnuplot, *axis, "accuracy", "relative error",
              columns({{"volume_error", "volumes"}, {"residual", "forces out of balance"}}), true));
    add(panel(gnuplot, *axis, "mesh", "triangles", columns({{"faces", "faces"}})));
    return panels;
}

}  // namespace lamella::app
