#pragma once

#include "lamella/dist/communicator.h"

#include <cstring>
#include <type_traits>
#include <utility>

namespace lamella::dist {

/// Items on their way to other processes: those that stay keep their order and come first, then those that arrive, by
/// the rank they come from. Made once for a set of items, then applied to each of their columns.
class Migration {
public:
    /// @param destination  the rank that each item goes to
    Migration(Communicator& processes, std::span<const int> destination);

    /// Items here afterwards.
    std::size_t count() const { return staying_.size() + arriving_; }
    /// Items that leave this process.
    std::size_t leaving() const { return leaving_; }

    /// The column of the items as they were becomes that of the items now here.
    template <class C>
    void operator()(C& column) const {
        using T = typename C::value_type;
        static_assert(std::is_trivially_copyable_v<T>);
        std::vector<std::byte> sent(leaving_ * sizeof(T));
        std::size_t at = 0;
        for (const Group& group : outgoing_)
            for (const std::uint32_t i : group.items) {
                std::memcpy(&sent[at], &column[i], sizeof(T));
                at += sizeof(T);
            }
        C moved(count());
        for (std::size_t n = 0; n < staying_.size(); ++n) moved[n] = column[staying_[n]];
        move(sent, std::as_writable_bytes(std::span(moved.data() + staying_.size(), arriving_)), sizeof(T));
        column.swap(moved);
    }

private:
    struct Group {
        int rank;
        std::vector<std::uint32_t> items;
    };
    struct Arrival {
        int rank;
        std::size_t items;
    };
    void move(std::span<const std::byte> sent, std::span<std::byte> received, std::size_t item_bytes) const;

    Communicator* processes_;
    std::vector<std::uint32_t> staying_;
    std::vector<Group> outgoing_;
    std::vector<Arrival> incoming_;
    std::size_t leaving_ = 0;
    std::size_t arriving_ = 0;
};

}  // namespace lamella::dist
