#include "lamella/solvers/equilibrium/rest_answer.h"

#include "lamella/geometry/curved_triangle.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/plateau_faults.h"
#include "lamella/mesh/quality.h"
#include "lamella/mesh/subdivide.h"
#include "lamella/solvers/equilibrium/rest_system.h"
#include "lamella/solvers/equilibrium/stability.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lamella::equilibrium {
namespace {

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

/// Direction in which a patch leaves the middle of its edge, perpendicular to the edge.
Vec3 conormal(const Patches& patches, const mesh::EdgeUse& use) {
    return geometry::edge_conormal(patches.corners(index(use.face)), use.opposite);
}

/// A + sum p (target - V): the Lagrangian, stationary at rest, so that its error is quadratic in that of the shape.
double corrected_area(const RestSystem& system, const std::vector<double>& pressure) {
    const Balance balance = system.balance(false);
    double area = balance.area;
    for (std::size_t r = 0; r < pressure.size(); ++r) area += pressure[r] * balance.missing[r];
    return area;
}

/// One step from an uneven mesh may lead anywhere.
bool is_trusted(double estimate, const mesh::FoamMesh& mesh, double polyhedral_area) {
    constexpr double kSmallestAngle = 15.0 * 3.14159265358979323846 / 180.0;
    constexpr double kMostChange = 0.01;  // of the area: flat faces are closer than that on every mesh of use
    return mesh::min_angle(mesh) > kSmallestAngle && std::abs(estimate / polyhedral_area - 1.0) < kMostChange;
}

}  // namespace

PatchAngles patch_angles(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, const Patches& patches) {
    constexpr double kFilmAngle = 2.0943951023931953;  // 120 degrees
    PatchAngles result;
    double weight = 0.0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto uses = edges.of(e);
        if (uses.size() != 3 || mesh::is_wire_edge(mesh, edges, e)) continue;
        const std::array<Vec3, 3> out{conormal(patches, uses[0]), conormal(patches, uses[1]),
                                      conormal(patches, uses[2])};
        const std::size_t tail = (uses[0].opposite + 1) % 3, head = (tail + 1) % 3;
        const std::array<Vec3, 6> x = patches.corners(index(uses[0].face));
        const double length = norm(x[head] - x[tail]);
        ++result.triple_edges;
        for (std::size_t k = 0; k < 3; ++k) {
            const double off = std::abs(angle_between(out[k], out[(k + 1) % 3]) - kFilmAngle);
            result.films.mean += length * off / 3.0;
            result.films.largest = std::max(result.films.largest, off);
        }
        weight += length;
    }
    if (weight > 0.0) result.films.mean /= weight;
    IdVector<mesh::FaceId, geometry::CurvedTriangle> curved;
    for (std::size_t p = 0; p < patches.size(); ++p) curved.push_back(patches.corners(p));
    std::vector<mesh::JunctionAngles> junctions = mesh::junction_angles(mesh, curved);
    std::erase_if(junctions, [&](const mesh::JunctionAngles& j) {
        return j.angle.size() != 6 || patches.fixed[index(j.vertex)] != 0;  // no proper junction, or on a wire
    });
    result.junction_points = junctions.size();
    result.junctions = mesh::deviation_from_plateau(junctions);
    return result;
}

RestAnswer rest_answer(const mesh::FoamMesh& mesh,
                       const std::vector<FilmTension>& tension,
                       Goal goal,
                       bool with_eigenvalue) {
    RestAnswer answer;
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    answer.polyhedral_area = RestSystem(mesh, edges, flat_patches(mesh, tension)).balance(false).area;
    const mesh::PlateauFaults faults = mesh::plateau_faults(mesh, edges);
    answer.crossed_edges = faults.edges.size();
    answer.irregular_vertices = faults.vertices.size();

    RestSystem system(mesh, edges, quadratic_patches(mesh, edges, tension));
    Newton newton(system, goal);
    constexpr double kTolerance = 1e-10;
    constexpr int kMostSteps = 20;
    answer.converged = newton.solve(kTolerance, 1);
    const double estimate = corrected_area(system, newton.pressure());
    if (!answer.converged) answer.converged = newton.solve(kTolerance, kMostSteps);
    answer.area = system.balance(false).area;
    answer.estimated_area = is_trusted(estimate, mesh, answer.polyhedral_area) ? estimate : answer.area;
    answer.residual = newton.last().residual;
    answer.index = newton.last().index;
    answer.pressure.assign(mesh.regions.size(), 0.0);
    double work = 0.0;
    for (std::size_t c = 0; c < newton.pressure().size(); ++c) {
        answer.pressure[index(system.constrained()[c])] = newton.pressure()[c];
        work += newton.pressure()[c] * system.target(c);
    }
    const bool held = std::any_of(mesh.on_wire.begin(), mesh.on_wire.end(), [](std::uint8_t w) { return w != 0; });
    if (!held && !mesh.periodic() && answer.area > 0.0) answer.virial = 1.5 * work / answer.area - 1.0;
    if (with_eigenvalue) answer.lowest_eigenvalue = lowest_eigenvalue(system, newton.pressure());
    for (std::size_t p = 0; p < system.patches().size(); ++p) answer.curved.push_back(system.patches().corners(p));
    const PatchAngles angles = patch_angles(mesh, edges, system.patches());
    answer.film_angles = angles.films;
    answer.junction_angles = angles.junctions;
    answer.triple_edges = angles.triple_edges;
    answer.junctions = angles.junction_points;
    return answer;
}

}  // namespace lamella::equilibrium
