#pragma once

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

namespace lamella::io::detail {

/// Writes `count` rows; append_row(out, i) appends row i to a string, from any thread. Rows come in order.
template <class AppendRow>
void write_rows(std::ostream& out, std::size_t count, AppendRow&& append_row) {
    constexpr std::size_t kBatch = 64 * kParallelBlock;  // bounds the text held in memory
    for (std::size_t first = 0; first < count; first += kBatch) {
        const std::size_t rows = std::min(kBatch, count - first);
        std::vector<std::string> blocks((rows + kParallelBlock - 1) / kParallelBlock);
        parallel_blocks(rows, kParallelBlock, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) append_row(blocks[begin / kParallelBlock], first + i);
        });
        for (const std::string& block : blocks) out << block;
    }
}

/// @throws IoError  something could not be written
inline void finish(std::ostream& out) {
    if (!out.flush()) throw IoError("cannot write the exported frame (disk full, or the reader of a pipe went away)");
}

}  // namespace lamella::io::detail
