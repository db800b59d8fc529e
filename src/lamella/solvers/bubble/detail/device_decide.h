#pragma once

#include "lamella/solvers/bubble/detail/device_sums.h"

namespace lamella::bubble::detail {

/// End of a turn: one thread decides what comes next.
template <int D>
struct Decide {
    DeviceView<D> view;
    Control* control;

    LAMELLA_HOST_DEVICE void operator()(const UpdateSums& update, const GatherSums& gather) const {
        Control& c = *control;
        if (!c.running()) return;
        switch (c.phase) {
            case Phase::kFirst:
                return after_first(c, gather);
            case Phase::kKeep:
                return mean_radius_or_attempt(c);
            case Phase::kMeanRadius:
                return after_mean_radius(c, update);
            case Phase::kStage:
                return after_stage(c, update, gather);
            case Phase::kError:
                return after_error(c, update);
            case Phase::kErrorSquares: {
                const double sum = sum_of(FixedSum(c.sum_scale), &update.sum[1]).value();
                return judge(c, square_root(sum / static_cast<double>(c.live)));
            }
            case Phase::kAccept:
                return after_accept(c, update);
            case Phase::kRemove:
                return after_remove(c, update);
            case Phase::kShare:
                c.max_size = update.maximum[0];
                c.expansion = update.maximum[1];
                c.rates_current = 0;
                return begin_step(c);
        }
    }

    /// Between two steps: whether there is a next one, and with which lists.
    LAMELLA_HOST_DEVICE void begin_step(Control& c) const {
        c.first_attempt = 1;
        if (c.clock.time >= c.limit) return wait(c, Waiting::kLimit);
        if (static_cast<double>(c.live) <= c.end_count || 2.0 * Shape<D>::radius(c.max_size) >= c.shortest_edge)
            return wait(c, Waiting::kEnd);
        if (c.steps_left == 0) return wait(c, Waiting::kSteps);
        c.landing = c.clock.landing(c.limit, c.time_rate, smaller(c.next_step, c.max_step));
        c.step = {};
        if (c.expansion + 1.2 * c.expected_reach >= c.reach) {
            c.least_reach = 0.0;
            return wait(c, Waiting::kLists);
        }
        first_or_attempt(c);
    }

    /// The host has built new lists.
    LAMELLA_HOST_DEVICE void with_new_lists(Control& c) const {
        c.expansion = 0.0;
        c.first_attempt != 0 ? first_or_attempt(c) : begin_attempt(c);
    }

private:
    LAMELLA_HOST_DEVICE static void wait(Control& c, Waiting what) { c.waiting = what; }

    LAMELLA_HOST_DEVICE void first_or_attempt(Control& c) const {
        if (c.rates_current != 0) return mean_radius_or_attempt(c);
        c.phase = Phase::kFirst;
    }

    LAMELLA_HOST_DEVICE void mean_radius_or_attempt(Control& c) const {
        c.first_stiffness = c.stiffness;
        c.step_tolerance = c.tolerance;
        if (c.relative_error == 0) return begin_attempt(c);
        c.sum_scale = c.sum_bound(Shape<D>::radius(c.max_size));
        c.phase = Phase::kMeanRadius;
    }

    LAMELLA_HOST_DEVICE void begin_attempt(Control& c) const {
        c.first_attempt = 0;
        c.wanted = smaller(c.next_step, c.max_step);
        const auto stages = chebyshev::stages_for(smaller(c.wanted, c.landing.longest), c.first_stiffness);
        c.h = stages.h;
        c.stages = stages.count;
        c.stage = 1;
        c.stage_reach = 0.0;
        c.phase = Phase::kStage;
    }

    LAMELLA_HOST_DEVICE void close(Control& c, const GatherSums& gather) const {
        const DeviceView<D>& v = view;
        if (v.model.exchanges_gas()) {
            const GasSums sums{sum_of(v.no_gas.weight, &gather.sum[0]), sum_of(v.no_gas.weight_by_size, &gather.sum[2]),
                               sum_of(v.no_gas.scale, &gather.sum[4])};
            c.gas = close_exchange<D>(v.model, sums, static_cast<double>(c.live));
        }
        if (!c.bounds_stiffness()) return;
        c.stiffness = 2.0 * v.model.push_rate * gather.maximum[0];
        if (v.model.exchanges_gas()) c.stiffness += exchange_stiffness<D>(v.model);
        c.stiffness += gather.maximum[1];
    }

