#include "lamella/spatial/vortex_sum.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/spatial/detail/pair_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lamella::spatial {

namespace {

using detail::kTargetBlock;
using detail::PairLaw;
using detail::SourceColumns;
using detail::SourceRange;
using detail::TargetBlock;

constexpr double kWidestSpread = 1e15;  // in units of delta: beyond it doubles cannot tell points delta apart
constexpr double kWidestSingle = 1e6;   // in units of delta: beyond it float runs out of exponents for K and K^(7/3)

bool finite(const Vec3& a) { return std::isfinite(a[0]) && std::isfinite(a[1]) && std::isfinite(a[2]); }

void check_finite(std::span<const Vec3> values, const char* name) {
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
    check_finite(targets, "targets");
    check_finite(centers, "centers");
    check_finite(strengths, "strengths");
}

struct Box {
    Vec3 low{{1.0, 1.0, 1.0}}, high{{-1.0, -1.0, -1.0}};
};

Box enclosing(std::span<const Vec3> a, std::span<const Vec3> b) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Box box{{{kInfinity, kInfinity, kInfinity}}, {{-kInfinity, -kInfinity, -kInfinity}}};
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

    double length(double x, std::size_t k) const { return (x - middle[k]) / delta; }
};

Scale scale_of(std::span<const Vec3> targets,
               std::span<const Vec3> centers,
               std::span<const Vec3> strengths,
               double delta) {
    const Box box = enclosing(targets, centers);
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

SourceColumns scaled_sources(std::span<const Vec3> centers, std::span<const Vec3> strengths, const Scale& scale) {
    SourceColumns sources;
    sources.resize(centers.size());
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < centers.size(); ++i) {
            sources.position[k][i] = scale.length(centers[i][k], k);
            sources.strength[k][i] = strengths[i][k] / scale.strength;
        }
    return sources;
}

/// Puts the sums of a block, with units, where they belong.
void store(const TargetBlock& block, std::size_t slot, std::size_t target, const Scale& scale, VortexField& field) {
    const double potential_unit = scale.strength / (4.0 * std::numbers::pi * scale.delta);
    const double velocity_unit = potential_unit / scale.delta;
    for (std::size_t k = 0; k < 3; ++k) field.velocity[target][k] = velocity_unit * block.sum[k][slot];
    if (field.potential.empty()) return;
    for (std::size_t k = 0; k < 3; ++k) field.potential[target][k] = potential_unit * block.sum[3 + k][slot];
}

void sum_directly(std::span<const Vec3> targets,
                  const SourceColumns& sources,
                  const PairLaw& law,
                  const Scale& scale,
                  VortexField& field) {
    const SourceRange all{0, static_cast<std::uint32_t>(sources.position[0].size())};
    parallel_blocks(targets.size(), kTargetBlock, [&](std::size_t begin, std::size_t end) {
        TargetBlock block;
        block.start(end - begin);
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = 0; k < 3; ++k) block.position[k][i - begin] = scale.length(targets[i][k], k);
        add_pairs(law, block, sources, {&all, 1});
        for (std::size_t i = begin; i < end; ++i) store(block, i - begin, i, scale, field);
    });
}

}  // namespace

VortexField vortex_sum(std::span<const Vec3> targets,
                       std::span<const Vec3> centers,
                       std::span<const Vec3> strengths,
                       const VortexSumOptions& options,
                       bool with_potential) {
    check(targets, centers, strengths, options);
    VortexField field{std::vector<Vec3>(targets.size()), std::vector<Vec3>(with_potential ? targets.size() : 0)};
    if (targets.empty() || centers.empty()) return field;
    const Scale scale = scale_of(targets, centers, strengths, options.delta);
    if (scale.strength == 0.0) return field;
    const bool single = options.precision == VortexSumOptions::Precision::kSingle && scale.spread <= kWidestSingle;
    const PairLaw law{options.kernel, with_potential, single};
    sum_directly(targets, scaled_sources(centers, strengths, scale), law, scale, field);
    return field;
}

}  // namespace lamella::spatial
