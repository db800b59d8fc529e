#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/mesh/tracker.h"
#include "lamella/sim/archive.h"
#include "lamella/solvers/equilibrium/crossing_memory.h"
#include "lamella/solvers/equilibrium/newton.h"
#include "lamella/solvers/equilibrium/patches.h"

#include <memory>
#include <string>
#include <vector>

namespace lamella::equilibrium {

struct RelaxationOptions {
    double edge_length = 0.0;            ///< of the mesh at rest [m]
    std::vector<FilmTension> tension;
    Goal goal = Goal::kMinimum;          ///< kStationary: Newton's method alone, on the mesh as it is
    double flow_step = 0.1;              ///< tau of the flow, in squared radii of the smallest bubble
    double flow_until = 0.05;            ///< residual from which on Newton's method takes over
    double freeze_at = 2e-3;             ///< residual from which on the mesh stays as it is
    double tolerance = 1e-8;             ///< residual at rest
    int coarse_faces = 2000;             ///< the films first come to rest on about so many faces
    bool separating = true;              ///< false: cones and crosses stay
    bool merging = true;
};

/// Brings films to rest: least area at the regions' target volumes, through changes of topology.
///
/// Far from rest the films follow an implicit mean curvature flow, nearer Newton's method, both through the tracker, which
/// keeps the mesh even and lets films merge and part; at the end the mesh is frozen and Newton's method converges. First on
/// a coarse mesh, then on ever finer ones. docs/equilibrium.md
class Relaxation {
public:
    /// What stands between the present state and rest.
    enum class Stage { kFlow, kNewton, kRest };

    /// A foam in a periodic box keeps its triangles: only Newton's method is at work.
    Relaxation(mesh::FoamMesh mesh, const RelaxationOptions& options);
    /// As it was saved.
    Relaxation(sim::StateReader& in, const RelaxationOptions& options);
    void save(sim::StateWriter& out) const;

    /// One step. Nothing happens at rest.
    void advance();
    bool at_rest() const { return stage_ == Stage::kRest; }
    Stage stage() const { return stage_; }

    const mesh::FoamMesh& mesh() const { return tracker_ ? tracker_->mesh() : frozen_; }
    double edge_length() const { return edge_length_; }     ///< of the present mesh [m]
    double residual() const { return residual_; }           ///< before the last step
    const std::vector<double>& pressure() const { return pressure_; }  ///< per region, over a film tension of 1 [1/m]
    int steps() const { return steps_; }
    /// Systems of equations solved: flow steps and Newton's, those on the frozen mesh included.
    int iterations() const { return iterations_; }
    std::vector<mesh::TopologyEvent> take_events();

    /// Changes of the regions; the films leave their rest.
    void pop(mesh::RegionId region, mesh::RegionId into);
    void set_target_volume(mesh::RegionId region, double volume);
    /// Puts another mesh in the place of the present one (resuming, annealing).
    void restart(mesh::FoamMesh mesh, double edge_length);

private:
    void take(mesh::FoamMesh mesh, double edge_length);
    void tidy();
    IdVector<mesh::VertexId, Vec3> displacement_to(const std::vector<Vec3>& position) const;
    void flow();
    void newton();
    void settle();
    void settle_frozen();
    void keep_pressures(const RestSystem& system, const Newton& newton);
    bool tracker_changes_topology();
    void heed(const std::vector<mesh::TopologyEvent>& events);
    bool leaves_crossing();
    void forget_crossings();
    void refine();
    double flow_time() const;
    void measure();

    RelaxationOptions options_;
    double edge_length_ = 0.0;
    std::unique_ptr<mesh::Tracker> tracker_;  ///< none where the mesh stays as it is
    mesh::FoamMesh frozen_;                   ///< then this is it
    Stage stage_ = Stage::kFlow;
    double residual_ = 0.0;
    std::vector<double> pressure_;
    int steps_ = 0;
    int iterations_ = 0;
    int failed_settles_ = 0;
    int slow_steps_ = 0;
    int crossing_tries_ = 0;
    CrossingMemory crossings_;
    IdVector<mesh::RegionId, double> gas_;  ///< that each bubble was given [m^3]; 0 for cavities and open regions
    double best_residual_ = 1.0;
    std::vector<mesh::TopologyEvent> events_;
};

}  // namespace lamella::equilibrium