    LAMELLA_HOST_DEVICE void after_first(Control& c, const GatherSums& gather) const {
        close(c, gather);
        c.rates_current = 1;
        ++c.step.evaluations;
        c.phase = Phase::kKeep;
    }

    LAMELLA_HOST_DEVICE void after_mean_radius(Control& c, const UpdateSums& update) const {
        const double sum = sum_of(FixedSum(c.sum_scale), &update.sum[1]).value();
        c.step_tolerance = c.tolerance * (sum / static_cast<double>(c.live > 1 ? c.live : 1));
        begin_attempt(c);
    }

    LAMELLA_HOST_DEVICE void after_stage(Control& c, const UpdateSums& update, const GatherSums& gather) const {
        c.stage_reach = larger(c.stage_reach, update.maximum[0]);
        if (!(c.stage_reach < half_spacing<D>(c.box_volume, static_cast<double>(c.live)))) {
            c.step.evaluations += c.stages;
            c.next_step = 0.25 * c.h;
            return reject(c);
        }
        if (c.expansion + c.stage_reach >= c.reach) {
            c.least_reach = 2.0 * c.stage_reach;
            return wait(c, Waiting::kLists);
        }
        close(c, gather);
        if (!c.last_stage()) {
            ++c.stage;
            return;
        }
        c.step.evaluations += c.stages;
        c.phase = Phase::kError;
    }

    LAMELLA_HOST_DEVICE void after_error(Control& c, const UpdateSums& update) const {
        if (c.rms_error == 0) return judge(c, update.maximum[0]);
        c.sum_scale = c.sum_bound(update.maximum[0]);
        c.phase = Phase::kErrorSquares;
    }

    LAMELLA_HOST_DEVICE void judge(Control& c, double error) const {
        c.step.error = c.error = error;
        c.next_step = chebyshev::next_step(c.h, error, c.step_tolerance);
        if (!(error <= c.step_tolerance)) return reject(c);
        // A step that was cut short to meet an output time says little about the longest possible one.
        if (c.h < c.wanted) c.next_step = larger(c.next_step, c.wanted);
        c.step.time = c.step.clock = c.h;
        c.phase = Phase::kAccept;
    }

    LAMELLA_HOST_DEVICE void reject(Control& c) const {
        ++c.step.rejections;
        c.stiffness = c.first_stiffness;
        if (c.next_step < 1e-12) return wait(c, Waiting::kUnderflow);
        begin_attempt(c);
    }

    LAMELLA_HOST_DEVICE void after_accept(Control& c, const UpdateSums& update) const {
        c.expected_reach = c.stage_reach;
        c.max_size = update.maximum[0];
        c.expansion = update.maximum[1];
        c.clock.tick(c.step, c.landing, c.limit, c.time_rate);
        --c.steps_left;
        c.vanishing = static_cast<std::uint64_t>(update.sum[0]);
        if (c.vanishing == 0) return begin_step(c);
        if (c.vanishing >= c.live) return wait(c, Waiting::kNothing);
        c.excess = sum_of(FixedSum(view.model.total_size), &update.sum[1]).value();
        c.sum_scale = c.sum_bound(c.max_size);
        c.lost_scale = c.sum_bound(update.maximum[2]);
        c.phase = Phase::kRemove;
    }

    LAMELLA_HOST_DEVICE void after_remove(Control& c, const UpdateSums& update) const {
        c.live -= c.vanishing;
        c.survivors = sum_of(FixedSum(c.sum_scale), &update.sum[1]).value();
        c.lost = sum_of(FixedSum(c.lost_scale), &update.sum[3]).value();
        c.removal_factor = growth_by_removal<D>(c.excess / c.survivors, c.printed_removal != 0);
        c.phase = Phase::kShare;
    }
};

}  // namespace lamella::bubble::detail
