#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

#include "lamella/core/error.h"
#include "lamella/film/bursting.h"
#include "lamella/film/tension.h"
#include "lamella/mesh/area.h"
#include "lamella/mesh/staged_move.h"
#include "lamella/mesh/volume.h"
#include "lamella/mesh/volume_projection.h"
#include "lamella/solvers/vortex_sheet/film_laplacian.h"
#include "lamella/solvers/vortex_sheet/impulse.h"
#include "lamella/solvers/vortex_sheet/point_form.h"
#include "lamella/solvers/vortex_sheet/step_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lamella::vortex_sheet {
namespace {

constexpr double kLongestLoose = 1.5;  // edges: with the smoothing length, neighbors overlap
constexpr double kFarthest = 0.25;     // edges that a film moves in one step
// Triangles that a swing stretches and lets go again keep their edges: every flip bends the film.
constexpr double kFlipAngle = 1.1;

}  // namespace

using mesh::FoamMesh;
using mesh::RegionId;
using mesh::RegionKind;
using mesh::VertexId;

VortexSheetSolver::VortexSheetSolver(const Options& options, const sim::SolverInput& input)
    : options_(options), input_(input) {
    if (!input_.films) throw InputError("the scene has no films; add a [[bubble]], [[film]] or [foam]");
    film::refuse_punctures(*input_.films, "vortex_sheet");
    const bool blows = std::any_of(input_.films->wires.begin(), input_.films->wires.end(),
                                   [](const film::Wire& wire) { return wire.ring && wire.ring->blow != 0.0; });
    if (blows && options_.compat.form == Form::kPoint)
        throw InputError("vortex_sheet.compat.form = \"point\" knows no wire.blow");
    if (input_.films->mesh.periodic())
        throw InputError("vortex_sheet: films in a periodic box are for solver equilibrium");
    if (options_.compat.form == Form::kPoint && options_.integrator == Integrator::kVerlet)
        throw InputError("vortex_sheet.compat.form = \"point\" goes with integrator = \"symplectic_euler\"");
    for (const film::Event& event : input_.films->events)
        if (event.kind == film::Event::Kind::kInflate && !options_.volume_projection)
            throw InputError("vortex_sheet.volume_projection = false: bubbles cannot be inflated without it");
    if (options_.compat.form == Form::kPoint && options_.popped_vorticity == PoppedVorticity::kFree)
        throw InputError("vortex_sheet.compat.form = \"point\" knows no popped_vorticity = \"free\"");
    if (options_.tension == Tension::kImplicit) check_implicit();
}

void VortexSheetSolver::start(const sim::StartContext&) {
    wire_of_ = input_.films->wire_of;
    wire_of_.resize(input_.films->mesh.position.size(), -1);
    take(input_.films->mesh);
    phi_.assign(topology_.size(), 0.0);
    velocity_.assign(mesh().position.size(), {});
    settle_volumes();
    give_start_velocities();
    apply_events();
}

void VortexSheetSolver::take(FoamMesh mesh) {
    mesh::TrackerOptions options;
    options.edge_length = input_.films->edge_length;
    options.merging = options_.merging;
    options.flip_angle = kFlipAngle;
    tracker_ = std::make_unique<mesh::Tracker>(std::move(mesh), options);
    topology_ = sheet_topology(tracker_->mesh());
}

void VortexSheetSolver::set_circulation(Circulation phi) {
    phi_ = std::move(phi);
    impulse_ = impulse(mesh(), topology_, sheet_geometry(mesh(), topology_), phi_);
    observed_.reset();
}

