#include "lamella/spatial/detail/vortex_tree.h"

#include "lamella/core/parallel.h"
#include "lamella/spatial/detail/chebyshev.h"

#include <algorithm>
#include <cmath>

namespace lamella::spatial::detail {

namespace {

/// For every target cluster, ranges of sources that act on it.
class Interactions {
public:
    void add(std::uint32_t target, SourceRange range) { found_.push_back({target, range}); }

    /// Sorts by target, keeping the order in which they were found.
    void finish(std::size_t clusters) {
        start_.assign(clusters + 1, 0);
        for (const auto& [target, range] : found_) ++start_[target + 1];
        for (std::size_t c = 0; c < clusters; ++c) start_[c + 1] += start_[c];
        ranges_.resize(found_.size());
        std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
        for (const auto& [target, range] : found_) ranges_[next[target]++] = range;
        found_ = {};
    }
    std::span<const SourceRange> of(std::size_t target) const {
        return {ranges_.data() + start_[target], start_[target + 1] - start_[target]};
    }

private:
    std::vector<std::pair<std::uint32_t, SourceRange>> found_;
    std::vector<std::uint32_t> start_;
    std::vector<SourceRange> ranges_;
};

class ClusterSum {
public:
    ClusterSum(const ClusterTree& targets, const ClusterTree& sources, const PairLaw& law, double opening)
        : target_tree_(targets),
          source_tree_(sources),
          targets_(targets.clusters()),
          sources_(sources.clusters()),
          law_(law),
          components_(law.with_potential ? 6 : 3),
          squared_opening_(opening * opening) {}

    SumColumns run(const std::vector<Vec3>& targets,
                   const std::vector<Vec3>& centers,
                   const std::vector<Vec3>& strengths) {
        gather_sources(centers, strengths);
        meet(0, 0);
        near_.finish(targets_.size());
        far_.finish(targets_.size());
        sum_at_proxies();
        carry_to_leaves();
        return sum_at_points(targets);
    }

private:
    std::uint32_t proxy_begin(const Cluster& c) const {
        return static_cast<std::uint32_t>(source_tree_.order().size()) + c.first_proxy;
    }

