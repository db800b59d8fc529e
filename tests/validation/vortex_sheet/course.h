#pragma once

// Starts for runs that are watched, and the line that is printed of one.

#include "sheets.h"

#include "lamella/mesh/shapes/standard_clusters.h"

#include <cstdio>

namespace lamella::vortex_sheet {

inline void report(const char* name, const Course& c) {
    std::printf("%-22s steps %5d  volume %.1e  energy %.5f to %.5f, spread/kinetic %.3f, /total %.1e  impulse %.1e\n", name,
                static_cast<int>(c.steps), c.volume_error, c.least_energy, c.largest_energy,
                c.energy_spread() / c.largest_kinetic, c.energy_spread() / c.largest_energy, c.impulse);
}

inline mesh::FoamMesh jittered(mesh::FoamMesh mesh, double edge, double share) {
    for (const mesh::VertexId v : mesh.position.ids()) {
        Vec3& x = mesh.position[v];
        const auto i = static_cast<double>(index(v));
        const Vec3 kick{{std::sin(12.9898 * i), std::sin(78.233 * i), std::sin(37.719 * i)}};
        x += share * edge * (kick - dot(kick, x) / dot(x, x) * x);
    }
    return mesh;
}
inline void take_volumes_as_targets(mesh::FoamMesh& mesh) {
    const auto volume = mesh::region_volumes(mesh);
    for (const mesh::RegionId r : mesh.regions.ids())
        if (mesh.regions[r].kind == mesh::RegionKind::kClosed) mesh.regions[r].target_volume = volume[r];
}

/// A bubble of radius 1, squashed, its vertices moved along it at random.
inline mesh::FoamMesh uneven_sphere(double edge) {
    mesh::FoamMesh sphere = jittered(mesh::spheres({{Vec3{}, 1.0}}, edge), edge, 0.2);
    for (Vec3& x : sphere.position) x[0] *= 0.9;
    take_volumes_as_targets(sphere);
    return sphere;
}
/// A double bubble with caps of radius 1, stretched, and bent out of its symmetry.
inline mesh::FoamMesh uneven_double_bubble(double edge) {
    mesh::FoamMesh bubbles = mesh::double_bubble(mesh::double_bubble_of_radii(1.0, 1.0), edge);
    for (Vec3& x : bubbles.position) x[0] *= 1.05, x[1] += 0.05 * x[1] * x[0];
    take_volumes_as_targets(bubbles);
    return bubbles;
}

}  // namespace lamella::vortex_sheet
