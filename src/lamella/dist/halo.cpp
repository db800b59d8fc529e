#include "lamella/dist/halo.h"

#include "lamella/core/parallel.h"

namespace lamella::dist {

Halo::Halo(Communicator& processes, std::vector<std::vector<std::uint32_t>> wanted) : processes_(&processes) {
    std::vector<std::int64_t> counts(wanted.size());
    for (std::size_t r = 0; r < wanted.size(); ++r) {
        counts[r] = static_cast<std::int64_t>(wanted[r].size());
        copied_ += wanted[r].size();
        if (!wanted[r].empty()) outgoing_.push_back({static_cast<int>(r), std::move(wanted[r])});
    }
    const std::vector<std::int64_t> from = processes.exchange(counts);
    for (std::size_t r = 0; r < from.size(); ++r) {
        if (from[r] == 0) continue;
        incoming_.push_back({static_cast<int>(r), static_cast<std::size_t>(from[r])});
        copies_ += incoming_.back().items;
    }
}

void Halo::renumber(std::span<const std::uint32_t> place, std::size_t first_copy) {
    for (Group& group : outgoing_)
        for (std::uint32_t& i : group.items) i = place[i];
    first_copy_ = first_copy;
}

void Halo::begin_messages(std::span<const std::byte> sent, std::span<std::byte> received, std::size_t item_bytes) {
    if (processes_ == nullptr) return;
    std::vector<Outgoing> outgoing;
    for (const Group& group : outgoing_) {
        outgoing.push_back({group.rank, sent.first(group.items.size() * item_bytes)});
        sent = sent.subspan(group.items.size() * item_bytes);
    }
    std::vector<Incoming> incoming;
    for (const Arrival& arrival : incoming_) {
        incoming.push_back({arrival.rank, received.first(arrival.items * item_bytes)});
        received = received.subspan(arrival.items * item_bytes);
    }
    processes_->begin(outgoing, incoming);
}

/// One message per neighbor: its items of the first column, of the second, and so on.
void Halo::begin(std::span<Column* const> columns) {
    if (processes_ == nullptr) return;
    columns_.assign(columns.begin(), columns.end());
    sent_.resize(columns.size() * copied_);
    received_.resize(columns.size() * copies_);
    std::size_t at = 0;
    for (const Group& group : outgoing_)
        for (Column* column : columns_) {
            parallel_for(group.items.size(), [&](std::size_t n) { sent_[at + n] = (*column)[group.items[n]]; });
            at += group.items.size();
        }
    for (Column* column : columns_)
        if (column->size() < first_copy_ + copies_) column->resize(first_copy_ + copies_);
    begin_messages(std::as_bytes(std::span(sent_)), std::as_writable_bytes(std::span(received_)),
                   columns.size() * sizeof(double));
}

void Halo::end() {
    if (processes_ == nullptr) return;
    processes_->end();
    std::size_t at = 0;
    std::size_t first = first_copy_;
    for (const Arrival& arrival : incoming_) {
        for (Column* column : columns_) {
            std::copy_n(&received_[at], arrival.items, &(*column)[first]);
            at += arrival.items;
        }
        first += arrival.items;
    }
    columns_.clear();
}

}  // namespace lamella::dist
