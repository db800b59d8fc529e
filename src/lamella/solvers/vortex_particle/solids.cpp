#include "lamella/solvers/vortex_particle/solids.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella::vortex_particle {
namespace {

constexpr std::array<double, 3> kMiddle{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};

/// Of the change that would do it if the film could be compressed. Getting around the solid takes half of that away in
/// the whole of a disk and nothing of the smallest swirls: this makes both lacks equal, a third.
constexpr double kOvershoot = 4.0 / 3.0;

Vec3 along(const Vec3& u, const Vec3& normal) { return u - dot(u, normal) * normal; }

}  // namespace

Cover cover_of(const Surface& s, std::span<const Body> bodies, double spread) {
    // Of an edge: how far inside its surface a solid's hold begins, so that it acts as large as it is, by the added
    // mass of disks four and eight edges in radius.
    constexpr double kInward = 0.22;
    Cover cover{std::vector<double>(s.triangles(), 0.0), std::vector<std::int32_t>(s.triangles(), -1)};
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        const Vec3 x = s.point(t, kMiddle);
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            if (!bodies[b].in_film) continue;
            const double depth = (bodies[b].radius + spread - norm(x - bodies[b].center)) / s.edge_length(t);
            const double free = 1.0 - std::clamp(depth - kInward, 0.0, 1.0);
            const double share = 1.0 - free * free * free * free;
            if (share <= cover.share[t]) continue;
            cover.share[t] = share;
            cover.body[t] = static_cast<std::int32_t>(b);
        }
    }
    return cover;
}

Grip::Grip(
    const Surface& s, Cover cover, std::vector<double> mass, std::span<Body> bodies, const Vec3& gravity, double dt)
    : surface_(s),
      cover_(std::move(cover)),
      mass_(std::move(mass)),
      bodies_(bodies),
      gravity_(gravity),
      dt_(dt),
      before_(bodies.begin(), bodies.end()),
      given_(bodies.size()),
      turned_(bodies.size()) {
    for (std::uint32_t t = 0; t < s.triangles(); ++t)
        if (cover_.body[t] >= 0) covered_.push_back(t);
}

/// The velocities of free bodies for which momentum is kept, given what the film has taken and this `u` of it.
void Grip::let_follow(std::span<const Vec3> u) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        Body& body = bodies_[b];
        if (!body.free) continue;
        double film = 0.0, inertia = 0.0;
        Vec3 momentum, turning, n;
        for (const std::uint32_t t : covered_) {
            if (cover_.body[t] != static_cast<std::int32_t>(b)) continue;
            const double m = kOvershoot * cover_.share[t] * mass_[t];
            const Vec3 arm = surface_.point(t, kMiddle) - body.center;
            film += m;
            inertia += m * squared_norm(arm);
            momentum += m * u[t];
            turning += m * cross(arm, u[t] - body.velocity);
            n += m * surface_.normal[t];
        }
        if (film == 0.0) continue;
        n *= 1.0 / norm(n);
        const Vec3 pull = along(gravity_, n);
        body.velocity = (body.mass * (before_[b].velocity + dt_ * pull) - given_[b] + momentum) / (body.mass + film);
        const double own = 0.5 * body.mass * body.radius * body.radius;
        body.spin = (dot(own * before_[b].spin - turned_[b] + turning, n) / (own + inertia)) * n;
    }
}

double Grip::sweep(std::span<const Vec3> u, std::vector<Vec3>& change) {
    let_follow(u);
    double worst = 0.0;
    for (const std::uint32_t t : covered_) {
        const auto b = static_cast<std::size_t>(cover_.body[t]);
        const Vec3 x = surface_.point(t, kMiddle);
        const Vec3 lack = along(bodies_[b].velocity_at(x), surface_.normal[t]) - u[t];
        change[t] = kOvershoot * cover_.share[t] * lack;
        given_[b] += mass_[t] * change[t];
        turned_[b] += mass_[t] * cross(x - bodies_[b].center, change[t]);
        if (cover_.share[t] == 1.0) worst = std::max(worst, norm(lack));
    }
    return worst;
}

void Grip::finish() {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        bodies_[b].force = given_[b] / -dt_;
        bodies_[b].torque = turned_[b] / -dt_;
    }
}

}  // namespace lamella::vortex_particle
