#include "lamella/solvers/bubble/removal.h"

#include <algorithm>

#include <fmt/format.h>

#include "lamella/core/error.h"
#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/dist/gather.h"

namespace lamella::bubble {

namespace {

/// What vanished bubbles lose or gain per time goes where their gas goes, so that rates keep adding up to zero.
template <int D>
void settle_rate(const System<D>& system, const std::vector<std::uint32_t>& removed, double survivors, Column& rate) {
    const Foam<D>& foam = system.foam;
    const double lost = system.domain().exact_sum(removed.size(), [&](std::size_t n) { return rate[removed[n]]; });
    for (const std::uint32_t i : removed) rate[i] = 0.0;
    parallel_for(foam.slots, [&](std::size_t i) { rate[i] += lost * foam.size[i] / survivors; });
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
std::vector<sim::Event> remove_vanished(System<D>& system, bool as_printed) {
    Foam<D>& foam = system.foam;
    const double limit = system.model.min_size;
    // A live bubble can stand at q <= 0 here; vanished ones are exactly 0 and have no radius in the stage.
    const auto exists = [&](std::size_t i) { return system.stage.radius[i] > 0.0; };
    std::vector<std::uint32_t> removed;
    const auto smallest = -parallel_max(foam.slots, -limit - 1.0, [&](std::size_t i) {
        return exists(i) ? -foam.size[i] : -limit - 1.0;
    });
    if (system.domain().largest(-smallest) < -limit) return {};
    for (std::size_t i = 0; i < foam.slots; ++i)
        if (exists(i) && foam.size[i] <= limit) removed.push_back(static_cast<std::uint32_t>(i));
    const auto vanished = static_cast<std::size_t>(system.domain().sum(static_cast<std::int64_t>(removed.size())));
    if (vanished >= foam.live) throw NumericalError(fmt::format("all {} bubbles would vanish in one step", foam.live));

    std::vector<Vanished<D>> list(removed.size());
    FixedSum excess[] = {FixedSum(system.model.total_size)};
    for (std::size_t n = 0; n < removed.size(); ++n) {
        const std::uint32_t i = removed[n];
        excess[0].add(foam.size[i]);
        list[n].id = foam.id[i];
        for (std::size_t k = 0; k < D; ++k) list[n].position[k] = foam.position[k][i];
        foam.size[i] = 0.0;
        for (std::size_t k = 0; k < D; ++k) foam.velocity[k][i] = 0.0;
        system.stage.radius[i] = 0.0;
    }
    foam.live -= vanished;
    system.domain().sum(excess);

    const double survivors = system.total_size();
    settle_rate(system, removed, survivors, foam.size_rate);
    for (Column* column : system.attached_size_rates)
        if (!column->empty()) settle_rate(system, removed, survivors, *column);

    const double factor = growth_by_removal<D>(excess[0].value() / survivors, as_printed);
    parallel_for(foam.slots, [&](std::size_t i) { foam.size[i] *= factor; });
    return events_of(dist::gather(system.domain().processes(), std::span<const Vanished<D>>(list)), vanished);
}

template std::vector<sim::Event> remove_vanished<2>(System<2>&, bool);
template std::vector<sim::Event> remove_vanished<3>(System<3>&, bool);

}  // namespace lamella::bubble