/// Bubbles that the scene sends off move as a whole at first: the flux through each vertex is that of its bubbles' mean
/// velocity. Clusters without such a bubble start without circulation and are carried along.
void VortexSheetSolver::give_start_velocities() {
    const auto& velocity = input_.films->velocity;
    const auto moving = [](const Vec3& v) { return squared_norm(v) > 0.0; };
    if (std::none_of(velocity.begin(), velocity.end(), moving)) return;
    std::vector<std::uint8_t> sent(topology_.clusters, 0);
    for (const VertexId v : mesh().position.ids())
        for (const RegionId r : topology_.entries.of(v))
            if (mesh().regions[r].kind == RegionKind::kClosed && moving(velocity[r])) sent[topology_.cluster[v]] = 1;
    IdVector<VertexId, Vec3> motion(mesh().position.size());
    for (const VertexId v : mesh().position.ids()) {
        double bubbles = 0.0;
        for (const RegionId r : topology_.entries.of(v))
            if (mesh().regions[r].kind == RegionKind::kClosed) {
                motion[v] += velocity[r];
                bubbles += 1.0;
            }
        if (bubbles > 0.0) motion[v] = motion[v] / bubbles;
    }
    keep_volumes_of(motion);
    const SheetGeometry geometry = sheet_geometry(mesh(), topology_);
    FluxTarget target;
    for (const VertexId v : mesh().position.ids())
        for (std::size_t i = topology_.first(v); i < topology_.last(v); ++i) {
            if (sent[topology_.cluster[v]] == 0 || topology_.hold[v] == Hold::kRim) continue;
            target.entry.push_back(static_cast<std::uint32_t>(i));
            target.flux.push_back(dot(geometry.outward[i], motion[v]));
        }
    constexpr double kTolerance = 1e-3;  // what is left are ripples of the length of an edge
    meet_fluxes(mesh(), topology_, geometry, target, std::vector<double>(topology_.size(), 0.0), kTolerance,
                sum_options(), phi_);
    fix_gauge(topology_, phi_);
    impulse_ = impulse(mesh(), topology_, geometry, phi_);
    velocity_ = flow_at(mesh(), topology_, geometry, phi_, {}, sum_options()).velocity;  // for the first step's length
}

/// The smallest change of a motion after which it leaves all volumes as they are. No flow of air has another, and
/// circulations that are to make one have no bounds.
void VortexSheetSolver::keep_volumes_of(IdVector<VertexId, Vec3>& motion) const {
    double fastest = 0.0;
    for (const Vec3& u : motion) fastest = std::max(fastest, norm(u));
    const double moment = 1e-5 * input_.films->edge_length / fastest;  // a linear problem, by a small motion
    FoamMesh moved = mesh();
    const IdVector<RegionId, double> volume = mesh::region_volumes(moved);
    for (const RegionId r : moved.regions.ids())
        if (moved.regions[r].kind == RegionKind::kClosed) moved.regions[r].target_volume = volume[r];
    for (const VertexId v : motion.ids()) moved.position[v] += moment * motion[v];
    const mesh::VolumeProjection back = mesh::volume_projection(moved);
    for (const VertexId v : motion.ids()) motion[v] += back.displacement[v] / moment;
}

sim::StepReport VortexSheetSolver::advance(double time_limit) {
    std::optional<ImplicitStep> implicit = try_implicit(time_limit);
    const double dt = implicit ? implicit->dt : choose_step(time_limit);
    const bool verlet = options_.integrator == Integrator::kVerlet;
    if (implicit)
        phi_ = std::move(implicit->phi);
    else
        kick(verlet ? 0.5 * dt : dt);
    damp(dt);
    velocity_ = implicit ? std::move(implicit->velocity) : velocity_at_midpoint(verlet ? dt : 0.0);
    move(dt);
    time_ = dt >= time_limit - time_ ? time_limit : time_ + dt;
    if (verlet && !implicit) kick(0.5 * dt);
    inflate();
    if (options_.remeshing)
        edit_mesh([&] { tracker_->remesh(); });
    else
        check_triangles();
    restore_volumes();
    keep_impulse();
    apply_events();
    step_ = dt;
    evaluations_ = implicit ? implicit->evaluations : 0;
    ++steps_;
    observed_.reset();
    if (implicit)
        return {
            .step = dt, .evaluations = evaluations_, .iterations = evaluations_ - 1, .residual = implicit->residual};
    return {.step = dt, .evaluations = 1, .residual = wire_residual_};
}

double VortexSheetSolver::choose_step(double time_limit) const {
    return fitted(farthest_step(options_.step_safety * capillary_limit()), time_limit);
}

/// The part of a step that the speed of films and wires allows, and the user.
double VortexSheetSolver::farthest_step(double dt) const {
    if (options_.largest_step > 0.0) dt = std::min(dt, options_.largest_step);
    double fastest = 0.0;
    for (const Vec3& u : velocity_) fastest = std::max(fastest, norm(u));
    for (const Vec3& u : loose_.velocity) fastest = std::max(fastest, norm(u));
    for (const film::Wire& wire : input_.films->wires) fastest = std::max(fastest, norm(wire.velocity));
    // A film that snaps sets the step, down to a twentieth: what is faster still are single vertices out of order.
    constexpr double kShortest = 0.05;
    if (dt * fastest <= kFarthest * input_.films->edge_length) return dt;
    return std::max(kShortest * dt, kFarthest * input_.films->edge_length / fastest);
}

