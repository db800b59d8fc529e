#include <algorithm>
#include <cmath>

#include "lamella/core/parallel.h"
#include "lamella/core/simd.h"
#include "lamella/solvers/bubble/contact.h"
#include "lamella/solvers/bubble/rates.h"

namespace lamella::bubble {
namespace {

using spatial::NeighborList;
using spatial::PeriodicBox;

/// The symmetric matrix sum_j n n^T / S of eight bubbles, lower triangle.
template <int D>
struct StiffnessMatrix {
    static constexpr std::size_t kEntries = D * (D + 1) / 2;
    Simd entry[kEntries] = {};

    LAMELLA_ALWAYS_INLINE void add(const Simd (&unit)[D], const Simd& weight) {
        std::size_t e = 0;
        for (std::size_t a = 0; a < D; ++a)
            for (std::size_t b = 0; b <= a; ++b) entry[e++] += weight * unit[a] * unit[b];
    }

    /// Exact in 2D; in 3D the largest row sum of absolute values, an upper bound.
    LAMELLA_ALWAYS_INLINE Simd largest_eigenvalue() const {
        if constexpr (D == 2) {
            const Simd mean = 0.5 * (entry[0] + entry[2]);
            const Simd half = 0.5 * (entry[0] - entry[2]);
            return mean + square_root(half * half + entry[1] * entry[1]);
        } else {
            const Simd xy = stdx::abs(entry[1]);
            const Simd xz = stdx::abs(entry[3]);
            const Simd yz = stdx::abs(entry[4]);
            return larger(larger(entry[0] + xy + xz, entry[2] + xy + yz), entry[5] + xz + yz);
        }
    }
};

struct Sums {
    FixedSum weight;          // sum w
    FixedSum weight_by_size;  // sum w/R
    FixedSum scale;           // sum A or sum R
    double stiffness = 0.0;

