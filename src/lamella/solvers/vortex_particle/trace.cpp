#include "lamella/solvers/vortex_particle/trace.h"

#include "lamella/core/parallel.h"
#include "lamella/core/random.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::vortex_particle {
namespace {

using Place3 = std::array<double, 3>;
/// Of a triangle: how fast barycentric coordinate j grows at its corner k [1/s]. Linear in between.
using Rates = std::array<std::array<double, 3>, 3>;

std::vector<Rates> corner_rates(const Surface& s, std::span<const Vec3> velocity) {
    std::vector<Rates> rates(s.triangles());
    parallel_for(s.triangles(), [&](std::size_t t) {
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) rates[t][j][k] = dot(s.hat_slope[t][j], velocity[s.corner[t][k]]);
    });
    return rates;
}

Place3 rate_at(const Rates& rates, const Place3& b) {
    Place3 r;
    for (std::size_t j = 0; j < 3; ++j) r[j] = rates[j][0] * b[0] + rates[j][1] * b[1] + rates[j][2] * b[2];
    return r;
}

Place3 ahead(const Place3& b, double dt, const Place3& rate) {
    return {b[0] + dt * rate[0], b[1] + dt * rate[1], b[2] + dt * rate[2]};
}

bool inside(const Place3& b) { return b[0] >= 0.0 && b[1] >= 0.0 && b[2] >= 0.0; }

void normalize(Place3& b) {
    for (double& c : b) c = std::max(0.0, c);
    const double sum = b[0] + b[1] + b[2];
    for (double& c : b) c /= sum;
}

/// The vector of a triangle's plane along which barycentric coordinates change by `rate`.
Vec3 vector_of(const Surface& s, std::size_t t, const Place3& rate) {
    return rate[1] * (s.position[s.corner[t][1]] - s.position[s.corner[t][0]]) +
           rate[2] * (s.position[s.corner[t][2]] - s.position[s.corner[t][0]]);
}

Place3 rate_of(const Surface& s, std::size_t t, const Vec3& u) {
    return {dot(s.hat_slope[t][0], u), dot(s.hat_slope[t][1], u), dot(s.hat_slope[t][2], u)};
}

constexpr std::size_t kInsideStill = 3;

/// Whether barycentric coordinate k falls, by more than rounding makes of motion along its edge.
bool sinks(const Place3& rate, std::size_t k) {
    const double most = std::max({std::abs(rate[0]), std::abs(rate[1]), std::abs(rate[2])});
    return rate[k] < -1e-12 * most;
}

/// Over the edge opposite to corner k, which the spot lies on.
void cross_edge(const Surface& s, Spot& spot, std::size_t k, Vec3& displacement) {
    const std::size_t t = spot.triangle;
    const auto next = static_cast<std::uint32_t>(s.neighbor[t][k]);
    const Vec3 along = s.edge(t, k) / norm(s.edge(t, k));
    const Vec3 in = cross(s.normal[next], along), out = cross(s.normal[t], along);
    displacement = dot(displacement, along) * along + dot(displacement, out) * in;
    Place3 place{};
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i)
            if (i != k && s.corner[next][j] == s.corner[t][i]) place[j] = spot.place[i];
    spot = {next, place};
}

/// How a particle goes on over a line where films meet.
struct Passage {
    std::span<const Vec3> velocity;  ///< of vertices [m/s]
    double chance;                   ///< in [0, 1)
    double side = 1.0;               ///< -1: the film that it is on now is seen from the other side of its path
};

/// The direction into triangle t at the edge opposite to corner k, along it.
Vec3 inward(const Surface& s, std::size_t t, std::size_t k) { return s.hat_slope[t][k] / norm(s.hat_slope[t][k]); }

/// A spot on the edge opposite to corner k, seen from a triangle of another film there.
Spot seen_from(const Surface& s, const Spot& spot, std::size_t k, const Incidence& other) {
    Spot seen{other.triangle, {}};
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i)
            if (i != k && j != other.k && s.site[s.corner[other.triangle][j]] == s.site[s.corner[spot.triangle][i]])
                seen.place[j] = spot.place[i];
    return seen;
}

