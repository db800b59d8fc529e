#include "lamella/run/series.h"

#include "lamella/core/error.h"
#include "lamella/measure/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::run {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Everything one row may hold, under its name; a measure that the solver itself reports is not repeated.
std::vector<sim::Scalar> row_values(const sim::Frame& frame, const std::vector<sim::Scalar>& measured) {
    std::vector<sim::Scalar> values{{"time", frame.time_unit, frame.time}};
    values.insert(values.end(), frame.scalars.begin(), frame.scalars.end());
    for (const sim::Scalar& value : measured)
        if (!measure::find_value(values, value.name)) values.push_back(value);
    return values;
}

std::string without_unit(const std::string& column) { return column.substr(0, column.find('[')); }

std::vector<double> column_values(const io::CsvTable& table, const std::string& name) {
    const int column = table.column(name);
    std::vector<double> values;
    if (column < 0) return values;
    for (const auto& row : table.rows) values.push_back(row[static_cast<std::size_t>(column)]);
    return values;
}

}  // namespace

double local_exponent(std::span<const double> times, std::span<const double> values) {
    if (times.empty()) return kNan;
    constexpr std::size_t kFewest = 4;
    const auto begin = std::lower_bound(times.begin(), times.end(), 0.5 * times.back());
    const auto first = static_cast<std::size_t>(begin - times.begin());
    const std::size_t count = times.size() - first;
    if (count < kFewest || !(times[first] > 0.0)) return kNan;

    double mean_x = 0.0;
    double mean_y = 0.0;
    for (std::size_t i = first; i < times.size(); ++i) {
        if (!(values[i] > 0.0)) return kNan;
        mean_x += std::log(times[i]) / static_cast<double>(count);
        mean_y += std::log(values[i]) / static_cast<double>(count);
    }
    double covariance = 0.0;
    double variance = 0.0;
    for (std::size_t i = first; i < times.size(); ++i) {
        const double dx = std::log(times[i]) - mean_x;
        covariance += dx * (std::log(values[i]) - mean_y);
        variance += dx * dx;
    }
    return variance > 0.0 ? covariance / variance : kNan;
}

Series::Series(std::filesystem::path path, std::uint64_t offset) : path_(std::move(path)) {
    if (offset == 0) return;
    file_.emplace(path_, offset);  // cuts off what came after the checkpoint
    const io::CsvTable table = io::read_csv(path_);
    for (const std::string& column : table.header) columns_.push_back(without_unit(column));
    if (columns_.empty() || columns_.front() != "time")
        throw InputError({path_.string()}, "is no series: its first column is not the time");
    times_ = column_values(table, "time");
    mean_radii_ = column_values(table, "mean_radius");
}

void Series::append(const sim::Frame& frame, const std::vector<sim::Scalar>& measured) {
    std::vector<sim::Scalar> values = row_values(frame, measured);
    if (const auto mean_radius = measure::find_value(values, "mean_radius")) {
        times_.push_back(frame.time);
        mean_radii_.push_back(*mean_radius);
        values.push_back({"exponent", "-", local_exponent(times_, mean_radii_)});
    }
    if (!file_) {
        std::vector<std::string> header;
        for (const sim::Scalar& value : values) {
            columns_.push_back(value.name);
            header.push_back(fmt::format("{}[{}]", value.name, value.unit));
        }
        file_.emplace(path_, header);
    }
    std::vector<double> row;
    for (const std::string& column : columns_) row.push_back(measure::find_value(values, column).value_or(kNan));
    file_->append(row);
}

std::uint64_t Series::sync() { return file_ ? file_->sync() : 0; }

}  // namespace lamella::run