    Sums& operator+=(const Sums& other) {
        weight += other.weight;
        weight_by_size += other.weight_by_size;
        scale += other.scale;
        stiffness = std::max(stiffness, other.stiffness);
        return *this;
    }
};

/// Bounds of the sums from N and Q = sum q by the power-mean inequality: sum R^p <= N^(1 - p/d) Q^(p/d).
template <int D>
Sums empty_sums(const Model& m) {
    const auto power_sum = [&](double p) {
        return std::pow(m.largest_count, 1.0 - p / D) * std::pow(m.total_size, p / D);
    };
    const double surface = Shape<D>::kSurface * power_sum(D - 1);
    Sums sums;
    if (m.medium_scaling == MediumScaling::kLsw) {
        sums.weight = FixedSum(power_sum(1));
        sums.weight_by_size = FixedSum(m.largest_count);
    } else {
        sums.weight = FixedSum(surface);
        sums.weight_by_size = FixedSum(Shape<D>::kSurface * power_sum(D - 2));
    }
    sums.scale = FixedSum(m.medium_scaling == MediumScaling::kRadius ? power_sum(1) : surface);
    return sums;
}

/// Surface that bubbles press against walls: a chord of 2 sqrt(R^2 - delta^2) or a disc of pi (R^2 - delta^2) per wall.
template <int D>
Simd wall_contact(const PeriodicBox<D>& box, const Simd (&position)[D], const Simd& radius) {
    Simd blocked = 0.0;
    for (std::size_t k = 0; k < D; ++k) {
        if (box.periodic[k]) continue;
        for (const Simd& delta : {position[k], box.lengths[k] - position[k]}) {
            const Simd rest = larger(radius * radius - delta * delta, Simd(0.0));
            blocked += D == 2 ? 2.0 * square_root(rest) : std::numbers::pi * rest;
        }
    }
    return blocked;
}

/// One group of eight bubbles: everything that their contacts give. Returns the bound on their relaxation rate.
template <int D, bool kGas, bool kStiffness, bool kImages>
double contacts_of_group(std::size_t group,
                         const Model& model,
                         const PeriodicBox<D>& box,
                         const Vec<D>& inverse_lengths,
                         const NeighborList<D>& neighbors,
                         const Stage<D>& stage,
                         Rates<D>& rates) {
    const std::size_t at = group * kLanes;
    Simd position[D];
    for (std::size_t k = 0; k < D; ++k) position[k] = load_lanes(&stage.position[k][at]);
    const Simd radius = load_lanes(&stage.radius[at]);
    const Simd inverse_radius = load_lanes(&stage.inverse_radius[at]);

    Simd velocity[D] = {};
    Simd film = 0.0;
    Simd covered = 0.0;
    StiffnessMatrix<D> matrix;
    const std::uint64_t end = neighbors.group_start[group + 1];
    for (std::uint64_t e = neighbors.group_start[group]; e < end; e += kLanes) {
        const std::uint32_t* other = &neighbors.index[e];
        Simd separation[D];
        Simd squared = 0.0;
        for (std::size_t k = 0; k < D; ++k) {
            separation[k] = position[k] - gather_lanes(stage.position[k].data(), other);
            const Simd image = kImages ? load_lanes(&neighbors.image[k][e]) : nearest(separation[k] * inverse_lengths[k]);
            separation[k] -= box.lengths[k] * image;
            squared += separation[k] * separation[k];
        }
        const Simd other_radius = gather_lanes(stage.radius.data(), other);
        const auto touch = touching(squared, radius, other_radius);
        const Overlap<Simd> overlap(squared, radius, other_radius);

        const Simd factor = select(touch, push(overlap), Simd(0.0));
        for (std::size_t k = 0; k < D; ++k) velocity[k] += factor * separation[k];
        if constexpr (kGas) {
            const Simd area = select(touch, film_size<D>(squared, overlap, radius, other_radius), Simd(0.0));
            film += area * (gather_lanes(stage.inverse_radius.data(), other) - inverse_radius);
            covered += area;
        }
        if constexpr (kStiffness) {
            Simd unit[D];
            for (std::size_t k = 0; k < D; ++k) unit[k] = separation[k] * overlap.inverse_distance();
            matrix.add(unit, select(touch, overlap.inverse_sum(), Simd(0.0)));
        }
    }

    for (std::size_t k = 0; k < D; ++k) store_lanes(model.push_rate * velocity[k], &rates.velocity[k][at]);
    if constexpr (kGas) {
        store_lanes(film, &rates.film[at]);
        // The chords of strong overlaps can add up to more than the surface: then none of it is free.
        const Simd surface = Shape<D>::surface(radius);
        if (model.wall_blocks_gas) covered += wall_contact<D>(box, position, radius);
        Simd weight = larger(surface - covered, Simd(0.0));
        if (model.medium_scaling == MediumScaling::kLsw) weight *= inverse_radius * (1.0 / Shape<D>::kSurface);  // R A^f/A
        store_lanes(weight, &rates.weight[at]);
    }
    if constexpr (kStiffness) return 2.0 * model.push_rate * stdx::hmax(matrix.largest_eigenvalue());
    return 0.0;
}

template <int D>
void add_block_sums(const Model& model,
                    const Stage<D>& stage,
                    const Rates<D>& rates,
                    std::size_t begin,
                    std::size_t end,
                    Sums& sums) {
    constexpr std::size_t kChunk = 256;
    double terms[kChunk];
    sums.weight.add(&rates.weight[begin], end - begin);
    for (std::size_t c = begin; c < end; c += kChunk) {
        const std::size_t n = std::min(kChunk, end - c);
        for (std::size_t i = 0; i < n; ++i) terms[i] = rates.weight[c + i] * stage.inverse_radius[c + i];
        sums.weight_by_size.add(terms, n);
        if (model.medium_scaling == MediumScaling::kArea) {
            for (std::size_t i = 0; i < n; ++i) terms[i] = Shape<D>::surface(stage.radius[c + i]);
            sums.scale.add(terms, n);
        } else if (model.medium_scaling == MediumScaling::kRadius) {
            sums.scale.add(&stage.radius[c], n);
        }
    }
}

template <int D, bool kGas, bool kStiffness, bool kImages>
Sums pass(const Model& model,
          const PeriodicBox<D>& box,
          const NeighborList<D>& neighbors,
          const Stage<D>& stage,
          Rates<D>& rates) {
    constexpr std::size_t kBlock = 2048;
    const std::size_t length = neighbors.groups() * kLanes;
    std::vector<Sums> parts((length + kBlock - 1) / kBlock, empty_sums<D>(model));
    const Vec<D> inverse_lengths = box.inverse_lengths();
    parallel_blocks(length, kBlock, [&](std::size_t begin, std::size_t end) {
        Sums& sums = parts[begin / kBlock];
        double stiffest = 0.0;
        for (std::size_t group = begin / kLanes; group < end / kLanes; ++group)
            stiffest = std::max(stiffest, contacts_of_group<D, kGas, kStiffness, kImages>(
                                              group, model, box, inverse_lengths, neighbors, stage, rates));
        sums.stiffness = stiffest;
        if constexpr (kGas) add_block_sums(model, stage, rates, begin, end, sums);
    });
    Sums total = empty_sums<D>(model);
    for (const Sums& part : parts) total += part;
    return total;
}

/// Calls f with each runtime choice as a compile-time constant.
template <class F>
auto with_constants(bool a, bool b, bool c, F&& f) {
    using T = std::true_type;
    using N = std::false_type;
    if (a) return b ? (c ? f(T{}, T{}, T{}) : f(T{}, T{}, N{})) : (c ? f(T{}, N{}, T{}) : f(T{}, N{}, N{}));
    return b ? (c ? f(N{}, T{}, T{}) : f(N{}, T{}, N{})) : (c ? f(N{}, N{}, T{}) : f(N{}, N{}, N{}));
}

template <int D>
GasExchange close_exchange(const Model& m, const Sums& sums, std::size_t live) {
    GasExchange gas;
    gas.film_factor = m.exchange_rate / Shape<D>::kVolume;
    const double weight = sums.weight.value();
    if (weight <= 0.0 || m.medium_ratio == 0.0) return gas;  // no free surface: nothing reaches the liquid
    gas.inverse_rho = sums.weight_by_size.value() / weight;
    const double mean_scale = sums.scale.value() / static_cast<double>(live);
    double factor = m.medium_ratio * m.exchange_rate;
    switch (m.medium_scaling) {
        case MediumScaling::kArea: factor *= m.initial_mean_surface / mean_scale; break;
        case MediumScaling::kRadius: factor *= m.initial_mean_radius / mean_scale; break;
        case MediumScaling::kLsw: factor *= 4.0 * std::numbers::pi * m.input_mean_radius; break;
    }
    gas.medium_factor = factor / Shape<D>::kVolume;
    return gas;
}

}  // namespace

template <int D>
Evaluation contact_pass(const Model& model,
                        const PeriodicBox<D>& box,
                        const NeighborList<D>& neighbors,
                        const Stage<D>& stage,
                        Gas gas,
                        Stiffness stiffness,
                        Domain& domain,
                        std::size_t live,
                        Rates<D>& rates) {
    const bool with_gas = gas == Gas::kOn && model.exchanges_gas();
    const bool bound = stiffness == Stiffness::kBound;
    const Sums sums = with_constants(with_gas, bound, neighbors.has_images(), [&](auto g, auto s, auto i) {
        return pass<D, g(), s(), i()>(model, box, neighbors, stage, rates);
    });
    Evaluation result;
    if (with_gas) {
        FixedSum all[] = {sums.weight, sums.weight_by_size, sums.scale};
        domain.sum(all);
        result.gas = close_exchange<D>(model, {all[0], all[1], all[2], 0.0}, live);
    }
    if (bound) {
        const double min_radius = Shape<D>::radius(model.min_size);
        result.stiffness = domain.largest(sums.stiffness);
        if (with_gas)
            result.stiffness += 2.0 * model.exchange_rate * (1.0 + model.medium_ratio) / (min_radius * min_radius);
    }
    return result;
}

template Evaluation contact_pass<2>(const Model&, const PeriodicBox<2>&, const NeighborList<2>&, const Stage<2>&,
                                    Gas, Stiffness, Domain&, std::size_t, Rates<2>&);
template Evaluation contact_pass<3>(const Model&, const PeriodicBox<3>&, const NeighborList<3>&, const Stage<3>&,
                                    Gas, Stiffness, Domain&, std::size_t, Rates<3>&);

}  // namespace lamella::bubble
