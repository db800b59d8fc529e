#pragma once

#include "lamella/film/solid.h"
#include "lamella/sim/registry.h"
#include "lamella/sim/solver.h"
#include "lamella/solvers/melp/contacts.h"
#include "lamella/solvers/melp/films.h"
#include "lamella/solvers/melp/normal_motion.h"
#include "lamella/solvers/melp/options.h"
#include "lamella/solvers/melp/particles.h"
#include "lamella/solvers/melp/rims.h"
#include "lamella/solvers/melp/surfactant.h"
#include "lamella/solvers/melp/transfer.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella::melp {

/// Thin films and foams by moving Eulerian-Lagrangian particles [Deng22], in the form of docs/melp.md: few coarse
/// particles carry the shape of the films, many fine ones are the liquid in them.
class MelpSolver final : public sim::Solver {
public:
    /// @throws InputError  options or films that do not go together
    MelpSolver(const Options& options, const sim::SolverInput& input);

    void start(const sim::StartContext& context) override;
    sim::StepReport advance(double time_limit) override;

    double time() const override { return time_; }
    std::int64_t step() const override { return steps_; }

    sim::Frame frame() const override;
    std::vector<sim::Scalar> scalars() const override;
    std::vector<sim::Scalar> characteristic_numbers() const override;
    double slow_motion() const override;
    std::vector<sim::Event> take_events() override { return std::exchange(events_, {}); }

    void save(sim::StateWriter& out) const override;
    void load(sim::StateReader& in) override;

    const CoarseParticles& coarse() const { return coarse_; }
    const FineParticles& fine() const { return fine_; }
    const std::vector<Gas>& gas() const { return gas_; }
    const std::vector<film::Body>& bodies() const { return bodies_; }
    const std::vector<RimPiece>& rims() const { return rims_now_; }
    const Geometry& geometry() const { return geometry_; }
    const Films& films() const { return films_; }
    double spacing() const { return spacing_; }

private:
    double liquid_density() const { return input_.films->material.liquid_density; }
    double support_radius() const { return options_.support_radius * spacing_; }
    double slowest_period(const std::vector<Gas>& bubbles) const;
    // The stages of a step, in order.
    double choose_step(double time_limit) const;
    double shorter_step(double dt) const;
    double strongest_pull() const;
    Vec3 wind_at(const Vec3& x) const;
    Vec3 weight_at(std::size_t i) const;
    std::vector<Vec3> surfactant_pull(std::span<const double> pressing) const;
    std::vector<Vec3> other_pull() const;
    double fastest_edge() const;
    double theta_of(double dt) const;
    SurfactantStep push_along_film(double dt);
    void carry_dry_along();
    NormalStep push_along_normals(double dt);
    void filter_short_waves();
    void give_to_fine(double dt);
    void move_coarse(double dt, const NormalStep& step);
    void move_fine(double dt);
    void pull_edges(double dt);
    void vent(double dt);
    void clear_edges();
    void keep_spacing();
    void apply_events();
    void apply(const film::Event& event);
    void move_solids(double dt);
    void burst_on_solids();
    void burst(std::size_t at, double radius, const std::string& kind);
    // Foams.
    bool is_foam() const;
    std::optional<std::size_t> place_of(mesh::RegionId region) const;
    std::optional<std::size_t> random_outer_bubble() const;
    void pop(const film::Event& event);
    void thin_out(const film::Event& event);
    void delete_bubble(std::size_t r);
    void hand_over_even_film(std::size_t r, std::size_t i);
    void join_bubbles(std::size_t from, std::size_t into);
    void renew_after_change();
    void burst_on_walls();
    bool is_free(const film::Release& release) const;
    void release_bubbles();
    std::ptrdiff_t waiting_bubbles() const;
    double next_release() const;
    void follow_contacts(double time);
    void load_contacts(sim::StateReader& in);
    void load_solids(sim::StateReader& in);
    std::vector<std::uint8_t> burst_regions() const;
    bool any_burst() const;
    void set_rims(double time);
    void keep_coarse_inside();
    void update_shape();
    void update_liquid();
    void gather_liquid();
    void exchange_liquid(double dt);
    void give_back_to_liquid(const std::vector<Vec3>& momentum);
    void give_back_to_even_films(const std::vector<Vec3>& drift);
    std::vector<Vec3> region_drifts_now() const;
    std::vector<std::ptrdiff_t> flying_clusters() const;
    void add_along_normals(const std::vector<std::ptrdiff_t>& cluster, const std::vector<Vec3>& velocity);
    void follow_particle_volumes(double dt);

    std::vector<double> masses() const;
    Vec3 velocity_of(std::size_t i) const;
    sim::Surface surface() const;
    std::vector<Vec3> region_momenta(std::span<const Vec3> velocity) const;
    std::vector<Vec3> region_velocities() const;
    void even_out_layout();
    std::string fault_of_step() const;

    Options options_;
    sim::SolverInput input_;
    film::SurfactantLaw law_;
    Heat heat_;

    CoarseParticles coarse_;
    FineParticles fine_;
    std::vector<Gas> gas_;
    std::vector<EvenFilm> even_;
    Rims rims_;
    std::vector<film::Body> bodies_;  ///< the solids of the scene
    double spacing_ = 0.0;
    double time_ = 0.0;
    std::int64_t steps_ = 0;
    double step_ = 0.0;            ///< the last one
    double initial_liquid_ = 0.0;  ///< and what has entered since [m^3]
    double left_liquid_ = 0.0;     ///< with bubbles of a foam that burst [m^3]
    std::size_t next_event_ = 0;
    std::vector<std::uint8_t> released_;  ///< per bubble of the faucets: it has entered
    Contacts contacts_;
    std::vector<sim::Event> events_;

    // What follows from the above: set by set_rims, update_shape and update_liquid.
    std::vector<RimPiece> rims_now_;
    Geometry geometry_;
    std::vector<double> joined_;  ///< per entry of the neighbors in other regions: see Contacts
    std::optional<Transfer> transfer_;
    Films films_;
    // Forces of this step that films exert on each other along themselves. [N]
    std::vector<Vec3> marangoni_;
};

/// Adds the solver "melp".
void register_melp(sim::SolverRegistry& registry);

}  // namespace lamella::melp
