#pragma once

#include "lamella/solvers/bubble/detail/device_columns.h"
#include "lamella/spatial/search_frame.h"

// The neighbor lists of a foam on a GPU: bubbles sorted by cell, lists counted and then filled, each sorted by id as on
// the CPU, so that sums over a list are the same bits. Every struct is the body of one loop.

namespace lamella::bubble::detail {

/// Bubbles of one window are sorted by the length of their lists, so that those of a slice are about equally long.
inline constexpr std::size_t kListWindow = 256;
static_assert(kListWindow % kSlice == 0);

/// The balls in the order of their cells, and how to search them.
template <int D>
struct CellSearch {
    spatial::CellLayout<D> layout;
    spatial::PeriodicBox<D> box;
    Vec<D> inverse_lengths;
    const std::uint32_t* cell_start;  ///< first ball of each cell, and the end
    const StagedBall<D>* ball;
    double largest;
    double skin;
    bool images;

    /// Calls found(j, image) for every neighbor of ball i, each image once.
    template <class Found>
    LAMELLA_HOST_DEVICE void visit(std::size_t i, Found&& found) const {
        const StagedBall<D> me = ball[i];
        Vec<D> center;
        for (int k = 0; k < D; ++k) center[static_cast<std::size_t>(k)] = me.x[k];
        layout.for_each_run(center, me.radius + largest + skin, [&](std::size_t first, std::size_t end) {
            for (std::uint32_t j = cell_start[first]; j < cell_start[end]; ++j) {
                if (j == i) continue;
                const StagedBall<D> other = ball[j];
                const double limit = me.radius + skin + other.radius;
                Vec<D> separation;
                for (int k = 0; k < D; ++k) separation[static_cast<std::size_t>(k)] = me.x[k] - other.x[k];
                if (images) {
                    spatial::for_each_image<D>(box, inverse_lengths, separation, limit,
                                               [&](const std::array<std::int8_t, D>& m) { found(j, packed(m)); });
                    continue;
                }
                double squared = 0.0;
                for (std::size_t k = 0; k < D; ++k) {
                    const double s =
                        separation[k] - box.lengths[k] * std::nearbyint(separation[k] * inverse_lengths[k]);
                    squared += s * s;
                }
                if (squared < limit * limit) found(j, 0U);
            }
        });
    }

    /// A byte per axis.
    LAMELLA_HOST_DEVICE static std::uint32_t packed(const std::array<std::int8_t, D>& image) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < D; ++k)
            word |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(image[k])) << (8 * k);
        return word;
    }
    /// In the order of std::array.
    LAMELLA_HOST_DEVICE static bool image_before(std::uint32_t a, std::uint32_t b) {
        for (int k = 0; k < D; ++k) {
            const auto byte_a = static_cast<std::int8_t>(a >> (8 * k));
            const auto byte_b = static_cast<std::int8_t>(b >> (8 * k));
            if (byte_a != byte_b) return byte_a < byte_b;
        }
        return false;
    }
};

/// The cell of each slot; vanished bubbles come after all cells.
template <int D>
struct FindCells {
    spatial::CellLayout<D> layout;
    spatial::SearchFrame<D> frame;
    const double* position[D];
    const double* size;
    std::uint32_t* cell;
    std::uint32_t* slot;

    LAMELLA_HOST_DEVICE void operator()(std::size_t i) const {
        Vec<D> x;
        for (std::size_t k = 0; k < D; ++k) x[k] = frame.place(k, position[k][i]);
        cell[i] = static_cast<std::uint32_t>(size[i] > 0.0 ? layout.cell_of(x) : layout.count());
        slot[i] = static_cast<std::uint32_t>(i);
    }
};

/// Where each cell begins among the sorted cells of `count` balls.
struct FindCellStarts {
    const std::uint32_t* sorted_cell;
    std::uint32_t count;
    std::uint32_t* cell_start;

    LAMELLA_HOST_DEVICE void operator()(std::size_t c) const {
        std::uint32_t low = 0;
        std::uint32_t high = count;
        while (low < high) {
            const std::uint32_t middle = low + (high - low) / 2;
            if (sorted_cell[middle] < c)
                low = middle + 1;
            else
                high = middle;
        }
        cell_start[c] = low;
    }
};

/// The balls copied in cell order.
template <int D>
struct SortBalls {
    spatial::SearchFrame<D> frame;
    const double* position[D];
    const double* size;
    const std::uint32_t* cell_order;
    StagedBall<D>* ball;

    LAMELLA_HOST_DEVICE void operator()(std::size_t i) const {
        const std::uint32_t from = cell_order[i];
        double x[D];
        for (std::size_t k = 0; k < D; ++k) x[k] = frame.place(k, position[k][from]);
        ball[i] = staged_ball<D>(x, {Shape<D>::radius(size[from]), 0.0});
    }
};

/// What a ball is to the lists: those that have copies in their lists stand after those that have none.
enum class Kind : std::uint32_t { kInterior, kBorder, kCopy, kEnd };

template <int D>
struct CountNeighbors {
    CellSearch<D> search;
    const std::uint32_t* cell_order;
    std::uint32_t first_copy;  ///< copies have slots from here on
    std::uint32_t* found;
    std::uint32_t* kind;  ///< nullptr: there are no copies

    LAMELLA_HOST_DEVICE void operator()(std::size_t i) const {
        std::uint32_t n = 0;
        Kind mine = cell_order[i] >= first_copy ? Kind::kCopy : Kind::kInterior;
        if (mine != Kind::kCopy)
            search.visit(i, [&](std::uint32_t j, std::uint32_t) {
                ++n;
                if (cell_order[j] >= first_copy) mine = Kind::kBorder;
            });
        found[i] = n;
        if (kind != nullptr) kind[i] = static_cast<std::uint32_t>(mine);
    }
};

