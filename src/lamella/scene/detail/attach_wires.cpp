#include "lamella/scene/detail/attach_wires.h"

#include "lamella/scene/detail/table_place.h"

#include <algorithm>

namespace lamella::scene::detail {
namespace {

/// The point of a wire that is nearest to `x` [m].
Vec3 nearest_on(const WireTable& wire, const Vec3& x) {
    if (wire.shape == WireShape::kSegment) {
        const Vec3 along = wire.to - wire.from;
        const double s = std::clamp(dot(x - wire.from, along) / squared_norm(along), 0.0, 1.0);
        return wire.from + s * along;
    }
    const Vec3 axis = wire.axis / norm(wire.axis);
    Vec3 arm = x - wire.center;
    arm -= dot(arm, axis) * axis;
    const double length = norm(arm);
    return length > 0.0 ? wire.center + (wire.radius / length) * arm : wire.center + Vec3{{1e300, 0.0, 0.0}};
}

film::Wire motion_of(const WireTable& wire) {
    film::Wire motion;
    motion.center = wire.shape == WireShape::kRing ? wire.center : 0.5 * (wire.from + wire.to);
    motion.velocity = wire.velocity;
    motion.spin = wire.spin;
    motion.start = wire.start;
    if (wire.end > 0.0) motion.end = wire.end;
    if (wire.shape == WireShape::kRing)
        motion.ring = film::Wire::Ring{wire.axis / norm(wire.axis), wire.radius, wire.blow};
    return motion;
}

void attach(film::Problem& problem, const WireTable& wire, const SourceLocation& where) {
    if (wire.shape == WireShape::kRing && norm(wire.axis) == 0.0)
        throw InputError(where, "wire.axis = [0, 0, 0] is no direction");
    if (wire.shape == WireShape::kSegment && squared_norm(wire.to - wire.from) == 0.0)
        throw InputError(where, "wire.from and wire.to are the same point");
    if (wire.end > 0.0 && wire.end < wire.start)
        throw InputError(where, fmt::format("wire.end = {} comes before wire.start = {}", wire.end, wire.start));
    if (wire.blow != 0.0 && wire.shape != WireShape::kRing)
        throw InputError(where, "wire.blow needs shape = \"ring\": air is blown through a ring");
    const double reach = wire.reach > 0.0 ? wire.reach : 0.5 * problem.edge_length;
    const auto number = static_cast<std::int32_t>(problem.wires.size());
    problem.wires.push_back(motion_of(wire));
    std::size_t held = 0;
    for (const mesh::VertexId v : problem.mesh.position.ids()) {
        const Vec3 on_wire = nearest_on(wire, problem.mesh.position[v]);
        if (norm(on_wire - problem.mesh.position[v]) > reach) continue;
        if (problem.mesh.on_wire[v] == 0) problem.mesh.position[v] = on_wire;
        problem.mesh.on_wire[v] = 1;
        problem.wire_of[v] = number;
        ++held;
    }
    if (held == 0 && wire.blow == 0.0)
        throw InputError(where,
                         fmt::format("no film is within {:.3g} m of the wire; move it, or raise wire.reach", reach));
}

}  // namespace

void attach_wires(film::Problem& problem, const FilmTables& tables, const sim::Node& root) {
    problem.wire_of.assign(problem.mesh.position.size(), -1);
    for (std::size_t k = 0; k < tables.wires.size(); ++k) attach(problem, tables.wires[k], place(root, "wire", k));
}

}  // namespace lamella::scene::detail
