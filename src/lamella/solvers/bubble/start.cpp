#include "lamella/solvers/bubble/start.h"

#include <algorithm>
#include <cmath>

#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/core/random.h"
#include "lamella/dist/gather.h"
#include "lamella/solvers/bubble/move.h"

namespace lamella::bubble {
namespace {

/// Points per axis of a grid with at least `count` points whose box has this shape.
template <int D>
std::array<std::size_t, D> grid_points(double count, const Vec3& shape) {
    double product = 1.0;
    for (std::size_t k = 0; k < D; ++k) product *= shape[k];
    const double density = std::pow(count / product, 1.0 / D);
    std::array<std::size_t, D> points;
    // 1e-9: a count that fits exactly, like 64 = 4^3, must not be rounded up by the last bit of the root.
    for (std::size_t k = 0; k < D; ++k)
        points[k] = static_cast<std::size_t>(std::max(1.0, std::ceil(density * shape[k] - 1e-9)));
    return points;
}

double first_radius(const Options& o, std::uint64_t seed, std::uint64_t id) {
    const RandomBits bits = random_bits(seed, RandomStream::kBubbleRadius, 0, id);
    const double least = o.min_radius * o.mean_radius;
    double radius = o.mean_radius;
    switch (o.start.sizes) {
        case Sizes::kNormal: radius = std::abs(o.mean_radius + o.start.radius_std * normal(bits)); break;
        case Sizes::kLognormal: radius = lognormal(bits, o.mean_radius, o.start.radius_std); break;
        case Sizes::kBidisperse: {
            // small (1 - f) + large f = mean with large = ratio * small
            const double f = o.start.large_fraction;
            const double small = o.mean_radius / (1.0 - f + f * o.start.size_ratio);
            radius = uniform01(bits) < f ? o.start.size_ratio * small : small;
        }
    }
    return radius <= least ? radius + least : radius;
}

/// Makes room for this process's share of `total` bubbles.
template <int D>
void take_share(std::int64_t total, const dist::Communicator& processes, Foam<D>& foam) {
    const dist::Share share = dist::share_of(total, processes);
    foam.resize(static_cast<std::size_t>(share.count));
    foam.live = static_cast<std::size_t>(total);
    for (std::size_t i = 0; i < foam.slots; ++i) foam.id[i] = share.first + static_cast<std::int64_t>(i);
}

template <int D>
void place_at_random(const Options& o, std::uint64_t seed, const dist::Communicator& processes, Foam<D>& foam) {
    take_share(o.count, processes, foam);
    double volume = 0.0;  // as on the grid: (2 <R_in>)^d per bubble
    double shape = 1.0;
    for (std::size_t k = 0; k < D; ++k) shape *= o.box_shape[k];
    volume = std::pow(2.0 * o.mean_radius, D) * o.count;
    for (std::size_t k = 0; k < D; ++k) foam.box.lengths[k] = o.box_shape[k] * std::pow(volume / shape, 1.0 / D);
    parallel_for(foam.slots, [&](std::size_t i) {
        const auto id = static_cast<std::uint64_t>(foam.id[i]);
        const Vec<D> u = uniform_vector<D>(random_bits(seed, RandomStream::kBubblePosition, 0, id));
        for (std::size_t k = 0; k < D; ++k) foam.position[k][i] = u[k] * foam.box.lengths[k];
    });
}

template <int D>
void place_on_grid(const Options& o, std::uint64_t seed, const dist::Communicator& processes, Foam<D>& foam) {
    const auto points = grid_points<D>(o.count, o.box_shape);
    std::size_t count = 1;
    for (const std::size_t n : points) count *= n;
    take_share(static_cast<std::int64_t>(count), processes, foam);
    const double spacing = 2.0 * o.mean_radius;
    for (std::size_t k = 0; k < D; ++k) foam.box.lengths[k] = spacing * static_cast<double>(points[k]);
    parallel_for(foam.slots, [&](std::size_t i) {
        const auto id = static_cast<std::uint64_t>(foam.id[i]);
        const double reach =
            o.mean_radius * uniform01(random_bits(seed, RandomStream::kBubbleJitter, 0, id));
        const Vec<D> direction = unit_vector<D>(random_bits(seed, RandomStream::kBubbleJitter, 0, id, 1));
        std::size_t rest = id;
        for (std::size_t k = 0; k < D; ++k) {
            const double on_grid = spacing * (static_cast<double>(rest % points[k]) + 0.5);
            rest /= points[k];
            std::int32_t crossings = 0;
            const double x = on_grid + reach * direction[k];
            // A wall does not let the jitter through.
            foam.position[k][i] = foam.box.periodic[k] ? wrapped(x, foam.box.lengths[k], crossings)
                                                       : std::clamp(x, 0.0, foam.box.lengths[k]);
        }
    });
}

template <int D>
void place_given(const Options& o,
                 const std::vector<GivenBubble>& given,
                 const dist::Communicator& processes,
                 Foam<D>& foam) {
    take_share(static_cast<std::int64_t>(given.size()), processes, foam);
    const auto bubble = [&](std::size_t i) { return given[static_cast<std::size_t>(foam.id[i])]; };
    for (std::size_t i = 0; i < foam.slots; ++i) foam.size[i] = Shape<D>::size(bubble(i).radius);
    if (has_file_box(o)) {
        for (std::size_t k = 0; k < D; ++k) {
            foam.box.lengths[k] = o.start.file_box[k];
            for (std::size_t i = 0; i < foam.slots; ++i) {
                const double x = bubble(i).position[k];
                foam.position[k][i] =
                    foam.box.periodic[k] ? x - o.start.file_box[k] * std::floor(x / o.start.file_box[k]) : x;
            }
        }
        return;
    }
    Vec<D> low;
    Vec<D> high;
    for (std::size_t k = 0; k < D; ++k) {
        low[k] = high[k] = given[0].position[k];
        for (const GivenBubble& b : given) {
            low[k] = std::min(low[k], b.position[k]);
            high[k] = std::max(high[k], b.position[k]);
        }
    }
    // The smallest box of the wanted shape that holds the centers; it is scaled to the gas fraction later.
    double scale = 0.0;
    for (std::size_t k = 0; k < D; ++k) scale = std::max(scale, (high[k] - low[k]) / o.box_shape[k]);
    if (scale == 0.0) scale = 2.0 * given[0].radius;
    for (std::size_t k = 0; k < D; ++k) {
        foam.box.lengths[k] = scale * o.box_shape[k] * (1.0 + 1e-12);
        for (std::size_t i = 0; i < foam.slots; ++i) foam.position[k][i] = bubble(i).position[k] - low[k];
    }
}

}  // namespace

template <int D>
void part_coincident(const Options& o, std::uint64_t seed, Foam<D>& foam) {
    std::vector<std::uint32_t> order(foam.slots);
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    const auto place = [&](std::uint32_t i) {
        std::array<double, D> x;
        for (std::size_t k = 0; k < D; ++k) x[k] = foam.position[k][i];
        return x;
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return place(a) != place(b) ? place(a) < place(b) : foam.id[a] < foam.id[b];
    });
    std::vector<std::uint32_t> coincident;
    for (std::size_t i = 1; i < order.size(); ++i)
        if (place(order[i]) == place(order[i - 1])) coincident.push_back(order[i]);
    for (const std::uint32_t i : coincident) {
        const Vec<D> direction = unit_vector<D>(random_bits(seed, RandomStream::kBubbleJitter, 1, static_cast<std::uint64_t>(foam.id[i])));
        for (std::size_t k = 0; k < D; ++k) {
            const double x = foam.position[k][i] + 1e-6 * o.mean_radius * direction[k];
            foam.position[k][i] = std::clamp(x, 0.0, foam.box.lengths[k] * (1.0 - 1e-15));
        }
    }
}

