#include "lamella/solvers/bubble/removal.h"

#include "lamella/core/error.h"
#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/dist/gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace lamella::bubble {

namespace {

/// The smallest bubble that the last step moved, and the largest.
struct Extremes {
    double smallest;
    double largest;
};

template <int D>
Extremes extremes_of(const System<D>& system) {
    struct Part {
        double negative, largest;
    };
    const Foam<D>& foam = system.foam;
    const Part here = parallel_reduce(
        foam.slots, Part{-2.0 * system.model.total_size, 0.0},
        [&](std::size_t begin, std::size_t end) {
            Part part{-2.0 * system.model.total_size, 0.0};
            for (std::size_t i = begin; i < end; ++i) {
                part.largest = std::max(part.largest, foam.size[i]);
                // A live bubble can stand at q <= 0 here; vanished ones are exactly 0 and have no radius in the stage.
                if (system.stage.radius[i] > 0.0) part.negative = std::max(part.negative, -foam.size[i]);
            }
            return part;
        },
        [](const Part& a, const Part& b) {
            return Part{std::max(a.negative, b.negative), std::max(a.largest, b.largest)};
        });
    double all[] = {here.negative, here.largest};
    system.domain().largest(all);
    return {-all[0], all[1]};
}

/// What vanished bubbles lose or gain per time goes where their gas goes, so that rates keep adding up to zero.
/// @param largest  of their |rate|, per column and of all processes
template <int D>
void settle_rates(const System<D>& system,
                  const std::vector<std::uint32_t>& removed,
                  double survivors,
                  std::span<Column* const> rates,
                  std::span<const double> largest) {
    std::vector<FixedSum> lost;
    for (std::size_t c = 0; c < rates.size(); ++c) {
        lost.emplace_back(largest[c] * system.domain().most_terms());
        for (const std::uint32_t i : removed) lost[c].add(std::exchange((*rates[c])[i], 0.0));
    }
    system.domain().sum(lost);
    const Foam<D>& foam = system.foam;
    for (std::size_t c = 0; c < rates.size(); ++c) {
        const double all = lost[c].value();
        parallel_for(foam.slots, [&](std::size_t i) { (*rates[c])[i] += all * foam.size[i] / survivors; });
    }
}

template <int D>
struct Vanished {
    std::int64_t id;
    Vec<D> position;
};

/// By id; an event of which nothing is known for each that another process reports.
template <int D>
std::vector<sim::Event> events_of(std::vector<Vanished<D>> list, std::size_t count) {
    std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    std::vector<sim::Event> events(count);
    for (std::size_t n = 0; n < list.size(); ++n) {
        events[n].kind = "remove";
        events[n].detail = fmt::format("bubble {}", list[n].id);
        for (std::size_t k = 0; k < D; ++k) events[n].position[k] = list[n].position[k];
    }
    return events;
}

}  // namespace

template <int D>
Removal remove_vanished(System<D>& system, bool as_printed) {
    Foam<D>& foam = system.foam;
    const Domain& domain = system.domain();
    const double limit = system.model.min_size;
    const Extremes extremes = extremes_of(system);
    if (extremes.smallest > limit) return {{}, extremes.largest};

    const auto vanishes = [&](std::size_t i) { return system.stage.radius[i] > 0.0 && foam.size[i] <= limit; };
    std::vector<std::uint32_t> removed;
    for (std::size_t i = 0; i < foam.slots; ++i)
        if (vanishes(i)) removed.push_back(static_cast<std::uint32_t>(i));
    std::vector<Column*> rates{&foam.size_rate};
    for (Column* column : system.attached_size_rates)
        if (!column->empty()) rates.push_back(column);

    // The scale of the survivors' sum is that of System::total_size.
    FixedSum count(static_cast<double>(foam.live));
    FixedSum excess(system.model.total_size);
    std::vector<double> largest_rate(rates.size(), 0.0);
    for (const std::uint32_t i : removed) {
        count.add(1.0);
        excess.add(foam.size[i]);
        for (std::size_t c = 0; c < rates.size(); ++c)
            largest_rate[c] = std::max(largest_rate[c], std::abs((*rates[c])[i]));
    }
    FixedSum sums[] = {count, excess, fixed_sum(foam.slots, extremes.largest * domain.most_terms(), [&](std::size_t i) {
                           return vanishes(i) ? 0.0 : foam.size[i];
                       })};
    domain.reduce(sums, largest_rate);
    const auto vanished = static_cast<std::size_t>(sums[0].value());
    if (vanished >= foam.live) throw NumericalError(fmt::format("all {} bubbles would vanish in one step", foam.live));
    const double survivors = sums[2].value();

    std::vector<Vanished<D>> list(removed.size());
    for (std::size_t n = 0; n < removed.size(); ++n) {
        const std::uint32_t i = removed[n];
        list[n].id = foam.id[i];
        for (std::size_t k = 0; k < D; ++k) list[n].position[k] = foam.position[k][i];
        foam.size[i] = 0.0;
        for (std::size_t k = 0; k < D; ++k) foam.velocity[k][i] = 0.0;
        system.stage.radius[i] = 0.0;
    }
    foam.live -= vanished;
    settle_rates(system, removed, survivors, rates, largest_rate);
    const double factor = growth_by_removal<D>(sums[1].value() / survivors, as_printed);
    parallel_for(foam.slots, [&](std::size_t i) { foam.size[i] *= factor; });
    return {events_of(dist::gather(domain.processes(), std::span<const Vanished<D>>(list)), vanished),
            extremes.largest * factor};
}

template Removal remove_vanished<2>(System<2>&, bool);
template Removal remove_vanished<3>(System<3>&, bool);

}  // namespace lamella::bubble
