#pragma once

#include "lamella/mesh/tracker.h"
#include "lamella/sim/registry.h"
#include "lamella/sim/solver.h"
#include "lamella/solvers/vortex_sheet/flow.h"
#include "lamella/solvers/vortex_sheet/implicit_step.h"
#include "lamella/solvers/vortex_sheet/options.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace lamella::vortex_sheet {

/// Films and foams in air: each film is a vortex sheet whose circulation surface tension drives, and whose induced
/// velocity moves all films [Da15], in the form of docs/vortex_sheet.md.
class VortexSheetSolver final : public sim::Solver {
public:
    /// @throws InputError  options or films that do not go together
    VortexSheetSolver(const Options& options, const sim::SolverInput& input);

    void start(const sim::StartContext& context) override;
    sim::StepReport advance(double time_limit) override;

    double time() const override { return time_; }
    std::int64_t step() const override { return steps_; }

    sim::Frame frame() const override;
    std::vector<sim::Scalar> scalars() const override;
    std::vector<sim::Event> take_events() override;
    std::vector<sim::Scalar> characteristic_numbers() const override;

    void save(sim::StateWriter& out) const override;
    void load(sim::StateReader& in) override;

    const mesh::FoamMesh& mesh() const { return tracker_->mesh(); }
    const SheetTopology& topology() const { return topology_; }
    const Circulation& circulation() const { return phi_; }
    const LooseSheets& loose_sheets() const { return loose_; }
    /// For tests that start from a flow of their own. @param phi  one value per entry of topology()
    void set_circulation(Circulation phi);

private:
    void take(mesh::FoamMesh mesh);
    void settle_volumes();
    void give_start_velocities();
    void keep_volumes_of(IdVector<mesh::VertexId, Vec3>& motion) const;
    // The stages of a step, in order.
    double choose_step(double time_limit) const;
    double farthest_step(double dt) const;
    double fitted(double dt, double time_limit) const;
    void kick(double dt);
    Circulation tension_rate(const mesh::FoamMesh& mesh, const SheetGeometry& geometry) const;
    void damp(double dt);
    mesh::FoamMesh films_ahead(double ahead) const;
    Flow flow_of(const mesh::FoamMesh& mesh,
                 const SheetGeometry& geometry,
                 double time,
                 const LooseSheets& loose) const;
    IdVector<mesh::VertexId, Vec3> velocity_at_midpoint(double dt);
    void obey_wires(const mesh::FoamMesh& mesh,
                    const SheetGeometry& geometry,
                    const LooseSheets& loose,
                    double from,
                    double to,
                    Flow& flow);
    void move(double dt);
    void check_triangles() const;
    void restore_volumes();
    void restore_volumes(const IdVector<mesh::RegionId, double>& before,
                         const std::vector<mesh::TopologyEvent>& events);
    void keep_impulse();
    void apply_events();
    void apply(const film::Event& event);
    void pop(mesh::RegionId region, mesh::RegionId into);
    void inflate();
    double mean_speed() const;
    void heal(const std::vector<mesh::VertexId>& edited);
    /// Runs an edit of the tracker and lets circulations, velocities and wires follow.
    void edit_mesh(const std::function<void()>& edit);

    // Semi-implicit tension, in implicit_tension.cpp.
    void check_implicit() const;
    bool implicit_possible() const;
    double slowest_period() const;
    double implicit_limit() const;
    double break_even() const;
    bool starts_implicitly() const;
    std::optional<ImplicitStep> try_implicit(double time_limit) const;
    ImplicitStep solve_implicitly(double dt) const;

    spatial::VortexSumOptions sum_options() const;
    Vec3 wire_velocity(mesh::VertexId v, const Vec3& at, double from, double to) const;
    double capillary_limit() const;
    /// The flow of this moment, for whoever looks; cached until the state changes.
    const Flow& observed() const;

    Options options_;
    sim::SolverInput input_;
    std::unique_ptr<mesh::Tracker> tracker_;
    SheetTopology topology_;
    Circulation phi_;
    LooseSheets loose_;                        ///< what burst films left
    IdVector<mesh::VertexId, Vec3> velocity_;  ///< of the last step: predicts the next midpoint
    IdVector<mesh::VertexId, std::int32_t> wire_of_;
    double time_ = 0.0;
    std::int64_t steps_ = 0;
    double step_ = 0.0;             ///< the last one
    std::int64_t evaluations_ = 0;  ///< of the flow in the last step, 0 if it was explicit
    Vec3 impulse_;                  ///< what the flow is to keep, without wires [m^4/s]
    double wire_residual_ = 0.0;
    std::size_t next_event_ = 0;
    /// A bubble on its way to another volume.
    struct Inflation {
        mesh::RegionId region;
        double from, to;    ///< volumes [m^3]
        double start, end;  ///< [s]
    };
    std::vector<Inflation> inflations_;
    std::vector<sim::Event> events_;
    mutable std::optional<Flow> observed_;
};

/// Adds the solver "vortex_sheet".
void register_vortex_sheet(sim::SolverRegistry& registry);

}  // namespace lamella::vortex_sheet
