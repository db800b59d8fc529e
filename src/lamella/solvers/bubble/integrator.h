#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "lamella/sim/archive.h"
#include "lamella/solvers/bubble/clock.h"
#include "lamella/solvers/bubble/id_order.h"
#include "lamella/solvers/bubble/integrator_state.h"
#include "lamella/solvers/bubble/system.h"

namespace lamella::bubble {

/// Advances a System by adaptive steps.
template <int D>
class Integrator {
public:
    virtual ~Integrator() = default;

    /// Evaluates the rates of the first state. Without it (after load) the saved rates are used.
    virtual void begin(System<D>& system) = 0;
    /// Takes one step of at most `longest`. @throws NumericalError  no step is small enough; the state is unchanged
    virtual Step step(System<D>& system, double longest) = 0;
    /// The foam changed between steps (bubbles vanished): rates must be evaluated anew.
    virtual void foam_changed() = 0;
    /// The step that the next attempt would like to take.
    virtual double next_step() const = 0;

    /// What is exchanged with a device that takes the steps instead. Only for rkc2: abm2 has a history as well.
    virtual IntegratorState state() const = 0;
    virtual void set_state(const IntegratorState& state) = 0;

    virtual void save(sim::StateWriter& out, const IdOrder<D>& order) const = 0;
    /// The foam holds this process's share of the bubbles, as they were read.
    virtual void load(sim::StateReader& in, System<D>& system) = 0;
};

/// What a NumericalError says when no step is small enough.
std::string step_underflow(double error, double tolerance);

template <int D>
std::unique_ptr<Integrator<D>> make_rkc2(const Options& options, System<D>& system);
template <int D>
std::unique_ptr<Integrator<D>> make_abm2(const Options& options, System<D>& system);

}  // namespace lamella::bubble
