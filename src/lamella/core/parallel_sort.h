#pragma once

#include "lamella/core/parallel.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

namespace lamella {

/// Sorts `items`, of which no two are equal in rank: the same order on any number of threads.
///
/// Fixed blocks are sorted each for itself, then merged two by two.
template <class Item, class Less = std::less<>>
void parallel_sort(std::vector<Item>& items, Less less = {}) {
    constexpr std::size_t kSorted = 8192;
    const std::size_t count = items.size();
    const auto at = [](std::vector<Item>& list, std::size_t i) { return list.begin() + static_cast<std::ptrdiff_t>(i); };
    parallel_blocks(count, kSorted, [&](std::size_t begin, std::size_t end) {
        std::sort(at(items, begin), at(items, end), less);
    });
    if (count <= kSorted) return;
    std::vector<Item> merged(count);
    for (std::size_t run = kSorted; run < count; run *= 2) {
        parallel_blocks(count, 2 * run, [&](std::size_t begin, std::size_t end) {
            const std::size_t middle = std::min(begin + run, end);
            std::merge(at(items, begin), at(items, middle), at(items, middle), at(items, end), at(merged, begin), less);
        });
        items.swap(merged);
    }
}

}  // namespace lamella