bool has_file_box(const Options& o) { return o.start.packing == Packing::kFile && o.start.file_box[0] > 0.0; }

template <int D>
void pack(const Options& options,
          std::uint64_t seed,
          const std::vector<GivenBubble>& given,
          const dist::Communicator& processes,
          Foam<D>& foam) {
    for (std::size_t k = 0; k < D; ++k) foam.box.periodic[k] = !options.walls[k];
    switch (options.start.packing) {
        case Packing::kGrid: place_on_grid(options, seed, processes, foam); break;
        case Packing::kRandom: place_at_random(options, seed, processes, foam); break;
        case Packing::kFile: place_given(options, given, processes, foam); break;
    }
    if (options.start.packing != Packing::kFile)
        parallel_for(foam.slots, [&](std::size_t i) {
            foam.size[i] = Shape<D>::size(first_radius(options, seed, static_cast<std::uint64_t>(foam.id[i])));
        });
}

template <int D>
void scale_to_gas_fraction(const Options& options, double gas_fraction, const Domain& domain, Foam<D>& foam) {
    const double gas = Shape<D>::kVolume * domain.exact_sum(foam.slots, [&](std::size_t i) { return foam.size[i]; });
    double shape = 1.0;
    for (std::size_t k = 0; k < D; ++k) shape *= options.box_shape[k];
    const double unit = std::pow(gas / (gas_fraction * shape), 1.0 / D);
    for (std::size_t k = 0; k < D; ++k) {
        const double length = unit * options.box_shape[k];
        const double factor = length / foam.box.lengths[k];
        foam.box.lengths[k] = length;
        parallel_for(foam.slots, [&](std::size_t i) {
            std::int32_t crossings = 0;
            const double x = foam.position[k][i] * factor;
            foam.position[k][i] = foam.box.periodic[k] ? wrapped(x, length, crossings) : std::min(x, length);
        });
    }
}

template void pack<2>(const Options&, std::uint64_t, const std::vector<GivenBubble>&, const dist::Communicator&, Foam<2>&);
template void pack<3>(const Options&, std::uint64_t, const std::vector<GivenBubble>&, const dist::Communicator&, Foam<3>&);
template void part_coincident<2>(const Options&, std::uint64_t, Foam<2>&);
template void part_coincident<3>(const Options&, std::uint64_t, Foam<3>&);
template void scale_to_gas_fraction<2>(const Options&, double, const Domain&, Foam<2>&);
template void scale_to_gas_fraction<3>(const Options&, double, const Domain&, Foam<3>&);

}  // namespace lamella::bubble