/// A step that ends where an event or an output does.
double VortexSheetSolver::fitted(double dt, double time_limit) const {
    double limit = time_limit;
    const auto& events = input_.films->events;
    if (next_event_ < events.size()) limit = std::min(limit, std::max(events[next_event_].time, time_));
    const double left = limit - time_;
    if (left <= dt) return left;
    return left < 2.0 * dt ? 0.5 * left : dt;  // no crumb of a step before an output
}

void VortexSheetSolver::kick(double dt) {
    const Circulation rate = tension_rate(mesh(), sheet_geometry(mesh(), topology_));
    for (std::size_t i = 0; i < phi_.size(); ++i) phi_[i] += dt * rate[i];
    if (!std::all_of(phi_.begin(), phi_.end(), [](double value) { return std::isfinite(value); }))
        throw NumericalError(fmt::format("t = {:.6g} s, step {}: circulations are not finite", time_, steps_));
    fix_gauge(topology_, phi_);
}

/// Tension drives the circulations: d phi_r / dt = -p_r / rho, with the pressures that the films ask for.
Circulation VortexSheetSolver::tension_rate(const FoamMesh& mesh, const SheetGeometry& geometry) const {
    const film::Problem& films = *input_.films;
    const double tension = films.material.film_tension();
    const std::vector<double> pressure =
        options_.compat.form == Form::kFace
            ? film_pressures(topology_, geometry,
                             mesh::area_gradient(mesh, film::face_tensions(mesh, tension, films.tensions)))
            : dihedral_pressures(mesh, topology_, 0.5 * tension);
    Circulation rate(topology_.size(), 0.0);
    for (const VertexId v : mesh.position.ids()) {
        if (topology_.hold[v] != Hold::kFree) continue;
        for (std::size_t i = topology_.first(v); i < topology_.last(v); ++i)
            rate[i] = -pressure[i] / films.material.air_density;
    }
    if (options_.impulse_projection) {
        const ImpulseControl control(mesh, topology_, geometry);
        std::vector<Vec3> given = control.impulses(rate);
        for (Vec3& p : given) p = -p;
        control.add(given, rate);
    }
    return rate;
}

void VortexSheetSolver::damp(double dt) {
    if (options_.damping > 0.0) {
        const double left = std::exp(-options_.damping * dt);
        for (double& value : phi_) value *= left;
        for (auto& jumps : loose_.circulation)
            for (double& value : jumps) value *= left;
    }
    if (options_.compat.smoothing > 0.0)
        smooth_pairs(mesh(), topology_, std::min(1.0, options_.compat.smoothing * dt), phi_);
    if (options_.surface_viscosity == 0.0 && options_.grid_filter == 0.0) return;
    const FilmLaplacian laplacian(mesh(), topology_);
    if (options_.surface_viscosity > 0.0) diffuse(laplacian, options_.surface_viscosity, dt, phi_);
    if (options_.grid_filter > 0.0) filter_grid_noise(laplacian, options_.grid_filter, phi_);
}

/// The films where they will be some time from now, as far as the last velocity tells.
FoamMesh VortexSheetSolver::films_ahead(double ahead) const {
    FoamMesh films = mesh();
    for (const VertexId v : films.position.ids())
        if (topology_.hold[v] == Hold::kFree)
            films.position[v] += ahead * velocity_[v];
        else
            films.position[v] += ahead * wire_velocity(v, films.position[v], time_, time_ + ahead);
    return films;
}

Flow VortexSheetSolver::flow_of(const FoamMesh& mesh,
                                const SheetGeometry& geometry,
                                double time,
                                const LooseSheets& loose) const {
    return flow_at(mesh, topology_, geometry, phi_, blown_rings(input_.films->wires, time), sum_options(), loose);
}

