#include "lamella/solvers/melp/melp_solver.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/exchange.h"
#include "lamella/solvers/melp/fine_order.h"
#include "lamella/solvers/melp/keep_inside.h"
#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/operators.h"
#include "lamella/solvers/melp/redistribution.h"
#include "lamella/solvers/melp/refusals.h"
#include "lamella/solvers/melp/solids.h"
#include "lamella/solvers/melp/start.h"
#include "lamella/solvers/melp/volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace lamella::melp {
namespace {

constexpr double kMostOnEdges = 2.0;  // of the reference concentration

}  // namespace

MelpSolver::MelpSolver(const Options& options, const sim::SolverInput& input) : options_(options), input_(input) {
    if (!input_.films) throw InputError("the scene has no films; add a [[bubble]]");
    const film::Material& material = input_.films->material;
    law_ = {.reference_tension = material.surface_tension,
            .reference_concentration = film::start_surfactant(material),
            .temperature = material.temperature};
    if (law_.tension(2.0 * law_.reference_concentration) <= 0.0)
        throw InputError(fmt::format(
            "melp: the elasticity of an interface, {:.3g} N/m from material.surfactant = {:.3g} mol/m^2, is as high as "
            "material.surface_tension = {:.3g} N/m: where a film has twice the surfactant it would have no tension",
            film::elasticity(material), law_.reference_concentration, law_.reference_tension));
    refuse_unknown_films(*input_.films, options_);
    const double weight = norm(material.gravity);
    heat_ =
        Heat(options_.heat, material.temperature, weight > 0.0 ? -material.gravity / weight : Vec3{{0.0, 0.0, 1.0}});
    contacts_ = Contacts({options_.joining, options_.joining_delay});
}

void MelpSolver::start(const sim::StartContext&) {
    Start start = start_particles(*input_.films, options_, input_.seed);
    coarse_ = std::move(start.coarse);
    fine_ = std::move(start.fine);
    gas_ = std::move(start.gas);
    even_ = std::move(start.even);
    rims_ = std::move(start.rims);
    bodies_ = film::bodies_at_start(input_.films->solids);
    spacing_ = start.spacing;
    set_rims(0.0);
    sort_fine_particles(fine_, spacing_);
    update_shape();
    even_out_layout();
    contacts_.start_joined(start.joined);
    follow_contacts(0.0);
    const std::vector<double> volume = particle_volumes(coarse_, geometry_, rims_now_, gas_, joined_);
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (gas_[r].closed) gas_[r].calibration = gas_[r].volume / volume[r];
    update_liquid();
    transfer_->project(geometry_.patch, geometry_.normal, fine_);
    update_liquid();
    for (const double v : fine_.liquid_volume) initial_liquid_ += v;
    for (const EvenFilm& film : even_) initial_liquid_ += film.liquid_volume;
    release_bubbles();
    apply_events();
    burst_on_solids();
}

/// Vertices of a mesh are no even layout: the first passes of redistribution are made before anything moves.
void MelpSolver::even_out_layout() {
    if (!options_.redistribution) return;
    constexpr double kEven = 0.15;
    constexpr int kMostPasses = 60;
    for (int pass = 0; pass < kMostPasses && density_spread(geometry_, coarse_, gas_.size()) > kEven; ++pass) {
        const std::vector<Vec3> shift = evening_shift(geometry_, coarse_, gas_.size(), spacing_);
        for (std::size_t i = 0; i < coarse_.size(); ++i)
            coarse_.position[i] += along_patch(geometry_.patch[i], shift[i]);
        keep_coarse_inside();
        update_shape();
    }
}

