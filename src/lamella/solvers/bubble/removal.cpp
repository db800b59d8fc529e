#include "lamella/solvers/bubble/removal.h"

#include <algorithm>

#include <fmt/format.h>

#include "lamella/core/error.h"
#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"

namespace lamella::bubble {

namespace {

/// What vanished bubbles lose or gain per time goes where their gas goes, so that rates keep adding up to zero.
template <int D>
void settle_rate(const Foam<D>& foam, const std::vector<std::uint32_t>& removed, double survivors, Column& rate) {
    const double lost = exact_sum(removed.size(), [&](std::size_t n) { return rate[removed[n]]; });
    for (const std::uint32_t i : removed) rate[i] = 0.0;
    parallel_for(foam.slots, [&](std::size_t i) { rate[i] += lost * foam.size[i] / survivors; });
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
    if (removed.size() >= foam.live)
        throw NumericalError(fmt::format("all {} bubbles would vanish in one step", foam.live));
    std::sort(removed.begin(), removed.end(), [&](auto a, auto b) { return foam.id[a] < foam.id[b]; });

    std::vector<sim::Event> events;
    events.reserve(removed.size());
    FixedSum excess(system.model.total_size);
    for (const std::uint32_t i : removed) {
        excess.add(foam.size[i]);
        sim::Event event{.time = 0.0, .kind = "remove", .position = {}, .detail = fmt::format("bubble {}", foam.id[i])};
        for (std::size_t k = 0; k < D; ++k) event.position[k] = foam.position[k][i];
        events.push_back(std::move(event));
        foam.size[i] = 0.0;
        for (std::size_t k = 0; k < D; ++k) foam.velocity[k][i] = 0.0;
        system.stage.radius[i] = 0.0;
    }
    foam.live -= removed.size();

    const double survivors = system.total_size();
    settle_rate(foam, removed, survivors, foam.size_rate);
    for (Column* column : system.attached_size_rates)
        if (!column->empty()) settle_rate(foam, removed, survivors, *column);

    const double factor = growth_by_removal<D>(excess.value() / survivors, as_printed);
    parallel_for(foam.slots, [&](std::size_t i) { foam.size[i] *= factor; });
    return events;
}

template std::vector<sim::Event> remove_vanished<2>(System<2>&, bool);
template std::vector<sim::Event> remove_vanished<3>(System<3>&, bool);

}  // namespace lamella::bubble
