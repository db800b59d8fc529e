#include "lamella/solvers/equilibrium/relaxation.h"

#include "lamella/core/error.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/plateau_faults.h"
#include "lamella/mesh/quality.h"
#include "lamella/mesh/smoothing.h"
#include "lamella/mesh/staged_move.h"
#include "lamella/mesh/subdivide.h"
#include "lamella/mesh/volume.h"
#include "lamella/sim/mesh_archive.h"
#include "lamella/solvers/equilibrium/curvature_flow.h"
#include "lamella/solvers/equilibrium/newton.h"
#include "lamella/solvers/equilibrium/rest_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella::equilibrium {
namespace {

using mesh::FoamMesh;
using mesh::RegionKind;
using mesh::VertexId;

/// Newton's steps through the tracker fall back when soft modes are left: then the mesh is frozen early.
constexpr int kMostSlowSteps = 5;
constexpr double kPi = 3.14159265358979323846;

bool has_wires(const FoamMesh& mesh) {
    return std::any_of(mesh.on_wire.begin(), mesh.on_wire.end(), [](std::uint8_t w) { return w != 0; });
}

/// Radius of the ball of the smallest target volume, or 0 without closed regions [m].
double smallest_radius(const FoamMesh& mesh) {
    double volume = 0.0;
    for (const mesh::Region& r : mesh.regions)
        if (r.kind == RegionKind::kClosed && (volume == 0.0 || r.target_volume < volume)) volume = r.target_volume;
    return std::cbrt(0.75 * volume / kPi);
}

double film_area(const FoamMesh& mesh) {
    double area = 0.0;
    for (const mesh::FaceId f : mesh.faces.ids())
        area += 0.5 * norm(cross(mesh.corner(f, 1) - mesh.corner(f, 0), mesh.corner(f, 2) - mesh.corner(f, 0)));
    return area;
}

/// How often the wanted edge length is doubled for the first mesh.
int coarse_levels(const FoamMesh& mesh, const RelaxationOptions& options) {
    if (mesh.periodic() || options.goal == Goal::kStationary) return 0;
    if (has_wires(mesh)) return 0;  // the rims keep their vertices
    constexpr double kFacePerSquareEdge = 0.4330127018922193;  // sqrt(3) / 4
    constexpr double kLongestEdge = 0.4;                       // of the smallest bubble's radius
    const double faces = film_area(mesh) / (kFacePerSquareEdge * options.edge_length * options.edge_length);
    int levels = 0;
    for (double h = options.edge_length, f = faces;
         f > options.coarse_faces && 2.0 * h < kLongestEdge * smallest_radius(mesh); h *= 2.0, f /= 4.0)
        ++levels;
    return levels;
}

RestSystem flat_system(const FoamMesh& mesh, const RelaxationOptions& options) {
    return RestSystem(mesh, mesh::edge_faces(mesh), flat_patches(mesh, options.tension));
}

}  // namespace

Relaxation::Relaxation(FoamMesh mesh, const RelaxationOptions& options) : options_(options) {
    const double coarse = options.edge_length * std::ldexp(1.0, coarse_levels(mesh, options));
    for (const mesh::Region& r : mesh.regions) gas_.push_back(r.kind == RegionKind::kClosed ? r.target_volume : 0.0);
    take(std::move(mesh), coarse);
}

void Relaxation::take(FoamMesh mesh, double edge_length) {
    edge_length_ = edge_length;
    if (mesh.periodic() || options_.goal == Goal::kStationary) {
        frozen_ = std::move(mesh);
        return;
    }
    mesh::TrackerOptions options;
    options.edge_length = edge_length;
    options.merging = options_.merging;
    options.separating = options_.separating;
    tracker_ = std::make_unique<mesh::Tracker>(std::move(mesh), options);
    tracker_->hold(crossings_.held());
}

void Relaxation::restart(FoamMesh mesh, double edge_length) {
    gas_.clear();
    for (const mesh::Region& r : mesh.regions) gas_.push_back(r.kind == RegionKind::kClosed ? r.target_volume : 0.0);
    crossings_ = {};
    take(std::move(mesh), edge_length);
    stage_ = Stage::kFlow;
}

void Relaxation::advance() {
    if (at_rest()) return;
    ++steps_;
    if (!tracker_) return settle_frozen();
    measure();
    if (residual_ > options_.flow_until || failed_settles_ > 0) {
        stage_ = Stage::kFlow;
        failed_settles_ = std::max(0, failed_settles_ - 1);
        flow();
    } else if (residual_ > options_.freeze_at && slow_steps_ < kMostSlowSteps) {
        stage_ = Stage::kNewton;
        slow_steps_ = residual_ > 0.5 * best_residual_ ? slow_steps_ + 1 : 0;
        best_residual_ = std::min(residual_, best_residual_);
        newton();
    } else {
        settle();
        slow_steps_ = 0;
        best_residual_ = 1.0;
    }
    heed(tracker_->take_events());
}

