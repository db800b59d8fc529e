#pragma once

#include "lamella/solvers/bubble/contact.h"
#include "lamella/solvers/bubble/detail/device_sums.h"

namespace lamella::bubble::detail {

/// Which bubbles of a device a loop goes over.
enum class Bubbles {
    kAll,
    kInterior,  ///< those that have no copies in their lists
    kBorder,    ///< the others
};

/// Second loop of a turn: the right-hand side of each bubble at the stage, one thread per bubble over its whole list.
template <int D>
struct GatherBubble {
    DeviceView<D> view;
    const Control* control;
    Bubbles which = Bubbles::kAll;

    LAMELLA_HOST_DEVICE std::size_t first() const { return which == Bubbles::kBorder ? control->interior : 0; }
    LAMELLA_HOST_DEVICE std::size_t end() const {
        return which == Bubbles::kInterior ? control->interior : control->slots;
    }
    LAMELLA_HOST_DEVICE std::size_t count() const {
        return control->running() && control->evaluates() ? end() - first() : 0;
    }

    LAMELLA_HOST_DEVICE void operator()(std::size_t n, GatherSums& sums) const {
        const std::size_t i = first() + n;
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

}  // namespace lamella::bubble::detail
