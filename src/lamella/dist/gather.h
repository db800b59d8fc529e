#pragma once

#include "lamella/dist/communicator.h"

#include <type_traits>

namespace lamella::dist {

/// The items of all processes on process 0, in the order of ranks; nothing on the others.
template <class T>
std::vector<T> gather(Communicator& processes, std::span<const T> items) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::int64_t> to_each(static_cast<std::size_t>(processes.size()), 0);
    to_each[0] = static_cast<std::int64_t>(items.size());
    const std::vector<std::int64_t> from = processes.exchange(to_each);
    std::vector<Outgoing> outgoing;
    std::vector<Incoming> incoming;
    std::vector<T> all;
    if (processes.rank() == 0) {
        std::size_t total = 0;
        for (const std::int64_t count : from) total += static_cast<std::size_t>(count);
        all.reserve(total);
        all.assign(items.begin(), items.end());
        all.resize(total);
        std::span<T> rest = std::span(all).subspan(items.size());
        for (std::size_t r = 1; r < from.size(); ++r) {
            const auto count = static_cast<std::size_t>(from[r]);
            if (count > 0) incoming.push_back({static_cast<int>(r), std::as_writable_bytes(rest.first(count))});
            rest = rest.subspan(count);
        }
    } else if (!items.empty()) {
        outgoing.push_back({0, std::as_bytes(items)});
    }
    processes.begin(outgoing, incoming);
    processes.end();
    return all;
}

/// What each process gets of `total` items in order: about as many each.
struct Share {
    std::int64_t first = 0;
    std::int64_t count = 0;
};
inline Share share_of(std::int64_t total, const Communicator& processes) {
    const std::int64_t size = processes.size();
    const auto begin = [&](std::int64_t r) { return total / size * r + total % size * r / size; };
    const std::int64_t first = begin(processes.rank());
    return {first, begin(processes.rank() + 1) - first};
}

/// The reverse of gather: each process gets its share (share_of) of the `total` items that process 0 holds.
template <class T>
std::vector<T> scatter(Communicator& processes, std::span<const T> all, std::int64_t total) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto count = static_cast<std::size_t>(share_of(total, processes).count);
    const std::vector<std::int64_t> counts = processes.exchange(
        std::vector<std::int64_t>(static_cast<std::size_t>(processes.size()), static_cast<std::int64_t>(count)));
    std::vector<Outgoing> outgoing;
    std::vector<Incoming> incoming;
    std::vector<T> own;
    if (processes.rank() == 0) {
        own.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
        std::span<const T> rest = all.subspan(count);
        for (std::size_t r = 1; r < counts.size(); ++r) {
            const auto n = static_cast<std::size_t>(counts[r]);
            if (n > 0) outgoing.push_back({static_cast<int>(r), std::as_bytes(rest.first(n))});
            rest = rest.subspan(n);
        }
    } else {
        own.resize(count);
        if (count > 0) incoming.push_back({0, std::as_writable_bytes(std::span(own))});
    }
    processes.begin(outgoing, incoming);
    processes.end();
    return own;
}

}  // namespace lamella::dist
