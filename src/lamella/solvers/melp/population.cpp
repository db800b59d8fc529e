#include "lamella/solvers/melp/population.h"

#include "lamella/solvers/melp/redistribution.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace lamella::melp {
namespace {

constexpr double kStretched = 1.2, kShrunk = 0.8;  // mean area over that at the start
constexpr double kThin = 2.5, kCrowded = 0.3;      // of single particles, over the mean
constexpr double kMost = 0.1;                      // of a region's particles at once
constexpr double kApart = 2.0;                     // spacings between changes of one call

/// The particles of a region that may change, with the region's mean area per particle.
struct Population {
    std::vector<std::uint32_t> members;
    double count = 0.0, area = 0.0;  ///< all of the region's counted [m^2]

    double mean() const { return area / count; }
    /// How many would have to be added for the area `cell` per particle; negative: taken.
    double lack(double cell) const { return area / cell - count; }
    std::size_t most() const { return static_cast<std::size_t>(std::max(kMost * count, 1.0)); }
};

std::vector<Population> populations(const CoarseParticles& coarse, const Geometry& g, std::size_t regions) {
    std::vector<Population> all(regions);
    const Neighbors& other = g.neighbors.other;
    for (std::uint32_t i = 0; i < coarse.size(); ++i) {
        Population& p = all[static_cast<std::size_t>(coarse.region[i])];
        p.count += 1.0;
        p.area += g.area[i];
        if (other.begin(i) == other.end(i)) p.members.push_back(i);
    }
    return all;
}

/// Places that keep their distance from each other.
class Apart {
public:
    explicit Apart(double distance) : square_(distance * distance) {}
    bool take(const Vec3& x) {
        for (const Vec3& y : taken_)
            if (squared_norm(x - y) < square_) return false;
        taken_.push_back(x);
        return true;
    }

private:
    double square_;
    std::vector<Vec3> taken_;
};

/// The middle of the widest gap next to a particle.
struct Gap {
    std::uint32_t beyond = 0;  ///< the particle on its other side
    Vec3 place{};
    double square = 0.0;  ///< distance to the nearest particle, squared [m^2]
};

Gap widest_gap(const CoarseParticles& coarse, const Geometry& g, std::uint32_t i, double spacing) {
    constexpr double kReach = 2.5;  // spacings
    const Neighbors& same = g.neighbors.same;
    const std::vector<Vec3>& x = coarse.position;
    Gap widest;
    for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
        const std::uint32_t j = same.index[k];
        if (squared_norm(x[j] - x[i]) > kReach * kReach * spacing * spacing) continue;
        const Vec3 middle = 0.5 * (x[i] + x[j]);
        double square = 0.25 * squared_norm(x[j] - x[i]);
        for (std::size_t m = same.begin(i); m < same.end(i); ++m)
            square = std::min(square, squared_norm(x[same.index[m]] - middle));
        if (square > widest.square) widest = {j, middle, square};
    }
    return widest;
}

void add_beside(CoarseParticles& coarse, const Geometry& g, std::uint32_t i, const Gap& gap) {
    const Vec3 normal = g.normal[i] + g.normal[gap.beyond];
    coarse.position.push_back(coarse.position[i] + along_patch(g.patch[i], gap.place - coarse.position[i]));
    coarse.frame_normal.push_back(normal / norm(normal));
    coarse.velocity.push_back(0.5 * (coarse.velocity[i] + coarse.velocity[gap.beyond]));
    coarse.region.push_back(coarse.region[i]);
}

void sort_by_area(std::vector<std::uint32_t>& members, const std::vector<double>& area, bool largest_first) {
    std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
        if (area[a] != area[b]) return (area[a] > area[b]) == largest_first;
        return a < b;
    });
}

bool fill_up(CoarseParticles& coarse, const Geometry& g, Population& p, double cell) {
    constexpr double kNearest = 0.45;  // spacings from any other
    const bool stretched = p.mean() > kStretched * cell;
    auto wanted = stretched ? static_cast<std::size_t>(std::max(p.lack(cell), 0.0)) : std::size_t{0};
    wanted = std::min(wanted, p.most());
    const double spacing = std::sqrt(p.mean()), nearest = kNearest * std::sqrt(cell);
    Apart places(kApart * spacing);
    std::size_t added = 0;
    sort_by_area(p.members, g.area, true);
    for (const std::uint32_t i : p.members) {
        if (g.area[i] < kThin * std::max(p.mean(), cell) && added >= wanted) break;
        const Gap gap = widest_gap(coarse, g, i, spacing);
        if (gap.square < nearest * nearest || !places.take(gap.place)) continue;
        add_beside(coarse, g, i, gap);
        ++added;
    }
    return added > 0;
}

/// @param[in,out] marked  those that go
bool thin_out(
    const CoarseParticles& coarse, const Geometry& g, Population& p, double cell, std::vector<std::uint8_t>& marked) {
    constexpr double kFewest = 40.0;
    if (p.count < kFewest) return false;
    const bool shrunk = p.mean() < kShrunk * cell;
    auto wanted = shrunk ? static_cast<std::size_t>(std::max(-p.lack(cell), 0.0)) : std::size_t{0};
    wanted = std::min(wanted, p.most());
    Apart places(kApart * std::sqrt(p.mean()));
    std::size_t taken = 0;
    sort_by_area(p.members, g.area, false);
    for (const std::uint32_t i : p.members) {
        if (g.area[i] > kCrowded * std::min(p.mean(), cell) && taken >= wanted) break;
        if (!places.take(coarse.position[i])) continue;
        marked[i] = 1;
        ++taken;
    }
    return taken > 0;
}

}  // namespace

bool repopulate(CoarseParticles& coarse, const Geometry& g, std::span<const Gas> gas) {
    std::vector<Population> all = populations(coarse, g, gas.size());
    std::vector<std::uint8_t> marked(coarse.size(), 0);
    bool added = false, taken = false;
    for (std::size_t r = 0; r < all.size(); ++r) {
        if (all[r].count == 0.0 || gas[r].burst || !(gas[r].cell > 0.0)) continue;
        taken = thin_out(coarse, g, all[r], gas[r].cell, marked) || taken;
        added = fill_up(coarse, g, all[r], gas[r].cell) || added;
    }
    marked.resize(coarse.size(), 0);
    if (taken) remove(coarse, marked);
    return added || taken;
}

}  // namespace lamella::melp
