#pragma once

#include "lamella/core/aligned.h"
#include "lamella/core/fixed_sum.h"
#include "lamella/dist/communicator.h"
#include "lamella/dist/halo.h"
#include "lamella/dist/sum.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>

namespace lamella::bubble {

/// The processes that share a foam. Each owns the bubbles in its part of the box and sees copies of those of others
/// that may touch its own; with one process there are no copies.
///
/// Every decision of the solver rests on numbers that went through sum(), exact_sum() or largest(), and sums are
/// integers: all processes decide alike, and the result does not depend on how many there are.
class Domain {
public:
    explicit Domain(dist::Communicator& processes) : processes_(&processes) {}

    dist::Communicator& processes() const { return *processes_; }
    bool several() const { return processes_->several(); }

    /// Each becomes the sum over all processes.
    void sum(std::span<FixedSum> sums) const { dist::sum(*processes_, sums); }
    /// Sums and maxima on one way: cheaper than one after another.
    void reduce(std::span<FixedSum> sums, std::span<double> maxima) const { dist::reduce(*processes_, sums, maxima); }
    std::int64_t sum(std::int64_t value) const { return dist::sum(*processes_, value); }
    double largest(double value) const { return dist::largest(*processes_, value); }
    void largest(std::span<double> values) const { processes_->largest(values); }
    /// As lamella::exact_sum, over the items of all processes.
    template <class Term>
    double exact_sum(std::size_t count, Term&& term) const {
        return dist::exact_sum(*processes_, count, most_items_, term);
    }
    /// No sum will have more terms than `most`.
    void expect_items(double most) { most_items_ = most; }
    double most_terms() const { return std::max(kMostTerms, most_items_); }

    /// Which bubbles are copied where.
    void set_halo(dist::Halo halo) { halo_ = std::move(halo); }
    std::size_t copies() const { return halo_.copies(); }
    /// Brings the copies' entries of these columns up to date; between begin and end they must not be read.
    void begin_refresh(std::span<Column* const> columns) { halo_.begin(columns); }
    void end_refresh() { halo_.end(); }
    void refresh(std::span<Column* const> columns) {
        begin_refresh(columns);
        end_refresh();
    }
    template <class Columns>
    void refresh_all(Columns& columns) {
        std::array<Column*, std::tuple_size_v<Columns>> pointers;
        for (std::size_t k = 0; k < pointers.size(); ++k) pointers[k] = &columns[k];
        refresh(pointers);
    }

private:
    dist::Communicator* processes_;
    dist::Halo halo_;
    double most_items_ = 1.0;
};

}  // namespace lamella::bubble
