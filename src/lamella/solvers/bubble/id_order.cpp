#include "lamella/solvers/bubble/id_order.h"

namespace lamella::bubble {

template <int D>
IdOrder<D>::IdOrder(const System<D>& system, std::int64_t ids) {
    const Foam<D>& foam = system.foam;
    dist::Communicator& processes = system.domain().processes();
    for (std::size_t i = 0; i < foam.slots; ++i)
        if (foam.alive(i)) slots_.push_back(static_cast<std::uint32_t>(i));
    std::vector<std::int64_t> id(slots_.size());
    for (std::size_t n = 0; n < slots_.size(); ++n) id[n] = foam.id[slots_[n]];

    if (processes.several()) {
        // Equal stretches of ids: bubbles vanish at random, so these stay about equally full.
        const std::int64_t stretch = ids / processes.size() + 1;
        std::vector<int> destination(id.size());
        for (std::size_t n = 0; n < id.size(); ++n) destination[n] = static_cast<int>(id[n] / stretch);
        migration_.emplace(processes, destination);
        (*migration_)(id);
    }
    place_.resize(id.size());
    for (std::size_t n = 0; n < place_.size(); ++n) place_[n] = static_cast<std::uint32_t>(n);
    std::sort(place_.begin(), place_.end(), [&](std::uint32_t a, std::uint32_t b) { return id[a] < id[b]; });

    std::vector<std::int64_t> counts(static_cast<std::size_t>(processes.size()), 0);
    counts[static_cast<std::size_t>(processes.rank())] = static_cast<std::int64_t>(place_.size());
    processes.sum(counts);
    for (std::size_t r = 0; r < counts.size(); ++r) {
        if (static_cast<int>(r) < processes.rank()) part_.first += counts[r];
        part_.total += counts[r];
    }
}

template class IdOrder<2>;
template class IdOrder<3>;

}  // namespace lamella::bubble
