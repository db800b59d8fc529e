#include "lamella/solvers/equilibrium/rest_answer.h"

#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/plateau_faults.h"
#include "lamella/solvers/equilibrium/patch_energy.h"
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
    const std::size_t tail = (use.opposite + 1) % 3;
    const auto [u, v] = node_place(3 + tail);
    const ShapePoint at = shape_at(6, u, v);
    const std::array<Vec3, 6> x = patches.corners(index(use.face));
    Vec3 a, b;
    for (std::size_t i = 0; i < 6; ++i) {
        a += at.along_u[i] * x[i];
        b += at.along_v[i] * x[i];
    }
    // Toward the opposite corner in the reference triangle, whose corners are (0,0), (1,0), (0,1).
    const auto [uo, vo] = node_place(use.opposite);
    const Vec3 inward = (uo - u) * a + (vo - v) * b;
    const Vec3 along = x[(tail + 1) % 3] - x[tail];  // the tangent of a parabola at its middle
    return inward - (dot(inward, along) / squared_norm(along)) * along;
}

}  // namespace

PatchAngles patch_angles(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, const Patches& patches) {
    constexpr double kFilmAngle = 2.0943951023931953;  // 120 degrees
    const double junction_angle = std::acos(-1.0 / 3.0);
    PatchAngles result;
    double weight = 0.0;
    std::vector<std::vector<Vec3>> tangents(mesh.position.size());  // of the lines at each vertex
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [a, b, shift] = edges.edge[e];
        const auto uses = edges.of(e);
        if (uses.size() != 3 || (mesh.on_wire[a] != 0 && mesh.on_wire[b] != 0)) continue;
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
        const Vec3 start = uses[0].forward ? x[tail] : x[head], end = uses[0].forward ? x[head] : x[tail];
        const Vec3 middle = x[3 + tail];
        tangents[index(a)].push_back(4.0 * middle - 3.0 * start - end);
        tangents[index(b)].push_back(4.0 * middle - 3.0 * end - start);
    }
    if (weight > 0.0) result.films.mean /= weight;
    std::size_t pairs = 0;
    for (std::size_t v = 0; v < tangents.size(); ++v) {
        if (tangents[v].size() != 4 || patches.fixed[v] != 0) continue;
        ++result.junction_points;
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t l = 0; l < k; ++l, ++pairs) {
                const double off = std::abs(angle_between(tangents[v][k], tangents[v][l]) - junction_angle);
                result.junctions.mean += off;
                result.junctions.largest = std::max(result.junctions.largest, off);
            }
    }
    if (pairs > 0) result.junctions.mean /= static_cast<double>(pairs);
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
    answer.quick_area = system.balance(false).area;
    if (!answer.converged) answer.converged = newton.solve(kTolerance, kMostSteps);
    answer.area = system.balance(false).area;
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
    const PatchAngles angles = patch_angles(mesh, edges, system.patches());
    answer.film_angles = angles.films;
    answer.junction_angles = angles.junctions;
    answer.triple_edges = angles.triple_edges;
    answer.junctions = angles.junction_points;
    return answer;
}

}  // namespace lamella::equilibrium
