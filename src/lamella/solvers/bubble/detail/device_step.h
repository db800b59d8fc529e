#pragma once

#include "lamella/solvers/bubble/contact.h"
#include "lamella/solvers/bubble/detail/device_view.h"
#include "lamella/solvers/bubble/increment.h"

// One turn of the loops that advance a foam on a GPU by steps of rkc2 (see rkc2.cpp, whose bits this repeats): update
// each bubble, gather over its contacts, decide. The phase says what a turn does; decisions are taken by one thread on
// what the loops have added up, and the host is asked only for new neighbor lists.

namespace lamella::bubble::detail {

using UpdateSums = Reduction<3, 5>;
using GatherSums = Reduction<2, 6>;

/// First loop of a turn: the state and the stage of each bubble.
template <int D>
struct UpdateBubble {
    DeviceView<D> view;
    Control* control;

    LAMELLA_HOST_DEVICE std::size_t count() const { return control->running() ? control->slots : 0; }

    LAMELLA_HOST_DEVICE void operator()(std::size_t i, UpdateSums& sums) const {
        const DeviceView<D>& v = view;
        const Control c = *control;  // a copy: it need not be read again after every store
        switch (c.phase) {
            case Phase::kFirst:
                return stage_current(v, i);
            case Phase::kKeep:
                return keep_rates(v, c, i);
            case Phase::kMeanRadius:
                return add_term(FixedSum(c.sum_scale), Shape<D>::radius(v.size[i]), &sums.sum[1]);
            case Phase::kStage:
                return advance_stage(v, c, i, sums);
            case Phase::kError:
                return sums.raise(0, c.rms_error != 0 ? squared(error(v, c, i)) : error(v, c, i));
            case Phase::kErrorSquares:
                return add_term(FixedSum(c.sum_scale), squared(error(v, c, i)), &sums.sum[1]);
            case Phase::kAccept:
                return accept(v, c, i, sums);
            case Phase::kRemove:
                return remove(v, c, i, &control->events, sums);
            case Phase::kShare:
                return share(v, c, i, sums);
        }
    }

private:
    LAMELLA_HOST_DEVICE static double squared(double a) { return a * a; }

    LAMELLA_HOST_DEVICE static void stage_current(const DeviceView<D>& v, std::size_t i) {
        double x[D];
        for (int k = 0; k < D; ++k) x[k] = v.position[k][i];
        v.stage[i] = staged_ball<D>(x, staged_radius<D>(v.model, v.size[i], v.size[i]));
    }

    LAMELLA_HOST_DEVICE static double size_rate(const DeviceView<D>& v, const Control& c, std::size_t i) {
        if (!v.model.exchanges_gas()) return 0.0;
        return c.gas.size_rate(v.film[i], v.weight[i], v.stage[i].inverse_radius());
    }

    LAMELLA_HOST_DEVICE static void keep_rates(const DeviceView<D>& v, const Control& c, std::size_t i) {
        for (int k = 0; k < D; ++k) v.velocity[k][i] = v.rate[k][i];
        v.size_rate[i] = size_rate(v, c, i);
    }

    /// Stage j writes where d_(j-2) stood. The last stage is wrapped into the box.
    LAMELLA_HOST_DEVICE static void advance_stage(const DeviceView<D>& v,
                                                  const Control& c,
                                                  std::size_t i,
                                                  UpdateSums& sums) {
        const chebyshev::StageWeights& w = v.weights[c.stages * (c.stages + 1) / 2 + c.stage];
        const chebyshev::StageWeights step{w.mu, w.nu, c.h * w.rate, c.h * w.first_rate};
        const bool first = c.stage == 1;
        const int to = c.stage & 1;
        const auto increment = [&](double first_rate, const double* last, double* before, double rate) {
            const double d =
                first ? step.first_rate * first_rate
                      : chebyshev::stage_increment(step, first_rate, last[i], c.stage == 2 ? 0.0 : before[i], rate);
            before[i] = d;
            return d;
        };
        double x[D];
        double length = 0.0;
        for (int k = 0; k < D; ++k) {
            const double d =
                increment(v.velocity[k][i], v.increment[1 - to][k], v.increment[to][k], first ? 0.0 : v.rate[k][i]);
            x[k] = v.position[k][i] + d;
            length += d * d;
            std::int32_t crossings = 0;
            const auto axis = static_cast<std::size_t>(k);
            if (c.last_stage() && v.liquid.box.periodic[axis])
                x[k] = wrapped(x[k], v.liquid.box.lengths[axis], crossings);
        }
        double reach = square_root(length);
        double dq = 0.0;
        if (v.model.exchanges_gas())
            dq = increment(v.size_rate[i], v.size_increment[1 - to], v.size_increment[to],
                           first ? 0.0 : size_rate(v, c, i));
        const StagedRadius<double> radius = staged_radius<D>(v.model, v.size[i], v.size[i] + dq);
        v.stage[i] = staged_ball<D>(x, radius);
        if (v.model.exchanges_gas()) reach += growth_bound<D>(dq, radius.inverse);
        // A NaN would lose every comparison: it has gone too far.
        sums.raise(0, reach == reach ? reach : std::numeric_limits<double>::infinity());
    }

