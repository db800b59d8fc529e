#include "lamella/solvers/melp/foam.h"

#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/point_grid.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace lamella::melp {
namespace {

constexpr double kShared = 0.5;  // of another region's film at a particle: it lies on a partition

void add(std::vector<Share>& shares, std::int32_t region, double gamma) {
    for (Share& share : shares)
        if (share.region == region) {
            share.gamma += gamma;
            return;
        }
    shares.push_back({region, gamma});
}

double gamma_of(const std::vector<Share>& shares, std::size_t region) {
    for (const Share& share : shares)
        if (static_cast<std::size_t>(share.region) == region) return share.gamma;
    return 0.0;
}

}  // namespace

std::vector<Share> shares_at(const CoarseParticles& coarse, const Geometry& g, std::size_t i) {
    std::vector<Share> shares;
    const Neighbors& other = g.neighbors.other;
    for (std::size_t k = other.begin(i); k < other.end(i); ++k)
        add(shares, coarse.region[other.index[k]], g.area[other.index[k]] * other.weight[k]);
    return shares;
}

std::vector<double> shared_film(const CoarseParticles& coarse, const Geometry& g, std::size_t regions, std::size_t r) {
    std::vector<double> area(regions, 0.0);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        if (static_cast<std::size_t>(coarse.region[i]) != r) continue;
        const std::vector<Share> shares = shares_at(coarse, g, i);
        double all = 0.0;
        for (const Share& share : shares) all += share.gamma;
        for (const Share& share : shares)
            area[static_cast<std::size_t>(share.region)] += g.area[i] * share.gamma / std::max(all, 1.0);
        area[r] += g.area[i] * std::max(1.0 - all, 0.0);
    }
    return area;
}

std::vector<std::uint8_t> on_partition(const CoarseParticles& coarse, const Geometry& g, std::size_t a, std::size_t b) {
    std::vector<std::uint8_t> marked(coarse.size(), 0);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const auto mine = static_cast<std::size_t>(coarse.region[i]);
        if (mine != a && mine != b) continue;
        marked[i] = gamma_of(shares_at(coarse, g, i), mine == a ? b : a) > kShared ? 1 : 0;
    }
    return marked;
}

std::vector<std::uint8_t> hand_over(const CoarseParticles& coarse,
                                    const Geometry& g,
                                    std::size_t r,
                                    FineParticles& fine) {
    std::vector<std::uint8_t> marked(fine.size(), 0);
    const FilmKernel kernel = g.neighbors.same.kernel;
    const double reach = kernel.support_radius;
    const PointGrid grid(coarse.position, 0.5 * reach);
    for (std::size_t p = 0; p < fine.size(); ++p) {
        if (static_cast<std::size_t>(fine.region[p]) != r) continue;
        std::vector<Share> shares;
        grid.for_each_near(fine.position[p], reach, [&](std::uint32_t i) {
            const double square = squared_norm(coarse.position[i] - fine.position[p]);
            if (static_cast<std::size_t>(coarse.region[i]) != r && square < reach * reach)
                add(shares, coarse.region[i], g.area[i] * kernel.value(square));
        });
        const auto most = std::max_element(shares.begin(), shares.end(),
                                           [](const Share& x, const Share& y) { return x.gamma < y.gamma; });
        if (most == shares.end() || most->gamma < kShared) {
            marked[p] = 1;
            continue;
        }
        fine.region[p] = most->region;
        fine.normal[p] = -fine.normal[p];  // it faced the bubble that takes it
    }
    return marked;
}

void gather_on_border(const CoarseParticles& coarse,
                      const std::vector<std::uint8_t>& marked,
                      std::size_t a,
                      std::size_t b,
                      double spacing,
                      FineParticles& fine) {
    const PointGrid grid(coarse.position, spacing);
    const auto is_of = [&](std::int32_t region, std::size_t r) { return static_cast<std::size_t>(region) == r; };
    for (std::size_t p = 0; p < fine.size(); ++p) {
        if (!is_of(fine.region[p], a) && !is_of(fine.region[p], b)) continue;
        // The nearest of all, and the nearest that stays, farther and farther out.
        double nearest = std::numeric_limits<double>::infinity();
        std::uint32_t own = 0;
        std::optional<std::uint32_t> stays;
        double distance = nearest;
        for (double reach = 2.0 * spacing; !stays && reach < 1e3 * spacing; reach *= 2.0)
            grid.for_each_near(fine.position[p], reach, [&](std::uint32_t i) {
                if (!is_of(coarse.region[i], a) && !is_of(coarse.region[i], b)) return;
                const double square = squared_norm(coarse.position[i] - fine.position[p]);
                if (square < nearest) {
                    nearest = square;
                    own = i;
                }
                if (marked[i] == 0 && square < distance) {
                    distance = square;
                    stays = i;
                }
            });
        if (nearest == std::numeric_limits<double>::infinity() || marked[own] == 0 || !stays) continue;
        // Beside the one that stays as they lay beside their own: on one spot they would never part again, and their
        // surfactant would drive a flow away from there without end.
        const Vec3& normal = coarse.frame_normal[*stays];
        const Vec3 beside = fine.position[p] - coarse.position[own];
        fine.position[p] = coarse.position[*stays] + beside - dot(beside, normal) * normal;
        fine.normal[p] = normal;
    }
}

std::size_t flipped_normals(const CoarseParticles& coarse,
                            const Geometry& g,
                            const std::vector<Gas>& gas,
                            double spacing) {
    constexpr double kNext = 1.5;  // spacings
    const double reach = kNext * spacing;
    const PointGrid grid(coarse.position, reach);
    std::vector<std::uint8_t> flipped(coarse.size(), 0);
    for_each_particle(coarse.size(), [&](std::size_t i) {
        double agree = 0.0;
        grid.for_each_near(coarse.position[i], reach, [&](std::uint32_t j) {
            if (j != i && coarse.region[i] == coarse.region[j] &&
                squared_norm(coarse.position[i] - coarse.position[j]) < reach * reach)
                agree += dot(g.normal[i], g.normal[j]);
        });
        flipped[i] = agree < 0.0 ? 1 : 0;
    });
    std::vector<double> volume(gas.size(), 0.0);
    std::vector<Vec3> any(gas.size());
    for (std::size_t i = 0; i < coarse.size(); ++i)
        any[static_cast<std::size_t>(coarse.region[i])] = coarse.position[i];
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const auto r = static_cast<std::size_t>(coarse.region[i]);
        volume[r] += g.area[i] * dot(coarse.position[i] - any[r], g.normal[i]);
    }
    std::size_t count = 0;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const auto r = static_cast<std::size_t>(coarse.region[i]);
        count += gas[r].closed && !gas[r].burst && !gas[r].held && !(volume[r] > 0.0) ? 1 : flipped[i];
    }
    return count;
}

}  // namespace lamella::melp
