#pragma once

#include "lamella/core/parallel.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Loops over coarse particles.

namespace lamella::melp {

/// Calls body(i) for every i in [0, count), in blocks that suit work on some thirty neighbors each.
template <class Body>
void for_each_particle(std::size_t count, Body&& body) {
    constexpr std::size_t kBlock = 256;
    parallel_blocks(count, kBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// Sums of term(i) over the particles of each region, added in fixed blocks: the same bits on any number of threads.
template <class Term>
auto sum_over_regions(std::span<const std::int32_t> region, std::size_t regions, Term&& term) {
    using Value = decltype(term(std::size_t{}));
    const std::size_t blocks = (region.size() + kParallelBlock - 1) / kParallelBlock;
    std::vector<Value> parts(blocks * regions);
    parallel_blocks(region.size(), kParallelBlock, [&](std::size_t begin, std::size_t end) {
        Value* part = parts.data() + begin / kParallelBlock * regions;
        for (std::size_t i = begin; i < end; ++i) part[static_cast<std::size_t>(region[i])] += term(i);
    });
    std::vector<Value> sum(regions);
    for (std::size_t k = 0; k < parts.size(); ++k) sum[k % regions] += parts[k];
    return sum;
}

}  // namespace lamella::melp
