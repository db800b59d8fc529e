#include "lamella/dist/routes.h"

#include <utility>

namespace lamella::dist {

Routes::Routes(Communicator& processes, std::vector<std::vector<std::uint32_t>> to) : processes_(&processes) {
    std::vector<std::int64_t> counts(to.size());
    for (std::size_t r = 0; r < to.size(); ++r) {
        counts[r] = static_cast<std::int64_t>(to[r].size());
        leaving_ += to[r].size();
        if (!to[r].empty()) outgoing_.push_back({static_cast<int>(r), std::move(to[r])});
    }
    const std::vector<std::int64_t> from = processes.exchange(counts);
    for (std::size_t r = 0; r < from.size(); ++r) {
        if (from[r] == 0) continue;
        incoming_.push_back({static_cast<int>(r), static_cast<std::size_t>(from[r])});
        arriving_ += incoming_.back().items;
    }
}

void Routes::begin(std::span<const std::byte> sent, std::span<std::byte> received, std::size_t item_bytes) const {
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

void Routes::end() const {
    if (processes_ != nullptr) processes_->end();
}

void Routes::receive() const {
    if (processes_ != nullptr) processes_->receive();
}

}  // namespace lamella::dist