sim::StepReport MelpSolver::advance(double time_limit) {
    const auto& events = input_.films->events;
    if (next_event_ < events.size()) time_limit = std::min(time_limit, events[next_event_].time);
    time_limit = std::min(time_limit, next_release());
    double dt = choose_step(time_limit);
    const std::vector<Vec3> velocity_before = coarse_.velocity;
    const std::vector<Gas> gas_before = gas_;
    SurfactantStep surfactant;
    NormalStep normal;
    for (int attempt = 0;; ++attempt) {
        surfactant = push_along_film(dt);
        normal = push_along_normals(dt);
        const std::string fault = fault_of_step();
        const double shorter = fault.empty() ? shorter_step(dt) : dt;
        constexpr int kMostAttempts = 8;
        if (fault.empty() && (shorter == dt || attempt == kMostAttempts)) break;
        coarse_.velocity = velocity_before;
        gas_ = gas_before;
        if (!fault.empty())
            throw NumericalError(fmt::format(
                "melp: step {} of {:.3g} s from time {:.6g} s: {}; a smaller melp.cfl or theta = 1 may help",
                steps_ + 1, dt, time_, fault));
        dt = shorter;
    }
    const std::vector<Vec3> momentum = region_momenta(coarse_.velocity), drift = region_drifts_now();
    filter_short_waves();
    give_to_fine(dt);
    move_coarse(dt, normal);
    move_solids(dt);
    set_rims(time_ + dt);
    keep_coarse_inside();
    update_shape();
    move_fine(dt);
    clear_edges();
    keep_spacing();
    time_ = dt >= time_limit - time_ ? time_limit : time_ + dt;
    follow_contacts(time_);
    give_back_to_even_films(drift);
    update_liquid();
    give_back_to_liquid(momentum);
    exchange_liquid(dt);
    follow_particle_volumes(dt);
    vent(dt);
    step_ = dt;
    ++steps_;
    burst_on_walls();
    burst_on_solids();
    apply_events();
    release_bubbles();
    return {.step = dt,
            .evaluations = 1,
            .iterations = surfactant.solution.iterations + normal.solution.iterations,
            .residual = std::max(surfactant.solution.residual, normal.solution.residual)};
}

std::vector<double> MelpSolver::masses() const {
    std::vector<double> mass(coarse_.size());
    for (std::size_t i = 0; i < mass.size(); ++i) {
        const double radius = gas_[static_cast<std::size_t>(coarse_.region[i])].radius();
        mass[i] = liquid_density() * films_.liquid_volume[i] +
                  options_.air_mass * input_.films->material.air_density * radius * geometry_.area[i];
    }
    return mass;
}

/// Tension, gas, weight and wind move the film along its normals; gases note what the film sweeps.
NormalStep MelpSolver::push_along_normals(double dt) {
    const std::size_t count = coarse_.size();
    std::vector<double> before(count);
    std::vector<Vec3> external(count);
    for_each_particle(count, [&](std::size_t i) {
        const Vec3& n = geometry_.normal[i];
        before[i] = dot(coarse_.velocity[i], n);
        external[i] = (liquid_density() * films_.liquid_volume[i]) * input_.films->material.gravity;
        const Vec3 wind = wind_at(coarse_.position[i]);
        if (dot(n, wind) < 0.0)  // the side that the wind blows on
            external[i] += (options_.air_drag * geometry_.area[i]) * (wind - coarse_.velocity[i]);
    });
    const std::vector<double> mass = masses();
    NormalStep step = move_along_normals({.coarse = coarse_,
                                          .geometry = geometry_,
                                          .gas = gas_,
                                          .rims = rims_now_,
                                          .walls = input_.films->walls,
                                          .joined = joined_,
                                          .outside_pressure = options_.outside_pressure,
                                          .mass = mass,
                                          .interface_tension = films_.tension,
                                          .velocity = before,
                                          .internal = marangoni_,
                                          .external = external,
                                          .even = fine_.size() == 0,
                                          .floating = options_.floating,
                                          .junction_correction = options_.junction_correction,
                                          .damping = options_.damping,
                                          .shape_damping = options_.shape_damping,
                                          .theta = theta_of(dt),
                                          .dt = dt,
                                          .tolerance = options_.solver_tolerance});
    for_each_particle(
        count, [&](std::size_t i) { coarse_.velocity[i] += (step.velocity[i] - before[i]) * geometry_.normal[i]; });
    for (std::size_t r = 0; r < gas_.size(); ++r) {
        if (!gas_[r].closed) continue;
        gas_[r].volume += step.swept[r];
        gas_[r].balanced = gas_[r].gauge_pressure(options_.outside_pressure);
    }
    return step;
}

/// Waves as short as the spacing are not resolved, and with theta = 1/2 nothing damps them. What two passes leave of
/// the velocity is made of these: a uniform velocity leaves nothing, a swing in mode 2 the square of a hundredth.
void MelpSolver::filter_short_waves() {
    if (options_.grid_filter == 0.0) return;
    const std::vector<Vec3> rough =
        roughness(geometry_, roughness(geometry_, coarse_.velocity, Beyond::kVelocity), Beyond::kDifference);
    for_each_particle(rough.size(), [&](std::size_t i) {
        const Vec3& n = geometry_.normal[i];
        coarse_.velocity[i] -= (options_.grid_filter * dot(rough[i], n)) * n;
    });
}

