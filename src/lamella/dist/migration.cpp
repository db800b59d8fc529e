#include "lamella/dist/migration.h"

namespace lamella::dist {

Migration::Migration(Communicator& processes, std::span<const int> destination) {
    std::vector<std::vector<std::uint32_t>> to(static_cast<std::size_t>(processes.size()));
    std::vector<std::uint32_t> gaps;
    for (std::uint32_t i = 0; i < destination.size(); ++i) {
        const int rank = destination[i];
        if (rank == processes.rank()) continue;
        gaps.push_back(i);
        if (rank != kGone) to[static_cast<std::size_t>(rank)].push_back(i);
    }
    routes_ = Routes(processes, std::move(to));
    count_ = destination.size() - gaps.size() + routes_.arriving();

    // Room beyond the items as they were counts as gaps, and of the gaps those below the new count are to be filled.
    for (std::size_t i = destination.size(); i < count_; ++i) gaps.push_back(static_cast<std::uint32_t>(i));
    auto gap = gaps.begin();
    for (std::size_t i = count_; i < destination.size(); ++i)
        if (destination[i] == processes.rank()) moves_.emplace_back(static_cast<std::uint32_t>(i), *gap++);
    places_.assign(gap, gap + static_cast<std::ptrdiff_t>(routes_.arriving()));
}

}  // namespace lamella::dist