/// Into one of the other films, with a probability as the flow into it is. @returns whether there is any
bool cross_seam(const Surface& s, Spot& spot, std::size_t k, Vec3& displacement, Passage& passage) {
    const std::uint32_t t = spot.triangle;
    const std::span<const Incidence> meeting = s.meeting(t, k);
    const auto inflow = [&](const Incidence& other) {
        if (other.triangle == t) return 0.0;
        const Spot seen = seen_from(s, spot, k, other);
        double flow = 0.0;
        for (std::size_t j = 0; j < 3; ++j)
            flow +=
                seen.place[j] * dot(passage.velocity[s.corner[other.triangle][j]], inward(s, other.triangle, other.k));
        return std::max(0.0, flow);
    };
    double total = 0.0;
    for (const Incidence& other : meeting) total += inflow(other);
    if (!(total > 0.0)) return false;
    double left = passage.chance * total;
    const Incidence* next = nullptr;
    for (const Incidence& other : meeting) {
        const double flow = inflow(other);
        if (flow > 0.0) next = &other;
        if (flow > 0.0 && left < flow) break;
        left -= flow;
    }
    passage.chance = std::fmod(passage.chance * 16.0, 1.0);  // for another line in the same step
    const Vec3 edge = s.edge(t, k), along = edge / norm(edge), out = -inward(s, t, k);
    const Vec3 in = inward(s, next->triangle, next->k);
    displacement = dot(displacement, along) * along + dot(displacement, out) * in;
    // The side from which this film is seen lies in a wedge between it and the other film, or does not.
    const double handed = dot(cross(along, out), s.normal[t]) * dot(cross(along, in), s.normal[next->triangle]);
    if (handed < 0.0) passage.side = -passage.side;
    spot = seen_from(s, spot, k, *next);
    return true;
}

/// As `walk`; with a passage over lines where films meet too.
bool go(const Surface& s, Spot& spot, Vec3 displacement, Passage* passage) {
    constexpr int kMostEdges = 60;
    for (int edge = 0; edge < kMostEdges; ++edge) {
        const std::size_t t = spot.triangle;
        const Place3 rate = rate_of(s, t, displacement);
        std::size_t out = kInsideStill;
        double share = 1.0;  // of the displacement until the first edge
        for (std::size_t k = 0; k < 3; ++k)
            if (sinks(rate, k) && spot.place[k] < -share * rate[k]) {
                share = spot.place[k] / -rate[k];
                out = k;
            }
        spot.place = ahead(spot.place, share, rate);
        if (out == kInsideStill) break;
        spot.place[out] = 0.0;
        normalize(spot.place);
        displacement *= 1.0 - share;
        if (s.neighbor[t][out] == kNoNeighbor) {
            if (s.opening_of(t, out) == Opening::kOutflow) return false;
            if (passage != nullptr && !s.meeting(t, out).empty() && cross_seam(s, spot, out, displacement, *passage))
                continue;
            const Vec3 wall = s.edge(t, out);
            displacement = (dot(displacement, wall) / squared_norm(wall)) * wall;
            // At the end of this stretch of wall the next one decides, from the triangle that it belongs to.
            const Place3 slide = rate_of(s, t, displacement);
            const std::size_t a = (out + 1) % 3, b = (out + 2) % 3;
            if (spot.place[a] == 0.0 && sinks(slide, a))
                out = a;
            else if (spot.place[b] == 0.0 && sinks(slide, b))
                out = b;
            else
                continue;
            if (s.neighbor[t][out] == kNoNeighbor) break;  // in a corner
        }
        cross_edge(s, spot, out, displacement);
    }
    normalize(spot.place);
    return true;
}

}  // namespace

bool walk(const Surface& s, Spot& spot, Vec3 displacement) { return go(s, spot, displacement, nullptr); }

void trace(const Surface& s, std::span<const Vec3> velocity, double dt, Particles& particles, const Draw& draw) {
    const std::vector<Rates> rates = corner_rates(s, velocity);
    parallel_for(particles.size(), [&](std::size_t p) {
        const Spot start{particles.triangle[p], particles.place[p]};
        const std::size_t t = start.triangle;
        // The velocity after `time` along `rate`, as a rate of the triangle that the particle starts from.
        const auto rate_after = [&](double time, const Place3& rate) {
            const Place3 near = ahead(start.place, time, rate);
            if (inside(near)) return rate_at(rates[t], near);
            Spot spot = start;
            walk(s, spot, time * vector_of(s, t, rate));
            const Vec3 u = vector_of(s, spot.triangle, rate_at(rates[spot.triangle], spot.place));
            return rate_of(s, t, turned(u, s.normal[spot.triangle], s.normal[t]));
        };
        const Place3 k1 = rate_at(rates[t], start.place);
        const Place3 k2 = rate_after(0.5 * dt, k1);
        const Place3 k3 = rate_after(0.5 * dt, k2);
        const Place3 k4 = rate_after(dt, k3);
        Place3 mean;
        for (std::size_t j = 0; j < 3; ++j) mean[j] = (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]) / 6.0;
        Spot spot = start;
        const Place3 near = ahead(start.place, dt, mean);
        bool stays = true;
        Passage passage{velocity, 0.0};
        if (inside(near)) {
            spot.place = near;
        } else {
            if (s.jointed())
                passage.chance = uniform01(random_bits(draw.seed, RandomStream::kFilmParticle, draw.step, p));
            stays = go(s, spot, dt * vector_of(s, t, mean), &passage);
        }
        normalize(spot.place);
        particles.velocity[p] = turned(particles.velocity[p], s.normal[t], passage.side * s.normal[spot.triangle]);
        particles.circulation[p] *= passage.side;
        particles.triangle[p] = stays ? spot.triangle : kGone;
        particles.place[p] = spot.place;
    });
}

}  // namespace lamella::vortex_particle
