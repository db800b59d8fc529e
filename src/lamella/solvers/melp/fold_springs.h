#pragma once

#include "lamella/solvers/melp/normal_motion.h"
#include "lamella/solvers/melp/pair_forces.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// What keeps single particles from leaving their film at folds, where other bubbles pull them harder than it does: a
/// spring between each particle that lies on other bubbles' film and the patch through its neighbors, which stands
/// above it by
///
///   h_i = sum_j w_ij (x_j - x_i) . n_i,   energy  k_i h_i^2 / 2,   k_i = 144 film tension a_i / reach^2
///
/// with weights w that the fit gives and the kernels' support radius as reach. Springs push and twist no film as a
/// whole, and shapes that a quadratic describes do not strain them. Without them single particles leave their film and
/// stretch it until it tears.
class FoldSprings {
public:
    /// A quarter of this takes two thirds of the solver's iterations, and the crowd of the tests stays more even with
    /// it; but caps at nine spacings to a radius meet at 122 degrees, and partitions are up to 2 % off.
    static constexpr double kStiffness = 144.0;

    /// It reads the problem, which has to outlive it.
    FoldSprings(const NormalProblem& problem, const Pairs& pairs);

    /// Of all springs on particle i, along its normal [N].
    double force(std::size_t i) const;

    /// No bubbles touch.
    bool none() const { return own_.empty(); }

    /// K v comes in two passes, K = sum_i k_i g_i g_i^T with g_i = grad h_i along the normals [N/m]: the strain per
    /// particle, k_i g_i . v, from what the neighbors lift of the patch, sum_j heights_k v_j over the entries k of
    /// particle i; and from that (K v)_i. Most particles of two bubbles strain no spring, have no heights and hang on
    /// none.
    bool strained(std::size_t i) const { return stiffness_[i] > 0.0; }
    const RawVector<float>& heights() const { return into_; }
    double strain(std::size_t i, double v, double lifted) const { return stiffness_[i] * (own_[i] * v + lifted); }
    double hold(std::size_t i, std::span<const double> strain) const {
        return held_[i] == 0 ? 0.0 : own_[i] * strain[i] + sum_of_products(same_, from_, strain, i);
    }
    /// K_ii [N/m]
    double diagonal(std::size_t i) const;

private:
    const Neighbors& same_;
    std::vector<double> stiffness_;   // k per particle; none: no bubbles touch [N/m]
    std::vector<double> force_;       // k_i h_i per particle [N]
    std::vector<double> own_;         // d h_i / d x_i, along the normal
    std::vector<std::uint8_t> held_;  // by a spring, its own or a neighbor's
    // Per entry of neighbors.same. Every iteration of the solver reads them: in single precision, alike in both rows.
    RawVector<float> into_;  // d h_i / d x_j
    RawVector<float> from_;  // d h_j / d x_i
};

}  // namespace lamella::melp
