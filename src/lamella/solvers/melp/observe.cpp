// What can be seen of films made of particles.

#include "lamella/solvers/melp/film_ends.h"
#include "lamella/solvers/melp/foam.h"
#include "lamella/solvers/melp/melp_solver.h"
#include "lamella/solvers/melp/redistribution.h"
#include "lamella/solvers/melp/start.h"
#include "lamella/solvers/melp/surface.h"
#include "lamella/solvers/melp/volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lamella::melp {
namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

struct Spread {
    double mean = 0.0, deviation = 0.0, least = 0.0, largest = 0.0;
};

/// Of values that count with weights.
Spread spread_of(const std::vector<double>& value, const std::vector<double>& weight) {
    Spread s;
    if (value.empty()) return s;
    const double total = sum(weight);
    for (std::size_t i = 0; i < value.size(); ++i) s.mean += weight[i] * value[i] / total;
    for (std::size_t i = 0; i < value.size(); ++i)
        s.deviation += weight[i] * (value[i] - s.mean) * (value[i] - s.mean) / total;
    s.deviation = std::sqrt(s.deviation);
    s.least = *std::min_element(value.begin(), value.end());
    s.largest = *std::max_element(value.begin(), value.end());
    return s;
}

constexpr double kEnds = 1.5;  // [spacings] of the nearest rim: films end there, farther away in holes

/// A stick shows as balls in a row, so near that dents are a thousandth of the radius deep.
void append_balls(const film::Body& body, std::vector<sim::Solid>& balls) {
    constexpr double kStep = 0.09;  // radii
    const int steps = static_cast<int>(std::ceil(2.0 * norm(body.arm) / (kStep * body.radius)));
    for (int k = 0; k <= steps; ++k) {
        const double s = steps > 0 ? 2.0 * k / steps - 1.0 : 0.0;
        balls.push_back({body.center + s * body.arm, body.radius});
    }
}

void append_scalars(std::size_t number, const film::Body& body, std::vector<sim::Scalar>& all) {
    const auto add = [&](const char* what, const char* unit, const Vec3& value, const char* text) {
        for (std::size_t k = 0; k < 3; ++k)
            all.push_back({fmt::format("solid_{}_{}_{}", number, what, "xyz"[k]), unit, value[k], text});
    };
    add("center", "m", body.center, "of the solid");
    add("velocity", "m/s", body.velocity, "of the solid");
    add("force", "N", body.force, "of the films on the solid, in the last step");
}

void append(std::vector<double>& to, const Vec3& x) { to.insert(to.end(), x.v, x.v + 3); }

}  // namespace

/// The films as triangles between coarse particles, each region's on its own, up to the rims that hold them.
sim::Surface MelpSolver::surface() const {
    sim::Surface surface;
    surface.position = coarse_.position;
    surface.triangles = surface_triangles(coarse_, geometry_);
    const FilmEnds ends = film_ends(coarse_, surface.triangles, rims_now_, kEnds * spacing_);
    for (const FilmEnds::Foot& foot : ends.feet) surface.position.push_back(foot.position);
    surface.triangles.insert(surface.triangles.end(), ends.triangles.begin(), ends.triangles.end());
    for (const auto& t : surface.triangles)
        surface.regions.push_back({gas_[static_cast<std::size_t>(coarse_.region[t[0]])].region, 0});
    sim::Field velocity{"velocity", "m/s", 3, false, {}};
    for (std::size_t i = 0; i < coarse_.size(); ++i) append(velocity.values, velocity_of(i));
    sim::Field on_wire{"on_wire", "-", 1, true, std::vector<double>(coarse_.size(), 0.0)};
    const auto with_feet = [&](std::vector<double> values) {
        for (const FilmEnds::Foot& foot : ends.feet) values.push_back(values[foot.particle]);
        return values;
    };
    for (const FilmEnds::Foot& foot : ends.feet) {
        const RimPiece& piece = rims_now_[foot.piece];
        append(velocity.values, piece.slides() ? velocity_of(foot.particle) : piece.velocity_at(foot.position));
        on_wire.values.push_back(piece.slides() ? 0.0 : 1.0);
    }
    surface.vertex_fields = {{"thickness", "m", 1, false, with_feet(films_.seen_thickness)},
                             {"surfactant_concentration", "mol/m^2", 1, false, with_feet(films_.concentration)},
                             {"temperature", "K", 1, false, with_feet(films_.temperature)},
                             {"curvature", "1/m", 1, false, with_feet(geometry_.curvature)},
                             std::move(velocity),
                             std::move(on_wire)};
    const std::size_t regions = input_.films->mesh.regions.size();
    sim::Field closed{"closed", "-", 1, true, std::vector<double>(regions, 0.0)};
    sim::Field target{"target_volume", "m^3", 1, false, std::vector<double>(regions, 0.0)};
    sim::Field pressure{"pressure", "Pa", 1, false, std::vector<double>(regions, 0.0)};
    for (const Gas& gas : gas_) {
        const auto r = static_cast<std::size_t>(gas.region);
        if (!gas.closed) continue;
        closed.values[r] = 1.0;
        target.values[r] = input_.films->mesh.regions[static_cast<mesh::RegionId>(r)].target_volume;
        if (gas.held) target.values[r] = gas.amount / options_.outside_pressure;  // half a bubble: the scene names none
        pressure.values[r] = gas.balanced;
    }
    surface.region_fields = {std::move(closed), std::move(target), std::move(pressure)};
    return surface;
}

