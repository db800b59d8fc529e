// Bubbles of a foam that burst, join in one, and enter.

#include "lamella/core/random.h"
#include "lamella/solvers/melp/fine_order.h"
#include "lamella/solvers/melp/foam.h"
#include "lamella/solvers/melp/melp_solver.h"
#include "lamella/solvers/melp/start.h"
#include "lamella/solvers/melp/volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace lamella::melp {
namespace {

constexpr double kLeastFilm = 0.01;  // of a bubble's film: it touches a region with that much

Vec3 center_of(const CoarseParticles& coarse, std::size_t region) {
    Vec3 sum;
    double count = 0.0;
    for (std::size_t i = 0; i < coarse.size(); ++i)
        if (static_cast<std::size_t>(coarse.region[i]) == region) {
            sum += coarse.position[i];
            count += 1.0;
        }
    return sum / std::max(count, 1.0);
}

}  // namespace

bool MelpSolver::is_foam() const {
    const auto& regions = input_.films->mesh.regions;
    return std::count_if(regions.begin(), regions.end(),
                         [](const auto& r) { return r.kind == mesh::RegionKind::kClosed; }) > 1;
}

std::optional<std::size_t> MelpSolver::place_of(mesh::RegionId region) const {
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (!gas_[r].gone && gas_[r].region == static_cast<std::int32_t>(index(region))) return r;
    return std::nullopt;
}

/// A bubble drawn at random among those that touch the outside, all with the same probability.
std::optional<std::size_t> MelpSolver::random_outer_bubble() const {
    std::vector<double> free(gas_.size(), 0.0), all(gas_.size(), 0.0);
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        double gamma = 0.0;
        for (const Share& share : shares_at(coarse_, geometry_, i)) gamma += share.gamma;
        const auto r = static_cast<std::size_t>(coarse_.region[i]);
        free[r] += geometry_.area[i] * std::max(1.0 - gamma, 0.0);
        all[r] += geometry_.area[i];
    }
    std::vector<std::size_t> outer;
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (gas_[r].closed && free[r] > kLeastFilm * all[r]) outer.push_back(r);
    if (outer.empty()) return std::nullopt;
    const double u = uniform01(random_bits(input_.seed, RandomStream::kFilmRupture, 0, next_event_));
    return outer[std::min(outer.size() - 1, static_cast<std::size_t>(u * static_cast<double>(outer.size())))];
}

/// The film between a bubble and another region bursts. [method sheet 10: deletion and merging]
void MelpSolver::pop(const film::Event& event) {
    const auto skip = [&](const std::string& why) { events_.push_back({time_, "skipped", {}, why}); };
    const std::optional<std::size_t> which =
        event.region == film::kRandomBubble ? random_outer_bubble() : place_of(event.region);
    if (!which) return skip("pop: the bubble is gone already, or none touches the outside");
    const std::vector<double> shared = shared_film(coarse_, geometry_, gas_.size(), *which);
    std::optional<std::size_t> into = *which;  // the outside
    if (event.into == film::kLargestNeighbor)
        into = static_cast<std::size_t>(std::max_element(shared.begin(), shared.end()) - shared.begin());
    else if (event.into != mesh::kOutside)
        into = place_of(event.into);
    if (!into || shared[*into] < kLeastFilm * std::accumulate(shared.begin(), shared.end(), 0.0))
        return skip(fmt::format("pop: bubble {} has no film to that region", gas_[*which].region));
    if (*into == *which)
        delete_bubble(*which);
    else
        join_bubbles(*which, *into);
}

/// All films of the bubble go. What it shared stays the neighbors', and they get the liquid that it had in there; that
/// of its film with the outside leaves as drops.
void MelpSolver::delete_bubble(std::size_t r) {
    events_.push_back({time_, "pop", center_of(coarse_, r), fmt::format("bubble {} bursts", gas_[r].region)});
    std::vector<std::uint8_t> marked(coarse_.size(), 0);
    for (std::size_t i = 0; i < coarse_.size(); ++i) {
        if (static_cast<std::size_t>(coarse_.region[i]) != r) continue;
        marked[i] = 1;
        if (even_[r].liquid_volume > 0.0) hand_over_even_film(r, i);
    }
    left_liquid_ += even_[r].liquid_volume;
    even_[r] = {};
    const std::vector<std::uint8_t> drops = hand_over(coarse_, geometry_, r, fine_);
    for (std::size_t p = 0; p < fine_.size(); ++p)
        if (drops[p] != 0) left_liquid_ += fine_.liquid_volume[p];
    remove(fine_, drops);
    remove(coarse_, marked);
    gas_[r].closed = false;
    gas_[r].gone = true;
    renew_after_change();
}

