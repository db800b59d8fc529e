#pragma once

#include "lamella/sim/registry.h"
#include "lamella/sim/solver.h"
#include "lamella/solvers/vortex_particle/flow.h"
#include "lamella/solvers/vortex_particle/kick.h"
#include "lamella/solvers/vortex_particle/options.h"
#include "lamella/solvers/vortex_particle/particles.h"
#include "lamella/solvers/vortex_particle/rebin.h"
#include "lamella/solvers/vortex_particle/solids.h"
#include "lamella/solvers/vortex_particle/stream.h"
#include "lamella/solvers/vortex_particle/transfer.h"

#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lamella::vortex_particle {

/// What the mesh knows of the flow at one moment.
struct MeshFlow {
    std::vector<double> circulation;  ///< Omega of the cell of each vertex [m^2/s]
    std::vector<double> thickness;    ///< eta of vertices [m]
    std::vector<double> surfactant;   ///< Gamma of vertices [mol/m^2]
    std::vector<double> area;         ///< that particles say they have around each vertex [m^2]
    std::vector<double> outflow;      ///< D of the cell of each vertex [m^2/s]
    std::vector<Vec3> velocity;       ///< of triangles [m/s]
};

/// The flow inside a film: particles that carry circulation, liquid and surfactant along a surface of triangles, which
/// finds their velocity [Tao24], in the form of docs/vortex_particle.md.
class VortexParticleSolver final : public sim::Solver {
public:
    /// @throws InputError  options or films that do not go together
    VortexParticleSolver(const Options& options, const sim::SolverInput& input);
    ~VortexParticleSolver() override;

    void start(const sim::StartContext& context) override;
    sim::StepReport advance(double time_limit) override;

    double time() const override { return time_; }
    std::int64_t step() const override { return steps_; }

    sim::Frame frame() const override;
    std::vector<sim::Scalar> scalars() const override;
    std::vector<sim::Scalar> characteristic_numbers() const override;
    std::vector<sim::Event> take_events() override { return std::exchange(events_, {}); }
    std::optional<std::string> stop_reason() const override;

    void save(sim::StateWriter& out) const override;
    void load(sim::StateReader& in) override;

    const Surface& surface() const { return surface_; }
    const Particles& particles() const { return particles_; }
    const std::vector<Body>& bodies() const { return bodies_; }
    /// The flow of this moment, for whoever looks.
    const MeshFlow& observed() const;
    double kinetic_energy() const;  ///< [J]

    double film_energy() const;  ///< kinetic, of films along their normals, air that counts included [J]
    const mesh::FoamMesh& films() const;

private:
    // The stages of a step, in order.
    double choose_step(double time_limit) const;
    MeshFlow particles_to_mesh() const;
    void drag(double dt, MeshFlow& flow) const;
    void drive_circulation(double dt, MeshFlow& flow);
    std::vector<double> compress(double dt, MeshFlow& flow);
    void hold_walls(MeshFlow& flow);
    void diffuse(double dt, MeshFlow& flow);
    void obey_solids(double dt, MeshFlow& flow);
    Cover cover(double dt) const;
    void recover_velocity(MeshFlow& flow) const;
    std::vector<double> particle_circulation(const MeshFlow& flow, std::vector<double> spin) const;
    std::vector<double> area_growth(double dt, const MeshFlow& flow) const;
    void mesh_to_particles(double dt,
                           const MeshFlow& before,
                           const MeshFlow& after,
                           const std::vector<double>& dilatation);
    void move_particles(double dt, const MeshFlow& flow);
    void exchange_with_stream(double dt);
    std::size_t most_per_triangle() const;

    SurfactantProblem surfactant_problem(double dt, const MeshFlow& flow) const;
    void note_iterations(int iterations, double residual);
    void take_dilatation(const std::vector<double>& dilatation, MeshFlow& flow);
    void check_solids() const;
    void take_shape();

    // Films that move, in moving.cpp.
    struct Moving;
    void check_moving() const;
    void start_moving();
    double farthest_film_step() const;
    void take_films(mesh::FoamMesh mesh);
    void settle_volumes();
    void start_carry();
    void place_films(const Vectors& position, std::span<std::vector<Vec3>* const> along);
    void drift(double dt, std::initializer_list<std::vector<Vec3>*> along);
    std::vector<double> kick_films(double dt, MeshFlow& flow);
    std::vector<double> film_tension(const MeshFlow& flow) const;
    std::vector<double> film_mass(const MeshFlow& flow) const;
    std::vector<double> film_areas() const;
    std::vector<Vec3> resultants(std::span<const double> value, std::span<const double> area) const;
    std::vector<double> film_forces(const std::vector<double>& mass, const std::vector<double>& tension) const;
    void stay_with_air(std::vector<double>& speed) const;
    std::vector<double> outward_signs() const;
    void factor_moving();
    void fit_air(double dt, const std::vector<double>& mass, const std::vector<double>& tension);
    void diffuse_moving(double dt, MeshFlow& flow) const;
    void settle_films();
    bool triangles_are_due() const;
    void edit_films(const std::function<void()>& edit);
    void follow_velocities(const Surface& before, const Relaid& change);
    void follow_holes(const Surface& before, const mesh::CompactionMaps& maps);
    void join_clusters();
    void apply_events();
    void apply(const film::Event& event);
    void burst(mesh::RegionId region, mesh::RegionId into);
    void look_for_rupture();
    double film_area() const;
    void add_film_motion(std::vector<Vec3>& velocity) const;
    void add_film_scalars(std::vector<sim::Scalar>& all) const;
    void save_moving(sim::StateWriter& out) const;
    void load_moving(sim::StateReader& in);

    void refresh_reference(double dt, const MeshFlow& flow);
    void factor_reference();

    Options options_;
    sim::SolverInput input_;
    double surfactant_strength_;  ///< 2 R T / rho [m^2/s^2 per mol/m^3]
    double viscosity_;            ///< of the film [m^2/s]

    // The film, and what is worked out for it once.
    Surface surface_;
    Stream stream_;
    Transfer transfer_;
    FlowSolver flow_solver_;
    Diffusion diffusion_;
    ShiftedStiffness compression_;
    std::vector<double> curvature_;  ///< Gaussian, of triangles; empty where the film is flat [1/m^2]
    std::vector<double> gravity_;    ///< weak divergence of gravity along the film [m^2/s^2]

    // The state.
    Particles particles_;
    Bins bins_;
    std::vector<Body> bodies_;
    std::vector<double> hole_circulation_;
    std::vector<Vec3> velocity_;  ///< of triangles, that the last step found
    double time_ = 0.0;
    std::int64_t steps_ = 0;
    double step_ = 0.0;  ///< the last one
    double fastest_dilatation_ = 0.0;
    /// Why there is nothing more to come.
    enum class End { kNone, kRupture, kNoFilm } end_ = End::kNone;
    std::vector<sim::Event> events_;             ///< since the last look
    double liquid_in_ = 0.0, liquid_out_ = 0.0;  ///< that the stream has brought and taken [m^3]
    std::int64_t iterations_ = 0;                ///< of the surfactant's equation in the last step
    /// For which its equation is factored; the factors precondition those of other steps.
    struct Reference {
        double step = 0.0;
        std::vector<double> thickness, surfactant;
    } reference_;
    double diffusion_step_ = 0.0;  ///< for which the diffusion is factored
    mutable std::optional<MeshFlow> observed_;
    std::unique_ptr<Moving> moving_;  ///< nothing where films stand still
};

/// Adds the solver "vortex_particle".
void register_vortex_particle(sim::SolverRegistry& registry);

}  // namespace lamella::vortex_particle
