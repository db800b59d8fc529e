#include "lamella/core/parallel.h"
#include "lamella/core/simd.h"
#include "lamella/solvers/bubble/contact.h"
#include "lamella/solvers/bubble/gas_sums.h"
#include "lamella/solvers/bubble/rates.h"

#include <algorithm>
#include <cmath>

namespace lamella::bubble {
namespace {

using spatial::NeighborList;
using spatial::PeriodicBox;

struct Sums {
    GasSums gas;
    double stiffness = 0.0;

    Sums& operator+=(const Sums& other) {
        gas += other.gas;
        stiffness = std::max(stiffness, other.stiffness);
        return *this;
    }
};

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

    ContactSums<D, Simd, kGas, kStiffness> sums;
    const std::uint64_t end = neighbors.group_start[group + 1];
    for (std::uint64_t e = neighbors.group_start[group]; e < end; e += kLanes) {
        const std::uint32_t* other = &neighbors.index[e];
        Simd separation[D];
        for (std::size_t k = 0; k < D; ++k) {
            separation[k] = position[k] - gather_lanes(stage.position[k].data(), other);
            const Simd image =
                kImages ? load_lanes(&neighbors.image[k][e]) : nearest(separation[k] * inverse_lengths[k]);
            separation[k] -= box.lengths[k] * image;
        }
        Simd other_inverse = 0.0;
        if constexpr (kGas) other_inverse = gather_lanes(stage.inverse_radius.data(), other);
        sums.add(separation, radius, inverse_radius, gather_lanes(stage.radius.data(), other), other_inverse);
    }

    for (std::size_t k = 0; k < D; ++k) store_lanes(model.push_rate * sums.velocity[k], &rates.velocity[k][at]);
    if constexpr (kGas) {
        store_lanes(sums.film, &rates.film[at]);
        store_lanes(medium_weight<D>(model, box, position, radius, inverse_radius, sums.covered), &rates.weight[at]);
    }
    if constexpr (kStiffness) return 2.0 * model.push_rate * stdx::hmax(sums.matrix.largest_eigenvalue());
    return 0.0;
}

template <int D>
void add_block_sums(const Model& model,
                    const Stage<D>& stage,
                    const Rates<D>& rates,
                    std::size_t begin,
                    std::size_t end,
                    GasSums& sums) {
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

/// The pass over groups first_group .. end_group - 1.
template <int D, bool kGas, bool kStiffness, bool kImages>
Sums pass(const Model& model,
          const PeriodicBox<D>& box,
          const NeighborList<D>& neighbors,
          std::size_t first_group,
          std::size_t end_group,
          const Stage<D>& stage,
          Rates<D>& rates) {
    constexpr std::size_t kBlock = 2048 / kLanes;
    const std::size_t count = end_group - first_group;
    std::vector<Sums> parts((count + kBlock - 1) / kBlock, Sums{empty_gas_sums<D>(model)});
    const Vec<D> inverse_lengths = box.inverse_lengths();
    parallel_blocks(count, kBlock, [&](std::size_t begin, std::size_t end) {
        Sums& sums = parts[begin / kBlock];
        const std::size_t last = first_group + end;
        double stiffest = 0.0;
        for (std::size_t group = first_group + begin; group < last; ++group)
            stiffest = std::max(stiffest, contacts_of_group<D, kGas, kStiffness, kImages>(
                                              group, model, box, inverse_lengths, neighbors, stage, rates));
        sums.stiffness = stiffest;
        if constexpr (kGas)
            add_block_sums(model, stage, rates, (first_group + begin) * kLanes, last * kLanes, sums.gas);
    });
    Sums total{empty_gas_sums<D>(model)};
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
                        Rates<D>& rates,
                        double* also) {
    const bool with_gas = gas == Gas::kOn && model.exchanges_gas();
    const bool bound = stiffness == Stiffness::kBound;
    const auto over = [&](std::size_t first_group, std::size_t end_group) {
        return with_constants(with_gas, bound, neighbors.has_images(), [&](auto g, auto s, auto i) {
            return pass<D, g(), s(), i()>(model, box, neighbors, first_group, end_group, stage, rates);
        });
    };
    // The copies are on their way: first what does not need them.
    Sums sums = over(0, neighbors.interior_groups);
    domain.end_refresh();
    sums += over(neighbors.interior_groups, neighbors.groups());
    FixedSum all[] = {sums.gas.weight, sums.gas.weight_by_size, sums.gas.scale};
    double maxima[] = {0.0, 0.0};
    std::size_t asked = 0;
    if (bound) maxima[asked++] = sums.stiffness;
    if (also != nullptr) maxima[asked++] = *also;
    domain.reduce(with_gas ? std::span(all) : std::span<FixedSum>(), std::span(maxima).first(asked));
    if (also != nullptr) *also = maxima[asked - 1];
    Evaluation result;
    if (with_gas) result.gas = close_exchange<D>(model, {all[0], all[1], all[2]}, static_cast<double>(live));
    if (bound) result.stiffness = maxima[0] + (with_gas ? exchange_stiffness<D>(model) : 0.0);
    return result;
}

template Evaluation contact_pass<2>(const Model&,
                                    const PeriodicBox<2>&,
                                    const NeighborList<2>&,
                                    const Stage<2>&,
                                    Gas,
                                    Stiffness,
                                    Domain&,
                                    std::size_t,
                                    Rates<2>&,
                                    double*);
template Evaluation contact_pass<3>(const Model&,
                                    const PeriodicBox<3>&,
                                    const NeighborList<3>&,
                                    const Stage<3>&,
                                    Gas,
                                    Stiffness,
                                    Domain&,
                                    std::size_t,
                                    Rates<3>&,
                                    double*);

}  // namespace lamella::bubble
