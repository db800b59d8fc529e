#pragma once

#include "lamella/core/host_device.h"
#include "lamella/core/parallel.h"
#include "lamella/mesh/detail/face_grid.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <experimental/simd>
#include <vector>

namespace lamella::mesh::detail {

/// All pairs of faces whose boxes overlap (to the rounding of a float), for passes over a whole mesh that does not change meanwhile.
///
/// Boxes are sorted by the cubic cell of their centers; a cell is as wide as the widest box, so that overlapping boxes
/// lie in neighboring cells. These are a few runs of the sorted list, which move along with the cell: every pair is
/// found once, in sequential reads, without a hash. The few widest boxes, as of films that snap, stand apart and meet
/// everyone, so that they do not make all cells huge. Sixteen boxes are looked at together.
class FacePairs {
public:
    struct Item {
        FaceId face;
        Box box;
    };
    explicit FacePairs(const std::vector<Item>& items);

    /// The cell of a center, which is given in widths of a cell from the lowest corner of all boxes.
    static std::uint64_t key(const Vec3& center) {
        std::uint64_t key = 0;
        for (std::size_t k = 3; k-- > 0;) key = (key << kBits) + static_cast<std::uint64_t>(center[k]) + 1;
        return key;
    }

    std::size_t size() const { return face_.size(); }

    /// What visit(f, g, found) appends to `found` for each pair, f < g, in an order that depends on the boxes alone.
    template <class Result, class Visit>
    std::vector<Result> collect(Visit&& visit) const {
        constexpr std::size_t kBlock = 256;
        std::vector<std::vector<Result>> parts((size() + kBlock - 1) / kBlock);
        parallel_blocks(size(), kBlock, [&](std::size_t begin, std::size_t end) {
            auto& part = parts[begin / kBlock];
            for_each(begin, end, [&](FaceId f, FaceId g) { visit(f, g, part); });
        });
        std::vector<Result> all;
        for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
        return all;
    }

private:
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
    LAMELLA_ALWAYS_INLINE void meet(std::size_t i, std::size_t begin, std::size_t end, Found&& found) const {
        const auto all = [&](const std::vector<float>& side) { return Lanes(side[i]); };
        const auto load = [&](const std::vector<float>& side, std::size_t j) {
            return Lanes(side.data() + j, std::experimental::element_aligned);
        };
        for (std::size_t j = begin; j < end; j += Lanes::size()) {
            auto near = load(low_[0], j) <= all(high_[0]) && load(high_[0], j) >= all(low_[0]);
            for (std::size_t k = 1; k < 3; ++k)
                near = near && load(low_[k], j) <= all(high_[k]) && load(high_[k], j) >= all(low_[k]);
            while (std::experimental::any_of(near)) {
                const int lane = std::experimental::find_first_set(near);
                near[lane] = false;
                const std::size_t other = j + static_cast<std::size_t>(lane);
                if (other < end) found(std::min(face_[i], face_[other]), std::max(face_[i], face_[other]));
            }
        }
    }

    using Lanes = std::experimental::simd<float, std::experimental::simd_abi::deduce_t<float, 16>>;

    std::size_t small_ = 0;  // those from here on are the widest
    std::vector<std::uint64_t> key_;
    std::vector<FaceId> face_;
    std::array<std::vector<float>, 3> low_, high_;  ///< boxes, rounded outwards, and empty ones after the last
};

}  // namespace lamella::mesh::detail