    LAMELLA_HOST_DEVICE static double increment_of(const DeviceView<D>& v, const Control& c, int k, std::size_t i) {
        return v.increment[c.stages & 1][k][i];
    }
    LAMELLA_HOST_DEVICE static double size_increment_of(const DeviceView<D>& v, const Control& c, std::size_t i) {
        return v.model.exchanges_gas() ? v.size_increment[c.stages & 1][i] : 0.0;
    }

    LAMELLA_HOST_DEVICE static double error(const DeviceView<D>& v, const Control& c, std::size_t i) {
        double ex[D];
        for (int k = 0; k < D; ++k)
            ex[k] = chebyshev::step_error(c.h, increment_of(v, c, k, i), v.velocity[k][i], v.rate[k][i]);
        double eq = 0.0;
        if (v.model.exchanges_gas())
            eq = chebyshev::step_error(c.h, size_increment_of(v, c, i), v.size_rate[i], size_rate(v, c, i));
        return bubble_error<D>(ex, eq, v.stage[i].radius, v.min_radius);
    }

    /// |dx| + dR since the lists were built.
    LAMELLA_HOST_DEVICE static double expansion(const DeviceView<D>& v, std::size_t i) {
        if (!v.alive(i)) return 0.0;
        double length = 0.0;
        for (int k = 0; k < D; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            const double s = v.position[k][i] - v.built_position[k][i];
            const double image = s - v.liquid.box.lengths[axis] * std::nearbyint(s * v.inverse_lengths[axis]);
            length += image * image;
        }
        return square_root(length) + Shape<D>::radius(v.size[i]) - v.built_radius[i];
    }

    LAMELLA_HOST_DEVICE static void accept(const DeviceView<D>& v, const Control& c, std::size_t i, UpdateSums& sums) {
        if (v.alive(i)) {
            double length = 0.0;
            for (int k = 0; k < D; ++k) {
                const auto axis = static_cast<std::size_t>(k);
                const double move = increment_of(v, c, k, i);
                length += move * move;
                if (v.liquid.box.periodic[axis])
                    wrapped(v.position[k][i] + move, v.liquid.box.lengths[axis], v.wraps[k][i]);
                v.position[k][i] = v.stage[i].x[k];
            }
            v.path_length[i] += square_root(length);
            v.size[i] += size_increment_of(v, c, i);
        }
        keep_rates(v, c, i);
        if (v.stage[i].radius > 0.0 && v.size[i] <= v.model.min_size) {
            ++sums.sum[0];
            add_term(FixedSum(v.model.total_size), v.size[i], &sums.sum[1]);
            sums.raise(2, std::fabs(v.size_rate[i]));
        }
        sums.raise(0, v.size[i]);
        sums.raise(1, expansion(v, i));
    }

    LAMELLA_HOST_DEVICE static void remove(
        const DeviceView<D>& v, const Control& c, std::size_t i, std::uint32_t* events, UpdateSums& sums) {
        if (v.stage[i].radius > 0.0 && v.size[i] <= v.model.min_size) {
            // The list of events is sorted by the host: the order in which they come here does not matter.
            VanishedBubble<D>& event = v.vanished[count_one(events)];
            event.id = v.id[i];
            event.step = c.clock.steps;
            event.time = c.clock.time;
            for (int k = 0; k < D; ++k) event.position[k] = v.position[k][i];
            add_term(FixedSum(c.lost_scale), v.size_rate[i], &sums.sum[3]);
            v.size[i] = 0.0;
            v.size_rate[i] = 0.0;
            for (int k = 0; k < D; ++k) v.velocity[k][i] = 0.0;
            v.stage[i].radius = 0.0;
        }
        add_term(FixedSum(c.sum_scale), v.size[i], &sums.sum[1]);
    }

    LAMELLA_HOST_DEVICE static void share(const DeviceView<D>& v, const Control& c, std::size_t i, UpdateSums& sums) {
        v.size_rate[i] += c.lost * v.size[i] / c.survivors;
        v.size[i] *= c.removal_factor;
        sums.raise(0, v.size[i]);
        sums.raise(1, expansion(v, i));
    }
};

/// Second loop of a turn: the right-hand side of each bubble at the stage, one thread per bubble over its whole list.
template <int D>
struct GatherBubble {
    DeviceView<D> view;
    const Control* control;

    LAMELLA_HOST_DEVICE std::size_t count() const {
        return control->running() && control->evaluates() ? control->slots : 0;
    }

