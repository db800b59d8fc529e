#pragma once

// Films for the tests of vortex sheets, in units with surface tension, density and radius 1.

#include "lamella/mesh/check.h"
#include "lamella/mesh/shapes/sphere.h"
#include "lamella/mesh/volume.h"
#include "lamella/scene/scene.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
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

/// A solver of a scene in the units of the tests.
inline std::unique_ptr<VortexSheetSolver> solver_of(const std::string& tables) {
    const auto registry = scene::all_solvers();
    const auto scene = scene::parse_scene(
        "solver = \"vortex_sheet\"\n" + tables + "\n[material]\nsurface_tension = 1.0\nair_density = 1.0\n", "test.toml", {},
        registry);
    auto solver = scene::create_solver(scene, registry);
    return std::unique_ptr<VortexSheetSolver>(dynamic_cast<VortexSheetSolver*>(solver.release()));
}

/// What is watched while a run goes on.
struct Course {
    double volume_error = 0.0;  ///< largest, of any bubble
    double largest_energy = 0.0, least_energy = 1e300, largest_kinetic = 0.0;
    double impulse = 0.0;  ///< largest
    std::int64_t steps = 0;

    double energy_spread() const { return largest_energy - least_energy; }
    void look(const VortexSheetSolver& solver) {
        volume_error = std::max(volume_error, scalar(solver, "volume_error"));
        const double energy = scalar(solver, "energy");
        largest_energy = std::max(largest_energy, energy);
        least_energy = std::min(least_energy, energy);
        largest_kinetic = std::max(largest_kinetic, scalar(solver, "energy_kinetic"));
        impulse = std::max(impulse, norm(Vec3{{scalar(solver, "impulse_x"), scalar(solver, "impulse_y"),
                                               scalar(solver, "impulse_z")}}));
    }
};

/// Runs to `end`, looking every few steps; the mesh must be sound at the end.
inline Course run(VortexSheetSolver& solver, double end, std::int64_t look_every = 10) {
    Course course;
    course.look(solver);
    while (solver.time() < end) {
        solver.advance(end);
        if (++course.steps % look_every == 0) course.look(solver);
    }
    course.look(solver);
    EXPECT_EQ(mesh::faults(solver.mesh()), std::vector<std::string>{});
    return course;
}

}  // namespace lamella::vortex_sheet
