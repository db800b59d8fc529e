// What a run is continued from: the particles and the gas. All else follows from these.

#include "lamella/core/error.h"
#include "lamella/solvers/melp/melp_solver.h"
#include "lamella/solvers/melp/start.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace lamella::melp {
namespace {

constexpr std::int64_t kMostParticles = std::int64_t{1} << 31;

void append(std::vector<double>& to, double value) { to.push_back(value); }
void append(std::vector<double>& to, const Vec3& value) { to.insert(to.end(), value.v, value.v + 3); }
void append(std::vector<double>& to, const Tensor& value) {
    for (const Vec3& row : value) append(to, row);
}

void take(const double*& from, double& value) { value = *from++; }
void take(const double*& from, Vec3& value) {
    for (double& component : value.v) component = *from++;
}
void take(const double*& from, Tensor& value) {
    for (Vec3& row : value) take(from, row);
}

template <class Particles>
void save_columns(sim::StateWriter& out, const std::string& group, const Particles& particles) {
    out.write_value(group + "/count", static_cast<std::int64_t>(particles.size()));
    Particles::for_each_column(particles, [&]<class T>(const char* name, const std::vector<T>& column) {
        if constexpr (std::is_same_v<T, std::int32_t>) {
            out.write(group + "/" + name, std::span<const std::int32_t>(column));
        } else {
            std::vector<double> values;
            values.reserve(column.size() * sizeof(T) / sizeof(double));
            for (const T& value : column) append(values, value);
            out.write(group + "/" + name, std::span<const double>(values));
        }
    });
}

template <class Particles>
Particles load_columns(sim::StateReader& in, const std::string& group) {
    const std::int64_t stored = in.read_integer(group + "/count");
    if (stored < 0 || stored > kMostParticles)
        throw InputError(fmt::format("{}/count = {} is no number of particles", group, stored));
    const auto count = static_cast<std::size_t>(stored);
    Particles particles;
    Particles::for_each_column(particles, [&]<class T>(const char* name, std::vector<T>& column) {
        if constexpr (std::is_same_v<T, std::int32_t>) {
            in.read(group + "/" + name, count, column);
        } else {
            std::vector<double> values;
            in.read(group + "/" + name, count * sizeof(T) / sizeof(double), values);
            column.resize(count);
            const double* from = values.data();
            for (T& value : column) take(from, value);
        }
    });
    return particles;
}

void require_regions(const std::vector<std::int32_t>& region, std::size_t regions, const char* group) {
    for (const std::int32_t r : region)
        if (r < 0 || static_cast<std::size_t>(r) >= regions)
            throw InputError(fmt::format("{}/region = {} is none of {} regions", group, r, regions));
}

}  // namespace

void MelpSolver::save(sim::StateWriter& out) const {
    save_columns(out, "coarse", coarse_);
    save_columns(out, "fine", fine_);
    out.write_value("regions", static_cast<std::int64_t>(gas_.size()));
    std::vector<std::int32_t> number, kind;
    std::vector<double> gas, even;
    for (const Gas& g : gas_) {
        number.push_back(g.region);
        gas.insert(gas.end(), {g.amount, g.volume, g.calibration, g.film_radius, g.balanced, g.cell});
        kind.insert(kind.end(), {g.closed ? 1 : 0, g.held ? 1 : 0, g.burst ? 1 : 0, g.gone ? 1 : 0});
    }
    for (const EvenFilm& film : even_) even.insert(even.end(), {film.liquid_volume, film.surfactant});
    out.write("region/number", std::span<const std::int32_t>(number));
    out.write("region/kind", std::span<const std::int32_t>(kind));
    out.write("region/gas", std::span<const double>(gas));
    out.write("region/even_film", std::span<const double>(even));
    out.write_value("spacing", spacing_);
    out.write_value("time", time_);
    out.write_value("steps", steps_);
    out.write_value("step", step_);
    out.write_value("initial_liquid", initial_liquid_);
    out.write_value("left_liquid", left_liquid_);
    out.write_value("next_event", static_cast<std::int64_t>(next_event_));
    std::vector<double> solids;
    for (const film::Body& body : bodies_)
        for (const Vec3& x : {body.center, body.velocity, body.force}) append(solids, x);
    out.write("solids", std::span<const double>(solids));
    const std::vector<std::int32_t> released(released_.begin(), released_.end());
    out.write("released", std::span<const std::int32_t>(released));
    std::vector<std::int32_t> touching;
    std::vector<double> since;
    for (const Contact& pair : contacts_.pairs()) {
        touching.insert(touching.end(), {pair.a, pair.b});
        since.push_back(pair.since);
    }
    out.write_value("contacts", static_cast<std::int64_t>(since.size()));
    out.write("contact/regions", std::span<const std::int32_t>(touching));
    out.write("contact/since", std::span<const double>(since));
}

