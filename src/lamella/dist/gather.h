#pragma once

#include "lamella/dist/agree.h"
#include "lamella/dist/communicator.h"

#include <algorithm>
#include <exception>
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

/// Items of this many bytes travel at once where a column is not to be in memory as a whole.
inline constexpr std::size_t kPieceBytes = std::size_t{8} << 20;

namespace detail {

/// Calls piece(rank, first, count) on every process for each piece of what the processes have of a column, in order.
template <class T, class Piece>
void for_each_piece(std::span<const std::int64_t> counts, std::size_t piece_bytes, Piece&& piece) {
    const auto most = static_cast<std::int64_t>(std::max<std::size_t>(1, piece_bytes / sizeof(T)));
    for (std::size_t r = 0; r < counts.size(); ++r)
        for (std::int64_t first = 0; first < counts[r]; first += most)
            piece(static_cast<int>(r), static_cast<std::size_t>(first),
                  static_cast<std::size_t>(std::min(most, counts[r] - first)));
}

/// What each process says of itself, to all.
inline std::vector<std::int64_t> counts_of_all(Communicator& processes, std::size_t count) {
    return processes.exchange(
        std::vector<std::int64_t>(static_cast<std::size_t>(processes.size()), static_cast<std::int64_t>(count)));
}

}  // namespace detail

/// The items of all processes come to process 0 piece by piece, in the order of ranks: there take(items) is called for
/// each piece. Once it throws, what is still to come is dropped, and all processes get the error.
template <class T, class Take>
void gather_in_pieces(Communicator& processes,
                      std::span<const T> items,
                      Take&& take,
                      std::size_t piece_bytes = kPieceBytes) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::exception_ptr error;
    std::vector<T> piece;
    const auto give = [&](std::span<const T> values) {
        try {
            if (!error) take(values);
        } catch (...) {
            error = std::current_exception();
        }
    };
    const auto counts = detail::counts_of_all(processes, items.size());
    detail::for_each_piece<T>(counts, piece_bytes, [&](int rank, std::size_t first, std::size_t count) {
        std::vector<Outgoing> outgoing;
        std::vector<Incoming> incoming;
        if (rank > 0 && processes.rank() == 0) {
            piece.resize(count);
            incoming.push_back({rank, std::as_writable_bytes(std::span(piece))});
        } else if (rank > 0 && processes.rank() == rank) {
            outgoing.push_back({0, std::as_bytes(items.subspan(first, count))});
        }
        processes.begin(outgoing, incoming);
        processes.end();
        if (processes.rank() == 0) give(rank == 0 ? items.subspan(first, count) : std::span<const T>(piece));
    });
    detail::agree_on_failure(processes, error);
}

/// The reverse: each process gets its share (share_of) of `total` items, which on process 0 fetch(first, count) reads
/// piece by piece. When that throws, all processes get the error.
template <class T, class Fetch>
std::vector<T> scatter_in_pieces(Communicator& processes,
                                 std::int64_t total,
                                 Fetch&& fetch,
                                 std::size_t piece_bytes = kPieceBytes) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::exception_ptr error;
    std::vector<T> own;
    std::vector<T> piece;
    std::int64_t at = 0;
    const auto counts = detail::counts_of_all(processes, static_cast<std::size_t>(share_of(total, processes).count));
    detail::for_each_piece<T>(counts, piece_bytes, [&](int rank, std::size_t first, std::size_t count) {
        if (processes.rank() == 0) {
            try {
                if (!error) piece = fetch(at, count);
            } catch (...) {
                error = std::current_exception();
            }
            piece.resize(count);
        }
        // A total that the file does not have is found while little memory is taken.
        if (at == 0) detail::agree_on_failure(processes, error);
        at += static_cast<std::int64_t>(count);
        std::vector<Outgoing> outgoing;
        std::vector<Incoming> incoming;
        if (rank == processes.rank()) own.resize(first + count);
        const std::span<T> place = rank == processes.rank() ? std::span(own).subspan(first) : std::span<T>();
        if (rank > 0 && processes.rank() == 0) outgoing.push_back({rank, std::as_bytes(std::span(piece))});
        if (rank > 0 && !place.empty()) incoming.push_back({0, std::as_writable_bytes(place)});
        if (rank == 0) std::copy_n(piece.begin(), place.size(), place.begin());
        processes.begin(outgoing, incoming);
        processes.end();
    });
    detail::agree_on_failure(processes, error);
    return own;
}

}  // namespace lamella::dist
