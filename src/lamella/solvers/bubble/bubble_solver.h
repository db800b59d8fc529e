#pragma once

#include "lamella/sim/registry.h"
#include "lamella/sim/solver.h"
#include "lamella/solvers/bubble/clock.h"
#include "lamella/solvers/bubble/id_order.h"
#include "lamella/solvers/bubble/integrator.h"
#include "lamella/solvers/bubble/options.h"
#include "lamella/solvers/bubble/system.h"

#include <memory>
#include <vector>

namespace lamella::bubble {

template <int D>
struct Census;

namespace detail {
template <int D>
class DeviceRunner;
}

/// The wet-foam bubble model with gas exchange in D dimensions [Lankinen20]: discs or balls that push each other
/// apart, move against the liquid, exchange gas through the films between them and through the liquid, and vanish.
template <int D>
class BubbleSolver final : public sim::Solver {
public:
    /// @throws InputError  options that do not go together
    BubbleSolver(const Options& options, const sim::SolverInput& input);
    ~BubbleSolver() override;

    void start(const sim::StartContext& context) override;
    sim::StepReport advance(double time_limit) override;

    double time() const override { return clock_.time; }
    std::string time_unit() const override { return "-"; }
    std::int64_t step() const override { return clock_.steps; }
    std::optional<std::string> stop_reason() const override;
    std::optional<double> progress() const override;

    sim::Frame frame() const override;
    sim::Frame measured_frame() const override;
    void mark_frame() override;
    std::vector<sim::Scalar> scalars() const override;
    std::vector<sim::Event> take_events() override;
    std::vector<sim::Scalar> characteristic_numbers() const override;

    void save(sim::StateWriter& out) const override;
    void load(sim::StateReader& in) override;

    const System<D>& system() const {
        observe();
        return *system_;
    }

private:
    template <class Order>
    sim::Frame frame_of(Census<D> census, const Order& order, bool all_fields) const;
    std::vector<sim::Scalar> scalars_from(const Census<D>& census) const;
    IdOrder<D> id_order() const { return IdOrder<D>(*system_, start_count_); }
    void remember_start();
    void make_integrator();
    void take_to_device();
    sim::StepReport advance_on_device(double time_limit);
    void take_vanished_from_device();
    /// Brings the foam up to date with the device, where that holds it.
    void observe() const;
    std::size_t live() const;
    /// Remembers the largest bubble of the foam, which decides whether it still fits its box.
    void look_for_the_largest();

    Options options_;
    sim::SolverInput input_;
    double time_rate_;  ///< solver time per mechanical time
    dist::Alone alone_;
    Domain domain_;
    std::unique_ptr<System<D>> system_;
    std::unique_ptr<Integrator<D>> integrator_;

    /// Takes the steps instead of the integrator; empty on the CPU. What leaves the solver is taken from system_ there
    /// too.
    std::unique_ptr<detail::DeviceRunner<D>> device_;
    mutable bool observed_ = true;  ///< system_ is up to date with it

    Clock clock_;
    double start_gas_ = 0.0;  ///< sum of q at the start
    std::int64_t start_count_ = 0;
    double largest_size_ = 0.0;  ///< q of the largest bubble
    std::vector<sim::Event> events_;
};

/// Adds the solver "bubble".
void register_bubble(sim::SolverRegistry& registry);

}  // namespace lamella::bubble