void MelpSolver::load(sim::StateReader& in) {
    coarse_ = load_columns<CoarseParticles>(in, "coarse");
    fine_ = load_columns<FineParticles>(in, "fine");
    const std::int64_t stored = in.read_integer("regions");
    if (stored < 0 || stored > static_cast<std::int64_t>(input_.films->mesh.regions.size()))
        throw InputError(fmt::format("regions = {} is no number of regions of this scene", stored));
    const auto regions = static_cast<std::size_t>(stored);
    require_regions(coarse_.region, regions, "coarse");
    require_regions(fine_.region, regions, "fine");
    std::vector<std::int32_t> number, kind;
    std::vector<double> gas, even;
    in.read("region/number", regions, number);
    in.read("region/kind", 4 * regions, kind);
    in.read("region/gas", 6 * regions, gas);
    in.read("region/even_film", 2 * regions, even);
    gas_.assign(regions, {});
    even_.assign(regions, {});
    for (std::size_t r = 0; r < regions; ++r) {
        gas_[r] = {.region = number[r],
                   .amount = gas[6 * r],
                   .volume = gas[6 * r + 1],
                   .calibration = gas[6 * r + 2],
                   .balanced = gas[6 * r + 4],
                   .closed = kind[4 * r] != 0,
                   .held = kind[4 * r + 1] != 0,
                   .burst = kind[4 * r + 2] != 0,
                   .gone = kind[4 * r + 3] != 0,
                   .cell = gas[6 * r + 5],
                   .film_radius = gas[6 * r + 3]};
        even_[r] = {even[2 * r], even[2 * r + 1], gas_[r].held};
    }
    spacing_ = in.read_double("spacing");
    if (!(spacing_ > 0.0)) throw InputError(fmt::format("spacing = {} m is no distance of particles", spacing_));
    time_ = in.read_double("time");
    steps_ = in.read_integer("steps");
    step_ = in.read_double("step");
    initial_liquid_ = in.read_double("initial_liquid");
    const std::int64_t next = in.read_integer("next_event");
    if (next < 0 || next > static_cast<std::int64_t>(input_.films->events.size()))
        throw InputError(fmt::format("next_event = {} is none of {} events", next, input_.films->events.size()));
    next_event_ = static_cast<std::size_t>(next);
    left_liquid_ = in.read_double("left_liquid");
    std::vector<std::int32_t> released;
    in.read("released", input_.films->releases.size(), released);
    released_.assign(released.begin(), released.end());
    load_contacts(in);
    load_solids(in);
    rims_ = start_rims(*input_.films, options_);
    set_rims(time_);
    update_shape();
    follow_contacts(time_);
    update_liquid();
}

void MelpSolver::load_solids(sim::StateReader& in) {
    bodies_ = film::bodies_at_start(input_.films->solids);
    film::move_bodies(input_.films->solids, time_, 0.0, bodies_);
    std::vector<double> solids;
    in.read("solids", 9 * bodies_.size(), solids);
    const double* from = solids.data();
    for (film::Body& body : bodies_)
        for (Vec3* x : {&body.center, &body.velocity, &body.force}) take(from, *x);
}

void MelpSolver::load_contacts(sim::StateReader& in) {
    const std::int64_t stored = in.read_integer("contacts");
    const auto regions = static_cast<std::int64_t>(gas_.size());
    if (stored < 0 || stored > regions * regions)
        throw InputError(fmt::format("contacts = {} is no number of pairs of {} regions", stored, regions));
    const auto count = static_cast<std::size_t>(stored);
    std::vector<std::int32_t> touching;
    std::vector<double> since;
    in.read("contact/regions", 2 * count, touching);
    in.read("contact/since", count, since);
    require_regions(touching, gas_.size(), "contact");
    std::vector<Contact> pairs;
    for (std::size_t k = 0; k < count; ++k) pairs.push_back({touching[2 * k], touching[2 * k + 1], since[k]});
    contacts_.set_pairs(std::move(pairs));
}

}  // namespace lamella::melp
