#include "lamella/scene/detail/obstacles.h"

#include <fmt/format.h>

namespace lamella::scene::detail {

film::Solid solid_of(const SolidTable& table, const SourceLocation& where) {
    if (!(table.radius > 0.0)) throw InputError(where, "solid.radius is missing, e.g. \"5 cm\"");
    if (table.end > 0.0 && table.end < table.start)
        throw InputError(where, fmt::format("solid.end = {} comes before solid.start = {}", table.end, table.start));
    if (table.period > 0.0 && !(table.end > table.start && table.end <= table.period))
        throw InputError(where, fmt::format("solid.end = {} has to lie between solid.start = {} and solid.period = {}",
                                            table.end, table.start, table.period));
    if (table.period == 0.0 && norm(table.stride) > 0.0)
        throw InputError(where, "solid.stride needs a solid.period, after which the next step begins");
    if (table.free && (table.start > 0.0 || table.end > 0.0 || table.period > 0.0))
        throw InputError(where, "a solid with free = true moves by itself; take start, end and period out");
    if (!table.free && table.mass > 0.0) throw InputError(where, "solid.mass is read where free = true");
    film::Solid solid{.center = table.center,
                      .radius = table.radius,
                      .velocity = table.velocity,
                      .spin = table.spin,
                      .start = table.start};
    solid.period = table.period;
    solid.stride = table.stride;
    solid.free = table.free;
    solid.mass = table.mass;
    solid.arm = table.arm;
    solid.wet = table.wet;
    if (table.end > 0.0) solid.end = table.end;
    return solid;
}

film::Wall wall_of(const WallTable& table, const SourceLocation& where) {
    if (norm(table.normal) == 0.0) throw InputError(where, "wall.normal = [0, 0, 0] is no direction");
    return {table.point, table.normal / norm(table.normal), table.bursts};
}

}  // namespace lamella::scene::detail
