#include "lamella/spatial/neighbor_list.h"

#include "lamella/core/parallel.h"
#include "lamella/spatial/cell_grid.h"
#include "lamella/spatial/search_frame.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace lamella::spatial {
namespace {

// Balls of one window are sorted by the length of their lists, so that the lists of a group are about equally long:
// the gaps shrink from 40 % of the entries to under 5 %, and neighbors in space stay within 1 kB of each other.
constexpr std::size_t kWindow = 128;
constexpr std::size_t kBlock = 16 * kWindow;
static_assert(kWindow % kLanes == 0);

template <int D>
struct Entry {
    std::int64_t id;
    std::uint32_t index;
    std::array<std::int8_t, D> image;
};

/// Coordinates copied in cell order: the search runs through them one after the other.
template <int D>
struct SortedBalls {
    std::array<Column, D> position;
    Column radius;
};

/// The candidates of one ball.
template <int D>
class Search {
public:
    Search(const PeriodicBox<D>& box, const CellGrid<D>& grid, const SortedBalls<D>& balls, double skin, bool images)
        : box_(box), inverse_(box.inverse_lengths()), grid_(grid), balls_(balls), skin_(skin), images_(images) {}

    /// Calls found(j, image) for every neighbor of ball i (cell order), each image once.
    template <class Found>
    void visit(std::size_t i, double reach, Found&& found) const {
        Vec<D> center;
        for (std::size_t k = 0; k < D; ++k) center[k] = balls_.position[k][i];
        const double own_reach = balls_.radius[i] + skin_;
        grid_.for_each_range(center, reach, [&](std::size_t begin, std::size_t end) {
            if (images_) {
                for (std::size_t j = begin; j < end; ++j)
                    visit_images(center, i, j, own_reach + balls_.radius[j], found);
                return;
            }
            for (std::size_t first = begin; first < end; first += kLanes) {
                auto near = within_reach(center, own_reach, first);
                while (stdx::any_of(near)) {
                    const auto lane = static_cast<std::size_t>(stdx::find_first_set(near));
                    near[lane] = false;
                    const std::size_t j = first + lane;
                    if (j < end && j != i) found(j, std::array<std::int8_t, D>{});
                }
            }
        });
    }

private:
    /// Which of the balls first .. first + 7 have their nearest image within reach.
    auto within_reach(const Vec<D>& center, double own_reach, std::size_t first) const {
        Simd squared = 0.0;
        for (std::size_t k = 0; k < D; ++k) {
            Simd s = center[k] - load_lanes(&balls_.position[k][first]);
            s -= box_.lengths[k] * nearest(s * inverse_[k]);
            squared += s * s;
        }
        const Simd limit = own_reach + load_lanes(&balls_.radius[first]);
        return squared < limit * limit;
    }

    template <class Found>
    void visit_images(const Vec<D>& center, std::size_t i, std::size_t j, double limit, Found&& found) const {
        // A ball meets its own image only when it spans the box; the foam ends before that.
        if (j == i) return;
        Vec<D> separation;
        for (std::size_t k = 0; k < D; ++k) separation[k] = center[k] - balls_.position[k][j];
        for_each_image<D>(box_, inverse_, separation, limit,
                          [&](const std::array<std::int8_t, D>& image) { found(j, image); });
    }

