#include "lamella/measure/measure.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/measure/film_measures.h"
#include "lamella/measure/local_gas_fraction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::measure {
namespace {

using sim::Field;
using sim::Frame;
using sim::Scalar;

/// The field called `name` with `components`, or nullptr.
const Field* find_field(const sim::Points& points, std::string_view name, int components) {
    const Field* field = points.find(name);
    if (field == nullptr || field->components != components) return nullptr;
    if (field->values.size() != points.size() * static_cast<std::size_t>(components))
        throw InputError(
            fmt::format("field {} has {} values for {} points", name, field->values.size(), points.size()));
    return field;
}

Vec3 vector_at(const Field& field, std::size_t i) {
    return {{field.values[3 * i], field.values[3 * i + 1], field.values[3 * i + 2]}};
}

std::string squared_unit(const std::string& unit) { return unit == "-" ? "-" : unit + "^2"; }

/// One scalar per line, in the order in which they are reported.
class Report {
public:
    void add(std::string name, std::string unit, double value, std::string text) {
        scalars_.push_back({std::move(name), std::move(unit), value, std::move(text)});
    }
    void add(Scalar scalar) { scalars_.push_back(std::move(scalar)); }
    std::vector<Scalar> take() { return std::move(scalars_); }

private:
    std::vector<Scalar> scalars_;
};

void measure_sizes(const Frame& frame, Report& report) {
    const sim::Points& balls = frame.points;
    const std::vector<double>& radius = balls.radius;
    const auto count = static_cast<double>(balls.size());
    report.add("bubbles", "-", count, "bubbles present");
    if (frame.box) {
        const double volume =
            parallel_sum(radius.size(), [&](std::size_t i) { return ball_volume(radius[i], frame.box->dimension); });
        report.add("gas_fraction", "-", volume / box_volume(*frame.box), "volume of the balls / volume of the box");
    }
    report.add("mean_radius", balls.length_unit,
               parallel_sum(radius.size(), [&](std::size_t i) { return radius[i]; }) / count, "<R>");
    report.add("mean_square_radius", squared_unit(balls.length_unit),
               parallel_sum(radius.size(), [&](std::size_t i) { return radius[i] * radius[i]; }) / count, "<R^2>");
    report.add("max_radius", balls.length_unit,
               parallel_max(radius.size(), 0.0, [&](std::size_t i) { return radius[i]; }), "largest R");
}

void measure_contacts(const Frame& frame, Report& report) {
    const Field* contacts = find_field(frame.points, "contacts", 1);
    if (contacts == nullptr) return;
    const std::size_t size = frame.points.size();
    const auto count = static_cast<double>(size);
    report.add("mean_contacts", "-", parallel_sum(size, [&](std::size_t i) { return contacts->values[i]; }) / count,
               "<Z>");
    const int dimension = frame.box ? frame.box->dimension : 3;
    report.add(
        "rattlers", "-",
        parallel_sum(size, [&](std::size_t i) { return contacts->values[i] < dimension + 1 ? 1.0 : 0.0; }) / count,
        fmt::format("fraction of bubbles with fewer than {} contacts", dimension + 1));
}

void measure_motion(const Frame& frame, Report& report) {
    const sim::Points& balls = frame.points;
    const auto count = static_cast<double>(balls.size());
    if (const Field* velocity = find_field(balls, "velocity", 3)) {
        Vec3 mean;
        for (std::size_t k = 0; k < 3; ++k)
            mean[k] = parallel_sum(balls.size(), [&](std::size_t i) { return velocity->values[3 * i + k]; }) / count;
        // Equal to <|v|^2> - |<v>|^2, but free of cancellation when all move together.
        const double variance =
            parallel_sum(balls.size(), [&](std::size_t i) { return squared_norm(vector_at(*velocity, i) - mean); });
        report.add("velocity_variance", squared_unit(velocity->unit), variance / count, "<|v|^2> - |<v>|^2");
    }
    if (const Field* path = find_field(balls, "path_length", 1))
        report.add("mean_path", path->unit,
                   parallel_sum(balls.size(), [&](std::size_t i) { return path->values[i]; }) / count,
                   "mean length of the paths travelled");
    if (const Field* displacement = find_field(balls, "displacement", 3))
        report.add(
            "mean_square_displacement", squared_unit(displacement->unit),
            parallel_sum(balls.size(), [&](std::size_t i) { return squared_norm(vector_at(*displacement, i)); }) /
                count,
            "<|displacement from the start|^2>");
}

void measure_homogeneity(const Frame& frame, Report& report) {
    if (!frame.box) return;
    const std::vector<double> local = local_gas_fraction(frame.points, *frame.box, kGasFractionCells);
    const auto cells = static_cast<double>(local.size());
    double mean = 0.0;
    for (const double value : local) mean += value / cells;
    double variance = 0.0;
    for (const double value : local) variance += (value - mean) * (value - mean) / cells;
    report.add("gas_fraction_spread", "-", std::sqrt(variance),
               "standard deviation of the local gas fraction over 10 cells per axis");
}

}  // namespace

std::vector<Scalar> measure_frame(const Frame& frame) {
    Report report;
    if (const auto films = film_measures(frame))
        for (Scalar& scalar : film_scalars(*films)) report.add(std::move(scalar));
    const sim::Points& points = frame.points;
    if (points.empty() || points.radius.empty()) return report.take();
    if (points.radius.size() != points.size())
        throw InputError(fmt::format("{} radii for {} points", points.radius.size(), points.size()));
    measure_sizes(frame, report);
    measure_contacts(frame, report);
    measure_motion(frame, report);
    measure_homogeneity(frame, report);
    return report.take();
}

std::optional<double> find_value(const std::vector<Scalar>& scalars, std::string_view name) {
    const auto it = std::find_if(scalars.begin(), scalars.end(), [&](const Scalar& s) { return s.name == name; });
    return it == scalars.end() ? std::nullopt : std::optional(it->value);
}

}  // namespace lamella::measure
