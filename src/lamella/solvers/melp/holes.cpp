// Films of the solver that burst.

#include "lamella/solvers/melp/bursting.h"
#include "lamella/solvers/melp/melp_solver.h"
#include "lamella/solvers/melp/solids.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::melp {

std::vector<std::uint8_t> MelpSolver::burst_regions() const {
    std::vector<std::uint8_t> burst;
    for (const Gas& gas : gas_) burst.push_back(gas.burst ? 1 : 0);
    return burst;
}

bool MelpSolver::any_burst() const {
    return std::any_of(gas_.begin(), gas_.end(), [](const Gas& gas) { return gas.burst; });
}

/// Taylor and Culick's, of the thinnest film that has burst [m/s].
double MelpSolver::fastest_edge() const {
    double fastest = 0.0;
    for (std::size_t i = 0; i < coarse_.size(); ++i)
        if (gas_[static_cast<std::size_t>(coarse_.region[i])].burst)
            fastest = std::max(fastest, 2.0 * films_.tension[i] / (liquid_density() * films_.thickness[i]));
    return std::sqrt(fastest);
}

/// A film bursts until it is gone or at rest on its rims.
double MelpSolver::slow_motion() const {
    constexpr double kAtRest = 0.1;  // of the speed of edges
    double fastest = 0.0;
    for (std::size_t i = 0; i < coarse_.size(); ++i)
        if (gas_[static_cast<std::size_t>(coarse_.region[i])].burst)
            fastest = std::max(fastest, norm(coarse_.velocity[i]));
    return fastest > kAtRest * fastest_edge() ? options_.slow_motion : 1.0;
}

void MelpSolver::pull_edges(double dt) {
    if (!any_burst()) return;
    const std::vector<double> strength = edge_strength(geometry_, coarse_);
    const auto zone = edge_zone(geometry_, coarse_, strength, burst_regions());
    std::vector<double> mass = films_.liquid_volume;
    for (double& m : mass) m *= liquid_density();
    const std::vector<Vec3> pull =
        shared_acceleration(geometry_, edge_pull(geometry_, coarse_, films_.tension, zone), mass);
    for (std::size_t i = 0; i < coarse_.size(); ++i) coarse_.velocity[i] += dt * pull[i];
}

/// Edges gather coarse particles as they gather liquid: those too many go, and those that have lost their liquid to
/// others. Shreds and the last bit of a film break up into drops: the gas would blow away what nothing holds.
void MelpSolver::clear_edges() {
    if (!any_burst()) return;
    constexpr std::size_t kFewest = 8, kShred = 4;  // particles; neighbors: a thread has six
    const Neighbors& same = geometry_.neighbors.same;
    auto marked = crowded(geometry_, coarse_, edge_strength(geometry_, coarse_), burst_regions(), spacing_);
    std::vector<std::size_t> left(gas_.size(), 0);
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        if (!gas_[static_cast<std::size_t>(coarse_.region[i])].burst) continue;
        if (films_.dry[i] != 0 || same.end(i) - same.begin(i) < kShred) marked[i] = 1;
    }
    for (std::size_t i = 0; i < coarse_.size(); ++i) left[static_cast<std::size_t>(coarse_.region[i])] += 1 - marked[i];
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        const auto r = static_cast<std::size_t>(coarse_.region[i]);
        if (gas_[r].burst && left[r] < kFewest) marked[i] = 1;
    }
    if (std::none_of(marked.begin(), marked.end(), [](std::uint8_t m) { return m != 0; })) return;
    remove(coarse_, marked);
    update_shape();
}

/// Gas of a bubble that has burst leaves through the hole as through an orifice, area * 0.6 sqrt(2 p / rho_air), and no
/// faster than films push it: the film does not fall in, as it would with nothing behind it.
void MelpSolver::vent(double dt) {
    constexpr double kContraction = 0.6;
    std::vector<Vec3> open(gas_.size());
    std::vector<double> left(gas_.size(), 0.0);
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        const auto r = static_cast<std::size_t>(coarse_.region[i]);
        open[r] += geometry_.area[i] * geometry_.normal[i];
        left[r] += geometry_.area[i];
    }
    for (std::size_t r = 0; r < gas_.size(); ++r) {
        Gas& gas = gas_[r];
        if (!gas.closed || !gas.burst) continue;
        const double outside = options_.outside_pressure, gauge = gas.gauge_pressure(outside);
        const double air = std::max(input_.films->material.air_density, 1e-3);
        const double speed = kContraction * std::sqrt(2.0 * std::abs(gauge) / air);
        const double flow = dt * norm(open[r]) * std::copysign(speed, gauge) * (outside + gauge);
        const double balanced = outside * gas.volume;
        gas.amount = gauge > 0.0 ? std::max(gas.amount - flow, balanced) : std::min(gas.amount - flow, balanced);
        if (left[r] == 0.0) gas.closed = false;
    }
}

void MelpSolver::apply_events() {
    const auto& events = input_.films->events;
    for (; next_event_ < events.size() && events[next_event_].time <= time_; ++next_event_) apply(events[next_event_]);
}

void MelpSolver::apply(const film::Event& event) {
    if (event.kind == film::Event::Kind::kSpot) return thin_out(event);
    if (is_foam()) return pop(event);
    std::size_t at = coarse_.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        const Gas& gas = gas_[static_cast<std::size_t>(coarse_.region[i])];
        double value = 0.0;
        if (event.kind == film::Event::Kind::kPuncture)
            value = squared_norm(coarse_.position[i] - event.center);
        else if (gas.burst || gas.region != static_cast<std::int32_t>(index(event.region)))
            continue;
        else
            value = films_.thickness[i];
        if (value >= least) continue;
        least = value;
        at = i;
    }
    if (at == coarse_.size()) {
        events_.push_back({time_, "skipped", event.center, "the film is gone already"});
        return;
    }
    const bool puncture = event.kind == film::Event::Kind::kPuncture;
    burst(at, event.radius, puncture ? "puncture" : "pop");
}

/// Dry solids burst what they touch.
void MelpSolver::burst_on_solids() {
    while (const std::optional<std::size_t> at = touching(bodies_, coarse_, gas_)) {
        if (is_foam())
            delete_bubble(static_cast<std::size_t>(coarse_.region[*at]));
        else
            burst(*at, 0.0, "puncture");
    }
}

/// Opens a hole in the film around a coarse particle; one of radius 0 is as small as the spacing lets it be.
void MelpSolver::burst(std::size_t at, double radius, const std::string& kind) {
    constexpr double kSmallest = 2.0;  // spacings: smaller ones close again, as real ones smaller than the film's
                                       // thickness do
    Gas& gas = gas_[static_cast<std::size_t>(coarse_.region[at])];
    gas.burst = true;
    events_.push_back({time_, kind, coarse_.position[at], fmt::format("film of region {}", gas.region)});
    remove(coarse_, open_hole(coarse_, fine_, at, std::max(radius, kSmallest * spacing_)));
    update_shape();
    update_liquid();
}

}  // namespace lamella::melp