    const PeriodicBox<D>& box_;
    Vec<D> inverse_;
    const CellGrid<D>& grid_;
    const SortedBalls<D>& balls_;
    double skin_;
    bool images_;
};

/// The lists of one block of balls, in cell order.
template <int D>
struct BlockLists {
    std::vector<std::uint32_t> length;
    std::vector<std::uint32_t> index;               ///< of the entries, list after list
    std::vector<std::array<std::int8_t, D>> image;  ///< likewise, where there are images
};

/// One axis of a SearchFrame.
struct Window {
    double origin = 0.0;
    double length = 0.0;
    bool whole = true;
};

/// The shortest window that holds all the points. @param reach  across a gap of this length nothing touches
Window window_of(const double* x, std::size_t count, double length, bool periodic, double reach) {
    constexpr std::size_t kBins = 1024;
    using Bins = std::array<std::uint8_t, kBins>;
    const auto wrapped = [&](double at) { return periodic ? at - length * std::floor(at / length) : at; };
    const Bins used = parallel_reduce(
        count, Bins{},
        [&](std::size_t begin, std::size_t end) {
            Bins bins{};
            for (std::size_t i = begin; i < end; ++i)
                bins[static_cast<std::size_t>(
                    std::clamp(wrapped(x[i]) / length * kBins, 0.0, static_cast<double>(kBins - 1)))] = 1;
            return bins;
        },
        [](Bins a, const Bins& b) {
            for (std::size_t k = 0; k < kBins; ++k) a[k] |= b[k];
            return a;
        });
    // The longest run of empty bins, around the box; on an axis with walls the one across its ends.
    std::size_t longest = 0;
    std::size_t end_of_longest = 0;
    std::size_t run = 0;
    for (std::size_t k = 0; k < 2 * kBins; ++k) {
        run = used[k % kBins] != 0 ? 0 : run + 1;
        const bool across_ends = k + 1 == kBins || (k >= kBins && k - kBins < run);
        const bool allowed = periodic || across_ends;
        if (allowed && run > longest && run <= kBins) {
            longest = run;
            end_of_longest = (k + 1) % kBins;
        }
    }
    // A bin on either side stays in the window: rounding must not push a point out of it.
    const double bin = length / static_cast<double>(kBins);
    if (longest == kBins || longest < 3 || static_cast<double>(longest - 2) * bin <= reach) return {0.0, length, true};
    return {(static_cast<double>(end_of_longest) - 1.0) * bin, static_cast<double>(kBins - longest + 2) * bin, false};
}

template <int D>
void sort_by_id(Entry<D>* begin, Entry<D>* end) {
    const auto before = [](const Entry<D>& a, const Entry<D>& b) {
        return a.id != b.id ? a.id < b.id : a.image < b.image;
    };
    for (Entry<D>* next = begin; next != end; ++next) {  // lists are short: insertion
        const Entry<D> entry = *next;
        Entry<D>* place = next;
        for (; place != begin && before(entry, place[-1]); --place) *place = place[-1];
        *place = entry;
    }
}

/// Final places of the balls with lists, those at the border to other processes last: windows of the cell order
/// sorted by list length, longest first (a counting sort; lists too long for it share its last bin, which only costs
/// gaps). Also how many balls at the front certainly have no copies in their lists, a multiple of kWindow (or all).
template <int D>
std::pair<std::vector<std::uint32_t>, std::size_t> window_order(const std::vector<BlockLists<D>>& blocks,
                                                                const std::vector<std::uint8_t>& at_border) {
    constexpr std::uint32_t kBins = 64;
    const std::size_t count = at_border.size();
    std::vector<std::uint32_t> sequence;
    sequence.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i)
        if (at_border[i] == 0) sequence.push_back(i);
    const std::size_t interior = sequence.size();
    for (std::uint32_t i = 0; interior < count && i < count; ++i)
        if (at_border[i] != 0) sequence.push_back(i);

    std::vector<std::uint32_t> order(count);
    parallel_blocks(count, kBlock, [&](std::size_t begin, std::size_t end) {
        const auto bin = [&](std::size_t n) {
            const std::uint32_t i = sequence[n];
            return kBins - 1 - std::min(blocks[i / kBlock].length[i % kBlock], kBins - 1);
        };
        for (std::size_t w = begin; w < end; w += kWindow) {
            const std::size_t window_end = std::min(end, w + kWindow);
            std::array<std::size_t, kBins + 1> place{};
            for (std::size_t n = w; n < window_end; ++n) ++place[bin(n) + 1];
            std::partial_sum(place.begin(), place.end(), place.begin());
            for (std::size_t n = w; n < window_end; ++n) order[w + place[bin(n)]++] = sequence[n];
        }
    });
    return {std::move(order), interior == count ? padded(count) : interior / kWindow * kWindow};
}

