#include "lamella/solvers/equilibrium/equilibrium_solver.h"

#include "lamella/core/error.h"
#include "lamella/core/random.h"
#include "lamella/film/bursting.h"
#include "lamella/mesh/area.h"
#include "lamella/sim/mesh_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella::equilibrium {

using mesh::RegionId;
using mesh::RegionKind;

EquilibriumSolver::EquilibriumSolver(const Options& options, const sim::SolverInput& input)
    : options_(options), input_(input) {
    if (!input_.films) throw InputError("the scene has no films; add a [[bubble]], [[film]] or [foam]");
    film::refuse_what_melp_alone_knows(*input_.films, "equilibrium");
    if (options_.anneal_rounds > 0 && input_.films->mesh.periodic())
        throw InputError("equilibrium.anneal_rounds: a foam in a periodic box cannot change its triangles");
}

RelaxationOptions EquilibriumSolver::relaxation_options() const {
    RelaxationOptions options;
    options.edge_length = input_.films->edge_length;
    options.tension = input_.films->tensions;
    options.goal = options_.goal;
    options.flow_step = options_.flow_step;
    options.tolerance = options_.tolerance;
    options.coarse_faces = options_.coarse_faces;
    options.merging = options_.merging;
    options.separating = options_.separating;
    return options;
}

void EquilibriumSolver::start(const sim::StartContext&) {
    relaxation_ = std::make_unique<Relaxation>(input_.films->mesh, relaxation_options());
    apply_events();
}

sim::StepReport EquilibriumSolver::advance(double time_limit) {
    const double before = time_;
    if (!relaxation_->at_rest() || !answer_) {
        relax();
        ++steps_;
        return {.iterations = 1, .residual = relaxation_->residual()};
    }
    if (annealing()) {
        anneal();
        return {.iterations = 1};
    }
    const auto& events = input_.films->events;
    ++steps_;
    if (next_event_ < events.size() && events[next_event_].time <= time_) {  // what is seen at its time is the rest before
        apply_events();
        return {.iterations = 1};
    }
    time_ = next_event_ < events.size() ? std::min(time_limit, events[next_event_].time) : time_limit;
    return {.step = time_ - before};
}

void EquilibriumSolver::relax() {
    if (!relaxation_->at_rest()) {
        constexpr int kLongestRound = 150;  // shaken too hard: not worth more steps
        if (annealing() && !best_mesh_.faces.empty() && steps_to_rest_ > kLongestRound) return give_up_round();
        if (++steps_to_rest_ > options_.max_steps)
            throw NumericalError(fmt::format(
                "the films did not come to rest in {} steps (residual {:.2g}); raise equilibrium.max_steps, or make "
                "resolution.edge_length smaller where bubbles are small",
                options_.max_steps, relaxation_->residual()));
        relaxation_->advance();
        collect_events();
    }
    if (relaxation_->at_rest()) come_to_rest();
}

void EquilibriumSolver::come_to_rest() {
    steps_to_rest_ = 0;
    if (annealing()) {  // examined at the end only
        answer_.emplace();
        return;
    }
    answer_ = rest_answer(relaxation_->mesh(), input_.films->tensions,
                          {options_.goal, options_.eigenvalue, options_.angle_tolerance});
}

/// One round: shaken volumes come to rest, then the true ones do; the smaller area stays.
void EquilibriumSolver::anneal() {
    answer_.reset();
    if (anneal_ == Anneal::kShaken) {
        anneal_ = Anneal::kRest;
        const auto& regions = best_mesh_.regions;
        for (const RegionId r : regions.ids())
            if (regions[r].kind == RegionKind::kClosed)
                relaxation_->set_target_volume(r, regions[r].target_volume);
        return;
    }
    const double area = mesh::total_area(relaxation_->mesh());
    const bool first = best_mesh_.faces.empty();
    const bool same_bubbles = first || relaxation_->mesh().regions.size() == best_mesh_.regions.size();
    if (!first) ++anneal_round_;
    if (first || (same_bubbles && area < best_area_)) {
        best_area_ = area;
        best_mesh_ = relaxation_->mesh();
        best_edge_ = relaxation_->edge_length();
    } else {
        relaxation_->restart(best_mesh_, best_edge_);
    }
    if (annealing()) shake_volumes();
}

void EquilibriumSolver::give_up_round() {
    ++anneal_round_;
    steps_to_rest_ = 0;
    relaxation_->restart(best_mesh_, best_edge_);
    anneal_ = Anneal::kRest;
    if (annealing()) shake_volumes();
}