/// Air of the outside that the films happen to lock in between bubbles belongs to nobody: when such a cavity is too small
/// to be seen and goes to a bubble, that bubble keeps the volume it was given. Gas of bubbles is never lost.
void Relaxation::heed(const std::vector<mesh::TopologyEvent>& events) {
    using Kind = mesh::TopologyEvent::Kind;
    gas_.resize(mesh().regions.size(), 0.0);
    for (const mesh::TopologyEvent& event : events) {
        events_.push_back(event);
        if (event.kind == Kind::kT1 && crossings_.note_parting(event, edge_length_) && tracker_)
            tracker_->hold(crossings_.held());
        const bool own_gas = event.a != mesh::kOutside && gas_[event.a] > 0.0;
        if (event.kind == Kind::kSplit && own_gas) {
            gas_[event.a] = mesh().regions[event.a].target_volume;
            gas_[event.b] = mesh().regions[event.b].target_volume;
        } else if (event.kind == Kind::kPop) {
            gas_[event.a] = 0.0;
            gas_[event.b] = mesh().regions[event.b].target_volume;
        } else if (event.kind == Kind::kAbsorb) {
            if (gas_[event.b] > 0.0) {
                gas_[event.b] += gas_[event.a];
                tracker_->set_target_volume(event.b, gas_[event.b]);
            }
            gas_[event.a] = 0.0;
        }
    }
}

void Relaxation::measure() {
    const RestSystem system = flat_system(mesh(), options_);
    const Balance balance = system.balance();
    const std::vector<double> best = system.best_pressures(balance);
    residual_ = RestSystem::residual(balance, best);
    for (std::size_t r = 0; r < balance.missing.size(); ++r)
        residual_ = std::max(residual_, std::abs(balance.missing[r]) / system.target(r));
}

void Relaxation::tidy() {
    tracker_->move(mesh::tangential_smoothing(mesh()));
    tracker_->remesh();
    RestSystem system = flat_system(mesh(), options_);
    tracker_->move(displacement_to(system.project_volumes(system.patches().position, 2)));
}

IdVector<VertexId, Vec3> Relaxation::displacement_to(const std::vector<Vec3>& position) const {
    IdVector<VertexId, Vec3> displacement(position);
    for (const VertexId v : displacement.ids()) displacement[v] -= mesh().position[v];
    return displacement;
}

double Relaxation::flow_time() const {
    const double radius = smallest_radius(mesh());
    if (radius > 0.0) return options_.flow_step * radius * radius;
    return options_.flow_step * film_area(mesh()) / kPi;
}

void Relaxation::flow() {
    mesh::staged_move(*tracker_, curvature_flow_step(mesh(), options_.tension, flow_time()));
    ++iterations_;
    tidy();
}

void Relaxation::newton() {
    RestSystem system = flat_system(mesh(), options_);
    Newton newton(system, Goal::kMinimum);
    newton.step();
    mesh::staged_move(*tracker_, displacement_to(system.patches().position));
    ++iterations_;
    tidy();
}

void Relaxation::settle() {
    RestSystem system = flat_system(mesh(), options_);
    Newton newton(system, Goal::kMinimum);
    constexpr int kMostSteps = 15;
    const bool converged = newton.solve(options_.tolerance, kMostSteps);
    bool moved_all = false;
    constexpr int kMostMoves = 10;
    for (int k = 0; k < kMostMoves && !moved_all; ++k)
        moved_all = tracker_->move(displacement_to(system.patches().position)).limited == 0;
    keep_pressures(system, newton);
    constexpr double kSliver = 5.0 * kPi / 180.0;  // on sharper faces quadratic patches fail
    if (!converged || !moved_all || mesh::min_angle(mesh()) < kSliver) {
        failed_settles_ = converged ? 0 : 3;
        tidy();
        return;
    }
    if (tracker_changes_topology() || leaves_crossing()) return;
    if (edge_length_ > 1.5 * options_.edge_length) {
        refine();
        return;
    }
    stage_ = Stage::kRest;
}

/// Ten of Newton's steps on the mesh as it is.
void Relaxation::settle_frozen() {
    stage_ = Stage::kNewton;
    RestSystem system = flat_system(mesh(), options_);
    Newton newton(system, options_.goal);
    constexpr int kMostSteps = 10;
    const bool converged = newton.solve(options_.tolerance, kMostSteps);
    frozen_.position.values() = system.patches().position;
    keep_pressures(system, newton);
    if (converged) stage_ = Stage::kRest;
}

