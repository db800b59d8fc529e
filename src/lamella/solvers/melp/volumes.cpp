#include "lamella/solvers/melp/volumes.h"

#include "lamella/solvers/melp/loops.h"

namespace lamella::melp {
namespace {

/// What lies at particle i between its film and those of other bubbles that it has pushed through [m^3]: the gases
/// press films of a partition a few tenths of a spacing into each other until cohesion holds them. Negative where they
/// gape.
double overlap_volume(const CoarseParticles& coarse,
                      const Geometry& geometry,
                      std::span<const double> joined,
                      std::size_t i) {
    const Neighbors& other = geometry.neighbors.other;
    double depth = 0.0;
    for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
        const std::size_t j = other.index[k];
        const double share = joined.empty() ? 1.0 : joined[k];
        depth += 0.5 * share * geometry.area[j] * other.weight[k] *
                 dot(coarse.position[i] - coarse.position[j], geometry.normal[i] - geometry.normal[j]);
    }
    return geometry.area[i] * depth;
}

}  // namespace

std::vector<double> particle_volumes(const CoarseParticles& coarse,
                                     const Geometry& geometry,
                                     std::span<const RimPiece> rims,
                                     const std::vector<Gas>& gas,
                                     std::span<const double> joined) {
    std::vector<Vec3> center(gas.size());
    std::vector<double> area(gas.size(), 0.0), volume(gas.size(), 0.0);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const auto r = static_cast<std::size_t>(coarse.region[i]);
        center[r] += geometry.area[i] * coarse.position[i];
        area[r] += geometry.area[i];
    }
    for (std::size_t r = 0; r < gas.size(); ++r) center[r] = center[r] / area[r];
    for (const RimPiece& piece : rims) center[static_cast<std::size_t>(piece.region)] = piece.a;  // in the plate
    std::vector<double> share(coarse.size());
    for_each_particle(coarse.size(), [&](std::size_t i) {
        const Vec3& o = center[static_cast<std::size_t>(coarse.region[i])];
        const Neighbors& other = geometry.neighbors.other;
        share[i] =
            other.begin(i) == other.end(i)
                ? geometry.area[i] * dot(coarse.position[i] - o, geometry.normal[i]) / 3.0
                : geometry.star[i].volume(coarse.position[i], o) - 0.5 * overlap_volume(coarse, geometry, joined, i);
    });
    for (std::size_t i = 0; i < coarse.size(); ++i) volume[static_cast<std::size_t>(coarse.region[i])] += share[i];
    for (std::size_t r = 0; r < gas.size(); ++r) volume[r] *= gas[r].calibration;
    return volume;
}

}  // namespace lamella::melp
