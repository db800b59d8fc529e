#pragma once

#include "lamella/dist/routes.h"

#include <algorithm>
#include <utility>

namespace lamella::dist {

/// Items on their way to other processes. Those that stay keep their places where they can: what arrives, and the last
/// ones, fill the gaps. Made once for a set of items, then applied to each of their columns.
class Migration {
public:
    static constexpr int kGone = -1;  ///< the destination of items that end here

    /// Collective. @param destination  the rank that each item goes to, or kGone
    Migration(Communicator& processes, std::span<const int> destination);

    /// Items here afterwards.
    std::size_t count() const { return count_; }

    /// The column of the items as they were (maybe with other entries behind them) becomes that of the items now here.
    template <class C>
    void operator()(C& column) const {
        using T = typename C::value_type;
        const std::vector<T> arrivals = routes_.arrivals(std::span<const T>(column));
        column.reserve(std::max(count_, column.size()));  // no more than that: columns are long
        if (count_ > column.size()) column.resize(count_);
        for (const auto& [from, to] : moves_) column[to] = column[from];
        for (std::size_t n = 0; n < arrivals.size(); ++n) column[places_[n]] = arrivals[n];
        column.resize(count_);
    }

private:
    Routes routes_;
    std::size_t count_ = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> moves_;  ///< of staying items: from, to
    std::vector<std::uint32_t> places_;                           ///< of the arrivals
};

}  // namespace lamella::dist
