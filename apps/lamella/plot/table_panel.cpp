#include "table_panel.h"

#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace lamella::app {
namespace {

std::optional<double> number(const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

/// The columns behind "task" that the sweep set: dotted keys of scenes, and the seed.
std::vector<std::size_t> key_columns(const io::CsvTextTable& table) {
    std::vector<std::size_t> keys;
    for (std::size_t k = 1; k < table.header.size(); ++k) {
        if (table.header[k].find('.') == std::string::npos && table.header[k] != "seed") break;
        keys.push_back(k);
    }
    return keys;
}

std::size_t find_column(const io::CsvTextTable& table, const std::string& name) {
    for (std::size_t k = 0; k < table.header.size(); ++k)
        if (table.header[k] == name || table.header[k].starts_with(name + "[")) return k;
    std::vector<std::string> names;  // without units
    for (const std::string& column : table.header) names.push_back(column.substr(0, column.find('[')));
    const auto near = nearest_word(name, names);
    throw InputError(fmt::format("the table has no column {}{}; it has {}", name.empty() ? "for --y yet" : name,
                                 near ? fmt::format("; did you mean {}?", *near) : "", fmt::join(names, ", ")));
}

/// Time where some task has more than one row, else the first key with numbers.
std::size_t default_x(const io::CsvTextTable& table, const std::vector<std::size_t>& keys) {
    std::set<std::string> tasks;
    for (const auto& row : table.rows) tasks.insert(row[0]);
    if (tasks.size() < table.rows.size()) {
        for (const char* time : {"scaled_time", "time"})
            for (std::size_t k = 0; k < table.header.size(); ++k)
                if (table.header[k] == time || table.header[k].starts_with(std::string(time) + "[")) return k;
    }
    for (const std::size_t k : keys)
        if (table.header[k] != "seed" && !table.rows.empty() && number(table.rows[0][k])) return k;
    throw InputError("no key of the table has numbers; say what to draw along with --x");
}

/// A column's name, with its unit where it has one.
std::string label_of(const std::string& column) {
    return column.ends_with("[-]") ? column.substr(0, column.size() - 3) : column;
}

struct Spread {
    double sum = 0.0, least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
    int count = 0;

    void include(double value) {
        sum += value;
        least = std::min(least, value);
        most = std::max(most, value);
        ++count;
    }
};

struct Point {
    std::string task;
    double x, y;
};

/// The points of the tasks that agree in all keys but the seed and what is drawn along.
struct Curve {
    std::string name;
    std::vector<Point> points;
};

std::string curve_name(const io::CsvTextTable& table,
                       const std::vector<std::size_t>& keys,
                       std::size_t x,
                       const std::vector<std::string>& row) {
    std::string name;
    for (const std::size_t k : keys)
        if (k != x && table.header[k] != "seed")
            name += fmt::format("{}{} {}", name.empty() ? "" : ", ",
                                table.header[k].substr(table.header[k].rfind('.') + 1), row[k]);
    return name;
}

std::vector<Curve> curves_of(const io::CsvTextTable& table,
                             const std::vector<std::size_t>& keys,
                             std::size_t x,
                             std::size_t y) {
    std::vector<Curve> curves;
    for (const auto& row : table.rows) {
        const auto place = number(row[x]), value = number(row[y]);
        if (!place || !value)
            throw InputError(fmt::format("{} or {} is not a number in some row", table.header[x], table.header[y]));
        if (!std::isfinite(*place) || !std::isfinite(*value)) continue;
        const std::string name = curve_name(table, keys, x, row);
        auto curve = std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.name == name; });
        if (curve == curves.end()) curve = curves.insert(curves.end(), {name, {}});
        curve->points.push_back({row[0], *place, *value});
    }
    return curves;
}

/// One row per place: mean, least, largest of the tasks there.
Columns averaged(const std::vector<Point>& points) {
    std::map<double, Spread> at;
    for (const Point& point : points) at[point.x].include(point.y);
    Columns columns(4);
    for (const auto& [place, values] : at) {
        columns[0].push_back(place);
        columns[1].push_back(values.sum / values.count);
        columns[2].push_back(values.least);
        columns[3].push_back(values.most);
    }
    return columns;
}

/// The rows of each task, a gap between tasks.
Columns one_by_one(const std::vector<Point>& points) {
    Columns columns(2);
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (i > 0 && points[i].task != points[i - 1].task)
            for (auto& column : columns) column.push_back(std::numeric_limits<double>::quiet_NaN());
        columns[0].push_back(points[i].x);
        columns[1].push_back(points[i].y);
    }
    return columns;
}

std::string axis(char name, bool logarithmic, const std::vector<Curve>& curves, double Point::*value) {
    if (!logarithmic)
        return fmt::format("set autoscale {}\nset offsets graph 0.02, graph 0.02, graph 0.05, graph 0.05\n", name);
    double low = std::numeric_limits<double>::infinity(), high = 0.0;
    for (const Curve& curve : curves)
        for (const Point& point : curve.points)
            if (point.*value > 0.0) low = std::min(low, point.*value), high = std::max(high, point.*value);
    if (!(high > 0.0)) throw InputError("a logarithmic axis needs positive numbers");
    return fmt::format("set logscale {0}\nset {0}range [{1:.6g}:{2:.6g}]\n", name, 0.95 * low, 1.05 * high) +
           log_tics(name, 0.95 * low, 1.05 * high);
}

}  // namespace

Panel table_panel(Gnuplot& gnuplot, const io::CsvTextTable& table, const TablePlot& plot) {
    const std::vector<std::size_t> keys = key_columns(table);
    const std::size_t y = find_column(table, plot.y);
    const std::size_t x = plot.x.empty() ? default_x(table, keys) : find_column(table, plot.x);
    const std::vector<Curve> curves = curves_of(table, keys, x, y);
    if (curves.empty())
        throw InputError(
            fmt::format("the table has no row with numbers in {} and {}", table.header[x], table.header[y]));
    const bool along_key = std::find(keys.begin(), keys.end(), x) != keys.end();
    std::string script = panel_style();
    script += fmt::format("set xlabel {} noenhanced\nset ylabel {} noenhanced\n",
                          gnuplot_text(label_of(table.header[x])), gnuplot_text(label_of(table.header[y])));
    script += axis('x', plot.log_x, curves, &Point::x) + axis('y', plot.log_y, curves, &Point::y);
    script +=
        curves.size() > 1 ? "set key outside right top Left reverse samplen 1 noenhanced\nplot " : "unset key\nplot ";
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const double share = curves.size() > 1 ? static_cast<double>(c) / static_cast<double>(curves.size() - 1) : 0.3;
        const std::string color = color_text(map_color(0.9 * share));
        const std::string data = gnuplot.data(along_key ? averaged(curves[c].points) : one_by_one(curves[c].points));
        if (c > 0) script += ", ";
        if (along_key)
            script +=
                fmt::format("{} using 1:2:3:4 with yerrorbars lw 1 pt 7 ps 0.7 lc rgb '{}' notitle, ", data, color);
        script += fmt::format("{} using 1:2 with lines lw 1.4 lc rgb '{}' title {}", data, color,
                              gnuplot_text(curves[c].name));
    }
    return {"table", script + "\n", curves.size() > 1 ? 1.6 : 1.25};
}

}  // namespace lamella::app