void EquilibriumSolver::shake_volumes() {
    anneal_ = Anneal::kShaken;
    for (const RegionId r : best_mesh_.regions.ids()) {
        if (best_mesh_.regions[r].kind != RegionKind::kClosed) continue;
        const double u = uniform01(random_bits(input_.seed, RandomStream::kAnneal,
                                               static_cast<std::uint64_t>(anneal_round_), index(r)));
        relaxation_->set_target_volume(
            r, best_mesh_.regions[r].target_volume * (1.0 + options_.anneal_strength * (2.0 * u - 1.0)));
    }
}

void EquilibriumSolver::apply_events() {
    const auto& events = input_.films->events;
    for (; next_event_ < events.size() && events[next_event_].time <= time_; ++next_event_) apply(events[next_event_]);
}

void EquilibriumSolver::apply(const film::Event& event) {
    const mesh::FoamMesh& films = relaxation_->mesh();
    const auto& regions = films.regions;
    const RegionId region = event.region == film::kRandomBubble
                                ? film::random_outer_bubble(films, input_.seed, next_event_).value_or(mesh::kOutside)
                                : event.region;
    if (index(region) >= regions.size() || regions[region].kind != RegionKind::kClosed) {
        events_.push_back({time_, "skipped", {}, fmt::format("bubble {} is gone already", index(region))});
        return;
    }
    if (event.kind == film::Event::Kind::kInflate) {
        answer_.reset();
        relaxation_->set_target_volume(region, event.volume);
        events_.push_back({time_, "inflate", {}, fmt::format("bubble {}", index(region))});
        return;
    }
    const RegionId into = event.into == film::kLargestNeighbor
                              ? film::largest_neighbor(films, region).value_or(mesh::kOutside)
                              : event.into;
    if (!film::share_film(films, region, into)) {
        events_.push_back({time_, "skipped", {}, fmt::format("regions {} and {} share no film", index(region), index(into))});
        return;
    }
    answer_.reset();
    relaxation_->pop(region, into);
    collect_events();
}

void EquilibriumSolver::collect_events() {
    for (const mesh::TopologyEvent& event : relaxation_->take_events())
        events_.push_back({time_, std::string(mesh::name(event.kind)), event.position,
                           fmt::format("regions {} {}", index(event.a), index(event.b))});
}

std::optional<std::string> EquilibriumSolver::stop_reason() const {
    if (input_.end_time > 0.0 || !answer_ || annealing() || next_event_ < input_.films->events.size())
        return std::nullopt;
    return "the films are at rest";
}

std::vector<sim::Event> EquilibriumSolver::take_events() { return std::exchange(events_, {}); }

void EquilibriumSolver::save(sim::StateWriter& out) const {
    out.write_value("time", time_);
    out.write_value("steps", steps_);
    out.write_value("next_event", static_cast<std::int64_t>(next_event_));
    out.write_value("steps_to_rest", static_cast<std::int64_t>(steps_to_rest_));
    out.write_value("has_answer", static_cast<std::int64_t>(answer_ ? 1 : 0));
    out.write_value("anneal", static_cast<std::int64_t>(anneal_));
    out.write_value("anneal_round", static_cast<std::int64_t>(anneal_round_));
    out.write_value("best_area", best_area_);
    out.write_value("best_edge", best_edge_);
    sim::save_mesh(out, "best", best_mesh_);
    relaxation_->save(out);
}

void EquilibriumSolver::load(sim::StateReader& in) {
    time_ = in.read_double("time");
    steps_ = in.read_integer("steps");
    next_event_ = static_cast<std::size_t>(in.read_integer("next_event"));
    steps_to_rest_ = static_cast<int>(in.read_integer("steps_to_rest"));
    const bool has_answer = in.read_integer("has_answer") != 0;
    anneal_ = in.read_integer("anneal") == 0 ? Anneal::kRest : Anneal::kShaken;
    anneal_round_ = static_cast<int>(in.read_integer("anneal_round"));
    best_area_ = in.read_double("best_area");
    best_edge_ = in.read_double("best_edge");
    best_mesh_ = sim::load_mesh(in, "best");
    relaxation_ = std::make_unique<Relaxation>(in, relaxation_options());
    const int steps = steps_to_rest_;
    if (has_answer) come_to_rest();
    steps_to_rest_ = steps;
}

}  // namespace lamella::equilibrium
