// Adams-Bashforth-Moulton predictor-corrector of order 2 [Lankinen20, 3.3.1], with the weights of a variable step and
// the clock of the step that was taken. The published factors and its clock are there for comparison.

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/solvers/bubble/integrator.h"
#include "lamella/solvers/bubble/move.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::bubble {
namespace {

/// How the step follows the error.
struct Control {
    double grow, shrink;      ///< factors after acceptance and rejection
    double grow_below_error;  ///< grow only when the error is below this share of the tolerance
    double grow_below_step;
    bool accepts_equality;
};
constexpr Control kThesis{1.9, 0.5, 1.0, 0.1, false};
constexpr Control kCubble{1.269, 0.37, 0.45, 10.0, true};

enum class Reach {
    kInLists,
    kBeyondLists,  ///< a bubble left the reach of the neighbor lists: build new ones and repeat the same step
    kTooFar,       ///< a bubble jumped out of its neighborhood: the step must be shorter
};
struct Reached {
    Reach how;
    double distance;  ///< largest |dx| + dR
};

template <int D>
class Abm2 final : public Integrator<D> {
public:
    Abm2(const Options& options, System<D>& system)
        : options_(options.integrator), compat_(options.compat), next_step_(options.integrator.initial_step) {
        system.attached = system.attached_size_rates = {&previous_.size};
        for (auto& column : previous_.position) system.attached.push_back(&column);
        system.scratch = {&predicted_.size, &corrected_.size, &predicted_size_rate_};
        for (Increment<D>* increment : {&predicted_, &corrected_})
            for (auto& column : increment->position) system.scratch.push_back(&column);
    }

    void begin(System<D>& system) override;
    Step step(System<D>& system, double longest) override;
    /// The history stays, as published: the push of a bubble that vanished leaves it within two steps.
    void foam_changed() override {}
    double next_step() const override { return next_step_; }
    IntegratorState state() const override { return {.next_step = next_step_}; }
    void set_state(const IntegratorState& state) override { next_step_ = state.next_step; }

    void save(sim::StateWriter& out, const IdOrder<D>& order) const override;
    void load(sim::StateReader& in, System<D>& system) override;

private:
    bool adapt(double error, double tolerance, double h);
    template <class Fill>
    static Reached fill(const System<D>& system, const Increment<D>& increment, double expansion, Fill&& of_bubble);

