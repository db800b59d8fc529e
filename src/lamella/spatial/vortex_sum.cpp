#include "lamella/spatial/vortex_sum.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/spatial/bvh.h"
#include "lamella/spatial/detail/vortex_gather.h"
#include "lamella/spatial/detail/vortex_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lamella::spatial {

namespace {

using detail::ClusterRule;
using detail::kTargetBlock;
using detail::PairLaw;
using detail::SourceColumns;
using detail::SourceRange;
using detail::SumColumns;
using detail::TargetBlock;

constexpr double kWidestSpread = 1e15;  // in units of delta: beyond it doubles cannot tell points delta apart
constexpr double kWidestSingle = 1e6;   // in units of delta: beyond it float runs out of exponents for K and K^(7/3)

bool finite(const Vec3& a) { return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]); }

void check_finite(std::span<const Vec3> values, const char* name) {
    const bool all = parallel_reduce(
                         values.size(), 1,
                         [&](std::size_t begin, std::size_t end) {
                             return std::all_of(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                                values.begin() + static_cast<std::ptrdiff_t>(end), finite)
                                        ? 1
                                        : 0;
                         },
                         [](int a, int b) { return a & b; }) != 0;
    if (all) return;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!finite(values[i]))
            throw InputError(fmt::format("vortex_sum: {}[{}] = ({}, {}, {}) is not finite", name, i, values[i][0],
                                         values[i][1], values[i][2]));
}

void check(std::span<const Vec3> targets,
           std::span<const Vec3> centers,
           std::span<const Vec3> strengths,
           const VortexSumOptions& options) {
    if (!(options.delta > 0.0) || !std::isfinite(options.delta))
        throw InputError(fmt::format("vortex_sum: delta = {} m: it must be above 0 and finite", options.delta));
    if (!(options.tolerance >= 1e-8 && options.tolerance <= 0.1))
        throw InputError(fmt::format("vortex_sum: tolerance = {} is outside [1e-8, 0.1]", options.tolerance));
    if (centers.size() != strengths.size())
        throw InputError(fmt::format("vortex_sum: {} centers but {} strengths", centers.size(), strengths.size()));
    if (std::max(targets.size(), centers.size()) > std::numeric_limits<std::uint32_t>::max() / 16)
        throw InputError(fmt::format("vortex_sum: {} points are too many", std::max(targets.size(), centers.size())));
    if (targets.data() != centers.data() || targets.size() != centers.size()) check_finite(targets, "targets");
    check_finite(centers, "centers");
    check_finite(strengths, "strengths");
}

Bounds enclosing(std::span<const Vec3> a, std::span<const Vec3> b) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Bounds box{{{kInfinity, kInfinity, kInfinity}}, {{-kInfinity, -kInfinity, -kInfinity}}};
    for (const std::span<const Vec3> points : {a, b})
        for (const Vec3& x : points)
            for (std::size_t k = 0; k < 3; ++k) {
                box.low[k] = std::min(box.low[k], x[k]);
                box.high[k] = std::max(box.high[k], x[k]);
            }
    return box;
}

/// Lengths in units of delta from the middle of all points, strengths in units of the largest component.
struct Scale {
    Vec3 middle;
    double delta, strength, spread;
};

Scale scale_of(std::span<const Vec3> targets,
               std::span<const Vec3> centers,
               std::span<const Vec3> strengths,
               double delta) {
    const Bounds box = enclosing(targets, centers);
    double strength = 0.0;
    for (const Vec3& g : strengths) strength = std::max({strength, std::abs(g[0]), std::abs(g[1]), std::abs(g[2])});
    double spread = 0.0;
    for (std::size_t k = 0; k < 3; ++k) spread = std::max(spread, (box.high[k] - box.low[k]) / delta);
    if (!(spread <= kWidestSpread))
        throw InputError(
            fmt::format("vortex_sum: delta = {} m is less than 1e-15 of the {} m over which the points spread", delta,
                        spread * delta));
    return {0.5 * (box.low + box.high), delta, strength, spread};
}

std::vector<Vec3> scaled_points(std::span<const Vec3> points, const Scale& scale) {
    std::vector<Vec3> scaled(points.size());
    parallel_for(points.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) scaled[i][k] = (points[i][k] - scale.middle[k]) / scale.delta;
    });
    return scaled;
}

std::vector<Vec3> scaled_strengths(std::span<const Vec3> strengths, const Scale& scale) {
    std::vector<Vec3> scaled(strengths.size());
    parallel_for(strengths.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) scaled[i][k] = strengths[i][k] / scale.strength;
    });
    return scaled;
}