void Relaxation::keep_pressures(const RestSystem& system, const Newton& newton) {
    residual_ = newton.last().residual;
    iterations_ += newton.steps();
    pressure_.assign(mesh().regions.size(), 0.0);
    for (std::size_t c = 0; c < newton.pressure().size(); ++c)
        pressure_[index(system.constrained()[c])] = newton.pressure()[c];
}

/// Whether the tracker sees something to merge or to part; if not, the mesh stays as it was.
bool Relaxation::tracker_changes_topology() {
    FoamMesh rested = mesh();
    tracker_->remesh();
    const std::vector<mesh::TopologyEvent> fresh = tracker_->take_events();
    const bool changed = !fresh.empty();
    heed(fresh);
    if (!changed) take(std::move(rested), edge_length_);
    return changed;
}

/// A crossing may balance so that parting it gains nothing at first, as the cone in a cube does: the first of two steps
/// of parting is allowed to cost a little area. A crossing that survives a few tries stays.
bool Relaxation::leaves_crossing() {
    constexpr int kMostTries = 3;
    if (!options_.separating || crossing_tries_ >= kMostTries) return false;
    if (mesh::plateau_faults(mesh(), mesh::edge_faces(mesh())).none()) return false;
    ++crossing_tries_;
    mesh::TrackerOptions generous = tracker_->options();
    generous.separation_cost = 0.05;
    mesh::Tracker parting(mesh(), generous);
    parting.hold(crossings_.held());
    parting.remesh();
    const std::vector<mesh::TopologyEvent> events = parting.take_events();
    take(parting.mesh(), edge_length_);
    heed(events);
    failed_settles_ = 2;  // let the flow take it from there
    return true;
}

void Relaxation::refine() {
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh());
    crossings_ = {};  // smaller films can be seen from here on
    take(mesh::subdivide(mesh(), edges, mesh::edge_middles(mesh(), edges)), 0.5 * edge_length_);
}

/// The foam is about to be another: what would not part before may now.
void Relaxation::forget_crossings() {
    crossings_ = {};
    if (tracker_) tracker_->hold({});
}

std::vector<mesh::TopologyEvent> Relaxation::take_events() { return std::exchange(events_, {}); }

void Relaxation::pop(mesh::RegionId region, mesh::RegionId into) {
    if (!tracker_) throw InputError("films whose mesh stays as it is (periodic, or stationary) cannot burst");
    forget_crossings();
    tracker_->pop(region, into);
    heed(tracker_->take_events());
    stage_ = Stage::kFlow;
}

void Relaxation::set_target_volume(mesh::RegionId region, double volume) {
    if (tracker_) tracker_->set_target_volume(region, volume);
    else frozen_.regions[region].target_volume = volume;
    gas_[region] = volume;
    forget_crossings();
    stage_ = Stage::kFlow;
}

Relaxation::Relaxation(sim::StateReader& in, const RelaxationOptions& options) : options_(options), crossings_(in) {
    take(sim::load_mesh(in, "mesh"), in.read_double("relaxation/edge_length"));
    const std::int64_t stage = in.read_integer("relaxation/stage");
    if (stage < 0 || stage > static_cast<std::int64_t>(Stage::kRest))
        throw InputError(fmt::format("relaxation/stage = {} is no stage", stage));
    stage_ = static_cast<Stage>(stage);
    residual_ = in.read_double("relaxation/residual");
    best_residual_ = in.read_double("relaxation/best_residual");
    steps_ = static_cast<int>(in.read_integer("relaxation/steps"));
    iterations_ = static_cast<int>(in.read_integer("relaxation/iterations"));
    failed_settles_ = static_cast<int>(in.read_integer("relaxation/failed_settles"));
    slow_steps_ = static_cast<int>(in.read_integer("relaxation/slow_steps"));
    in.read("relaxation/gas", mesh().regions.size(), gas_.values());
    crossing_tries_ = static_cast<int>(in.read_integer("relaxation/crossing_tries"));
}

void Relaxation::save(sim::StateWriter& out) const {
    sim::save_mesh(out, "mesh", mesh());
    crossings_.save(out);
    out.write_value("relaxation/edge_length", edge_length_);
    out.write_value("relaxation/stage", static_cast<std::int64_t>(stage_));
    out.write_value("relaxation/residual", residual_);
    out.write_value("relaxation/best_residual", best_residual_);
    out.write_value("relaxation/steps", static_cast<std::int64_t>(steps_));
    out.write_value("relaxation/iterations", static_cast<std::int64_t>(iterations_));
    out.write_value("relaxation/failed_settles", static_cast<std::int64_t>(failed_settles_));
    out.write_value("relaxation/slow_steps", static_cast<std::int64_t>(slow_steps_));
    out.write("relaxation/gas", std::span<const double>(gas_.values()));
    out.write_value("relaxation/crossing_tries", static_cast<std::int64_t>(crossing_tries_));
}

}  // namespace lamella::equilibrium