Vec3 MelpSolver::velocity_of(std::size_t i) const {
    const Vec3& n = geometry_.normal[i];
    return films_.along[i] + dot(coarse_.velocity[i], n) * n;
}

sim::Frame MelpSolver::frame() const {
    sim::Frame frame;
    frame.solver = "melp";
    frame.time = time_;
    frame.step = steps_;
    frame.surface = surface();
    frame.points.position = coarse_.position;
    frame.points.position.insert(frame.points.position.end(), fine_.position.begin(), fine_.position.end());
    sim::Field fine{"fine", "-", 1, true, {}}, region{"region", "-", 1, true, {}};
    sim::Field thickness{"thickness", "m", 1, false, films_.thickness}, velocity{"velocity", "m/s", 3, false, {}};
    sim::Field normal{"normal", "-", 3, false, {}};
    fine.values.assign(coarse_.size(), 0.0);
    fine.values.resize(coarse_.size() + fine_.size(), 1.0);
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        append(velocity.values, velocity_of(i));
        append(normal.values, geometry_.normal[i]);
        region.values.push_back(gas_[static_cast<std::size_t>(coarse_.region[i])].region);
    }
    thickness.values.insert(thickness.values.end(), fine_.thickness.begin(), fine_.thickness.end());
    for (std::size_t p = 0; p < fine_.size(); ++p) {
        append(velocity.values, fine_.velocity[p]);
        append(normal.values, fine_.normal[p]);
        region.values.push_back(gas_[static_cast<std::size_t>(fine_.region[p])].region);
    }
    for (sim::Field* field : {&fine, &region, &thickness, &velocity, &normal})
        frame.points.fields.push_back(std::move(*field));
    for (const film::Body& body : bodies_)
        if (body.in_film) append_balls(body, frame.solids);
    frame.scalars = scalars();
    return frame;
}