/// Velocity of the vertices where they will be half a step from now.
IdVector<VertexId, Vec3> VortexSheetSolver::velocity_at_midpoint(double dt) {
    const double half = time_ + 0.5 * dt;
    const FoamMesh middle = films_ahead(0.5 * dt);
    const SheetGeometry geometry = sheet_geometry(middle, topology_);
    if (options_.compat.form == Form::kPoint) return point_velocity(middle, topology_, geometry, phi_, sum_options());
    const LooseSheets loose = loose_.ahead(0.5 * dt);
    Flow flow = flow_of(middle, geometry, half, loose);
    obey_wires(middle, geometry, loose, half, half + std::max(dt, 1e-9), flow);
    loose_.velocity = std::move(flow.loose_velocity);
    if (dt > 0.0) {
        for (const VertexId v : mesh().position.ids())
            if (topology_.hold[v] != Hold::kFree)
                flow.velocity[v] = wire_velocity(v, mesh().position[v], time_, time_ + dt);
        carry_fluxes_all_the_way(mesh(), topology_, geometry, flow.flux, options_.compat.velocity_factor * dt,
                                 flow.velocity);
    }
    return std::move(flow.velocity);
}

/// Where a wire runs through a film, the circulation there is such that the air goes with the wire.
void VortexSheetSolver::obey_wires(const FoamMesh& middle,
                                   const SheetGeometry& geometry,
                                   const LooseSheets& loose,
                                   double from,
                                   double to,
                                   Flow& flow) {
    FluxTarget target;
    for (const VertexId v : middle.position.ids()) {
        if (topology_.hold[v] != Hold::kPinned) continue;
        const Vec3 u = wire_velocity(v, middle.position[v], from, to);
        for (std::size_t i = topology_.first(v); i < topology_.last(v); ++i) {
            target.entry.push_back(static_cast<std::uint32_t>(i));
            target.flux.push_back(dot(geometry.outward[i], u));
        }
    }
    wire_residual_ = 0.0;
    if (target.entry.empty()) return;
    constexpr double kTolerance = 1e-3;
    wire_residual_ = meet_fluxes(middle, topology_, geometry, target, flow.flux, kTolerance, sum_options(), phi_);
    fix_gauge(topology_, phi_);
    flow = flow_of(middle, geometry, from, loose);
}

void VortexSheetSolver::move(double dt) {
    IdVector<VertexId, Vec3> displacement(mesh().position.size());
    const double most = 2.0 * kFarthest * input_.films->edge_length / dt;
    for (const VertexId v : displacement.ids()) {
        if (topology_.hold[v] != Hold::kFree)
            velocity_[v] = wire_velocity(v, mesh().position[v], time_, time_ + dt);
        else
            velocity_[v] *= options_.compat.velocity_factor;
        const double speed = norm(velocity_[v]);
        if (speed > most) velocity_[v] *= most / speed;
        displacement[v] = dt * velocity_[v];
    }
    mesh::staged_move(*tracker_, displacement);
    for (Vec3& u : loose_.velocity) u *= options_.compat.velocity_factor;
    loose_ = loose_.ahead(dt);
    loose_.refine(kLongestLoose * input_.films->edge_length);
}

/// Without wires nothing outside pushes the air: what remeshing and rounding did to its impulse is taken back.
void VortexSheetSolver::keep_impulse() {
    if (!options_.impulse_projection) return;
    const SheetGeometry geometry = sheet_geometry(mesh(), topology_);
    const ImpulseControl control(mesh(), topology_, geometry);
    double total = 0.0;
    for (std::size_t c = 0; c < control.clusters(); ++c) {
        if (control.held(c)) return;
        total += control.volume(c);
    }
    if (!(total > 0.0)) return;
    for (const film::Wire& wire : input_.films->wires)
        if (wire.ring && wire.ring->blow != 0.0) return;
    const Vec3 missing = impulse_ - impulse(mesh(), topology_, geometry, phi_) - loose_.impulse();
    std::vector<Vec3> change(control.clusters());
    for (std::size_t c = 0; c < change.size(); ++c) change[c] = (control.volume(c) / total) * missing;
    control.add(change, phi_);
    fix_gauge(topology_, phi_);
}

void VortexSheetSolver::apply_events() {
    const auto& events = input_.films->events;
    for (; next_event_ < events.size() && events[next_event_].time <= time_; ++next_event_) apply(events[next_event_]);
}

