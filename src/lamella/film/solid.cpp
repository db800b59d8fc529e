#include "lamella/film/solid.h"

namespace lamella::film {

std::vector<Body> bodies_at_start(std::span<const Solid> solids) {
    std::vector<Body> bodies;
    for (const Solid& solid : solids)
        bodies.push_back({.radius = solid.radius,
                          .free = solid.free,
                          .mass = solid.mass,
                          .center = solid.center,
                          .velocity = solid.velocity,
                          .spin = solid.spin,
                          .force = {},
                          .torque = {},
                          .arm = solid.arm,
                          .wet = solid.wet});
    move_bodies(solids, 0.0, 0.0, bodies);
    return bodies;
}

void move_bodies(std::span<const Solid> solids, double time, double ahead, std::span<Body> bodies) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        Body& body = bodies[b];
        if (body.free) {
            body.center += ahead * body.velocity;
            continue;
        }
        const Solid& solid = solids[b];
        const bool moves = solid.moves(time);
        body.in_film = solid.in_film(time);
        body.center = solid.center_at(time);
        body.velocity = moves ? solid.velocity : Vec3{};
        body.spin = moves ? solid.spin : Vec3{};
    }
}

double fastest(std::span<const Solid> solids) {
    double speed = 0.0;
    for (const Solid& solid : solids)
        if (!solid.free) speed = std::max(speed, norm(solid.velocity) + norm(solid.spin) * solid.radius);
    return speed;
}

}  // namespace lamella::film
