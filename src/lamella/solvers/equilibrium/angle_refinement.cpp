#include "lamella/solvers/equilibrium/angle_refinement.h"

#include "lamella/solvers/equilibrium/rest_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella::equilibrium {
namespace {

using mesh::VertexId;

/// How often the patches at each vertex are to be halved. Angles at junctions fall by 1.57 with every level (measured on
/// Kelvin's and Weaire and Phelan's foams and on clusters), others by two or more.
IdVector<VertexId, int> wanted_levels(const Graded& films, const PatchAngles& angles, double tolerance, int most_levels) {
    constexpr double kJunctionGain = 1.5, kFilmGain = 2.0;
    IdVector<VertexId, int> levels(films.mesh.position.size(), 0);
    const auto ask = [&](VertexId v, double error, double gain) {
        if (error <= tolerance || films.mesh.on_wire[v]) return;
        const double n = std::ceil(std::log(error / tolerance) / std::log(gain));
        levels[v] = std::max(levels[v], static_cast<int>(std::min(n, static_cast<double>(most_levels))));
    };
    for (const auto& j : angles.junction) ask(j.vertex, j.error, kJunctionGain);
    for (const auto& film : angles.film) {
        const mesh::EdgeKey& edge = films.edges.edge[film.edge];
        // Next to a junction it is the junction's error.
        if (levels[edge.a] > 0 || levels[edge.b] > 0) continue;
        ask(edge.a, film.error, kFilmGain);
        ask(edge.b, film.error, kFilmGain);
    }
    return levels;
}

Graded graded(Graded films, const IdVector<VertexId, int>& levels, const std::vector<FilmTension>& tension) {
    for (int level = 0;; ++level) {
        IdVector<VertexId, std::uint8_t> marked(films.mesh.position.size(), 0);
        bool any = false;
        for (const VertexId v : levels.ids())
            if (levels[v] > level) {
                marked[v] = 1;
                any = true;
            }
        if (!any) return films;
        films = grade(films.mesh, films.edges, films.patches, marked, tension);
    }
}

}  // namespace

Refined refine_angles(Graded start, const std::vector<FilmTension>& tension, Goal goal, double tolerance) {
    constexpr int kMostRounds = 6, kMostSteps = 20;
    constexpr double kResidual = 1e-8;  // far below what angles of a thousandth of a degree ask for
    const std::size_t most_faces = 8 * start.mesh.faces.size();
    Refined best{std::move(start), {}};
    best.angles = patch_angles(best.films.mesh, best.films.edges, best.films.patches);
    int levels = 3;  // at a time
    for (int round = 0; round < kMostRounds; ++round) {
        if (std::max(best.angles.films.largest, best.angles.junctions.largest) <= tolerance) break;
        Graded finer = graded(best.films, wanted_levels(best.films, best.angles, tolerance, levels), tension);
        if (finer.mesh.faces.size() > most_faces) break;
        RestSystem system(finer.mesh, finer.edges, finer.patches);
        if (!Newton(system, goal).solve(kResidual, kMostSteps)) {
            // Films of one or two patches change much: a smaller step keeps Newton's method near its goal.
            if (levels == 1) break;
            levels = 1;
            continue;
        }
        finer.patches = system.patches();
        best.films = std::move(finer);
        best.angles = patch_angles(best.films.mesh, best.films.edges, best.films.patches);
    }
    return best;
}

}  // namespace lamella::equilibrium