void VortexSheetSolver::apply(const film::Event& event) {
    const RegionId region = event.region == film::kRandomBubble
                                ? film::random_outer_bubble(mesh(), input_.seed, next_event_).value_or(mesh::kOutside)
                                : event.region;
    if (index(region) >= mesh().regions.size() || mesh().regions[region].kind != RegionKind::kClosed) {
        events_.push_back({time_, "skipped", {}, fmt::format("bubble {} is gone already", index(region))});
        return;
    }
    if (event.kind == film::Event::Kind::kInflate) {
        inflations_.push_back(
            {region, mesh().regions[region].target_volume, event.volume, time_, time_ + event.duration});
        events_.push_back({time_, "inflate", {}, fmt::format("bubble {}", index(region))});
        return;
    }
    const RegionId into = event.into == film::kLargestNeighbor
                              ? film::largest_neighbor(mesh(), region).value_or(mesh::kOutside)
                              : event.into;
    if (film::share_film(mesh(), region, into)) return pop(region, into);
    events_.push_back(
        {time_, "skipped", {}, fmt::format("regions {} and {} share no film", index(region), index(into))});
}

/// The circulation of the film that bursts is lost, or becomes a sheet without film. What was a jump between its two
/// sides at its rim is shared out between the films that go on there: the constants of the two regions are chosen such
/// that the jump vanishes in the mean [method sheet 10.1].
void VortexSheetSolver::pop(RegionId region, RegionId into) {
    double jump = 0.0, count = 0.0;
    for (const VertexId v : mesh().position.ids()) {
        const auto a = topology_.entries.find(v, region), b = topology_.entries.find(v, into);
        if (!a || !b || topology_.last(v) - topology_.first(v) < 3) continue;
        jump += phi_[*b] - phi_[*a];
        count += 1.0;
    }
    if (count > 0.0)
        for (std::size_t i = 0; i < phi_.size(); ++i)
            if (topology_.entries.region[i] == region) phi_[i] += jump / count;
    const bool stays = options_.popped_vorticity == PoppedVorticity::kFree;
    const FoamMesh films = mesh();
    const SheetTopology topology = topology_;
    const Circulation phi = phi_;
    const auto velocity = velocity_;
    edit_mesh([&] { tracker_->pop(region, into); });
    if (stays)
        loose_.add(left_behind({films, topology, phi}, velocity, tracker_->maps(), {mesh(), topology_, phi_}));
    else
        impulse_ = impulse(mesh(), topology_, sheet_geometry(mesh(), topology_), phi_) + loose_.impulse();
}

void VortexSheetSolver::inflate() {
    for (const Inflation& i : inflations_) {
        if (mesh().regions[i.region].kind != RegionKind::kClosed) continue;
        const double share = i.end > i.start ? std::clamp((time_ - i.start) / (i.end - i.start), 0.0, 1.0) : 1.0;
        tracker_->set_target_volume(i.region, i.from + share * (i.to - i.from));
    }
    std::erase_if(inflations_, [&](const Inflation& i) { return time_ >= i.end; });
}

spatial::VortexSumOptions VortexSheetSolver::sum_options() const {
    return {.kernel = options_.kernel,
            .delta = options_.smoothing_length * input_.films->edge_length,
            .precision = options_.sum_in_double ? spatial::VortexSumOptions::Precision::kDouble
                                                : spatial::VortexSumOptions::Precision::kSingle,
            .device = input_.device,
            .tolerance = options_.sum_tolerance};
}

/// The mean velocity between two times of the wire that holds a vertex; 0 where none moves.
Vec3 VortexSheetSolver::wire_velocity(VertexId v, const Vec3& at, double from, double to) const {
    if (wire_of_[v] < 0 || !(to > from)) return {};
    return (input_.films->wires[static_cast<std::size_t>(wire_of_[v])].carried(at, from, to) - at) / (to - from);
}

double VortexSheetSolver::capillary_limit() const {
    const film::Problem& films = *input_.films;
    double tension = 1.0;
    for (const film::FilmTension& t : films.tensions) tension = std::max(tension, t.factor);
    return capillary_step_limit(options_.kernel, options_.smoothing_length, films.edge_length,
                                tension * options_.compat.velocity_factor * films.material.surface_tension,
                                films.material.air_density);
}

const Flow& VortexSheetSolver::observed() const {
    if (!observed_) observed_ = flow_of(mesh(), sheet_geometry(mesh(), topology_), time_, loose_);
    return *observed_;
}

std::vector<sim::Event> VortexSheetSolver::take_events() { return std::exchange(events_, {}); }

}  // namespace lamella::vortex_sheet