void MelpSolver::give_to_fine(double dt) {
    transfer_->to_fine({coarse_.position, coarse_.velocity, films_.thickness, films_.seen_thickness},
                       -std::expm1(-options_.thickness_rate * dt), fine_);
}

/// Coarse particles follow the film along its normals and its region as a whole, and spread; where they leave the
/// liquid behind, they take the velocity of the place they come to.
void MelpSolver::move_coarse(double dt, const NormalStep& step) {
    const std::vector<Vec3> mean = region_velocities();
    const bool stirred = std::any_of(bodies_.begin(), bodies_.end(), [](const film::Body& b) { return b.wet; });
    std::vector<Vec3> shift = options_.redistribution ? evening_shift(geometry_, coarse_, gas_.size(), spacing_)
                                                      : std::vector<Vec3>(coarse_.size());
    const std::vector<Tensor> slope = gradient(geometry_, coarse_.position, coarse_.velocity);
    for_each_particle(coarse_.size(), [&](std::size_t i) {
        const Vec3& n = geometry_.normal[i];
        const auto region = static_cast<std::size_t>(coarse_.region[i]);
        // Those of a film that has burst go with the liquid: edges move that far in a step. So do those of a film that
        // solids are in: the liquid flows around them, and does not pile up before them.
        const bool torn = gas_[region].burst;
        const Vec3& carried = torn || (stirred && gas_[region].held) ? coarse_.velocity[i] : mean[region];
        if (torn) shift[i] = {};
        const Vec3 along = dt * (carried - dot(carried, n) * n);
        const Vec3 liquid = dt * (coarse_.velocity[i] - dot(coarse_.velocity[i], n) * n);
        coarse_.position[i] += along + (dt * step.mean[i]) * n + along_patch(geometry_.patch[i], shift[i]);
        coarse_.velocity[i] += slope[i] * (along + shift[i] - liquid);
    });
    coarse_.frame_normal = steady_normals(geometry_, coarse_.frame_normal);
}

namespace {

/// By how much the film around a particle stretches when all of it goes straight on for dt: det(1 + dt grad u) along
/// the film, and not exp(dt div u). Straight paths leave a whirl and widen it by (omega dt)^2 in a step; with the
/// divergence alone, what flows in for that made the particle thicker, at omega^2 dt / 2.
double stretch(const Tensor& slope, double dt) {
    constexpr double kLeast = 0.1;  // of rough flows at edges, that a step does not turn inside out
    double trace = 0.0, square = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        trace += slope[k][k];
        for (std::size_t m = 0; m < 3; ++m) square += slope[k][m] * slope[m][k];
    }
    return std::max(1.0 + dt * trace + 0.5 * dt * dt * (trace * trace - square), kLeast);
}

}  // namespace

/// Fine particles go with the flow, onto the film where it is now, and stretch with it.
void MelpSolver::move_fine(double dt) {
    parallel_for(fine_.size(), [&](std::size_t p) {
        fine_.position[p] += dt * fine_.velocity[p];
        if (transfer_->stray(p))  // a drop in the air
            fine_.velocity[p] += dt * input_.films->material.gravity;
        else
            fine_.thickness[p] /= stretch(fine_.gradient[p], dt);
    });
    transfer_->project(geometry_.patch, geometry_.normal, fine_);
    heat_.warm(dt, fine_);
    keep_inside({rims_now_, coarse_.position, coarse_.region, spacing_, 0.0}, fine_.region, fine_.normal,
                fine_.position, fine_.velocity);
    constexpr std::int64_t kSortEvery = 32;
    if ((steps_ + 1) % kSortEvery == 0) sort_fine_particles(fine_, spacing_);
}

void MelpSolver::set_rims(double time) {
    rims_now_ = rims_.at(time);
    append_solids(bodies_, gas_, rims_now_);
}

