#pragma once

#include "lamella/core/aligned.h"
#include "lamella/dist/routes.h"

#include <array>
#include <cstdint>
#include <utility>

namespace lamella::dist {

/// Copies of other processes' items that are near this one's, and how they are kept up to date.
class Halo {
public:
    /// No copies.
    Halo() = default;
    /// @param wanted  for each rank the items here that it gets copies of, in the order in which it will see them
    Halo(Communicator& processes, std::vector<std::vector<std::uint32_t>> wanted)
        : routes_(processes, std::move(wanted)) {}

    /// Copies here. Those of one rank are neighbors, ranks in order.
    std::size_t copies() const { return routes_.arriving(); }
    /// Copies of this process's items elsewhere.
    std::size_t copied() const { return routes_.leaving(); }

    /// The copies' entries of a column of the items here.
    template <class T>
    std::vector<T> fetch(std::span<const T> column) const {
        return routes_.arrivals(column);
    }

    /// The items were stored anew: item i stands at place[i] now, and the copies follow from `first_copy` on.
    void renumber(std::span<const std::uint32_t> place, std::size_t first_copy);

    /// Sends the columns' entries to where they are copied; until end() the columns must live, and their copies (made
    /// room for where they are missing) must not be read.
    void begin(std::span<Column* const> columns);
    void end();

private:
    Routes routes_;
    std::size_t first_copy_ = 0;

    std::vector<Column*> columns_;             ///< between begin() and end()
    std::array<std::vector<double>, 2> sent_;  ///< by turns: the last one may still be on its way
    std::vector<double> received_;
    std::size_t turn_ = 0;
};

}  // namespace lamella::dist