template <int D>
void fill(const std::vector<BlockLists<D>>& blocks,
          const std::vector<std::uint32_t>& order,
          const std::vector<std::uint32_t>& place,
          bool images,
          NeighborList<D>& list) {
    const std::size_t count = order.size();
    std::vector<std::uint32_t> first(count);  // of each ball's entries within its block
    parallel_blocks(count, kBlock, [&](std::size_t begin, std::size_t end) {
        std::uint32_t at = 0;
        for (std::size_t i = begin; i < end; ++i) {
            first[i] = at;
            at += blocks[begin / kBlock].length[i - begin];
        }
    });

    const std::size_t groups = padded(count) / kLanes;
    const auto length_of = [&](std::size_t i) {
        return i < count ? blocks[order[i] / kBlock].length[order[i] % kBlock] : 0U;
    };
    list.group_start.assign(groups + 1, 0);
    parallel_for(groups, [&](std::size_t g) {
        std::uint32_t longest = 0;
        for (std::size_t lane = 0; lane < kLanes; ++lane) longest = std::max(longest, length_of(g * kLanes + lane));
        list.group_start[g + 1] = longest * kLanes;
    });
    std::partial_sum(list.group_start.begin(), list.group_start.end(), list.group_start.begin());

    const auto nobody = static_cast<std::uint32_t>(count);
    list.index.resize(list.group_start.back());
    list.by_image = images;
    for (auto& column : list.image) column.assign(images ? list.index.size() : 0, 0.0);
    parallel_blocks(groups, kBlock / kLanes, [&](std::size_t begin, std::size_t end) {
        std::fill(list.index.begin() + static_cast<std::ptrdiff_t>(list.group_start[begin]),
                  list.index.begin() + static_cast<std::ptrdiff_t>(list.group_start[end]), nobody);
        for (std::size_t i = begin * kLanes; i < std::min(count, end * kLanes); ++i) {
            const BlockLists<D>& lists = blocks[order[i] / kBlock];
            std::size_t entry = first[order[i]];
            std::size_t at = list.group_start[i / kLanes] + i % kLanes;
            for (std::uint32_t n = length_of(i); n-- > 0; ++entry, at += kLanes) {
                list.index[at] = place[lists.index[entry]];
                if (!images) continue;
                for (std::size_t k = 0; k < D; ++k) list.image[k][at] = lists.image[entry][k];
            }
        }
    });
}

/// Narrows the frame to where the balls are, and moves them into it.
template <int D>
std::array<Column, D> narrow(SearchFrame<D>& frame,
                             std::array<const double*, D> position,
                             std::size_t count,
                             double reach) {
    std::array<Column, D> placed;
    for (std::size_t k = 0; k < D; ++k) {
        const Window window = window_of(position[k], count, frame.box.lengths[k], frame.box.periodic[k], reach);
        if (!window.whole) frame.narrow(k, window.origin, window.length);
        placed[k].resize(count);
        parallel_for(count, [&](std::size_t i) { placed[k][i] = frame.place(k, position[k][i]); });
    }
    return placed;
}

}  // namespace