std::vector<sim::Scalar> MelpSolver::scalars() const {
    const std::vector<double> mass = masses();
    double kinetic = 0.0, surface = 0.0, fastest = 0.0;
    Vec3 momentum;
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        const Vec3& n = geometry_.normal[i];
        const double v = dot(coarse_.velocity[i], n);
        const double liquid = liquid_density() * films_.liquid_volume[i];
        kinetic += 0.5 * mass[i] * v * v + 0.5 * liquid * squared_norm(films_.along[i]);
        momentum += liquid * (v * n + films_.along[i]);
        surface += 2.0 * films_.tension[i] * geometry_.area[i];
        fastest = std::max(fastest, std::hypot(v, norm(films_.along[i])));
    }
    const double liquid = sum(fine_.liquid_volume) +
                          std::accumulate(even_.begin(), even_.end(), 0.0, [](double total, const EvenFilm& film) {
                              return total + film.liquid_volume;
                          });
    const double surfactant = sum(fine_.surfactant) +
                              std::accumulate(even_.begin(), even_.end(), 0.0, [](double total, const EvenFilm& film) {
                                  return total + film.surfactant;
                              });
    double gas = 0.0, volume_error = 0.0;
    const std::vector<double> volume = particle_volumes(coarse_, geometry_, rims_now_, gas_, joined_);
    for (std::size_t r = 0; r < gas_.size(); ++r) {
        if (!gas_[r].closed) continue;
        gas += volume[r];
        volume_error = std::max(volume_error, std::abs(volume[r] / gas_[r].volume - 1.0));
    }
    const Spread film = spread_of(films_.thickness, geometry_.area);
    std::vector<sim::Scalar> scalars{
        {"energy_kinetic", "J", kinetic, "of the film, and of the air that swings with it"},
        {"energy_surface", "J", surface, "tension of both interfaces * area; a film between two bubbles counts twice"},
        {"particle_area", "m^2", sum(geometry_.area), "of the films, summed over coarse particles"},
        {"particle_volume", "m^3", gas, "of all bubbles, summed over coarse particles"},
        {"swept_volume_error", "-", volume_error, "largest relative difference of that and what the films have swept"},
        {"liquid_mass", "kg", liquid_density() * liquid, "of all films"},
        {"liquid_left", "kg", liquid_density() * left_liquid_, "with bubbles of a foam that have burst"},
        {"liquid_error", "-", initial_liquid_ > 0.0 ? (liquid + left_liquid_) / initial_liquid_ - 1.0 : 0.0,
         "of both together, relative to the start and what has entered since"},
        {"surfactant_amount", "mol", surfactant, "of one interface of all films"},
        {"momentum_x", "kg m/s", momentum[0], "of the films"},
        {"momentum_y", "kg m/s", momentum[1], "of the films"},
        {"momentum_z", "kg m/s", momentum[2], "of the films"},
        {"film_thickness_mean", "m", film.mean, "at coarse particles, weighted with area"},
        {"film_thickness_deviation", "m", film.deviation, "standard deviation of that"},
        {"film_thickness_min", "m", film.least, "at coarse particles"},
        {"film_thickness_max", "m", film.largest, "at coarse particles"},
        {"mean_curvature_sum", "1/m", spread_of(geometry_.curvature, geometry_.area).mean,
         "kappa_1 + kappa_2, -2 / R for a sphere, weighted with area"},
        {"max_velocity", "m/s", fastest, "of the films"},
        {"time_step", "s", step_, "the last one"},
        {"density_spread", "-", density_spread(geometry_, coarse_, gas_.size()),
         "(largest - smallest) / mean of coarse particles per area"},
        {"strays", "-", static_cast<double>(transfer_ ? transfer_->strays() : 0),
         "fine particles that no coarse one reaches"},
        {"flipped_normals", "-", static_cast<double>(flipped_normals(coarse_, geometry_, gas_, spacing_)),
         "coarse particles whose normal disagrees with those next to them"},
        {"bubbles", "-",
         static_cast<double>(std::count_if(gas_.begin(), gas_.end(), [](const Gas& g) { return g.closed; })),
         "with gas of their own"},
        {"waiting_bubbles", "-", static_cast<double>(waiting_bubbles()), "of faucets whose place is not free yet"},
        {"coarse_particles", "-", static_cast<double>(coarse_.size()), "that carry the shape"},
        {"fine_particles", "-", static_cast<double>(fine_.size()), "that are the liquid"},
    };
    for (std::size_t b = 0; b < bodies_.size(); ++b) append_scalars(b, bodies_[b], scalars);
    std::vector<double> of_region(gas_.size(), 0.0);
    for (std::size_t p = 0; p < fine_.size(); ++p)
        of_region[static_cast<std::size_t>(fine_.region[p])] += fine_.liquid_volume[p];
    constexpr std::size_t kMostBubbles = 12;
    for (std::size_t r = 0; r < std::min(gas_.size(), kMostBubbles); ++r) {
        const std::string number = std::to_string(gas_[r].region);
        scalars.push_back({"gauge_pressure_" + number, "Pa", gas_[r].balanced, "of its gas, above the outside"});
        scalars.push_back(
            {"liquid_mass_" + number, "kg", liquid_density() * (of_region[r] + even_[r].liquid_volume), "of its film"});
    }
    return scalars;
}

std::vector<sim::Scalar> MelpSolver::characteristic_numbers() const {
    const Start start = start_particles(*input_.films, options_, input_.seed);
    const film::Material& material = input_.films->material;
    const double mass = liquid_density() * material.thickness;
    const double elasticity = 2.0 * film::elasticity(material);
    const double gravity = norm(material.gravity);
    return {
        {"film_tension", "N/m", material.film_tension(), "twice the surface tension"},
        {"film_mass", "kg/m^2", mass, "per area"},
        {"films", "-", static_cast<double>(start.gas.size()), "bubbles and films on wires"},
        {"coarse_particles", "-", static_cast<double>(start.coarse.size()), "at the start"},
        {"fine_particles", "-", static_cast<double>(start.fine.size()), "at the start"},
        {"spacing", "m", start.spacing, "of coarse particles"},
        {"support_radius", "m", options_.support_radius * start.spacing, "of the kernels"},
        {"membrane_wave_speed", "m/s", std::sqrt(material.film_tension() / mass),
         "across the film; of the rim of a hole too"},
        {"elastic_wave_speed", "m/s", film::elastic_wave_speed(material),
         "of thickness waves along the film (Marangoni)"},
        {"drainage_rate", "1/m", mass * gravity / elasticity,
         "a film at rest under gravity is thinner by exp(- this * height)"},
        {"slowest_period", "s", slowest_period(start.gas), "of the smallest bubble"},
        {"swing_step", "s",
         options_.steps_per_period > 0.0 ? slowest_period(start.gas) / options_.steps_per_period : 0.0,
         "upper limit of the step from steps_per_period; 0: none"},
        {"air_mass", "-", options_.air_mass, "0: films swing alone; 5/6: with the air of mode 2"},
    };
}

}  // namespace lamella::melp
