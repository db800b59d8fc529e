#pragma once

#include "lamella/core/fixed_sum.h"
#include "lamella/dist/communicator.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace lamella::dist {

/// Each sum becomes the one over all processes: integers, so that it does not show how many there are.
/// Each of `maxima` becomes the largest over all processes, on the same way.
void reduce(Communicator& processes, std::span<FixedSum> sums, std::span<double> maxima);
inline void sum(Communicator& processes, std::span<FixedSum> sums) { reduce(processes, sums, {}); }
std::int64_t sum(Communicator& processes, std::int64_t value);
double largest(Communicator& processes, double value);

/// exact_sum over the items of all processes.
/// @param most_terms  a bound of their number in all, the same on every process
template <class Term>
double exact_sum(Communicator& processes, std::size_t count, double most_terms, Term&& term) {
    const double here = parallel_max(count, 0.0, [&](std::size_t i) { return std::abs(term(i)); });
    const double scale = largest(processes, here) * std::max(kMostTerms, most_terms);
    FixedSum total[] = {fixed_sum(count, scale, term)};
    sum(processes, total);
    return total[0].value();
}

}  // namespace lamella::dist
