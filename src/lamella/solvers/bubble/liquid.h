#pragma once

#include <cstdint>
#include <vector>

#include "lamella/solvers/bubble/options.h"
#include "lamella/solvers/bubble/rates.h"

namespace lamella::bubble {

/// How the liquid and the walls turn the pushes of the contacts into velocities: drag model, prescribed flow, wall
/// push and wall drag (method sheet, 2.2 to 2.4).
///
/// At a wall at distance delta < R with inward normal n (delta is signed, so a center that crossed comes back):
///   v += (F_0/mu_0) (1 - delta/R) n,   and the tangential velocity relative to the wall is reduced by wall_drag.
/// Every wall that is touched scales once, before all normal pushes are added, so the axes need no order. (The
/// published code lets each axis also scale the pushes of the axes before it.)
template <int D>
class Liquid {
public:
    Liquid(const Options& options, const Model& model, const spatial::PeriodicBox<D>& box);

    /// Nothing to do: background drag in a liquid at rest without walls.
    bool trivial() const { return trivial_; }

    /// Completes rates.velocity, which holds the pushes. @param last_velocity  of the last accepted state
    /// @returns  largest relaxation rate of a wall contact
    /// @throws NumericalError  the linear system of pairwise drag does not converge
    double apply(const spatial::NeighborList<D>& neighbors,
                 const Stage<D>& stage,
                 const Columns<D>& last_velocity,
                 Domain& domain,
                 Rates<D>& rates);

    /// Prescribed velocity of the liquid for a bubble at x [length/time].
    Vec<D> flow(const Vec<D>& x, double radius) const;

private:
    struct WallTouch {
        Vec<D> push;             ///< sum of n (1 - delta/R)
        std::array<double, D> tangential;  ///< factor of each velocity component
        Vec<D> velocity;         ///< of the wall
    };
    WallTouch touch_walls(const Vec<D>& x, double radius) const;
    double region_weight(const Vec<D>& x, double radius) const;
    void find_contacts(const spatial::NeighborList<D>& neighbors, const Stage<D>& stage);
    void solve_pairwise(Domain& domain, std::size_t count, Columns<D>& velocity);

    Options options_;
    double push_rate_;
    spatial::PeriodicBox<D> box_;
    bool has_walls_ = false;
    bool trivial_ = true;

    std::vector<std::uint64_t> contact_start_;  // touching bubbles of each bubble, for the other drag models
    std::vector<std::uint32_t> contact_;
    Columns<D> right_side_, residual_, direction_, image_;  // of the conjugate gradients
};

}  // namespace lamella::bubble
