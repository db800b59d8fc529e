#pragma once

#include "lamella/spatial/detail/cluster_tree.h"
#include "lamella/spatial/detail/pair_block.h"

#include <span>
#include <vector>

namespace lamella::spatial::detail {

/// The sums of TargetBlock for all targets: six columns, by target.
using SumColumns = std::array<Column, 6>;

/// What tolerance, precision and kernel ask for.
ClusterRule cluster_rule(double tolerance);

/// Velocity and potential by clusters: two clusters that are far apart act on each other through their proxies, which
/// are summed by the same pair kernels as the points themselves. See docs/theory/fast-sums.md.
///
/// @param targets, centers, strengths  in units of delta and of the largest strength
/// @param same                         the targets are the centers
SumColumns sum_by_clusters(const std::vector<Vec3>& targets,
                           const std::vector<Vec3>& centers,
                           const std::vector<Vec3>& strengths,
                           bool same,
                           const PairLaw& law,
                           const ClusterRule& rule);

}  // namespace lamella::spatial::detail
