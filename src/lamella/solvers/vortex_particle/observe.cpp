// What can be seen of the flow in a film: the frame, its scalars, and the numbers that `lamella check` prints.

#include "lamella/core/parallel.h"
#include "lamella/film/surfactant.h"
#include "lamella/sim/film_surface.h"
#include "lamella/solvers/vortex_particle/solids.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::vortex_particle {
namespace {

double mean_of(const Surface& s, std::size_t t, const std::vector<double>& value) {
    return (value[s.corner[t][0]] + value[s.corner[t][1]] + value[s.corner[t][2]]) / 3.0;
}

sim::Field vectors(std::string name, std::string unit, const std::vector<Vec3>& values) {
    sim::Field field{std::move(name), std::move(unit), 3, false, {}};
    for (const Vec3& u : values) field.values.insert(field.values.end(), u.v, u.v + 3);
    return field;
}

/// Values of the vertices of the films from those of their leaves: the mean, weighted with area.
template <class Value>
std::vector<Value> of_films(const Surface& s, std::size_t vertices, const std::vector<Value>& leaves) {
    if (vertices == s.vertices()) return leaves;
    std::vector<Value> mean(vertices, Value{});
    std::vector<double> area(vertices, 0.0);
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        mean[s.site[v]] += s.vertex_area[v] * leaves[v];
        area[s.site[v]] += s.vertex_area[v];
    }
    for (std::size_t v = 0; v < vertices; ++v)
        if (area[v] > 0.0) mean[v] *= 1.0 / area[v];
    return mean;
}

void add_scalars(std::size_t number, const Body& body, std::vector<sim::Scalar>& all) {
    const auto add = [&](const char* what, const char* unit, const Vec3& value, const char* text) {
        for (std::size_t k = 0; k < 3; ++k)
            all.push_back({fmt::format("solid_{}_{}_{}", number, what, "xyz"[k]), unit, value[k], text});
    };
    add("force", "N", body.force, "of the film on the solid and the film that it covers, in the last step");
    add("torque", "N m", body.torque, "about its center, likewise");
    if (!body.free) return;
    add("center", "m", body.center, "of the free solid");
    add("velocity", "m/s", body.velocity, "of the free solid");
    add("spin", "rad/s", body.spin, "of the free solid");
}

}  // namespace

const MeshFlow& VortexParticleSolver::observed() const {
    if (!observed_) {
        MeshFlow flow = particles_to_mesh();
        recover_velocity(flow);
        observed_ = std::move(flow);
    }
    return *observed_;
}

double VortexParticleSolver::kinetic_energy() const {
    const MeshFlow& flow = observed();
    const double density = input_.films->material.liquid_density;
    return parallel_sum(surface_.triangles(), [&](std::size_t t) {
        return 0.5 * density * mean_of(surface_, t, flow.thickness) * surface_.area[t] * squared_norm(flow.velocity[t]);
    });
}

sim::Frame VortexParticleSolver::frame() const {
    const MeshFlow& flow = observed();
    sim::Frame frame;
    frame.solver = "vortex_particle";
    frame.time = time_;
    frame.step = steps_;
    frame.surface = sim::film_surface(films());
    std::vector<double> vorticity = flow.circulation, dilatation = flow.outflow, thickness = flow.thickness;
    for (std::size_t v = 0; v < surface_.vertices(); ++v) {
        vorticity[v] /= surface_.vertex_area[v];
        dilatation[v] /= surface_.vertex_area[v];
        thickness[v] /= surface_.vertex_share[v];
    }
    const std::size_t vertices = films().position.size();
    auto& fields = frame.surface.vertex_fields;
    fields.push_back({"thickness", "m", 1, false, of_films(surface_, vertices, thickness)});
    fields.push_back({"vorticity", "1/s", 1, false, of_films(surface_, vertices, vorticity)});
    fields.push_back({"surfactant_concentration", "mol/m^2", 1, false, of_films(surface_, vertices, flow.surfactant)});
    fields.push_back({"dilatation", "1/s", 1, false, of_films(surface_, vertices, dilatation)});
    if (!input_.films->solids.empty()) {
        const Cover held = cover(step_);
        std::vector<double> solid(films().faces.size(), 0.0);
        for (std::size_t t = 0; t < surface_.triangles(); ++t) solid[surface_.film[t]] = held.share[t];
        frame.surface.face_fields.push_back({"solid", "-", 1, false, std::move(solid)});
    }
    std::vector<Vec3> velocity = of_films(surface_, vertices, vertex_velocity(surface_, flow.velocity));
    add_film_motion(velocity);
    fields.push_back(vectors("velocity", "m/s", velocity));
    if (options_.particles_in_frames) {
        thickness.resize(particles_.size());
        for (std::size_t p = 0; p < particles_.size(); ++p) {
            frame.points.position.push_back(surface_.point(particles_.triangle[p], particles_.place[p]));
            thickness[p] = particles_.volume[p] / particles_.area[p];
        }
        frame.points.fields.push_back({"circulation", "m^2/s", 1, false, particles_.circulation});
        frame.points.fields.push_back({"thickness", "m", 1, false, std::move(thickness)});
        frame.points.fields.push_back(vectors("velocity", "m/s", particles_.velocity));
    }
    for (const film::Solid& solid : input_.films->solids)
        frame.solids.push_back({solid.center_at(time_), solid.radius});
    frame.scalars = scalars();
    return frame;
}

