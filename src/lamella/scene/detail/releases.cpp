#include "lamella/scene/detail/releases.h"

#include "lamella/core/random.h"
#include "lamella/scene/detail/table_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::scene::detail {
namespace {

/// A place in the disk of radius faucet.width across its velocity, evenly distributed over its area.
Vec3 place_of(const FaucetTable& faucet, const RandomBits& bits) {
    const double speed = norm(faucet.velocity);
    const Vec3 axis = speed > 0.0 ? faucet.velocity / speed : Vec3{{0.0, 0.0, 1.0}};
    const Vec3 aside = std::abs(axis[2]) < 0.9 ? Vec3{{0.0, 0.0, 1.0}} : Vec3{{1.0, 0.0, 0.0}};
    const Vec3 e1 = cross(axis, aside) / norm(cross(axis, aside)), e2 = cross(axis, e1);
    const double r = faucet.width * std::sqrt(uniform01(bits, 0)), angle = 2.0 * std::numbers::pi * uniform01(bits, 1);
    return faucet.center + r * (std::cos(angle) * e1 + std::sin(angle) * e2);
}

}  // namespace

void add_releases(film::Problem& problem, const FilmTables& tables, const sim::Node& root, std::uint64_t seed) {
    for (std::size_t k = 0; k < tables.faucets.size(); ++k) {
        const FaucetTable& faucet = tables.faucets[k];
        if (!(faucet.radius > 0.0))
            throw InputError(place(root, "faucet", k), "faucet.radius is missing: of its bubbles, e.g. \"1 cm\"");
        for (int n = 0; n < faucet.count; ++n) {
            const auto draw = [&](std::uint32_t d) {
                return random_bits(seed, RandomStream::kFaucet, k, static_cast<std::uint64_t>(n), d);
            };
            const double u = uniform01(draw(0));
            problem.releases.push_back({.time = faucet.start + n * faucet.interval,
                                        .center = place_of(faucet, draw(1)),
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
