#pragma once

#include "lamella/mesh/detail/face_grid.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::mesh::detail {

/// All pairs of faces whose boxes overlap, for passes over a whole mesh that does not change meanwhile.
///
/// Boxes are sorted by the cubic cell of their centers; a cell is as wide as the widest box, so that overlapping boxes
/// lie in neighboring cells. These are a few runs of the sorted list, which move along with the cell: every pair is
/// found once, in sequential reads, without a hash. The few widest boxes stand apart and meet everyone, so that a
/// single huge face does not make all cells huge.
class FacePairs {
public:
    struct Item {
        FaceId face;
        Box box;
    };
    explicit FacePairs(const std::vector<Item>& items);

    std::size_t size() const { return face_.size(); }

    /// Calls found(f, g), f < g, for every overlapping pair whose first member in the sorted order is one of
    /// [begin, end): blocks that cover [0, size()) find every pair once.
    template <class Found>
    void for_each(std::size_t begin, std::size_t end, Found&& found) const {
        std::array<Run, kRows.size()> runs{};
        std::uint64_t at = 0;  // no key is zero
        for (std::size_t i = begin; i < end; ++i) {
            if (i < small_ && key_[i] != at) {
                for (std::size_t r = 0; r < runs.size(); ++r) follow(runs[r], key_[i] + kRows[r], at == 0);
                at = key_[i];
            }
            if (i >= small_) {
                meet(i, i + 1, size(), found);
                continue;
            }
            meet(i, i + 1, runs[0].end, found);
            for (std::size_t r = 1; r < runs.size(); ++r) meet(i, runs[r].begin, runs[r].end, found);
            meet(i, small_, size(), found);
        }
    }

private:
    struct Run {
        std::size_t begin, end;
    };
    static constexpr int kBits = 21;  // of a key, per axis
    static constexpr std::uint64_t kY = std::uint64_t{1} << kBits, kZ = kY << kBits;
    /// From a cell to the middles of the rows of three cells that hold its later neighbors; the first is its own row.
    static constexpr std::array<std::uint64_t, 5> kRows{0, kY, kZ - kY, kZ, kZ + kY};

    /// Moves a run on to the row of cells around `middle`; `jump`: from anywhere.
    void follow(Run& run, std::uint64_t middle, bool jump) const {
        const auto first = key_.begin();
        const auto last = first + static_cast<std::ptrdiff_t>(small_);
        if (jump) {
            run.begin = static_cast<std::size_t>(std::lower_bound(first, last, middle - 1) - first);
            run.end = static_cast<std::size_t>(std::upper_bound(first, last, middle + 1) - first);
            return;
        }
        while (run.begin < small_ && key_[run.begin] < middle - 1) ++run.begin;
        while (run.end < small_ && key_[run.end] <= middle + 1) ++run.end;
    }

    template <class Found>
    void meet(std::size_t i, std::size_t begin, std::size_t end, Found&& found) const {
        const Box& a = box_[i];
        for (std::size_t j = begin; j < end; ++j) {
            const Box& b = box_[j];
            // One branch: most boxes in reach miss each other along some axis, and which one is hard to predict.
            const bool apart = (a.low[0] > b.high[0]) | (b.low[0] > a.high[0]) | (a.low[1] > b.high[1]) |
                               (b.low[1] > a.high[1]) | (a.low[2] > b.high[2]) | (b.low[2] > a.high[2]);
            if (!apart) found(std::min(face_[i], face_[j]), std::max(face_[i], face_[j]));
        }
    }

    std::size_t small_ = 0;  // those from here on are the widest
    std::vector<std::uint64_t> key_;
    std::vector<FaceId> face_;
    std::vector<Box> box_;
};

}  // namespace lamella::mesh::detail