std::vector<sim::Scalar> VortexParticleSolver::scalars() const {
    const MeshFlow& flow = observed();
    const film::Material& material = input_.films->material;
    const double rest = film::start_surfactant(material), rt = film::thermal_energy(material);
    double elastic = 0.0, on_mesh = 0.0, enstrophy = 0.0, fastest = 0.0;
    Vec3 impulse;
    for (std::size_t v = 0; v < surface_.vertices(); ++v) {
        const double gamma = flow.surfactant[v], area = surface_.vertex_area[v], omega = flow.circulation[v] / area;
        elastic += 2.0 * rt * surface_.vertex_share[v] * area * (gamma * std::log(gamma / rest) - gamma + rest);
        on_mesh += flow.thickness[v] * area;
        enstrophy += 0.5 * omega * omega * area;
        impulse += flow.circulation[v] * surface_.position[v];
    }
    for (const Vec3& u : flow.velocity) fastest = std::max(fastest, norm(u));
    const auto sum = [&](const std::vector<double>& column) {
        return parallel_sum(column.size(), [&](std::size_t p) { return column[p]; });
    };
    const double volume = sum(particles_.volume), kinetic = kinetic_energy();
    const double gravity = -material.liquid_density * parallel_sum(particles_.size(), [&](std::size_t p) {
        return particles_.volume[p] *
               dot(material.gravity, surface_.point(particles_.triangle[p], particles_.place[p]));
    });
    std::size_t fewest = particles_.size(), most = 0;
    for (std::size_t t = 0; t < surface_.triangles(); ++t) {
        fewest = std::min(fewest, bins_[t + 1] - bins_[t]);
        most = std::max(most, bins_[t + 1] - bins_[t]);
    }
    std::vector<sim::Scalar> all{
        {"energy_kinetic", "J", kinetic, "of the liquid along the film"},
        {"energy_elastic", "J", elastic, "of the surfactant, above that of an even film of material.surfactant"},
        {"energy_gravity", "J", gravity, "of the liquid, above the origin"},
        {"energy", "J", kinetic + elastic + gravity, "of all three"},
        {"circulation", "m^2/s", sum(particles_.circulation), "of all particles"},
        {"enstrophy", "m^2/s^2", enstrophy, "half the integral of the squared vorticity"},
        {"angular_impulse_x", "m^3/s", impulse[0], "integral of vorticity times position"},
        {"angular_impulse_y", "m^3/s", impulse[1], "integral of vorticity times position"},
        {"angular_impulse_z", "m^3/s", impulse[2], "integral of vorticity times position"},
        {"liquid_volume", "m^3", volume, "of all particles: constant"},
        {"surfactant_amount", "mol", 2.0 * sum(particles_.amount), "on both interfaces: constant"},
        {"mesh_volume_error", "-", on_mesh / volume - 1.0,
         "of the thickness on the mesh against the particles' liquid; below 0 after a burst: what is in borders"},
        {"max_velocity", "m/s", fastest, "along the film"},
        {"max_mach", "-", fastest / film::elastic_wave_speed(material), "that over the speed of elastic waves"},
        {"time_step", "s", step_, "the last one"},
        {"iterations", "-", static_cast<double>(iterations_), "of the surfactant's equation in the last step"},
        {"particles", "-", static_cast<double>(particles_.size()), "of all films"},
        {"fewest_in_triangle", "-", static_cast<double>(fewest), "particles"},
        {"most_in_triangle", "-", static_cast<double>(most), "particles"},
    };
    if (moving_) add_film_scalars(all);
    if (surface_.open()) {
        all.push_back({"liquid_in", "m^3", liquid_in_, "that the stream has brought"});
        all.push_back({"liquid_out", "m^3", liquid_out_, "that it has taken"});
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) add_scalars(b, bodies_[b], all);
    return all;
}

std::vector<sim::Scalar> VortexParticleSolver::characteristic_numbers() const {
    const film::Material& material = input_.films->material;
    const double c = film::elastic_wave_speed(material);
    const auto triangles = static_cast<double>(surface_.triangles());
    return {
        {"surfactant", "mol/m^2", film::start_surfactant(material), "on one interface"},
        {"elasticity", "N/m", film::elasticity(material), "of one interface"},
        {"elastic_wave_speed", "m/s", c, "of waves of thickness"},
        {"film_viscosity", "m^2/s", viscosity_, "of liquid and interfaces"},
        {"drainage_exponent", "1/m", norm(material.gravity) / (c * c),
         "the thickness of a film at rest falls with height by this"},
        {"vertices", "-", static_cast<double>(surface_.vertices()), "of the films"},
        {"triangles", "-", triangles, "of the films"},
        {"particles", "-", triangles * options_.particles_per_triangle, "at the start"},
        {"holes", "-",
         static_cast<double>(surface_.loops.size()) -
             static_cast<double>(std::count_if(surface_.loops.begin(), surface_.loops.end(),
                                               [](const BoundaryLoop& l) { return l.outer; })),
         "that the flow may go around"},
        {"mean_edge", "m", surface_.mean_edge, "of a triangle"},
        {"elastic_step", "s", surface_.mean_edge / c, "steps longer than two of it damp waves of thickness"},
    };
}

}  // namespace lamella::vortex_particle