/// What particle i of a film without fine particles has of its region's liquid goes to the regions whose film lies
/// there.
void MelpSolver::hand_over_even_film(std::size_t r, std::size_t i) {
    const std::vector<Share> shares = shares_at(coarse_, geometry_, i);
    double all = 0.0;
    for (const Share& share : shares) all += share.gamma;
    for (const Share& share : shares) {
        EvenFilm& to = even_[static_cast<std::size_t>(share.region)];
        const double part = share.gamma / std::max(all, 1.0) * films_.liquid_volume[i];
        const double soap = part * even_[r].surfactant / even_[r].liquid_volume;
        to.liquid_volume += part;
        to.surfactant += soap;
        even_[r].liquid_volume -= part;
        even_[r].surfactant -= soap;
    }
}

/// The film between bubbles `from` and `into` goes; they are one then, with the gas of both. Its liquid goes to its
/// border.
void MelpSolver::join_bubbles(std::size_t from, std::size_t into) {
    events_.push_back({time_, "pop", center_of(coarse_, from),
                       fmt::format("bubble {} joins {}", gas_[from].region, gas_[into].region)});
    const std::vector<std::uint8_t> marked = on_partition(coarse_, geometry_, from, into);
    gather_on_border(coarse_, marked, from, into, spacing_, fine_);
    const auto rename = [&](std::int32_t& region) {
        if (static_cast<std::size_t>(region) == from) region = static_cast<std::int32_t>(into);
    };
    std::for_each(coarse_.region.begin(), coarse_.region.end(), rename);
    std::for_each(fine_.region.begin(), fine_.region.end(), rename);
    remove(coarse_, marked);
    even_[into].liquid_volume += even_[from].liquid_volume;
    even_[into].surfactant += even_[from].surfactant;
    even_[from] = {};
    Gas &gas = gas_[into], &other = gas_[from];
    gas.calibration = (gas.calibration * gas.volume + other.calibration * other.volume) / (gas.volume + other.volume);
    gas.amount += other.amount;
    gas.volume += other.volume;
    other.closed = false;
    other.gone = true;
    contacts_.rename(static_cast<std::int32_t>(from), static_cast<std::int32_t>(into));
    renew_after_change();
}

void MelpSolver::renew_after_change() {
    sort_fine_particles(fine_, spacing_);
    update_shape();
    follow_contacts(time_);
    update_liquid();
}

/// Bubbles that have touched a wall that bursts them.
void MelpSolver::burst_on_walls() {
    for (const film::Wall& wall : input_.films->walls) {
        if (!wall.bursts) continue;
        for (std::size_t i = 0; i < coarse_.size();) {
            if (dot(coarse_.position[i] - wall.point, wall.normal) <= 0.0) {
                delete_bubble(static_cast<std::size_t>(coarse_.region[i]));
                i = 0;
            } else {
                ++i;
            }
        }
    }
}

/// Whether a bubble could enter: no film is within two spacings of its own, and its center is in none.
bool MelpSolver::is_free(const film::Release& release) const {
    const double reach = release.radius + 2.0 * spacing_;
    for (const Vec3& x : coarse_.position)
        if (squared_norm(x - release.center) < reach * reach) return false;
    for (std::size_t r = 0; r < gas_.size(); ++r)
        if (gas_[r].closed && norm(center_of(coarse_, r) - release.center) < gas_[r].radius()) return false;
    return true;
}

/// Lets bubbles of faucets in whose time has come, and whose place is free.
void MelpSolver::release_bubbles() {
    const auto& releases = input_.films->releases;
    released_.resize(releases.size(), 0);
    for (std::size_t k = 0; k < releases.size() && releases[k].time <= time_; ++k) {
        if (released_[k] != 0 || !is_free(releases[k])) continue;
        released_[k] = 1;
        Start all{std::move(coarse_), std::move(fine_), std::move(gas_), std::move(even_), {}, spacing_};
        append_release(all, *input_.films, options_, releases[k], input_.seed);
        coarse_ = std::move(all.coarse);
        fine_ = std::move(all.fine);
        gas_ = std::move(all.gas);
        even_ = std::move(all.even);
        const auto now = static_cast<std::int32_t>(gas_.size() - 1);
        for (std::size_t p = 0; p < fine_.size(); ++p)
            if (fine_.region[p] == now) initial_liquid_ += fine_.liquid_volume[p];
        initial_liquid_ += even_.back().liquid_volume;
        renew_after_change();
        Gas& gas = gas_.back();
        gas.calibration = gas.volume / particle_volumes(coarse_, geometry_, rims_now_, gas_, joined_).back();
        events_.push_back({time_, "enter", releases[k].center, fmt::format("bubble {}", gas.region)});
    }
}

/// Bubbles of faucets whose time has come and whose place is not free.
std::ptrdiff_t MelpSolver::waiting_bubbles() const {
    std::ptrdiff_t waiting = 0;
    for (std::size_t k = 0; k < released_.size(); ++k)
        if (released_[k] == 0 && input_.films->releases[k].time <= time_) ++waiting;
    return waiting;
}

/// When the next bubble enters that has not come yet [s].
double MelpSolver::next_release() const {
    for (std::size_t k = 0; k < released_.size(); ++k)
        if (released_[k] == 0 && input_.films->releases[k].time > time_) return input_.films->releases[k].time;
    return std::numeric_limits<double>::infinity();
}

}  // namespace lamella::melp
