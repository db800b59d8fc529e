#include "lamella/dist/partition.h"

#include "lamella/core/parallel.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace lamella::dist {
namespace {

// A cut is sought by counting points in bins, then in the bins of that bin, and so on: after four rounds it is placed
// to 1 part in 2^24 of the piece's edge.
constexpr std::size_t kBins = 64;
constexpr int kRounds = 4;

/// The search for one cut.
struct Search {
    std::int32_t node;
    std::size_t axis;
    double low, high;         // the cut lies between
    std::int64_t below = 0;   // points of the node below `low`
    std::int64_t wanted = 0;  // points that should end up below the cut

    double edge(std::size_t bin) const {
        return bin == kBins ? high : low + (high - low) * (static_cast<double>(bin) / static_cast<double>(kBins));
    }
    /// kBins for what does not lie between low and high.
    std::size_t bin_of(double x) const {
        if (!(x >= low) || !(x < high)) return kBins;
        auto bin = static_cast<std::size_t>((x - low) / (high - low) * static_cast<double>(kBins));
        bin = std::min(bin, kBins - 1);
        while (bin > 0 && x < edge(bin)) --bin;
        while (bin + 1 < kBins && x >= edge(bin + 1)) ++bin;
        return bin;
    }
};

std::int64_t sum_of(std::span<const std::int64_t> weights) {
    return std::accumulate(weights.begin(), weights.end(), std::int64_t{0});
}

}  // namespace

template <int D>
Partition<D>::Partition(const spatial::PeriodicBox<D>& box, int parts) : box_(box), parts_(parts), nodes_(1) {
    nodes_[0].high = box.lengths;
    nodes_[0].parts = parts;
}

template <int D>
Partition<D>::Partition(Communicator& processes,
                        const spatial::PeriodicBox<D>& box,
                        std::array<const double*, D> position,
                        std::size_t count,
                        std::span<const std::int64_t> weights)
    : Partition(box, static_cast<int>(weights.size())) {
    std::vector<std::int32_t> node_of_point(count, 0);
    std::vector<std::int32_t> open{0};
    while (true) {
        std::erase_if(open, [&](std::int32_t n) { return nodes_[static_cast<std::size_t>(n)].parts == 1; });
        if (open.empty()) break;
        const std::size_t first_new = nodes_.size();
        cut_level(processes, position, weights, node_of_point, open);
        open.clear();
        for (std::size_t n = first_new; n < nodes_.size(); ++n) open.push_back(static_cast<std::int32_t>(n));
    }
}

/// Cuts every node in `open` once, into halves of its parts, and moves the points into the halves.
template <int D>
void Partition<D>::cut_level(Communicator& processes,
                             std::array<const double*, D> position,
                             std::span<const std::int64_t> weights,
                             std::vector<std::int32_t>& node_of_point,
                             const std::vector<std::int32_t>& open) {
    std::vector<Search> searches;
    std::vector<std::int32_t> search_of_node(nodes_.size(), -1);
    for (const std::int32_t n : open) {
        const Node& node = nodes_[static_cast<std::size_t>(n)];
        std::size_t axis = 0;
        for (std::size_t k = 1; k < D; ++k)
            if (node.high[k] - node.low[k] > node.high[axis] - node.low[axis]) axis = k;
        search_of_node[static_cast<std::size_t>(n)] = static_cast<std::int32_t>(searches.size());
        searches.push_back({n, axis, node.low[axis], node.high[axis]});
    }
    const auto coordinate = [&](std::size_t axis, std::size_t i) {
        Vec<D> x;
        for (std::size_t k = 0; k < D; ++k) x[k] = position[k][i];
        const double length = box_.lengths[axis];
        return std::clamp(in_box(x)[axis], 0.0, length * (1.0 - 1e-15));
    };

    for (int round = 0; round < kRounds; ++round) {
        using Counts = std::vector<std::int64_t>;
        Counts counts = parallel_reduce(
            node_of_point.size(), Counts(searches.size() * kBins),
            [&](std::size_t begin, std::size_t end) {
                Counts part(searches.size() * kBins);
                for (std::size_t i = begin; i < end; ++i) {
                    const std::int32_t s = search_of_node[static_cast<std::size_t>(node_of_point[i])];
                    if (s < 0) continue;
                    const Search& search = searches[static_cast<std::size_t>(s)];
                    const std::size_t bin = search.bin_of(coordinate(search.axis, i));
                    if (bin < kBins) ++part[static_cast<std::size_t>(s) * kBins + bin];
                }
                return part;
            },
            [](Counts a, const Counts& b) {
                for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
                return a;
            },
            std::max<std::size_t>(node_of_point.size() / 64 + 1, kParallelBlock));
        processes.sum(counts);
        for (std::size_t s = 0; s < searches.size(); ++s) {
            Search& search = searches[s];
            const std::int64_t* in_bin = &counts[s * kBins];
            if (round == 0) {
                std::int64_t all = 0;
                for (std::size_t b = 0; b < kBins; ++b) all += in_bin[b];
                const Node& node = nodes_[static_cast<std::size_t>(search.node)];
                const auto of_node =
                    weights.subspan(static_cast<std::size_t>(node.first), static_cast<std::size_t>(node.parts));
                const std::int64_t whole = sum_of(of_node);
                const std::int64_t below = sum_of(of_node.first(of_node.size() / 2));
                search.wanted = all / whole * below + all % whole * below / whole;
            }
            std::size_t bin = 0;
            while (bin + 1 < kBins && search.below + in_bin[bin] < search.wanted) search.below += in_bin[bin++];
            const double low = search.edge(bin);
            search.high = search.edge(bin + 1);
            search.low = low;
        }
    }

    for (const Search& search : searches) {
        const auto at = static_cast<std::int32_t>(nodes_.size());
        Node& node = nodes_[static_cast<std::size_t>(search.node)];
        node.axis = static_cast<int>(search.axis);
        node.cut = search.high;
        node.below = at;
        Node below = node;
        below.axis = -1;
        below.parts = node.parts / 2;
        below.high[search.axis] = node.cut;
        Node above = node;
        above.axis = -1;
        above.first = node.first + below.parts;
        above.parts = node.parts - below.parts;
        above.low[search.axis] = node.cut;
        nodes_.push_back(below);
        nodes_.push_back(above);
    }
    parallel_for(node_of_point.size(), [&](std::size_t i) {
        const Node& node = nodes_[static_cast<std::size_t>(node_of_point[i])];
        if (node.axis < 0) return;
        const auto axis = static_cast<std::size_t>(node.axis);
        node_of_point[i] = node.below + (coordinate(axis, i) < node.cut ? 0 : 1);
    });
}

template <int D>
Part<D> Partition<D>::part(int n) const {
    Part<D> part;
    part.box = box_;
    for (std::size_t k = 0; k < D; ++k) {
        part.from[k] = -std::numeric_limits<double>::infinity();
        part.to[k] = std::numeric_limits<double>::infinity();
    }
    const Node* node = &nodes_[0];
    while (node->axis >= 0) {
        const auto axis = static_cast<std::size_t>(node->axis);
        const Node* below = &nodes_[static_cast<std::size_t>(node->below)];
        const bool in_below = n < below->first + below->parts;
        (in_below ? part.to : part.from)[axis] = node->cut;
        node = in_below ? below : below + 1;
    }
    return part;
}

template class Partition<2>;
template class Partition<3>;

}  // namespace lamella::dist
