#pragma once

#include "lamella/sim/registry.h"
#include "lamella/sim/solver.h"
#include "lamella/solvers/equilibrium/options.h"
#include "lamella/solvers/equilibrium/relaxation.h"
#include "lamella/solvers/equilibrium/rest_answer.h"

#include <memory>
#include <optional>
#include <vector>

namespace lamella::equilibrium {

/// Where films come to rest: least area at given volumes. Coming to rest takes no time; time goes on from rest to rest,
/// from one event to the next.
class EquilibriumSolver final : public sim::Solver {
public:
    /// @throws InputError  options or films that do not go together
    EquilibriumSolver(const Options& options, const sim::SolverInput& input);

    void start(const sim::StartContext& context) override;
    sim::StepReport advance(double time_limit) override;

    double time() const override { return time_; }
    std::int64_t step() const override { return steps_; }
    std::optional<std::string> stop_reason() const override;

    sim::Frame frame() const override;
    std::vector<sim::Scalar> scalars() const override;
    std::vector<sim::Event> take_events() override;
    std::vector<sim::Scalar> characteristic_numbers() const override;

    void save(sim::StateWriter& out) const override;
    void load(sim::StateReader& in) override;

    const RestAnswer* answer() const { return answer_ ? &*answer_ : nullptr; }
    const Relaxation& relaxation() const { return *relaxation_; }

private:
    RelaxationOptions relaxation_options() const;
    void relax();
    void come_to_rest();
    void apply_events();
    void apply(const film::Event& event);
    void collect_events();
    // Annealing.
    bool annealing() const { return anneal_round_ < options_.anneal_rounds; }
    void anneal();
    void shake_volumes();
    void give_up_round();

    Options options_;
    sim::SolverInput input_;
    std::unique_ptr<Relaxation> relaxation_;
    std::optional<RestAnswer> answer_;  ///< while at rest
    double time_ = 0.0;
    std::int64_t steps_ = 0;
    std::size_t next_event_ = 0;
    int steps_to_rest_ = 0;  ///< since the films last left their rest
    std::vector<sim::Event> events_;

    enum class Anneal { kRest, kShaken };
    Anneal anneal_ = Anneal::kRest;
    int anneal_round_ = 0;
    double best_area_ = 0.0;
    mesh::FoamMesh best_mesh_;
    double best_edge_ = 0.0;
};

/// Adds the solver "equilibrium".
void register_equilibrium(sim::SolverRegistry& registry);

}  // namespace lamella::equilibrium
