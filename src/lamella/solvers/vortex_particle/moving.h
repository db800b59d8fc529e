#pragma once

// The state of films that move, beside what the flow in them is.

#include "lamella/mesh/tracker.h"
#include "lamella/solvers/vortex_particle/air_mass.h"
#include "lamella/solvers/vortex_particle/membrane.h"
#include "lamella/solvers/vortex_particle/vortex_particle_solver.h"

#include <memory>
#include <optional>
#include <vector>

namespace lamella::vortex_particle {

struct VortexParticleSolver::Moving {
    std::unique_ptr<mesh::Tracker> tracker;
    mesh::FoamMesh films;  ///< where they are now
    Membrane membrane;
    std::optional<AirMass> air;
    Vectors velocity;              ///< along the normals, beside `carry` [m/s]
    Vectors carry;                 ///< the steady motion of each cluster as a whole, in which the flow is told [m/s]
    std::vector<double> pressure;  ///< of regions in the last step, over the outside's [Pa]
    std::size_t next_event = 0;
    Vectors looked_at;  ///< where the films were when the tracker last looked at their triangles [m]

    /// For which the equations are factored; the factors precondition those of other steps.
    struct Reference {
        double step = 0.0;                          ///< 0: nothing is yet
        bool stale = false;                         ///< the next step is to factor anew
        Vectors position;                           ///< [m]
        std::vector<double> thickness, surfactant;  ///< of the surface's vertices
        std::vector<double> mass;                   ///< of the films' vertices [kg]
        std::vector<double> tension;                ///< of triangles [N/m]
    } reference;

    Moving(const mesh::FoamMesh& mesh, const Surface& s) : films(mesh), membrane(mesh, s), looked_at(mesh.position) {}
};

}  // namespace lamella::vortex_particle
