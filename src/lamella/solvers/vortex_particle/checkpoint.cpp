// What a run of the flow in a film is continued from.

#include "lamella/core/error.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

#include <fmt/format.h>

#include <type_traits>

namespace lamella::vortex_particle {
namespace {

std::vector<double> flat(const std::vector<Vec3>& column) {
    std::vector<double> values;
    for (const Vec3& x : column) values.insert(values.end(), x.v, x.v + 3);
    return values;
}

void read_vectors(sim::StateReader& in, const std::string& name, std::size_t count, std::vector<Vec3>& column) {
    std::vector<double> values;
    in.read(name, 3 * count, values);
    column.resize(count);
    for (std::size_t i = 0; i < count; ++i) column[i] = {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}};
}

void write_column(sim::StateWriter& out, const std::string& name, const std::vector<double>& column) {
    out.write(name, std::span<const double>(column));
}
void write_column(sim::StateWriter& out, const std::string& name, const std::vector<Vec3>& column) {
    out.write(name, std::span<const double>(flat(column)));
}
void write_column(sim::StateWriter& out, const std::string& name, const std::vector<std::array<double, 3>>& column) {
    std::vector<double> values;
    for (const auto& b : column) values.insert(values.end(), b.begin(), b.end());
    out.write(name, std::span<const double>(values));
}
void write_column(sim::StateWriter& out, const std::string& name, const std::vector<std::uint32_t>& column) {
    const std::vector<std::int32_t> values(column.begin(), column.end());
    out.write(name, std::span<const std::int32_t>(values));
}

void read_column(sim::StateReader& in, const std::string& name, std::size_t count, std::vector<double>& column) {
    in.read(name, count, column);
}
void read_column(sim::StateReader& in, const std::string& name, std::size_t count, std::vector<Vec3>& column) {
    read_vectors(in, name, count, column);
}
void read_column(sim::StateReader& in,
                 const std::string& name,
                 std::size_t count,
                 std::vector<std::array<double, 3>>& column) {
    std::vector<double> values;
    in.read(name, 3 * count, values);
    column.resize(count);
    for (std::size_t i = 0; i < count; ++i) column[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}
void read_column(sim::StateReader& in, const std::string& name, std::size_t count, std::vector<std::uint32_t>& column) {
    std::vector<std::int32_t> values;
    in.read(name, count, values);
    column.assign(values.begin(), values.end());
}

/// The vectors of a solid that change.
template <class Bodies, class Use>
void each_vector(Bodies& bodies, Use&& use) {
    for (auto& body : bodies)
        for (auto* vector : {&body.center, &body.velocity, &body.spin, &body.force, &body.torque}) use(*vector);
}
constexpr std::size_t kBodyNumbers = 15;

std::vector<double> state_of(const std::vector<Body>& bodies) {
    std::vector<double> values;
    each_vector(bodies, [&](const Vec3& x) { values.insert(values.end(), x.v, x.v + 3); });
    return values;
}
void restore(const std::vector<double>& values, std::vector<Body>& bodies) {
    std::size_t next = 0;
    each_vector(bodies, [&](Vec3& x) {
        for (std::size_t k = 0; k < 3; ++k) x[k] = values[next++];
    });
}

}  // namespace

void VortexParticleSolver::save(sim::StateWriter& out) const {
    if (moving_) save_moving(out);
    out.write_value("vertices", static_cast<std::int64_t>(surface_.vertices()));
    out.write_value("triangles", static_cast<std::int64_t>(surface_.triangles()));
    out.write_value("particles", static_cast<std::int64_t>(particles_.size()));
    Particles::for_each_column(particles_, [&](const char* name, const auto& column) {
        write_column(out, fmt::format("particle/{}", name), column);
    });
    write_column(out, "hole_circulation", hole_circulation_);
    write_column(out, "velocity", velocity_);
    out.write_value("time", time_);
    out.write_value("steps", steps_);
    out.write_value("step", step_);
    out.write_value("fastest_dilatation", fastest_dilatation_);
    write_column(out, "solids", state_of(bodies_));
    out.write_value("end", static_cast<std::int64_t>(end_));
    out.write_value("liquid_in", liquid_in_);
    out.write_value("liquid_out", liquid_out_);
    out.write_value("iterations", iterations_);
    out.write_value("reference/step", reference_.step);
    out.write_value("reference/vertices", static_cast<std::int64_t>(reference_.thickness.size()));
    write_column(out, "reference/thickness", reference_.thickness);
    write_column(out, "reference/surfactant", reference_.surfactant);
}

void VortexParticleSolver::load(sim::StateReader& in) {
    if (options_.moving) load_moving(in);
    const auto expect = [&](const char* name, std::size_t mine) {
        if (in.read_integer(name) != static_cast<std::int64_t>(mine))
            throw InputError(fmt::format("the checkpoint's {} are not those of this scene's film", name));
    };
    expect("vertices", surface_.vertices());
    expect("triangles", surface_.triangles());
    const std::int64_t count = in.read_integer("particles");
    constexpr std::int64_t kMost = 2'000'000'000;
    if (count < 0 || count > kMost) throw InputError(fmt::format("particles = {} is no number of particles", count));
    Particles::for_each_column(particles_, [&](const char* name, auto& column) {
        read_column(in, fmt::format("particle/{}", name), static_cast<std::size_t>(count), column);
    });
    for (const std::uint32_t t : particles_.triangle)
        if (t >= surface_.triangles())
            throw InputError(fmt::format("a particle is in triangle {}, which does not exist", t));
    bins_ = sort_by_triangle(particles_, surface_.triangles());
    read_column(in, "hole_circulation", surface_.loops.size(), hole_circulation_);
    read_column(in, "velocity", surface_.triangles(), velocity_);
    time_ = in.read_double("time");
    steps_ = in.read_integer("steps");
    step_ = in.read_double("step");
    film::move_bodies(input_.films->solids, time_, 0.0, bodies_);
    fastest_dilatation_ = in.read_double("fastest_dilatation");
    std::vector<double> solids;
    read_column(in, "solids", kBodyNumbers * bodies_.size(), solids);
    restore(solids, bodies_);
    const std::int64_t end = in.read_integer("end");
    if (end < 0 || end > static_cast<std::int64_t>(End::kNoFilm))
        throw InputError(fmt::format("end = {} is no reason to end", end));
    end_ = static_cast<End>(end);
    liquid_in_ = in.read_double("liquid_in");
    liquid_out_ = in.read_double("liquid_out");
    iterations_ = in.read_integer("iterations");
    reference_.step = in.read_double("reference/step");
    const std::int64_t known = in.read_integer("reference/vertices");
    if (known != 0 && known != static_cast<std::int64_t>(surface_.vertices()))
        throw InputError(fmt::format("reference/vertices = {} does not fit the film", known));
    read_column(in, "reference/thickness", static_cast<std::size_t>(known), reference_.thickness);
    read_column(in, "reference/surfactant", static_cast<std::size_t>(known), reference_.surfactant);
    if (known != 0 && reference_.step > 0.0) factor_reference();
    observed_.reset();
}

}  // namespace lamella::vortex_particle
