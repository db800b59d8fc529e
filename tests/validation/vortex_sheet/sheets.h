#pragma once

// Films for the tests of vortex sheets, in units with surface tension, density and radius 1.

#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/volume.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

#include <cmath>
#include <memory>
#include <utility>

namespace lamella::vortex_sheet {

inline film::Problem unit_problem(mesh::FoamMesh mesh, double edge_length) {
    film::Problem films;
    films.material.surface_tension = 1.0;
    films.material.air_density = 1.0;
    films.edge_length = edge_length;
    films.velocity.assign(mesh.regions.size(), {});
    films.mesh = std::move(mesh);
    return films;
}

inline std::unique_ptr<VortexSheetSolver> started(const film::Problem& films, const Options& options) {
    sim::SolverInput input;
    input.films = std::make_shared<film::Problem>(films);
    auto solver = std::make_unique<VortexSheetSolver>(options, input);
    solver->start({});
    return solver;
}

inline double scalar(const VortexSheetSolver& solver, const char* name) {
    for (const sim::Scalar& s : solver.scalars())
        if (s.name == name) return s.value;
    return std::nan("");
}

/// Legendre's polynomials of degree 0 to 4.
inline double legendre(int l, double c) {
    switch (l) {
        case 2: return 0.5 * (3 * c * c - 1);
        case 3: return 0.5 * (5 * c * c * c - 3 * c);
        case 4: return (35 * c * c * c * c - 30 * c * c + 3) / 8;
        default: return l == 0 ? 1.0 : c;
    }
}

/// Amplitude of mode l of a nearly spherical film around the origin: (2 l + 1) / (4 pi) times the integral of r P_l.
inline double mode(const mesh::FoamMesh& mesh, int l) {
    double sum = 0.0, angle = 0.0;
    for (const mesh::FaceId f : mesh.faces.ids()) {
        Vec3 c = (mesh.corner(f, 0) + mesh.corner(f, 1) + mesh.corner(f, 2)) / 3.0;
        const Vec3 area = 0.5 * cross(mesh.corner(f, 1) - mesh.corner(f, 0), mesh.corner(f, 2) - mesh.corner(f, 0));
        const double r = norm(c);
        const double solid = std::abs(dot(area, c)) / (r * r * r);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 x = mesh.corner(f, k);
            sum += solid / 3.0 * norm(x) * legendre(l, x[0] / norm(x));
        }
        angle += solid;
    }
    return (2 * l + 1) * sum / angle;
}

}  // namespace lamella::vortex_sheet
