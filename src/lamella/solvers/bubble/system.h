#pragma once

#include "lamella/solvers/bubble/domain.h"
#include "lamella/solvers/bubble/foam.h"
#include "lamella/solvers/bubble/increment.h"
#include "lamella/solvers/bubble/liquid.h"
#include "lamella/solvers/bubble/model.h"
#include "lamella/solvers/bubble/options.h"
#include "lamella/solvers/bubble/ownership.h"
#include "lamella/solvers/bubble/rates.h"

#include <cstdint>
#include <vector>

namespace lamella::bubble {

/// While the first packing relaxes the liquid is at rest and walls do not rub.
enum class LiquidMotion { kAtRest, kAsGiven };

/// The foam with what is needed to evaluate its rates: constants, neighbor lists, the stage being evaluated.
///
/// When lists are rebuilt, and how bubbles are stored, changes no bit of the state: lists only ever hold more pairs
/// than touch, sums over a list go by id, sums over the foam are integers.
template <int D>
class System {
public:
    System(const Options& options, Domain& domain);

    Foam<D> foam;
    Model model;
    Stage<D> stage;
    Rates<D> rates;

    /// Columns of an integrator that must follow when bubbles are reordered; empty ones are not in use.
    std::vector<Column*> attached;
    /// Those of them that are earlier size rates: they must keep adding up to zero when bubbles vanish.
    std::vector<Column*> attached_size_rates;
    /// Columns of an integrator that hold nothing between its steps, nor when lists are built anew.
    std::vector<Column*> scratch;

    const spatial::NeighborList<D>& neighbors() const { return neighbors_; }
    Domain& domain() const { return *domain_; }
    Ownership<D>& ownership() { return ownership_; }
    std::size_t length() const { return spatial::padded(foam.slots); }

    /// Takes the box, its walls, and the liquid's motion for the evaluations to come. Call after changing the box.
    void prepare(LiquidMotion motion);

    /// Hands every bubble to the process that owns its place, and drops vanished ones; with one process, nothing.
    void distribute();

    /// Drops vanished bubbles, distributes and builds new neighbor lists for the current state. The lists stay valid
    /// while no bubble's |dx| + dR passes reach(), at least `least_reach`.
    void rebuild(double least_reach = 0.0);
    double reach() const { return 0.5 * skin_; }
    std::int64_t rebuilds() const { return rebuilds_; }

    /// Largest |dx| + dR of any bubble between the last rebuild and the current state.
    double expansion() const;

    /// Where lists hold images and a bubble has crossed the border of the box since they were built: builds them anew.
    void follow_images();

    /// Brings the copies' positions and sizes up to date: what a look at the neighbors of the current state needs.
    void refresh_copies();

    /// Lets go of the memory of the rates and of the integrator's scratch: evaluations and steps take it again.
    void release_scratch();

    /// stage = the current state.
    void stage_current();

    /// rates = the right-hand side at `stage`. @param also  as of contact_pass
    Evaluation evaluate(Gas gas, Stiffness stiffness, double* also = nullptr);

    /// foam.velocity and foam.size_rate from `rates` and the exchange of an evaluation of the current state.
    void keep_rates(const GasExchange& gas);

    double mean_radius() const;
    double total_size() const;

private:
    Vec<D> place(std::size_t i) const;
    std::vector<std::uint32_t> live_slots() const;
    std::vector<Column*> attached_in_use() const;
    spatial::NeighborSearch<D> search_neighbors(const std::vector<std::uint32_t>& kept, dist::Halo& halo);
    dist::Halo find_copies(const std::vector<std::uint32_t>& kept, double largest_radius) const;

    Options options_;
    Domain* domain_;
    Liquid<D> liquid_;
    spatial::NeighborList<D> neighbors_;
    Ownership<D> ownership_;
    Columns<D> built_position_;
    Column built_radius_;
    double skin_ = 0.0;
    std::int64_t rebuilds_ = 0;
};

/// Radius and inverse radius of a stage's size q; 0 where the bubble had vanished before the step.
template <int D>
void set_radius(const Model& model, double size, bool alive, double& radius, double& inverse_radius) {
    const StagedRadius<double> staged = staged_radius<D>(model, alive ? 1.0 : 0.0, size);
    radius = staged.radius;
    inverse_radius = staged.inverse;
}

}  // namespace lamella::bubble
