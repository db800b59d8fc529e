#include "lamella/dist/halo.h"

#include "lamella/core/parallel.h"

namespace lamella::dist {

void Halo::renumber(std::span<const std::uint32_t> place, std::size_t first_copy) {
    for (Routes::Group& group : routes_.outgoing())
        for (std::uint32_t& i : group.items) i = place[i];
    first_copy_ = first_copy;
}

/// One message per neighbor: its items of the first column, of the second, and so on.
void Halo::begin(std::span<Column* const> columns) {
    columns_.assign(columns.begin(), columns.end());
    std::vector<double>& sent = sent_[turn_++ % sent_.size()];
    sent.resize(columns.size() * copied());
    received_.resize(columns.size() * copies());
    std::size_t at = 0;
    for (const Routes::Group& group : routes_.outgoing())
        for (Column* column : columns_) {
            parallel_for(group.items.size(), [&](std::size_t n) { sent[at + n] = (*column)[group.items[n]]; });
            at += group.items.size();
        }
    if (copies() > 0)
        for (Column* column : columns_)
            if (column->size() < first_copy_ + copies()) {
                column->reserve(first_copy_ + copies());  // no more than that: columns are long
                column->resize(first_copy_ + copies());
            }
    routes_.begin(std::as_bytes(std::span(sent)), std::as_writable_bytes(std::span(received_)),
                  columns.size() * sizeof(double));
}

void Halo::end() {
    routes_.receive();
    std::size_t at = 0;
    std::size_t first = first_copy_;
    for (const Routes::Arrival& arrival : routes_.incoming()) {
        for (Column* column : columns_) {
            std::copy_n(&received_[at], arrival.items, &(*column)[first]);
            at += arrival.items;
        }
        first += arrival.items;
    }
    columns_.clear();
}

}  // namespace lamella::dist
