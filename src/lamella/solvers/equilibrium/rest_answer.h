#pragma once

#include "lamella/geometry/curved_triangle.h"
#include "lamella/mesh/angles.h"
#include "lamella/mesh/foam_mesh.h"
#include "lamella/solvers/equilibrium/newton.h"
#include "lamella/solvers/equilibrium/patches.h"

#include <cstddef>
#include <vector>

namespace lamella::equilibrium {

/// What is known about films at rest. Lengths in the mesh's unit, for a film tension of 1; angles in radians.
struct RestAnswer {
    double polyhedral_area = 0.0;       ///< of the flat faces: too large by about 3 / F of itself
    double estimated_area = 0.0;        ///< after one Newton step on quadratic patches, corrected for the volumes; `area`
                                        ///< where the mesh is too uneven for that
    double area = 0.0;                  ///< of the quadratic patches at rest; weighted with the tensions, as the others
    double residual = 0.0;              ///< of the quadratic patches
    bool converged = false;             ///< they came to rest; if not, `area` is the best that was reached
    std::vector<double> pressure;       ///< per region, above region 0
    double virial = 0.0;                ///< 1.5 sum p V / area - 1: zero for clusters in open air; its size is that of
                                        ///< the pressures' error
    int index = 0;                      ///< unstable modes: negative eigenvalues of the second variation
    double lowest_eigenvalue = 0.0;     ///< of the second variation per area
    std::size_t crossed_edges = 0;      ///< with more than three films
    std::size_t irregular_vertices = 0; ///< that Plateau's laws forbid
    mesh::AngleDeviation film_angles;      ///< from 120 degrees, on the quadratic patches
    mesh::AngleDeviation junction_angles;  ///< from 109.47 degrees
    std::size_t triple_edges = 0, junctions = 0;
    std::vector<geometry::CurvedTriangle> curved;  ///< the quadratic patch of each face

    /// A minimum: no unstable mode and nothing that could part.
    bool stable() const { return converged && index == 0 && irregular_vertices == 0; }
};

/// What is asked of films at rest.
struct RestQuestions {
    Goal goal = Goal::kMinimum;
    bool eigenvalue = true;         ///< the lowest of the second variation: costs about as much as all the rest
    double angle_tolerance = 0.0;   ///< patches are made finer where angles are off by more [rad]; 0: they stay as they are
};

/// Raises a resting mesh to quadratic patches, lets them come to rest, and examines them. The angles are those of finer
/// patches where angle_tolerance asks for some; area, pressures and stability belong to the patches of the mesh.
RestAnswer rest_answer(const mesh::FoamMesh& mesh,
                       const std::vector<FilmTension>& tension,
                       const RestQuestions& ask);

}  // namespace lamella::equilibrium
