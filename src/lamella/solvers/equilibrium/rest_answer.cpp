#include "lamella/solvers/equilibrium/rest_answer.h"

#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/plateau_faults.h"
#include "lamella/mesh/quality.h"
#include "lamella/mesh/subdivide.h"
#include "lamella/solvers/equilibrium/angle_refinement.h"
#include "lamella/solvers/equilibrium/rest_system.h"
#include "lamella/solvers/equilibrium/stability.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella::equilibrium {
namespace {

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

void measure_angles(RestAnswer& answer, Graded films, const std::vector<FilmTension>& tension, const RestQuestions& ask) {
    const PatchAngles angles = answer.converged && ask.angle_tolerance > 0.0
                                   ? refine_angles(std::move(films), tension, ask.goal, ask.angle_tolerance).angles
                                   : patch_angles(films.mesh, films.edges, films.patches);
    answer.film_angles = angles.films;
    answer.junction_angles = angles.junctions;
    answer.triple_edges = angles.film.size();
    answer.junctions = angles.junction.size();
}

}  // namespace

RestAnswer rest_answer(const mesh::FoamMesh& mesh,
                       const std::vector<FilmTension>& tension,
                       const RestQuestions& ask) {
    RestAnswer answer;
    const mesh::EdgeFaces edges = mesh::edge_faces(mesh);
    answer.polyhedral_area = RestSystem(mesh, edges, flat_patches(mesh, tension)).balance(false).area;
    const mesh::PlateauFaults faults = mesh::plateau_faults(mesh, edges);
    answer.crossed_edges = faults.edges.size();
    answer.irregular_vertices = faults.vertices.size();

    RestSystem system(mesh, edges, quadratic_patches(mesh, edges, tension));
    Newton newton(system, ask.goal);
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
    if (ask.eigenvalue) answer.lowest_eigenvalue = lowest_eigenvalue(system, newton.pressure());
    for (std::size_t p = 0; p < system.patches().size(); ++p) answer.curved.push_back(system.patches().corners(p));
    measure_angles(answer, {mesh, edges, system.patches()}, tension, ask);
    return answer;
}

}  // namespace lamella::equilibrium
