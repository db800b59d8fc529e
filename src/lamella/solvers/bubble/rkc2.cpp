// Runge-Kutta-Chebyshev of order 2 [Sommeijer98]: s evaluations buy a step of 0.65 s^2 relaxation times, where an
// explicit method of fixed order gets s/2. Written in increments d_j = Y_j - y_n, so that the gas, a linear
// invariant, is conserved to round-off, and so that the state is read once per stage.

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/core/simd.h"
#include "lamella/solvers/bubble/chebyshev.h"
#include "lamella/solvers/bubble/integrator.h"
#include "lamella/solvers/bubble/move.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella::bubble {
namespace {

constexpr std::size_t kGroupsPerBlock = 512;

using chebyshev::StageWeights;

enum class StagesEnd {
    kDone,
    kListsOutgrown,  ///< a bubble left the reach of the neighbor lists: build new ones and repeat the same step
    kTooFar,         ///< a bubble jumped out of its neighborhood: the step must be shorter
};

template <int D>
class Rkc2 final : public Integrator<D> {
public:
    Rkc2(const Options& options, System<D>& system)
        : options_(options.integrator), next_step_(options.integrator.initial_step) {
        system.scratch = {&last_.size, &before_.size};
        for (Increment<D>* increment : {&last_, &before_})
            for (auto& column : increment->position) system.scratch.push_back(&column);
    }

    void begin(System<D>& system) override { evaluate_first(system); }
    Step step(System<D>& system, double longest) override;
    void foam_changed() override { rates_current_ = false; }
    double next_step() const override { return next_step_; }
    IntegratorState state() const override { return {next_step_, stiffness_, rates_current_}; }
    void set_state(const IntegratorState& state) override {
        next_step_ = state.next_step;
        stiffness_ = state.stiffness;
        rates_current_ = state.rates_current;
    }

    void save(sim::StateWriter& out, const IdOrder<D>&) const override {
        out.write_value("integrator/next_step", next_step_);
        out.write_value("integrator/stiffness", stiffness_);
        out.write_value("integrator/rates_current", std::int64_t{rates_current_});
    }
    void load(sim::StateReader& in, System<D>&) override {
        next_step_ = in.read_double("integrator/next_step");
        stiffness_ = in.read_double("integrator/stiffness");
        rates_current_ = in.read_integer("integrator/rates_current") != 0;
    }

private:
    void evaluate_first(System<D>& system);
    StagesEnd run_stages(System<D>& system, double h, int stages);
    double advance_stage(System<D>& system, const StageWeights& weights, double h, int number);
    double step_error(const System<D>& system, const GasExchange& gas, double h) const;

    IntegratorOptions options_;
    double next_step_;
    double stiffness_ = 0.0;      // largest relaxation rate at the current state
    bool rates_current_ = false;  // foam.velocity and size_rate belong to the current state

