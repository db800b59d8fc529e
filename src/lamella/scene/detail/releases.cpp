#include "lamella/scene/detail/releases.h"

#include "lamella/core/random.h"
#include "lamella/scene/detail/table_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::scene::detail {

void add_releases(film::Problem& problem, const FilmTables& tables, const sim::Node& root, std::uint64_t seed) {
    for (std::size_t k = 0; k < tables.faucets.size(); ++k) {
        const FaucetTable& faucet = tables.faucets[k];
        if (!(faucet.radius > 0.0))
            throw InputError(place(root, "faucet", k), "faucet.radius is missing: of its bubbles, e.g. \"1 cm\"");
        for (int n = 0; n < faucet.count; ++n) {
            const double u = uniform01(random_bits(seed, RandomStream::kFaucet, k, static_cast<std::uint64_t>(n)));
            problem.releases.push_back({.time = faucet.start + n * faucet.interval,
                                        .center = faucet.center,
                                        .radius = faucet.radius * (1.0 + faucet.radius_spread * (2.0 * u - 1.0)),
                                        .velocity = faucet.velocity});
        }
    }
    std::stable_sort(problem.releases.begin(), problem.releases.end(),
                     [](const auto& a, const auto& b) { return a.time < b.time; });
    for (film::Release& release : problem.releases) {
        release.region = static_cast<mesh::RegionId>(problem.mesh.regions.size());
        problem.mesh.regions.push_back(
            {mesh::RegionKind::kClosed, 4.0 / 3.0 * std::numbers::pi * std::pow(release.radius, 3)});
    }
}

}  // namespace lamella::scene::detail