SumColumns sum_directly(const std::vector<Vec3>& targets,
                        const std::vector<Vec3>& centers,
                        const std::vector<Vec3>& strengths,
                        const PairLaw& law) {
    SourceColumns sources;
    sources.resize(centers.size());
    parallel_for(centers.size(), [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) {
            sources.position[k][i] = centers[i][k];
            sources.strength[k][i] = strengths[i][k];
        }
    });
    const SourceRange all{0, static_cast<std::uint32_t>(centers.size())};
    SumColumns sums;
    const std::size_t components = law.with_potential ? 6 : 3;
    for (std::size_t k = 0; k < components; ++k) sums[k].resize(targets.size());
    parallel_blocks(targets.size(), kTargetBlock, [&](std::size_t begin, std::size_t end) {
        TargetBlock block;
        block.start(end - begin);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = begin; i < end; ++i) block.position[k][i - begin] = targets[i][k];
        add_pairs(law, block, sources, {&all, 1});
        for (std::size_t k = 0; k < components; ++k) std::copy_n(block.sum[k], block.count, &sums[k][begin]);
    });
    return sums;
}

SumColumns sum_on_device(Device device,
                         const std::vector<Vec3>& targets,
                         const std::vector<Vec3>& centers,
                         const std::vector<Vec3>& strengths,
                         const PairLaw& law) {
    std::vector<detail::GatherSource> sources(centers.size());
    for (std::size_t i = 0; i < sources.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            sources[i].x[k] = centers[i][k];
            sources[i].g[k] = strengths[i][k];
        }
    return device == Device::kCuda ? detail::gather_on_gpu(targets, sources, law)
                                   : detail::gather_on_twin(targets, sources, law);
}

/// The tree costs about as much per target as so many pairs, measured on spheres with delta of 1.5 spacings.
bool tree_is_faster(std::size_t targets, std::size_t sources, const ClusterRule& rule, bool single) {
    const double pairs = (single ? 350.0 : 250.0) * static_cast<double>(rule.order * rule.order);
    return static_cast<double>(std::min(targets, sources)) > pairs;
}

VortexField with_units(const SumColumns& sums, const Scale& scale, bool with_potential) {
    const std::size_t count = sums[0].size();
    const double potential_unit = scale.strength / (4.0 * std::numbers::pi * scale.delta);
    const double velocity_unit = potential_unit / scale.delta;
    VortexField field{std::vector<Vec3>(count), std::vector<Vec3>(with_potential ? count : 0)};
    parallel_for(count, [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) {
            field.velocity[i][k] = velocity_unit * sums[k][i];
            if (with_potential) field.potential[i][k] = potential_unit * sums[3 + k][i];
        }
    });
    return field;
}

}  // namespace

VortexField vortex_sum(std::span<const Vec3> targets,
                       std::span<const Vec3> centers,
                       std::span<const Vec3> strengths,
                       const VortexSumOptions& options,
                       bool with_potential) {
    check(targets, centers, strengths, options);
    const auto zero = [&] {
        return VortexField{std::vector<Vec3>(targets.size()), std::vector<Vec3>(with_potential ? targets.size() : 0)};
    };
    if (targets.empty() || centers.empty()) return zero();
    const Scale scale = scale_of(targets, centers, strengths, options.delta);
    if (scale.strength == 0.0) return zero();

    using Method = VortexSumOptions::Method;
    const bool single = options.precision == VortexSumOptions::Precision::kSingle && scale.spread <= kWidestSingle;
    const PairLaw law{options.kernel, with_potential, single};
    const ClusterRule rule = detail::cluster_rule(options.tolerance);
    const bool on_device = options.device != Device::kCpu && options.method != Method::kTree;
    const bool tree = options.method == Method::kTree || (!on_device && options.method == Method::kAuto &&
                                                          tree_is_faster(targets.size(), centers.size(), rule, single));
    const bool same = targets.data() == centers.data() && targets.size() == centers.size();
    const std::vector<Vec3> sources = scaled_points(centers, scale);
    const std::vector<Vec3> points = same ? std::vector<Vec3>{} : scaled_points(targets, scale);
    const std::vector<Vec3>& wanted = same ? sources : points;
    const std::vector<Vec3> weights = scaled_strengths(strengths, scale);
    if (on_device)
        return with_units(sum_on_device(options.device, wanted, sources, weights, law), scale, with_potential);
    const SumColumns sums = tree ? detail::sum_by_clusters(wanted, sources, weights, same, law, rule)
                                 : sum_directly(wanted, sources, weights, law);
    return with_units(sums, scale, with_potential);
}

}  // namespace lamella::spatial
