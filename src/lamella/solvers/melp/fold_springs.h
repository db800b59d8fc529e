#pragma once

#include "lamella/solvers/melp/normal_motion.h"
#include "lamella/solvers/melp/pair_forces.h"

#include <cstddef>
#include <span>
#include <vector>

namespace lamella::melp {

/// What keeps single particles from leaving their film at folds, where other bubbles pull them harder than it does: a
/// spring between each particle that lies on other bubbles' film and the patch through its neighbors, which stands
/// above it by
///
///   h_i = sum_j w_ij (x_j - x_i) . n_i,   energy  k_i h_i^2 / 2,   k_i = 144 film tension a_i / support radius^2
///
/// with weights w that the fit gives. Springs push and twist no film as a whole, and shapes that a quadratic describes
/// do not strain them. Without them single particles leave their film and stretch it until it tears.
class FoldSprings {
public:
    /// It reads the problem, which has to outlive it.
    FoldSprings(const NormalProblem& problem, const Pairs& pairs);

    /// Of all springs on particle i, along its normal [N].
    double force(std::size_t i) const { return -product(force_, i); }

    /// K v in two passes, K = sum_i k_i grad h_i grad h_i^T with gradients along the normals [N/m]: k_i grad h_i . v
    /// per particle, and (K v)_i from that.
    std::vector<double> strain(std::span<const double> v) const;
    double product(std::span<const double> strain, std::size_t i) const;
    /// K_ii [N/m]
    double diagonal(std::size_t i) const;

private:
    const Neighbors& same_;
    std::vector<double> stiffness_;  // k per particle; none: no bubbles touch [N/m]
    std::vector<double> force_;      // k_i h_i per particle [N]
    std::vector<double> own_;        // d h_i / d x_i, along the normal
    // Per entry of neighbors.same. Every iteration of the solver reads them: in single precision, alike in both rows.
    std::vector<float> into_;  // d h_i / d x_j
    std::vector<float> from_;  // d h_j / d x_i
};

}  // namespace lamella::melp
