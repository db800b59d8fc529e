#include "lamella/solvers/melp/solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::melp {
namespace {

/// Where around the solid a particle of a film lies.
struct LoopPoint {
    double angle;
    std::uint32_t particle;
    friend bool operator<(const LoopPoint& a, const LoopPoint& b) {
        return a.angle != b.angle ? a.angle < b.angle : a.particle < b.particle;
    }
};

/// Particles of one film that see their pictures behind the solid, and are near it.
std::vector<std::uint32_t> at_contact(const CoarseParticles& coarse,
                                      const Geometry& geometry,
                                      const film::Body& body,
                                      std::int32_t region,
                                      double reach) {
    constexpr double kSteepest = 0.4;  // of the square of n . outward: as for pictures, whose normals have to agree
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < coarse.size(); ++i) {
        if (coarse.region[i] != region || body.distance(coarse.position[i]) > reach) continue;
        const Vec3 arm = coarse.position[i] - film::nearest_on_axis(body.center, body.arm, coarse.position[i]);
        const double along = dot(arm, geometry.normal[i]);
        if (along * along < kSteepest * squared_norm(arm)) found.push_back(i);
    }
    return found;
}

/// They in the order in which they lie around the middle of the loop, seen from where their normals point; empty if
/// there is a gap.
std::vector<LoopPoint> loop_of(const CoarseParticles& coarse,
                               const Geometry& geometry,
                               const std::vector<std::uint32_t>& particles) {
    constexpr std::size_t kFewest = 8;
    constexpr double kWidestGap = 0.5 * std::numbers::pi;
    std::vector<LoopPoint> loop;
    if (particles.size() < kFewest) return loop;
    Vec3 axis, middle;
    for (const std::uint32_t i : particles) {
        axis += geometry.normal[i];
        middle += coarse.position[i] / static_cast<double>(particles.size());
    }
    if (!(norm(axis) > 0.0)) return loop;
    const Frame frame = frame_of(axis / norm(axis));
    for (const std::uint32_t i : particles) {
        const Vec3 d = coarse.position[i] - middle;
        loop.push_back({std::atan2(dot(d, frame.e2), dot(d, frame.e1)), i});
    }
    std::sort(loop.begin(), loop.end());
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const double next = k + 1 < loop.size() ? loop[k + 1].angle : loop[0].angle + 2.0 * std::numbers::pi;
        if (next - loop[k].angle > kWidestGap) return {};
    }
    return loop;
}

}  // namespace

void append_solids(std::span<const film::Body> bodies, std::span<const Gas> gas, std::vector<RimPiece>& rims) {
    for (const film::Body& body : bodies) {
        if (!body.wet || !body.in_film) continue;
        for (std::size_t r = 0; r < gas.size(); ++r)
            if (gas[r].held)
                rims.push_back({.kind = RimKind::kBall,
                                .region = static_cast<std::int32_t>(r),
                                .a = body.center,
                                .b = body.arm,
                                .radius = body.radius,
                                .velocity_a = body.velocity});
    }
}

void cut_out(std::span<const film::Body> bodies, Sample& sample) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < sample.position.size(); ++i) {
        const bool inside = std::any_of(bodies.begin(), bodies.end(), [&](const film::Body& body) {
            return body.wet && body.in_film && body.distance(sample.position[i]) < 0.0;
        });
        if (inside) continue;
        sample.position[kept] = sample.position[i];
        sample.normal[kept] = sample.normal[i];
        ++kept;
    }
    sample.position.resize(kept);
    sample.normal.resize(kept);
}

void pull_solids(const CoarseParticles& coarse,
                 const Geometry& geometry,
                 std::span<const double> tension,
                 double spacing,
                 std::span<film::Body> bodies) {
    constexpr double kReach = 1.5;  // spacings
    const auto regions = coarse.region.empty() ? 0 : *std::max_element(coarse.region.begin(), coarse.region.end()) + 1;
    for (film::Body& body : bodies) {
        body.force = {};
        if (!body.wet || !body.in_film) continue;
        for (std::int32_t r = 0; r < regions; ++r) {
            const auto loop = loop_of(coarse, geometry, at_contact(coarse, geometry, body, r, kReach * spacing));
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const std::uint32_t i = loop[k].particle, j = loop[(k + 1) % loop.size()].particle;
                const Vec3 normal = 0.5 * (geometry.normal[i] + geometry.normal[j]);
                body.force += (tension[i] + tension[j]) * cross(coarse.position[j] - coarse.position[i], normal);
            }
        }
    }
}

std::optional<std::size_t> touching(std::span<const film::Body> bodies,
                                    const CoarseParticles& coarse,
                                    std::span<const Gas> gas) {
    for (const film::Body& body : bodies) {
        if (body.wet || !body.in_film) continue;
        for (std::size_t i = 0; i < coarse.size(); ++i)
            if (!gas[static_cast<std::size_t>(coarse.region[i])].burst && body.distance(coarse.position[i]) < 0.0)
                return i;
    }
    return std::nullopt;
}

}  // namespace lamella::melp