template <int D>
NeighborSearch<D> find_neighbors(const PeriodicBox<D>& box,
                                 std::array<const double*, D> position,
                                 const double* radius,
                                 const std::int64_t* id,
                                 std::size_t count,
                                 double skin,
                                 const Copies& copies) {
    const std::size_t owned = count - copies.count;
    const double largest = parallel_max(count, copies.largest_radius, [&](std::size_t i) { return radius[i]; });
    const double mean = parallel_sum(count, [&](std::size_t i) { return radius[i]; }) /
                        static_cast<double>(std::max<std::size_t>(count, 1));
    bool images = false;
    for (std::size_t k = 0; k < D; ++k)
        images = images || (box.periodic[k] && box.lengths[k] <= 2.0 * (2.0 * largest + skin));

    SearchFrame<D> frame(box);
    std::array<Column, D> placed;
    if (copies.count > 0 && !images) {
        placed = narrow<D>(frame, position, count, 2.0 * largest + skin);
        for (std::size_t k = 0; k < D; ++k) position[k] = placed[k].data();
    }
    const CellGrid<D> grid(frame.box, position, count, 2.5 * mean);
    const auto cell_order = grid.order();
    SortedBalls<D> balls;
    for (auto& column : balls.position) column.resize(count + kLanes);  // the last group may be read past its end
    balls.radius.resize(count + kLanes);
    parallel_for(count, [&](std::size_t i) {
        for (std::size_t k = 0; k < D; ++k) balls.position[k][i] = position[k][cell_order[i]];
        balls.radius[i] = radius[cell_order[i]];
    });
    placed = {};

    std::vector<std::uint32_t> subjects;
    subjects.reserve(owned);
    for (std::uint32_t i = 0; i < count; ++i)
        if (cell_order[i] < owned) subjects.push_back(i);
    const Search<D> search(frame.box, grid, balls, skin, images);
    std::vector<BlockLists<D>> blocks((owned + kBlock - 1) / kBlock);
    std::vector<std::uint8_t> at_border(owned, 0);
    parallel_blocks(owned, kBlock, [&](std::size_t begin, std::size_t end) {
        BlockLists<D>& lists = blocks[begin / kBlock];
        lists.length.resize(end - begin);
        lists.index.reserve((end - begin) * (D == 2 ? 7 : 14));
        std::vector<Entry<D>> entries;  // of one ball
        for (std::size_t s = begin; s < end; ++s) {
            const std::size_t i = subjects[s];
            entries.clear();
            search.visit(i, balls.radius[i] + largest + skin, [&](std::size_t j, std::array<std::int8_t, D> image) {
                entries.push_back({id[cell_order[j]], static_cast<std::uint32_t>(j), image});
                if (cell_order[j] >= owned) at_border[s] = 1;
            });
            sort_by_id(entries.data(), entries.data() + entries.size());
            for (const Entry<D>& entry : entries) lists.index.push_back(entry.index);
            if (images)
                for (const Entry<D>& entry : entries) lists.image.push_back(entry.image);
            lists.length[s - begin] = static_cast<std::uint32_t>(entries.size());
        }
    });

    balls = {};

    NeighborSearch<D> result;
    const auto [order, interior] = window_order(blocks, at_border);
    result.list.interior_groups = interior / kLanes;
    std::vector<std::uint32_t> place(count);  // cell order -> final
    const std::size_t first_copy = padded(owned);
    parallel_for(count, [&](std::size_t i) {
        if (cell_order[i] >= owned) place[i] = static_cast<std::uint32_t>(first_copy + cell_order[i] - owned);
    });
    parallel_for(owned, [&](std::size_t n) { place[subjects[order[n]]] = static_cast<std::uint32_t>(n); });
    fill(blocks, order, place, images, result.list);
    result.order.resize(owned);
    parallel_for(owned, [&](std::size_t n) { result.order[n] = cell_order[subjects[order[n]]]; });
    return result;
}

template NeighborSearch<2> find_neighbors<2>(const PeriodicBox<2>&,
                                             std::array<const double*, 2>,
                                             const double*,
                                             const std::int64_t*,
                                             std::size_t,
                                             double,
                                             const Copies&);
template NeighborSearch<3> find_neighbors<3>(const PeriodicBox<3>&,
                                             std::array<const double*, 3>,
                                             const double*,
                                             const std::int64_t*,
                                             std::size_t,
                                             double,
                                             const Copies&);

}  // namespace lamella::spatial