    IntegratorOptions options_;
    CompatOptions compat_;
    double next_step_;
    double last_step_ = 0.0;      // 0: no history yet
    Increment<D> previous_;       // f_(n-1): velocity and size rate
    Increment<D> predicted_;      // y^ - y_n
    Increment<D> corrected_;      // y_(n+1) - y_n
    Column predicted_size_rate_;  // f^ of q
};

/// f_n at the start; without a history the first predictor is Euler's.
template <int D>
void Abm2<D>::begin(System<D>& system) {
    system.stage_current();
    const Evaluation first = system.evaluate(Gas::kOn, Stiffness::kSkip);
    system.keep_rates(first.gas);
    previous_.position = system.foam.velocity;
    previous_.size = system.foam.size_rate;
}

/// Steps the published way (fixed factors) or by the error's order. True: the step is accepted.
template <int D>
bool Abm2<D>::adapt(double error, double tolerance, double h) {
    if (compat_.step_control == StepControl::kDefault) {
        const double factor = 0.9 * std::cbrt(tolerance / std::max(error, 1e-30));
        const bool accepted = error <= tolerance;
        next_step_ = h * std::clamp(factor, 0.2, accepted ? 1.5 : 0.9);
        return accepted;
    }
    const Control& c = compat_.step_control == StepControl::kThesis ? kThesis : kCubble;
    const bool accepted = c.accepts_equality ? error <= tolerance : error < tolerance;
    if (!accepted)
        next_step_ = c.shrink * h;
    else
        next_step_ = error < c.grow_below_error * tolerance && h < c.grow_below_step ? c.grow * h : h;
    return accepted;
}

/// Fills an increment bubble by bubble, and tells how far it leads. Lists are only asked about where the state may go:
/// whether a step is too long must not depend on them.
template <int D>
template <class Fill>
Reached Abm2<D>::fill(const System<D>& system, const Increment<D>& increment, double expansion, Fill&& of_bubble) {
    const double reach = system.domain().largest(parallel_max(system.foam.slots, 0.0, [&](std::size_t i) {
        if (!system.foam.alive(i)) return 0.0;
        of_bubble(i);
        double squared = 0.0;
        for (std::size_t k = 0; k < D; ++k) squared += increment.position[k][i] * increment.position[k][i];
        const double size = std::max(system.foam.size[i] + increment.size[i], system.model.floor_size);
        const double growth = std::max(increment.size[i], 0.0) / (D == 2 ? std::sqrt(size) : std::cbrt(size * size));
        return std::sqrt(squared) + growth;
    }));
    if (!(reach < farthest_move(system))) return {Reach::kTooFar, reach};
    return {expansion + reach < system.reach() ? Reach::kInLists : Reach::kBeyondLists, reach};
}

template <int D>
Step Abm2<D>::step(System<D>& system, double longest) {
    Step done;
    Foam<D>& foam = system.foam;
    const bool exchange = system.model.exchanges_gas();
    double expansion = system.expansion();
    if (expansion >= 0.8 * system.reach()) {
        system.rebuild();
        expansion = 0.0;
    }
    const auto size_scratch = [&] {
        predicted_.assign_zero(system.length());
        corrected_.assign_zero(system.length());
        predicted_size_rate_.assign(system.length(), 0.0);
    };
    size_scratch();
    const double tolerance = options_.tolerance * (options_.relative_error ? system.mean_radius() : 1.0);

    while (true) {
        const double wanted = std::min(next_step_, options_.max_step);
        const double h = std::min(wanted, longest);
        const bool fixed_weights = compat_.step_control != StepControl::kDefault;
        const double ratio = last_step_ == 0.0 || fixed_weights ? 1.0 : h / last_step_;

        // Predict: y^ = y_n + h ((1 + w/2) f_n - (w/2) f_(n-1)), w = h/h_prev
        const double now = h * (1.0 + 0.5 * ratio);
        const double before = h * 0.5 * ratio;
        const auto predict = [&](double rate, double previous) { return now * rate - before * previous; };
        Reached reached = fill(system, predicted_, expansion, [&](std::size_t i) {
            for (std::size_t k = 0; k < D; ++k)
                predicted_.position[k][i] = predict(foam.velocity[k][i], previous_.position[k][i]);
            if (exchange) predicted_.size[i] = predict(foam.size_rate[i], previous_.size[i]);
        });

        // Correct: y_(n+1) = y_n + h (f^ + f_n)/2
        if (reached.how == Reach::kInLists) {
            stage_moved(system, predicted_);
            const GasExchange gas = system.evaluate(Gas::kOn, Stiffness::kSkip).gas;
            reached = fill(system, corrected_, expansion, [&](std::size_t i) {
                for (std::size_t k = 0; k < D; ++k)
                    corrected_.position[k][i] = 0.5 * h * (system.rates.velocity[k][i] + foam.velocity[k][i]);
                if (!exchange) return;
                predicted_size_rate_[i] =
                    gas.size_rate(system.rates.film[i], system.rates.weight[i], system.stage.inverse_radius[i]);
                corrected_.size[i] = 0.5 * h * (predicted_size_rate_[i] + foam.size_rate[i]);
            });
        }
        if (reached.how == Reach::kBeyondLists) {
            system.rebuild(2.0 * reached.distance);
            size_scratch();
            expansion = 0.0;
            continue;
        }
        ++done.evaluations;
        done.error = std::numeric_limits<double>::infinity();
        if (reached.how == Reach::kInLists)
            done.error = error_norm<D>(system, options_.norm, [&](std::size_t i, double* ex, double& eq) {
                for (std::size_t k = 0; k < D; ++k) ex[k] = predicted_.position[k][i] - corrected_.position[k][i];
                eq = predicted_.size[i] - corrected_.size[i];
            });
        if (adapt(done.error, tolerance, h)) {
            if (h < wanted && !fixed_weights) next_step_ = std::max(next_step_, wanted);
            done.time = h;
            done.clock = compat_.clock ? next_step_ : h;
            break;
        }
        ++done.rejections;
        if (next_step_ < 1e-12) throw NumericalError(step_underflow(done.error, tolerance));
    }

    stage_moved(system, corrected_);
    previous_.position = foam.velocity;
    previous_.size = foam.size_rate;
    accept_moved(system, corrected_);
    if (options_.evaluate_again) {
        const Evaluation again = system.evaluate(Gas::kOn, Stiffness::kSkip);
        system.keep_rates(again.gas);
        ++done.evaluations;
    } else {
        for (std::size_t k = 0; k < D; ++k) foam.velocity[k] = system.rates.velocity[k];
        foam.size_rate = predicted_size_rate_;
    }
    last_step_ = done.time;
    return done;
}

template <int D>
void Abm2<D>::save(sim::StateWriter& out, const IdOrder<D>& order) const {
    const auto write = [&](const std::string& name, const Column& column) {
        const std::vector<double> sorted = order.column([&](std::size_t i) { return column[i]; });
        out.write_part(name, std::span<const double>(sorted), order.part());
    };
    out.write_value("integrator/next_step", next_step_);
    out.write_value("integrator/last_step", last_step_);
    for (std::size_t k = 0; k < D; ++k) write(fmt::format("integrator/previous_velocity_{}", k), previous_.position[k]);
    write("integrator/previous_size_rate", previous_.size);
}

template <int D>
void Abm2<D>::load(sim::StateReader& in, System<D>& system) {
    const auto total = system.foam.live;
    const auto read = [&](const std::string& name, Column& column) {
        std::vector<double> values;
        in.read_part(name, total, values);
        column.assign(system.length(), 0.0);
        std::copy(values.begin(), values.end(), column.begin());
    };
    next_step_ = in.read_double("integrator/next_step");
    last_step_ = in.read_double("integrator/last_step");
    for (std::size_t k = 0; k < D; ++k) read(fmt::format("integrator/previous_velocity_{}", k), previous_.position[k]);
    read("integrator/previous_size_rate", previous_.size);
}

}  // namespace

template <int D>
std::unique_ptr<Integrator<D>> make_abm2(const Options& options, System<D>& system) {
    return std::make_unique<Abm2<D>>(options, system);
}

template std::unique_ptr<Integrator<2>> make_abm2<2>(const Options&, System<2>&);
template std::unique_ptr<Integrator<3>> make_abm2<3>(const Options&, System<3>&);

}  // namespace lamella::bubble