    // Scratch of one step.
    Increment<D> last_, before_;  // d_(j-1), d_(j-2)
    GasExchange gas_;             // of the last evaluated stage
    double start_expansion_ = 0.0;
    double stage_reach_ = 0.0;     // largest |dx| + dR of the stages so far
    double expected_reach_ = 0.0;  // of the last step: decides whether lists are rebuilt before the next
    std::int64_t evaluations_ = 0;
};

template <int D>
void Rkc2<D>::evaluate_first(System<D>& system) {
    if (rates_current_) return;
    system.stage_current();
    const Evaluation first = system.evaluate(Gas::kOn, Stiffness::kBound);
    system.keep_rates(first.gas);
    stiffness_ = first.stiffness;
    rates_current_ = true;
    ++evaluations_;
}

/// One stage: the increment, the state that it leads to, and the largest |dx| + dR of a bubble here from the step's
/// start.
template <int D>
double Rkc2<D>::advance_stage(System<D>& system, const StageWeights& w, double h, int number) {
    const Foam<D>& foam = system.foam;
    Stage<D>& stage = system.stage;
    const Rates<D>& rates = system.rates;
    const Model& model = system.model;
    const bool exchange = model.exchanges_gas();
    const StageWeights step{w.mu, w.nu, h * w.rate, h * w.first_rate};
    const bool first = number == 1;
    const auto load_before = [&](const Column& column, std::size_t at) {
        return number == 2 ? Simd(0.0) : load_lanes(&column[at]);  // d_0
    };

    const auto group_reach = [&](std::size_t at) {
        Simd squared = 0.0;
        for (std::size_t k = 0; k < D; ++k) {
            const Simd f0 = load_lanes(&foam.velocity[k][at]);
            const Simd d = first ? step.first_rate * f0
                                 : chebyshev::stage_increment(step, f0, load_lanes(&last_.position[k][at]),
                                                              load_before(before_.position[k], at),
                                                              load_lanes(&rates.velocity[k][at]));
            store_lanes(d, &before_.position[k][at]);
            store_lanes(load_lanes(&foam.position[k][at]) + d, &stage.position[k][at]);
            squared += d * d;
        }
        const Simd reach = square_root(squared);
        if (!exchange) return stdx::hmax(reach);

        const Simd f0 = load_lanes(&foam.size_rate[at]);
        Simd d = step.first_rate * f0;
        if (!first) {
            const Simd size_rate = gas_.size_rate(load_lanes(&rates.film[at]), load_lanes(&rates.weight[at]),
                                                  load_lanes(&stage.inverse_radius[at]));
            d = chebyshev::stage_increment(step, f0, load_lanes(&last_.size[at]), load_before(before_.size, at),
                                           size_rate);
        }
        store_lanes(d, &before_.size[at]);
        const Simd size = load_lanes(&foam.size[at]);
        const StagedRadius<Simd> staged = staged_radius<D>(model, size, Simd(size + d));
        store_lanes(staged.radius, &stage.radius[at]);
        store_lanes(staged.inverse, &stage.inverse_radius[at]);
        return stdx::hmax(reach + growth_bound<D>(d, staged.inverse));
    };
    const double reach = parallel_reduce(
        system.length() / kLanes, 0.0,
        [&](std::size_t begin, std::size_t end) {
            double largest = 0.0;
            for (std::size_t g = begin; g < end; ++g) largest = std::max(largest, group_reach(g * kLanes));
            return largest;
        },
        [](double a, double b) { return std::max(a, b); }, kGroupsPerBlock);
    std::swap(last_, before_);
    return reach;
}

/// Stages 1 to s; `stage` is then the new state, evaluated.
template <int D>
StagesEnd Rkc2<D>::run_stages(System<D>& system, double h, int stages) {
    const std::vector<StageWeights> weights = chebyshev::stage_weights(stages);
    const double farthest = farthest_move(system);
    const auto limit = [&] {
        if (!(stage_reach_ < farthest)) return StagesEnd::kTooFar;
        return start_expansion_ + stage_reach_ < system.reach() ? StagesEnd::kDone : StagesEnd::kListsOutgrown;
    };
    stage_reach_ = 0.0;
    last_.resize(system.length());
    before_.resize(system.length());
    for (int j = 1; j <= stages; ++j) {
        const double reach = advance_stage(system, weights[static_cast<std::size_t>(j)], h, j);
        stage_reach_ = std::max(stage_reach_, reach);
        const bool last = j == stages;
        // How far the bubbles of others went is only known after the evaluation, which is then for nothing.
        if (const StagesEnd here = limit(); here == StagesEnd::kDone) {
            if (last) stage_moved(system, last_);
        } else {
            if (!system.domain().several()) return here;
            system.stage_current();  // a state whose sums are in bounds
        }
        const Evaluation evaluation =
            system.evaluate(Gas::kOn, last ? Stiffness::kBound : Stiffness::kSkip, &stage_reach_);
        if (const StagesEnd all = limit(); all != StagesEnd::kDone) return all;
        gas_ = evaluation.gas;
        if (last) stiffness_ = evaluation.stiffness;
    }
    return StagesEnd::kDone;
}

template <int D>
double Rkc2<D>::step_error(const System<D>& system, const GasExchange& gas, double h) const {
    const Foam<D>& foam = system.foam;
    const Rates<D>& rates = system.rates;
    const bool exchange = system.model.exchanges_gas();
    return error_norm<D>(system, options_.norm, [&](std::size_t i, double* ex, double& eq) {
        for (std::size_t k = 0; k < D; ++k)
            ex[k] = chebyshev::step_error(h, last_.position[k][i], foam.velocity[k][i], rates.velocity[k][i]);
        if (!exchange) return;
        const double rate = gas.size_rate(rates.film[i], rates.weight[i], system.stage.inverse_radius[i]);
        eq = chebyshev::step_error(h, last_.size[i], foam.size_rate[i], rate);
    });
}

template <int D>
Step Rkc2<D>::step(System<D>& system, double longest) {
    Step done;
    evaluations_ = 0;
    start_expansion_ = system.expansion();
    if (start_expansion_ + 1.2 * expected_reach_ >= system.reach()) {
        system.rebuild();
        start_expansion_ = 0.0;
    }
    evaluate_first(system);
    const double tolerance = options_.tolerance * (options_.relative_error ? system.mean_radius() : 1.0);
    const double first_stiffness = stiffness_;

    while (true) {
        const double wanted = std::min(next_step_, options_.max_step);
        const auto [stages, h] = chebyshev::stages_for(std::min(wanted, longest), first_stiffness);
        const StagesEnd end = run_stages(system, h, stages);
        if (end == StagesEnd::kListsOutgrown) {
            system.rebuild(2.0 * stage_reach_);
            start_expansion_ = 0.0;
            continue;
        }
        evaluations_ += stages;
        if (end == StagesEnd::kTooFar) {
            next_step_ = 0.25 * h;
        } else {
            done.error = step_error(system, gas_, h);
            next_step_ = chebyshev::next_step(h, done.error, tolerance);
            if (done.error <= tolerance) {
                // A step that was cut short to meet an output time says little about the longest possible one.
                if (h < wanted) next_step_ = std::max(next_step_, wanted);
                done.time = done.clock = h;
                break;
            }
        }
        ++done.rejections;
        stiffness_ = first_stiffness;
        if (next_step_ < 1e-12) throw NumericalError(step_underflow(done.error, tolerance));
    }
    expected_reach_ = stage_reach_;
    accept_moved(system, last_);
    system.keep_rates(gas_);
    done.evaluations = evaluations_;
    return done;
}

}  // namespace

template <int D>
std::unique_ptr<Integrator<D>> make_rkc2(const Options& options, System<D>& system) {
    return std::make_unique<Rkc2<D>>(options, system);
}

template std::unique_ptr<Integrator<2>> make_rkc2<2>(const Options&, System<2>&);
template std::unique_ptr<Integrator<3>> make_rkc2<3>(const Options&, System<3>&);

}  // namespace lamella::bubble
