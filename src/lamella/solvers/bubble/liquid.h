#pragma once

#include <cstdint>
#include <vector>

#include "lamella/solvers/bubble/liquid_law.h"
#include "lamella/solvers/bubble/options.h"
#include "lamella/solvers/bubble/rates.h"

namespace lamella::bubble {

/// How the liquid and the walls turn the pushes of the contacts into velocities: LiquidLaw for every bubble, with
/// what the drag models need of the neighbors.
template <int D>
class Liquid {
public:
    Liquid(const Options& options, const Model& model, const spatial::PeriodicBox<D>& box);

    /// Completes rates.velocity, which holds the pushes. @param last_velocity  of the last accepted state; its copies
    /// are brought up to date
    /// @returns  largest relaxation rate of a wall contact
    /// @throws NumericalError  the linear system of pairwise drag does not converge
    double apply(const spatial::NeighborList<D>& neighbors,
                 const Stage<D>& stage,
                 Columns<D>& last_velocity,
                 Domain& domain,
                 Rates<D>& rates);

private:
    void find_contacts(const spatial::NeighborList<D>& neighbors, const Stage<D>& stage);
    void solve_pairwise(Domain& domain, std::size_t count, Columns<D>& velocity);

    Options options_;
    LiquidLaw<D> law_;

    std::vector<std::uint64_t> contact_start_;  // touching bubbles of each bubble, for the other drag models
    std::vector<std::uint32_t> contact_;
    Columns<D> right_side_, residual_, direction_, image_;  // of the conjugate gradients
};

}  // namespace lamella::bubble