    LAMELLA_HOST_DEVICE void operator()(std::size_t i, GatherSums& sums) const {
        const bool gas = view.model.exchanges_gas();
        if (control->bounds_stiffness())
            gas ? gather<true, true>(i, sums) : gather<false, true>(i, sums);
        else
            gas ? gather<true, false>(i, sums) : gather<false, false>(i, sums);
    }

private:
    LAMELLA_HOST_DEVICE void separate(const DeviceView<D>& v,
                                      const StagedBall<D>& me,
                                      const StagedBall<D>& other,
                                      std::uint64_t e,
                                      double (&separation)[D]) const {
        for (int k = 0; k < D; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            const double s = me.x[k] - other.x[k];
            const double image = v.image != nullptr
                                     ? static_cast<double>(static_cast<std::int8_t>(v.image[e] >> (8 * k)))
                                     : std::nearbyint(s * v.inverse_lengths[axis]);
            separation[k] = s - v.liquid.box.lengths[axis] * image;
        }
    }

    template <bool kGas, bool kStiffness>
    LAMELLA_HOST_DEVICE void gather(std::size_t i, GatherSums& sums) const {
        const DeviceView<D>& v = view;
        const StagedBall<D> me = v.stage[i];
        ContactSums<D, double, kGas, kStiffness> contacts;
        if (me.radius > 0.0) {
            std::uint64_t e = v.slice_start[i / kSlice] + i % kSlice;
            for (std::uint32_t n = v.length[i]; n-- > 0; e += kSlice) {
                const StagedBall<D> other = v.stage[v.index[e]];
                double separation[D];
                separate(v, me, other, e, separation);
                contacts.add(separation, me.radius, me.inverse_radius(), other.radius, other.inverse_radius());
            }
        }
        Vec<D> velocity;
        for (int k = 0; k < D; ++k) velocity[static_cast<std::size_t>(k)] = v.model.push_rate * contacts.velocity[k];
        if (!v.liquid.trivial()) velocity = in_liquid<kStiffness>(v, i, me, velocity, sums);
        for (int k = 0; k < D; ++k) v.rate[k][i] = velocity[static_cast<std::size_t>(k)];
        if constexpr (kGas) {
            const double inverse = me.inverse_radius();
            const double weight = medium_weight<D>(v.model, v.liquid.box, me.x, me.radius, inverse, contacts.covered);
            v.film[i] = contacts.film;
            v.weight[i] = weight;
            add_term(v.no_gas.weight, weight, &sums.sum[0]);
            add_term(v.no_gas.weight_by_size, weight * inverse, &sums.sum[2]);
            if (v.model.medium_scaling == MediumScaling::kArea)
                add_term(v.no_gas.scale, Shape<D>::surface(me.radius), &sums.sum[4]);
            else if (v.model.medium_scaling == MediumScaling::kRadius)
                add_term(v.no_gas.scale, me.radius, &sums.sum[4]);
        }
        if constexpr (kStiffness) sums.raise(0, contacts.matrix.largest_eigenvalue());
    }

    template <bool kStiffness>
    LAMELLA_HOST_DEVICE Vec<D> in_liquid(
        const DeviceView<D>& v, std::size_t i, const StagedBall<D>& me, const Vec<D>& pushed, GatherSums& sums) const {
        if (me.radius == 0.0) return {};
        Vec<D> x;
        for (int k = 0; k < D; ++k) x[static_cast<std::size_t>(k)] = me.x[k];
        const auto touch = v.liquid.touch_walls(x, me.radius);
        if constexpr (kStiffness) sums.raise(1, v.liquid.wall_rate(touch, me.radius));
        const Vec<D> flow =
            v.liquid.takes_mean_of_neighbors(x, me.radius) ? mean_of_neighbors(v, i, me) : v.liquid.flow(x, me.radius);
        return v.liquid.velocity(touch, pushed, flow);
    }

    /// Mean velocity, at the last accepted state, of the bubbles that touch this one.
    LAMELLA_HOST_DEVICE Vec<D> mean_of_neighbors(const DeviceView<D>& v, std::size_t i, const StagedBall<D>& me) const {
        Vec<D> mean;
        double contacts = 0.0;
        std::uint64_t e = v.slice_start[i / kSlice] + i % kSlice;
        for (std::uint32_t n = v.length[i]; n-- > 0; e += kSlice) {
            const std::uint32_t j = v.index[e];
            double separation[D];
            separate(v, me, v.stage[j], e, separation);
            double squared = 0.0;
            for (int k = 0; k < D; ++k) squared += separation[k] * separation[k];
            if (!touching(squared, me.radius, v.stage[j].radius)) continue;
            for (int k = 0; k < D; ++k) mean[static_cast<std::size_t>(k)] += v.velocity[k][j];
            contacts += 1.0;
        }
        return contacts > 0.0 ? mean / contacts : mean;
    }
};

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
        c.sum_scale = sum_bound(Shape<D>::radius(c.max_size));
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
        c.sum_scale = sum_bound(update.maximum[0]);
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
        c.sum_scale = sum_bound(c.max_size);
        c.lost_scale = sum_bound(update.maximum[2]);
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
