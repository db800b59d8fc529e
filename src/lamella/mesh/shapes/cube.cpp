#include "lamella/mesh/shapes/cube.h"

#include "lamella/mesh/shapes/detail/builder.h"

#include <algorithm>
#include <cmath>

namespace lamella::mesh {

FoamMesh cube_bubble(const Vec3& center, double edge, double edge_length) {
    detail::require_positive(edge, "edge of the cube");
    detail::require_positive(edge_length, "edge length");
    detail::require_affordable(6.0 * edge * edge, edge_length);
    FoamMesh mesh = detail::empty_mesh(1, RegionKind::kClosed);
    mesh.regions[RegionId{1}].target_volume = edge * edge * edge;
    // Right triangles with legs of the wanted length times 1.14 have the area of equilateral ones with such edges.
    const int n = std::max(1, static_cast<int>(std::lround(edge / (0.93 * edge_length))));
    detail::Welder weld(mesh, edge);
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {-0.5, 0.5}) {
            Vec3 out, u, v;
            out[axis] = side * edge;
            u[(axis + 1) % 3] = 0.5 * edge;
            v[(axis + 2) % 3] = side < 0.0 ? -0.5 * edge : 0.5 * edge;  // u x v points outward
            const Vec3 middle = center + out;
            const auto grid = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
                detail::add_triangle_grid(
                    mesh, n, [&](double s, double t) { return weld.at(a + s * (b - a) + t * (c - a)); }, RegionId{1},
                    kOutside);
            };
            grid(middle - u - v, middle + u - v, middle + u + v);
            grid(middle - u - v, middle + u + v, middle - u + v);
        }
    return mesh;
}

}  // namespace lamella::mesh
