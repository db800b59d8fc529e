#pragma once

#include "lamella/solvers/bubble/detail/device_sums.h"
#include "lamella/solvers/bubble/increment.h"

namespace lamella::bubble::detail {

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

    /// Stage j writes where d_(j-2) stood.
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

    /// |dx| + dR since the lists were built; beyond any reach where lists hold images and the bubble has crossed the
    /// border of the box.
    LAMELLA_HOST_DEVICE static double expansion(const DeviceView<D>& v, std::size_t i) {
        if (!v.alive(i)) return 0.0;
        double length = 0.0;
        for (int k = 0; k < D; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            const double s = v.position[k][i] - v.built_position[k][i];
            if (v.image != nullptr && v.liquid.box.periodic[axis] && std::fabs(s) > 0.5 * v.liquid.box.lengths[axis])
                return std::numeric_limits<double>::infinity();
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
                double x = v.position[k][i] + move;
                if (v.liquid.box.periodic[axis]) x = wrapped(x, v.liquid.box.lengths[axis], v.wraps[k][i]);
                v.position[k][i] = x;
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

}  // namespace lamella::bubble::detail