/// The balls that have lists, in an order; copies follow them. A number here is a place in the order of the cells.
struct ListOrder {
    const std::uint32_t* ball;  ///< nullptr: the order of the cells itself
    LAMELLA_HOST_DEVICE std::size_t operator()(std::size_t n) const { return ball != nullptr ? ball[n] : n; }
};

/// Final place of each ball that has a list: windows of their order sorted by list length, longest first.
struct PlaceBalls {
    ListOrder listed;
    const std::uint32_t* found;
    const std::uint32_t* cell_order;
    std::size_t interior;  ///< no window goes across this border
    std::size_t count;
    std::uint32_t* place;   ///< cell order -> final slot
    std::uint32_t* order;   ///< final slot -> old slot
    std::uint32_t* length;  ///< of the list of a final slot

    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const {
        std::size_t begin = n / kListWindow * kListWindow;
        std::size_t end = begin + kListWindow < count ? begin + kListWindow : count;
        if (n >= interior && begin < interior) begin = interior;
        if (n < interior && end > interior) end = interior;
        const std::size_t ball = listed(n);
        const std::uint32_t mine = found[ball];
        std::size_t rank = begin;
        for (std::size_t j = begin; j < end; ++j) {
            const std::uint32_t other = found[listed(j)];
            rank += other > mine || (other == mine && j < n) ? 1U : 0U;
        }
        place[ball] = static_cast<std::uint32_t>(rank);
        order[rank] = cell_order[ball];
        length[rank] = mine;
    }
};

/// Copies stand behind the `count` balls that have lists, in the order in which they came.
struct PlaceCopies {
    ListOrder listed;
    const std::uint32_t* cell_order;
    std::uint32_t first_copy;
    std::size_t count;
    std::uint32_t* place;

    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const {
        const std::size_t ball = listed(count + n);
        place[ball] = static_cast<std::uint32_t>(count + cell_order[ball] - first_copy);
    }
};

/// Entries that each slice takes; one more slice of none, so that the sum ends with the total.
struct MeasureSlices {
    const std::uint32_t* length;
    std::size_t count;
    std::uint64_t* entries;

    LAMELLA_HOST_DEVICE void operator()(std::size_t s) const {
        std::uint32_t longest = 0;
        for (std::size_t i = s * kSlice; i < (s + 1) * kSlice && i < count; ++i)
            longest = length[i] > longest ? length[i] : longest;
        entries[s] = longest * kSlice;
    }
};

struct InvertOrder {
    const std::uint32_t* order;
    std::uint32_t* inverse;
    LAMELLA_HOST_DEVICE void operator()(std::size_t i) const { inverse[order[i]] = static_cast<std::uint32_t>(i); }
};

/// Moves a bubble to its new slot, and notes where it stands.
template <int D>
struct ReorderBubble {
    DeviceView<D> from;
    DeviceView<D> to;
    const std::uint32_t* order;

    LAMELLA_HOST_DEVICE void operator()(std::size_t i) const {
        const BubbleRecord<D> bubble = record_of(from, order[i]);
        put_record(to, i, bubble);
        for (int k = 0; k < D; ++k) to.built_position[k][i] = bubble.position[k];
        to.built_radius[i] = Shape<D>::radius(bubble.size);
    }
};

struct MoveIds {
    const std::int64_t* from;
    std::int64_t* to;
    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const { to[n] = from[n]; }
};

/// Writes the list of each ball in the order of the neighbors' ids.
template <int D>
struct FillLists {
    CellSearch<D> search;
    ListOrder listed;
    const std::uint32_t* place;
    const std::int64_t* id;  ///< by final slot
    const std::uint64_t* slice_start;
    std::uint32_t* index;
    std::uint32_t* image;  ///< nullptr: none are kept

    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const {
        const std::size_t i = listed(n);
        const std::uint32_t me = place[i];
        const std::uint64_t first = slice_start[me / kSlice] + me % kSlice;
        std::uint64_t end = first;
        search.visit(i, [&](std::uint32_t j, std::uint32_t m) {
            const std::uint32_t other = place[j];
            std::uint64_t at = end;
            for (; at != first && before(id[other], m, at - kSlice); at -= kSlice) {
                index[at] = index[at - kSlice];
                if (image != nullptr) image[at] = image[at - kSlice];
            }
            index[at] = other;
            if (image != nullptr) image[at] = m;
            end += kSlice;
        });
    }

private:
    LAMELLA_HOST_DEVICE bool before(std::int64_t new_id, std::uint32_t new_image, std::uint64_t at) const {
        const std::int64_t old_id = id[index[at]];
        if (new_id != old_id || image == nullptr) return new_id < old_id;
        return CellSearch<D>::image_before(new_image, image[at]);
    }
};

/// Adds up the radii of a foam.
template <int D>
struct AddRadii {
    const double* size;
    std::size_t slots;
    double scale;

    LAMELLA_HOST_DEVICE std::size_t count() const { return slots; }
    LAMELLA_HOST_DEVICE void operator()(std::size_t i, Reduction<1, 2>& sums) const {
        add_term(FixedSum(scale), Shape<D>::radius(size[i]), sums.sum);
    }
};

template <int D>
struct MarkPosition {
    DeviceView<D> view;
    LAMELLA_HOST_DEVICE void operator()(std::size_t i) const {
        for (int k = 0; k < D; ++k) view.marked[k][i] = view.position[k][i];
    }
};

}  // namespace lamella::bubble::detail
