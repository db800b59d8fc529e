// What can be seen of films that move, and what they are continued from.

#include "lamella/core/error.h"
#include "lamella/mesh/volume.h"
#include "lamella/sim/mesh_archive.h"
#include "lamella/solvers/vortex_particle/moving.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::vortex_particle {
namespace {

using mesh::RegionId;

std::vector<double> flat(const Vectors& column) {
    std::vector<double> values;
    for (const Vec3& x : column) values.insert(values.end(), x.v, x.v + 3);
    return values;
}

void read_vectors(sim::StateReader& in, const std::string& name, std::size_t count, Vectors& column) {
    std::vector<double> values;
    in.read(name, 3 * count, values);
    column.resize(count);
    for (std::size_t i = 0; i < count; ++i)
        column.values()[i] = {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}};
}

}  // namespace

void VortexParticleSolver::add_film_scalars(std::vector<sim::Scalar>& all) const {
    const Moving& m = *moving_;
    const film::Material& material = input_.films->material;
    double worst = 0.0;
    const IdVector<RegionId, double> volume = mesh::region_volumes(m.films);
    for (const RegionId r : m.films.regions.ids())
        if (m.films.regions[r].kind == mesh::RegionKind::kClosed)
            worst = std::max(worst, std::abs(volume[r] / m.films.regions[r].target_volume - 1.0));
    double fastest = 0.0;
    for (const Vec3& v : m.velocity) fastest = std::max(fastest, norm(v));
    const double motion = film_energy(), surface = material.film_tension() * film_area();
    for (sim::Scalar& scalar : all) {
        if (scalar.name == "energy_elastic" && options_.incompressible) scalar.value = 0.0;
    }
    double sum = motion + surface;
    for (const sim::Scalar& scalar : all)
        if (scalar.name == "energy_kinetic" || scalar.name == "energy_elastic" || scalar.name == "energy_gravity")
            sum += scalar.value;
    for (sim::Scalar& scalar : all)
        if (scalar.name == "energy") scalar.value = sum;
    all.push_back({"energy_motion", "J", motion, "kinetic, of films along their normals and of air that counts"});
    all.push_back({"energy_surface", "J", surface, "of the films' area at the tension of material.surface_tension"});
    all.push_back({"film_area", "m^2", film_area(), "of all films"});
    all.push_back({"volume_error", "-", worst, "largest of any bubble, relative"});
    all.push_back({"max_normal_velocity", "m/s", fastest, "of films along their normals"});
}

/// Adds the films' own motion to that of their liquid along them.
void VortexParticleSolver::add_film_motion(std::vector<Vec3>& velocity) const {
    if (!moving_) return;
    for (std::size_t v = 0; v < velocity.size(); ++v)
        velocity[v] += moving_->velocity.values()[v] + moving_->carry.values()[v];
}

/// [m^2]
double VortexParticleSolver::film_area() const {
    std::vector<double> area(films().faces.size(), 0.0);
    double sum = 0.0;
    for (std::size_t t = 0; t < surface_.triangles(); ++t) {
        if (area[surface_.film[t]] != 0.0) continue;  // a film that bounds two bubbles has two sides
        area[surface_.film[t]] = surface_.area[t];
        sum += surface_.area[t];
    }
    return sum;
}

void VortexParticleSolver::save_moving(sim::StateWriter& out) const {
    const Moving& m = *moving_;
    sim::save_mesh(out, "mesh", m.films);
    const auto write = [&](const char* name, const std::vector<double>& values) {
        out.write(name, std::span<const double>(values));
    };
    write("film/velocity", flat(m.velocity));
    write("film/carry", flat(m.carry));
    write("film/looked_at", flat(m.looked_at));
    write("film/pressure", m.pressure);
    out.write_value("film/next_event", static_cast<std::int64_t>(m.next_event));
    out.write_value("film/reference/step", m.reference.step);
    out.write_value("film/reference/stale", static_cast<std::int64_t>(m.reference.stale ? 1 : 0));
    write("film/reference/position", flat(m.reference.position));
    write("film/reference/thickness", m.reference.thickness);
    write("film/reference/surfactant", m.reference.surfactant);
    write("film/reference/mass", m.reference.mass);
    write("film/reference/tension", m.reference.tension);
}

/// The equations are factored where they were.
void VortexParticleSolver::load_moving(sim::StateReader& in) {
    moving_.reset();
    take_films(sim::load_mesh(in, "mesh"));
    Moving& m = *moving_;
    const std::size_t vertices = m.films.position.size();
    read_vectors(in, "film/velocity", vertices, m.velocity);
    read_vectors(in, "film/carry", vertices, m.carry);
    read_vectors(in, "film/looked_at", vertices, m.looked_at);
    in.read("film/pressure", m.films.regions.size(), m.pressure);
    const std::int64_t next = in.read_integer("film/next_event");
    if (next < 0 || next > static_cast<std::int64_t>(input_.films->events.size()))
        throw InputError(fmt::format("next_event = {} is no event of this scene", next));
    m.next_event = static_cast<std::size_t>(next);
    Moving::Reference& r = m.reference;
    r.step = in.read_double("film/reference/step");
    r.stale = in.read_integer("film/reference/stale") != 0;
    if (!(r.step > 0.0)) return;
    read_vectors(in, "film/reference/position", vertices, r.position);
    in.read("film/reference/thickness", surface_.vertices(), r.thickness);
    in.read("film/reference/surfactant", surface_.vertices(), r.surfactant);
    in.read("film/reference/mass", vertices, r.mass);
    in.read("film/reference/tension", surface_.triangles(), r.tension);
    const Vectors now = m.films.position;
    m.films.position = r.position;
    place(r.position, options_.walls, surface_);
    factor_moving();
    m.films.position = now;
    place(now, options_.walls, surface_);
    take_shape();
}

}  // namespace lamella::vortex_particle
