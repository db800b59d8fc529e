// Black spots that come to a film on the way.

#include "lamella/core/random.h"
#include "lamella/solvers/melp/melp_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace lamella::melp {
namespace {

/// The fine particle that is nearest to the center; with a spread one of those within it, drawn.
std::optional<std::size_t> middle_of(const film::Event& event, const FineParticles& fine, double draw) {
    std::vector<std::size_t> near;
    std::optional<std::size_t> nearest;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < fine.size(); ++p) {
        const double square = squared_norm(fine.position[p] - event.center);
        if (square <= event.spread * event.spread) near.push_back(p);
        if (square >= least) continue;
        least = square;
        nearest = p;
    }
    if (event.spread == 0.0) return nearest;
    if (near.empty()) return {};
    return near[std::min(near.size() - 1, static_cast<std::size_t>(draw * static_cast<double>(near.size())))];
}

}  // namespace

/// The liquid of a spot goes to the film around it, by the share of what is there, with its momentum and its heat;
/// surfactant stays.
void MelpSolver::thin_out(const film::Event& event) {
    constexpr double kAround = 1.6;    // radii of the spot
    constexpr double kAgreeing = 0.2;  // least cosine between normals of one film
    const double draw = uniform01(random_bits(input_.seed, RandomStream::kFilmParticle, 2, next_event_));
    const std::optional<std::size_t> middle = middle_of(event, fine_, draw);
    std::vector<std::size_t> spot, around;
    for (std::size_t p = 0; middle && p < fine_.size(); ++p) {
        if (fine_.region[p] != fine_.region[*middle]) continue;
        if (dot(fine_.normal[p], fine_.normal[*middle]) < kAgreeing) continue;
        const double distance = norm(fine_.position[p] - fine_.position[*middle]);
        if (distance < kAround * event.radius) (distance < event.radius ? spot : around).push_back(p);
    }
    double there = 0.0;
    for (const std::size_t p : around) there += fine_.liquid_volume[p];
    if (spot.empty() || there == 0.0) {
        events_.push_back({time_, "skipped", event.center, "no film for a black spot"});
        return;
    }
    const std::vector<double> film = transfer_->at_fine(films_.thickness);
    double liquid = 0.0, heat = 0.0;
    Vec3 momentum;
    for (const std::size_t p : spot) {
        if (film[p] <= options_.start.spot_thickness) continue;  // thin enough, or a drop in the air
        const double kept = options_.start.spot_thickness / film[p];
        const double goes = (1.0 - kept) * fine_.liquid_volume[p];
        liquid += goes;
        heat += goes * fine_.temperature[p];
        momentum += goes * fine_.velocity[p];
        fine_.liquid_volume[p] -= goes;
        fine_.thickness[p] = options_.start.spot_thickness;
    }
    const double grown = 1.0 + liquid / there;
    for (const std::size_t p : around) {
        fine_.velocity[p] = (fine_.velocity[p] + momentum / there) / grown;
        fine_.temperature[p] = (fine_.temperature[p] + heat / there) / grown;
        fine_.liquid_volume[p] *= grown;
        fine_.thickness[p] *= grown;
    }
    events_.push_back({time_, "spot", fine_.position[*middle], fmt::format("{:.4g} m^3 of liquid go from it", liquid)});
    update_liquid();
}

}  // namespace lamella::melp