/// Solids go on to the end of the step; free ones by their weight and what films pull them with.
void MelpSolver::move_solids(double dt) {
    pull_solids(coarse_, geometry_, films_.tension, spacing_, bodies_);
    for (film::Body& body : bodies_) {
        if (!body.free) continue;
        const Vec3 pull = body.force / body.mass + input_.films->material.gravity;
        body.velocity = (body.velocity + dt * pull) / (1.0 + dt * options_.damping);
    }
    film::move_bodies(input_.films->solids, time_ + dt, dt, bodies_);
}

/// Coarse particles nearer to a rim than this would count its pictures double.
void MelpSolver::keep_coarse_inside() {
    constexpr double kNearest = 0.2;  // spacings
    keep_inside({rims_now_, coarse_.position, coarse_.region, spacing_, kNearest * spacing_}, coarse_.region,
                coarse_.frame_normal, coarse_.position, coarse_.velocity);
}

void MelpSolver::update_shape() { geometry_ = geometry_of(coarse_, support_radius(), rims_now_); }

void MelpSolver::follow_contacts(double time) {
    contacts_.update(geometry_.neighbors.touching, time);
    joined_ = contacts_.joined(geometry_.neighbors.other, coarse_.region, time);
}

void MelpSolver::update_liquid() {
    transfer_.emplace(coarse_, geometry_.normal, fine_, support_radius(), geometry_.images);
    gather_liquid();
}

/// The films as the fine particles make them, with the weights that are there.
void MelpSolver::gather_liquid() {
    films_ = films_of(geometry_, coarse_, transfer_->to_coarse(coarse_, fine_), even_, law_, heat_);
    // The thick edge of a hole is no film: surfactant that does not fit on it goes into its liquid.
    const double most = kMostOnEdges * law_.reference_concentration;
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        if (!gas_[static_cast<std::size_t>(coarse_.region[i])].burst) continue;
        films_.concentration[i] = std::min(films_.concentration[i], most);
        films_.pressing[i] = std::min(films_.pressing[i], most);
        films_.tension[i] = law_.tension(films_.pressing[i]) + heat_.extra_tension(films_.temperature[i]);
    }
}

/// Films of two bubbles that lie on each other even out.
void MelpSolver::exchange_liquid(double dt) {
    if (options_.exchange_rate == 0.0 || geometry_.neighbors.other.index.empty() || any_burst()) return;
    std::vector<Vec3> velocity(coarse_.size());
    for (std::size_t i = 0; i < coarse_.size(); ++i) velocity[i] = velocity_of(i);
    Exchange gained = exchange_between(geometry_, films_, velocity, joined_, options_.exchange_rate, dt);
    std::vector<Vec3> momentum = region_momenta(velocity);
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        momentum[static_cast<std::size_t>(coarse_.region[i])] += gained.momentum[i];
        const double before = films_.liquid_volume[i], after = before + gained.liquid_volume[i];
        const Vec3& n = geometry_.normal[i];
        coarse_.velocity[i] += dot((before * velocity[i] + gained.momentum[i]) / after - velocity[i], n) * n;
        gained.liquid_volume[i] /= before;
        gained.momentum[i] = gained.momentum[i] / before;
        gained.heat[i] /= before;
        if (gained.surfactant[i] != 0.0) gained.surfactant[i] /= films_.concentration[i] * geometry_.area[i];
    }
    transfer_->grow({gained.liquid_volume, gained.surfactant, gained.momentum, gained.heat}, fine_);
    gather_liquid();
    give_back_to_liquid(momentum);
}

/// Sums over particles know a volume to a thousandth only, which would be 100 Pa: gases go by what films sweep, and
/// follow the sums slowly. [method sheet 16.2]
void MelpSolver::follow_particle_volumes(double dt) {
    const double share = -std::expm1(-options_.volume_rate * dt);
    const std::vector<double> volume = particle_volumes(coarse_, geometry_, rims_now_, gas_, joined_);
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (gas_[r].closed && !gas_[r].burst) gas_[r].volume += share * (volume[r] - gas_[r].volume);
}

/// What went wrong in this step, before anything has moved; empty when nothing has.
std::string MelpSolver::fault_of_step() const {
    for (std::size_t i = 0; i < coarse_.size(); ++i)
        if (!std::isfinite(squared_norm(coarse_.velocity[i])))
            return fmt::format("the velocity of coarse particle {} is not finite", i);
    for (const Gas& gas : gas_)
        if (gas.closed && !(gas.volume > 0.0)) return fmt::format("bubble {} has no volume left", gas.region);
    return {};
}

}  // namespace lamella::melp
