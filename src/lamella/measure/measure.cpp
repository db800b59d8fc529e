#include "lamella/measure/measure.h"

#include "lamella/core/error.h"
#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/dist/agree.h"
#include "lamella/dist/sum.h"
#include "lamella/measure/film_measures.h"
#include "lamella/measure/local_gas_fraction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

/// The balls of all processes, of which a share is here.
class Balls {
public:
    Balls(const Frame& share, dist::Communicator& processes)
        : share_(share),
          processes_(processes),
          count_(static_cast<double>(dist::sum(processes, static_cast<std::int64_t>(share.points.size())))) {}

    const Frame& share() const { return share_; }
    const sim::Points& points() const { return share_.points; }
    dist::Communicator& processes() const { return processes_; }
    double count() const { return count_; }
    int dimension() const { return share_.box ? share_.box->dimension : 3; }

    /// Largest term(i), at least 0; infinite where a term is not a number.
    template <class Term>
    double largest(Term&& term) const {
        constexpr double kInfinite = std::numeric_limits<double>::infinity();
        return dist::largest(processes_, parallel_max(points().size(), 0.0, [&](std::size_t i) {
                                 const double t = term(i);
                                 return std::isnan(t) ? kInfinite : t;
                             }));
    }
    /// Sum of term(i); not a number where a term is none, as in a damaged file.
    template <class Term>
    double sum(Term&& term) const {
        const double most = largest([&](std::size_t i) { return std::abs(term(i)); });
        const double bound = most * std::max(kMostTerms, count_);
        if (!std::isfinite(bound)) return std::numeric_limits<double>::quiet_NaN();
        FixedSum total = fixed_sum(points().size(), bound, term);
        dist::sum(processes_, std::span(&total, 1));
        return total.value();
    }
    template <class Term>
    double mean(Term&& term) const {
        return sum(term) / count_;
    }

private:
    const Frame& share_;
    dist::Communicator& processes_;
    double count_;
};

void measure_sizes(const Balls& balls, Report& report) {
    const std::vector<double>& radius = balls.points().radius;
    const std::string& unit = balls.points().length_unit;
    report.add("bubbles", "-", balls.count(), "bubbles present");
    if (const auto& box = balls.share().box) {
        const double volume = balls.sum([&](std::size_t i) { return ball_volume(radius[i], box->dimension); });
        report.add("gas_fraction", "-", volume / box_volume(*box), "volume of the balls / volume of the box");
    }
    report.add("mean_radius", unit, balls.mean([&](std::size_t i) { return radius[i]; }), "<R>");
    report.add("mean_square_radius", squared_unit(unit),
               balls.mean([&](std::size_t i) { return radius[i] * radius[i]; }), "<R^2>");
    report.add("max_radius", unit, balls.largest([&](std::size_t i) { return radius[i]; }), "largest R");
}

void measure_contacts(const Balls& balls, Report& report) {
    const Field* contacts = find_field(balls.points(), "contacts", 1);
    if (contacts == nullptr) return;
    report.add("mean_contacts", "-", balls.mean([&](std::size_t i) { return contacts->values[i]; }), "<Z>");
    const int fewest = balls.dimension() + 1;
    report.add("rattlers", "-", balls.mean([&](std::size_t i) { return contacts->values[i] < fewest ? 1.0 : 0.0; }),
               fmt::format("fraction of bubbles with fewer than {} contacts", fewest));
}

void measure_motion(const Balls& balls, Report& report) {
    if (const Field* velocity = find_field(balls.points(), "velocity", 3)) {
        Vec3 mean;
        for (std::size_t k = 0; k < 3; ++k)
            mean[k] = balls.mean([&](std::size_t i) { return velocity->values[3 * i + k]; });
        // Equal to <|v|^2> - |<v>|^2, but free of cancellation when all move together.
        report.add("velocity_variance", squared_unit(velocity->unit),
                   balls.mean([&](std::size_t i) { return squared_norm(vector_at(*velocity, i) - mean); }),
                   "<|v|^2> - |<v>|^2");
    }
    if (const Field* path = find_field(balls.points(), "path_length", 1))
        report.add("mean_path", path->unit, balls.mean([&](std::size_t i) { return path->values[i]; }),
                   "mean length of the paths travelled");
    if (const Field* displacement = find_field(balls.points(), "displacement", 3))
        report.add("mean_square_displacement", squared_unit(displacement->unit),
                   balls.mean([&](std::size_t i) { return squared_norm(vector_at(*displacement, i)); }),
                   "<|displacement from the start|^2>");
}

void measure_homogeneity(const Balls& balls, Report& report) {
    if (!balls.share().box) return;
    const std::vector<double> local =
        local_gas_fraction(balls.points(), *balls.share().box, kGasFractionCells, balls.processes());
    const auto cells = static_cast<double>(local.size());
    double mean = 0.0;
    for (const double value : local) mean += value / cells;
    double variance = 0.0;
    for (const double value : local) variance += (value - mean) * (value - mean) / cells;
    report.add("gas_fraction_spread", "-", std::sqrt(variance),
               "standard deviation of the local gas fraction over 10 cells per axis");
}

/// Refuses what does not fit together.
void check(const sim::Points& points) {
    if (points.radius.size() != points.size() && !points.radius.empty())
        throw InputError(fmt::format("{} radii for {} points", points.radius.size(), points.size()));
    for (const auto& [name, components] :
         {std::pair("contacts", 1), {"velocity", 3}, {"path_length", 1}, {"displacement", 3}})
        find_field(points, name, components);
}

}  // namespace

std::vector<Scalar> measure_frame(const Frame& frame) {
    dist::Alone alone;
    return measure_frame(frame, alone);
}

std::vector<Scalar> measure_frame(const Frame& share, dist::Communicator& processes) {
    Report report;
    if (const auto films = film_measures(share))
        for (Scalar& scalar : film_scalars(*films)) report.add(std::move(scalar));
    const sim::Points& points = share.points;
    dist::together(processes, [&] { check(points); });
    if (dist::sum(processes, static_cast<std::int64_t>(points.radius.size())) == 0) return report.take();
    const Balls balls(share, processes);
    measure_sizes(balls, report);
    measure_contacts(balls, report);
    measure_motion(balls, report);
    measure_homogeneity(balls, report);
    return report.take();
}

std::optional<double> find_value(const std::vector<Scalar>& scalars, std::string_view name) {
    const auto it = std::find_if(scalars.begin(), scalars.end(), [&](const Scalar& s) { return s.name == name; });
    return it == scalars.end() ? std::nullopt : std::optional(it->value);
}

}  // namespace lamella::measure