    /// Columns: the points in tree order, then the proxies of all clusters.
    void gather_sources(const std::vector<Vec3>& centers, const std::vector<Vec3>& strengths) {
        const std::vector<std::uint32_t>& order = source_tree_.order();
        columns_.resize(order.size() + source_tree_.proxy_count());
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < order.size(); ++i) {
                columns_.position[k][i] = centers[order[i]][k];
                columns_.strength[k][i] = strengths[order[i]][k];
            }
        for (std::size_t depth = source_tree_.levels().size(); depth-- > 0;) {
            const std::vector<std::uint32_t>& level = source_tree_.levels()[depth];
            parallel_blocks(level.size(), 4, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) gather_proxies(sources_[level[i]]);
            });
        }
    }

    void gather_proxies(const Cluster& c) {
        place_proxies(c, {&columns_.position[0][proxy_begin(c)], &columns_.position[1][proxy_begin(c)],
                          &columns_.position[2][proxy_begin(c)]});
        const std::array<double*, 3> to{&columns_.strength[0][proxy_begin(c)], &columns_.strength[1][proxy_begin(c)],
                                        &columns_.strength[2][proxy_begin(c)]};
        if (c.is_leaf()) return gather_points(c, to);
        for (const std::uint32_t child : {c.left, c.right}) {
            const Cluster& inner = sources_[child];
            const GridWeights weights(table_, c, inner);
            for (std::size_t k = 0; k < 3; ++k)
                carry_up(weights, c, inner, &columns_.strength[k][proxy_begin(inner)], to[k]);
        }
    }

    void gather_points(const Cluster& c, const std::array<double*, 3>& to) {
        for (std::uint32_t p = c.begin; p < c.end; ++p) {
            const Vec3 x{{columns_.position[0][p], columns_.position[1][p], columns_.position[2][p]}};
            const PointWeights weights(table_, c, x);
            for (std::size_t k = 0; k < 3; ++k) {
                double* out = to[k];
                for (std::size_t a = 0; a < c.proxies[0]; ++a)
                    for (std::size_t b = 0; b < c.proxies[1]; ++b, out += c.proxies[2]) {
                        const double scale = columns_.strength[k][p] * weights.w[0][a] * weights.w[1][b];
                        for (std::size_t d = 0; d < c.proxies[2]; ++d) out[d] += scale * weights.w[2][d];
                    }
            }
        }
    }

    void place_proxies(const Cluster& c, const std::array<double*, 3>& to) const {
        std::size_t i = 0;
        for (std::size_t a = 0; a < c.proxies[0]; ++a)
            for (std::size_t b = 0; b < c.proxies[1]; ++b)
                for (std::size_t d = 0; d < c.proxies[2]; ++d, ++i) {
                    to[0][i] = proxy_coordinate(table_, c, 0, a);
                    to[1][i] = proxy_coordinate(table_, c, 1, b);
                    to[2][i] = proxy_coordinate(table_, c, 2, d);
                }
    }

    bool far_apart(const Cluster& target, const Cluster& source) const {
        const double reach = target.radius + source.radius;
        return reach * reach < squared_opening_ * squared_norm(target.middle - source.middle);
    }

    void meet(std::uint32_t t, std::uint32_t s) {
        const Cluster &target = targets_[t], &source = sources_[s];
        if (far_apart(target, source)) {
            const bool by_proxies = source.count() > source.proxy_count();
            const SourceRange range =
                by_proxies ? SourceRange{proxy_begin(source),
                                         proxy_begin(source) + static_cast<std::uint32_t>(source.proxy_count())}
                           : SourceRange{source.begin, source.end};
            if (target.count() > target.proxy_count())
                far_.add(t, range);
            else
                add_to_leaves(t, range);
        } else if (target.is_leaf() && source.is_leaf()) {
            near_.add(t, {source.begin, source.end});
        } else if (source.is_leaf() || (!target.is_leaf() && target.radius > source.radius)) {
            meet(target.left, s);
            meet(target.right, s);
        } else {
            meet(t, source.left);
            meet(t, source.right);
        }
    }

    void add_to_leaves(std::uint32_t t, SourceRange range) {
        if (targets_[t].is_leaf()) return near_.add(t, range);
        add_to_leaves(targets_[t].left, range);
        add_to_leaves(targets_[t].right, range);
    }

    void sum_at_proxies() {
        for (std::size_t k = 0; k < components_; ++k) local_[k].assign(target_tree_.proxy_count(), 0.0);
        parallel_blocks(targets_.size(), 4, [&](std::size_t begin, std::size_t end) {
            std::array<std::vector<double>, 3> x;
            for (std::size_t t = begin; t < end; ++t) {
                const Cluster& c = targets_[t];
                if (far_.of(t).empty()) continue;
                for (auto& column : x) column.resize(c.proxy_count());
                place_proxies(c, {x[0].data(), x[1].data(), x[2].data()});
                sum_in_blocks(
                    c.proxy_count(), far_.of(t), [&](std::size_t k, std::size_t i) { return x[k][i]; },
                    [&](std::size_t k, std::size_t i, double sum) { local_[k][c.first_proxy + i] = sum; });
            }
        });
    }

    template <class Position, class Result>
    void sum_in_blocks(std::size_t count,
                       std::span<const SourceRange> ranges,
                       Position&& position,
                       Result&& result) const {
        TargetBlock block;
        for (std::size_t begin = 0; begin < count; begin += kTargetBlock) {
            block.start(std::min(kTargetBlock, count - begin));
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t i = 0; i < block.count; ++i) block.position[k][i] = position(k, begin + i);
            add_pairs(law_, block, columns_, ranges);
            for (std::size_t k = 0; k < components_; ++k)
                for (std::size_t i = 0; i < block.count; ++i) result(k, begin + i, block.sum[k][i]);
        }
    }

    void carry_to_leaves() {
        for (const std::vector<std::uint32_t>& level : target_tree_.levels())
            parallel_blocks(level.size(), 4, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    const Cluster& outer = targets_[level[i]];
                    if (outer.is_leaf()) continue;
                    for (const std::uint32_t child : {outer.left, outer.right}) {
                        const Cluster& inner = targets_[child];
                        const GridWeights weights(table_, outer, inner);
                        for (std::size_t k = 0; k < components_; ++k)
                            carry_down(weights, outer, inner, &local_[k][outer.first_proxy],
                                       &local_[k][inner.first_proxy]);
                    }
                }
            });
    }

    SumColumns sum_at_points(const std::vector<Vec3>& targets) const {
        SumColumns sums;
        for (std::size_t k = 0; k < components_; ++k) sums[k].resize(targets.size());
        const std::vector<std::uint32_t>& order = target_tree_.order();
        parallel_blocks(targets_.size(), 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) {
                const Cluster& c = targets_[t];
                if (!c.is_leaf()) continue;
                sum_in_blocks(
                    c.count(), near_.of(t),
                    [&](std::size_t k, std::size_t i) { return targets[order[c.begin + i]][k]; },
                    [&](std::size_t k, std::size_t i, double sum) { sums[k][order[c.begin + i]] = sum; });
                for (std::uint32_t p = c.begin; p < c.end; ++p) interpolate(c, targets[order[p]], order[p], sums);
            }
        });
        return sums;
    }

    void interpolate(const Cluster& c, const Vec3& x, std::uint32_t target, SumColumns& sums) const {
        const PointWeights weights(table_, c, x);
        for (std::size_t k = 0; k < components_; ++k) {
            const double* value = &local_[k][c.first_proxy];
            double total = 0.0;
            for (std::size_t a = 0; a < c.proxies[0]; ++a) {
                double plane = 0.0;
                for (std::size_t b = 0; b < c.proxies[1]; ++b, value += c.proxies[2]) {
                    double row = 0.0;
                    for (std::size_t d = 0; d < c.proxies[2]; ++d) row += weights.w[2][d] * value[d];
                    plane += weights.w[1][b] * row;
                }
                total += weights.w[0][a] * plane;
            }
            sums[k][target] += total;
        }
    }

    const ClusterTree &target_tree_, &source_tree_;
    const std::vector<Cluster>&targets_, &sources_;
    PairLaw law_;
    std::size_t components_;
    double squared_opening_;
    ChebyshevTable table_;
    SourceColumns columns_;
    Interactions near_, far_;
    std::array<Column, 6> local_;  // sums at the proxies of the target clusters
};

}  // namespace

/// One digit for each point. Largest errors of the velocity measured at this opening (a sphere and eight, 20,000 to
/// 400,000 points, delta of 1.5 spacings): 2e-2, 2e-3, 4e-4, 5e-5, 5e-6, 2e-7, 4e-8, 4e-9 with 2 ... 9 points along a
/// cube.
ClusterRule cluster_rule(double tolerance) {
    const double order = std::clamp(std::ceil(1.0 - std::log10(tolerance) - 1e-9), 2.0, 9.0);
    const auto n = static_cast<std::size_t>(order);
    return {.order = n, .opening = 0.65, .leaf_size = std::clamp<std::size_t>(n * n * n, 64, 256)};
}

SumColumns sum_by_clusters(const std::vector<Vec3>& targets,
                           const std::vector<Vec3>& centers,
                           const std::vector<Vec3>& strengths,
                           bool same,
                           const PairLaw& law,
                           const ClusterRule& rule) {
    const ClusterTree sources(centers, rule);
    if (same) return ClusterSum(sources, sources, law, rule.opening).run(targets, centers, strengths);
    const ClusterTree own(targets, rule);
    return ClusterSum(own, sources, law, rule.opening).run(targets, centers, strengths);
}

}  // namespace lamella::spatial::detail
