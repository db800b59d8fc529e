#include "lamella/sweep/collect.h"

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace lamella::sweep {
namespace {

double number(const std::string& text, const std::string& all) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
        throw InputError(fmt::format("--at {}: \"{}\" is no number; write --at scaled_time=10,20", all, text));
    return value;
}

/// The first row pair of a column between which `value` lies, as index of the second and the share of the way to it.
std::optional<std::pair<std::size_t, double>> crossing(const io::CsvTable& series, std::size_t column, double value) {
    for (std::size_t i = 0; i < series.rows.size(); ++i) {
        const double here = series.rows[i][column];
        if (here == value) return {{i, 1.0}};
        if (i == 0) continue;
        const double before = series.rows[i - 1][column];
        if ((before < value) == (here > value) && before != here) return {{i, (value - before) / (here - before)}};
    }
    return std::nullopt;
}

/// The rows of one series that are wanted.
std::vector<std::vector<double>> chosen_rows(const io::CsvTable& series,
                                             const CollectOptions& options,
                                             std::string& missing) {
    if (options.series || series.rows.empty()) return series.rows;
    if (!options.at) return {series.rows.back()};
    std::vector<std::vector<double>> rows;
    const int column = series.column(options.at->column);
    for (const double value : options.at->values) {
        const auto found = column < 0 ? std::nullopt : crossing(series, static_cast<std::size_t>(column), value);
        if (!found) {
            missing += fmt::format("{}{} = {}", missing.empty() ? "" : ", ", options.at->column, value);
            continue;
        }
        const auto [i, share] = *found;
        std::vector<double> row = series.rows[i];
        if (share < 1.0)
            for (std::size_t k = 0; k < row.size(); ++k) row[k] = std::lerp(series.rows[i - 1][k], row[k], share);
        rows.push_back(std::move(row));
    }
    return rows;
}

/// Places of a series' columns in the table, which gets the ones that it lacks.
std::vector<std::size_t> places(std::vector<std::string>& columns, const std::vector<std::string>& header) {
    std::vector<std::size_t> at;
    for (const std::string& name : header) {
        const auto found = std::find(columns.begin(), columns.end(), name);
        at.push_back(static_cast<std::size_t>(found - columns.begin()));
        if (found == columns.end()) columns.push_back(name);
    }
    return at;
}

struct Row {
    std::size_t task;
    std::vector<std::size_t> places;
    std::vector<double> values;
};

std::vector<std::string> text_of(const SweepFolder& folder, const Row& row, std::size_t columns) {
    std::vector<std::string> text{fmt::format("{}", row.task)};
    text.insert(text.end(), folder.values(row.task).begin(), folder.values(row.task).end());
    std::vector<double> values(columns, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < row.values.size(); ++k) values[row.places[k]] = row.values[k];
    for (const double value : values) text.push_back(io::shortest_text(value));
    return text;
}

}  // namespace

At parse_at(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError(fmt::format("--at {}: there is no '='; write --at scaled_time=10,20", text));
    At at{text.substr(0, equals), {}};
    for (std::size_t begin = equals + 1; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        at.values.push_back(number(text.substr(begin, end - begin), text));
        begin = end + 1;
    }
    return at;
}

Collected collect(const SweepFolder& folder, const CollectOptions& options) {
    Collected table;
    std::vector<std::string> columns;
    std::vector<Row> rows;
    bool column_seen = !options.at;
    for (std::size_t task = 0; task < folder.size(); ++task) {
        if (folder.state(task) != TaskState::kDone) continue;
        ++table.done;
        const io::CsvTable series = io::read_csv(folder.run(task) / "series.csv");
        column_seen = column_seen || series.column(options.at->column) >= 0;
        const std::vector<std::size_t> at = places(columns, series.header);
        std::string missing;
        for (auto& values : chosen_rows(series, options, missing)) rows.push_back({task, at, std::move(values)});
        if (!missing.empty()) table.remarks.push_back(fmt::format("task {} never reaches {}", task, missing));
    }
    if (!column_seen && table.done > 0)
        throw InputError(fmt::format("no series of this sweep has a column {}; they have {}", options.at->column,
                                     fmt::join(columns, ", ")));
    if (table.done < folder.size())
        table.remarks.push_back(
            fmt::format("{} of {} tasks are not done yet", folder.size() - table.done, folder.size()));
    table.header = {"task"};
    table.header.insert(table.header.end(), folder.keys().begin(), folder.keys().end());
    table.header.insert(table.header.end(), columns.begin(), columns.end());
    for (const Row& row : rows) table.rows.push_back(text_of(folder, row, columns.size()));
    return table;
}

}  // namespace lamella::sweep
