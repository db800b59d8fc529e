#pragma once

#include "lamella/dist/communicator.h"

#include <type_traits>

namespace lamella::dist {

/// Which items of this process go to which others, and how many come from where. Made once, then used for each of the
/// items' columns.
class Routes {
public:
    struct Group {
        int rank;
        std::vector<std::uint32_t> items;
    };
    struct Arrival {
        int rank;
        std::size_t items;
    };

    /// Nothing goes anywhere.
    Routes() = default;
    /// Collective. @param to  for each rank the items here that go to it, in the order in which they arrive there
    Routes(Communicator& processes, std::vector<std::vector<std::uint32_t>> to);

    /// Items that go, and that come; groups by rank, in order.
    std::size_t leaving() const { return leaving_; }
    std::size_t arriving() const { return arriving_; }
    std::span<const Group> outgoing() const { return outgoing_; }
    std::span<Group> outgoing() { return outgoing_; }
    std::span<const Arrival> incoming() const { return incoming_; }

    /// What arrives of a column, by rank.
    template <class T>
    std::vector<T> arrivals(std::span<const T> column) const {
        static_assert(std::is_trivially_copyable_v<T>);
        std::vector<T> sent(leaving_);
        std::size_t at = 0;
        for (const Group& group : outgoing_)
            for (const std::uint32_t i : group.items) sent[at++] = column[i];
        std::vector<T> received(arriving_);
        begin(std::as_bytes(std::span(sent)), std::as_writable_bytes(std::span(received)), sizeof(T));
        end();
        return received;
    }

    /// One message per route of so many bytes an item, as in Communicator; received with end() or receive().
    void begin(std::span<const std::byte> sent, std::span<std::byte> received, std::size_t item_bytes) const;
    void end() const;
    void receive() const;

private:
    Communicator* processes_ = nullptr;
    std::vector<Group> outgoing_;
    std::vector<Arrival> incoming_;
    std::size_t leaving_ = 0;
    std::size_t arriving_ = 0;
};

}  // namespace lamella::dist
