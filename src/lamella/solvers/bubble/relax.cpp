#include "lamella/solvers/bubble/relax.h"

#include <algorithm>
#include <cmath>

#include "lamella/core/error.h"
#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/solvers/bubble/census.h"
#include "lamella/solvers/bubble/move.h"

namespace lamella::bubble {
namespace {

// The constants recommended in [Bitzek06].
constexpr int kDelay = 5;
constexpr double kGrow = 1.1;
constexpr double kShrink = 0.5;
constexpr double kMixing = 0.1;
constexpr double kMixingDecay = 0.99;
constexpr int kCheckInterval = 20;

template <int D>
double component_product(const Columns<D>& a, const Columns<D>& b, std::size_t i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < D; ++k) sum += a[k][i] * b[k][i];
    return sum;
}

template <int D>
class Fire {
public:
    Fire(System<D>& system, const Options& options) : system_(system), options_(options) {
        for (auto& column : velocity_) {
            column.assign(system.length(), 0.0);
            system.attached.push_back(&column);
        }
        evaluate(Stiffness::kBound);
        step_ = 0.1 * longest_step_;
    }
    ~Fire() { system_.attached.resize(system_.attached.size() - D); }

    void iterate() {
        const Columns<D>& force = system_.rates.velocity;
        const Products products = multiply(force);
        double keep = 0.0;  // v = keep v + turn F
        double turn = 0.0;
        if (products.power > 0.0) {
            keep = 1.0 - mixing_;
            turn = mixing_ * std::sqrt(products.velocities / products.forces);
            if (++downhill_ > kDelay) {
                step_ = std::min(kGrow * step_, longest_step_);
                mixing_ *= kMixingDecay;
            }
        } else {
            downhill_ = 0;
            step_ = std::max(kShrink * step_, 1e-3 * longest_step_);
            mixing_ = kMixing;
        }
        // No bubble moves further than a tenth of the mean radius in one iteration.
        const double farthest = 0.1 * options_.mean_radius / step_;
        parallel_for(system_.foam.slots, [&](std::size_t i) {
            double squared = 0.0;
            for (std::size_t k = 0; k < D; ++k) {
                velocity_[k][i] = keep * velocity_[k][i] + (turn + step_) * force[k][i];
                squared += velocity_[k][i] * velocity_[k][i];
            }
            const double shorten = squared > farthest * farthest ? farthest / std::sqrt(squared) : 1.0;
            std::int32_t crossings = 0;
            for (std::size_t k = 0; k < D; ++k) {
                velocity_[k][i] *= shorten;
                double& x = system_.foam.position[k][i];
                x += step_ * velocity_[k][i];
                if (system_.foam.box.periodic[k]) x = wrapped(x, system_.foam.box.lengths[k], crossings);
            }
        });
        system_.follow_images();
        if (system_.expansion() >= system_.reach()) system_.rebuild();
        // Anew now and then, but not with the lists: when those are built must not change the path.
        evaluate(++iterations_ % kCheckInterval == 0 ? Stiffness::kBound : Stiffness::kSkip);
    }

    /// Mean |F_i| over mean |F_ij|, 0 when the foam does not jam.
    double residual() const {
        const Census<D> census = take_census(system_, options_);
        const auto live = static_cast<double>(system_.foam.live);
        const double unit = options_.surface_tension * options_.mean_radius * options_.mean_radius;
        const bool walls = std::any_of(system_.foam.box.periodic.begin(), system_.foam.box.periodic.end(),
                                       [](bool periodic) { return !periodic; });
        if (!walls && census.total_energy / live < 1e-16 * unit) return 0.0;
        const double mean_force = system_.domain().exact_sum(system_.foam.slots, [&](std::size_t i) {
                                      return std::sqrt(component_product<D>(system_.rates.velocity,
                                                                            system_.rates.velocity, i));
                                  }) *
                                  options_.viscosity / live;
        if (mean_force == 0.0) return 0.0;
        // Bubbles that touch only walls have no contact force to compare with: use the scale of the forces instead.
        const double scale = std::max(census.mean_contact_force, 1e-6 * system_.model.energy_scale);
        return mean_force / scale;
    }

private:
    struct Products {
        double power = 0.0;       ///< sum F . v
        double forces = 0.0;      ///< sum F . F
        double velocities = 0.0;  ///< sum v . v
    };

    /// The three sums in two passes: one for their scales, one to add.
    Products multiply(const Columns<D>& force) const {
        const Domain& domain = system_.domain();
        const std::size_t count = system_.foam.slots;
        const auto largest = [](Products a, const Products& b) {
            return Products{0.0, std::max(a.forces, b.forces), std::max(a.velocities, b.velocities)};
        };
        const Products most_here = parallel_reduce(
            count, Products{},
            [&](std::size_t begin, std::size_t end) {
                Products most;
                for (std::size_t i = begin; i < end; ++i)
                    most = largest(most, {0.0, component_product<D>(force, force, i),
                                          component_product<D>(velocity_, velocity_, i)});
                return most;
            },
            largest);
        double most_anywhere[] = {most_here.forces, most_here.velocities};
        domain.largest(most_anywhere);
        const Products scale{0.0, most_anywhere[0], most_anywhere[1]};
        struct Sums {
            FixedSum power, forces, velocities;
        };
        const double most = domain.most_terms();
        const Sums none{FixedSum(most * std::sqrt(scale.forces * scale.velocities)),
                        FixedSum(most * scale.forces), FixedSum(most * scale.velocities)};
        const Sums sums = parallel_reduce(
            count, none,
            [&](std::size_t begin, std::size_t end) {
                Sums part = none;
                for (std::size_t i = begin; i < end; ++i) {
                    part.power.add(component_product<D>(force, velocity_, i));
                    part.forces.add(component_product<D>(force, force, i));
                    part.velocities.add(component_product<D>(velocity_, velocity_, i));
                }
                return part;
            },
            [](Sums a, const Sums& b) {
                a.power += b.power;
                a.forces += b.forces;
                a.velocities += b.velocities;
                return a;
            });
        FixedSum all[] = {sums.power, sums.forces, sums.velocities};
        domain.sum(all);
        return {all[0].value(), all[1].value(), all[2].value()};
    }

    void evaluate(Stiffness stiffness) {
        system_.stage_current();
        const Evaluation evaluation = system_.evaluate(Gas::kOff, stiffness);
        if (stiffness == Stiffness::kBound)
            longest_step_ = 1.0 / std::sqrt(std::max(evaluation.stiffness, 0.1 * system_.model.push_rate));
    }

    System<D>& system_;
    const Options& options_;
    Columns<D> velocity_;
    double step_ = 0.0;
    double longest_step_ = 0.0;
    double mixing_ = kMixing;
    int downhill_ = 0;
    int iterations_ = 0;
};

}  // namespace

template <int D>
Relaxation relax(System<D>& system, const Options& options, const sim::StartContext& context) {
    const auto working = system.ownership().working();
    Fire<D> fire(system, options);
    Relaxation result;
    double first = 0.0;
    for (;; ++result.iterations) {
        if (result.iterations % kCheckInterval == 0) {
            if (system.domain().largest(context.stop_requested() ? 1.0 : 0.0) > 0.0) throw Interrupted();
            result.residual = fire.residual();
            result.at_rest = result.residual < options.start.force_tolerance;
            first = std::max(first, result.residual);
            const double goal = std::log(first / options.start.force_tolerance);
            context.progress("relaxing", goal > 0.0 ? std::clamp(std::log(first / std::max(result.residual, 1e-300)) / goal,
                                                                 0.0, 1.0)
                                                    : 1.0);
            if (result.at_rest) break;
        }
        if (result.iterations >= options.start.max_iterations) break;
        fire.iterate();
    }
    return result;
}

template Relaxation relax<2>(System<2>&, const Options&, const sim::StartContext&);
template Relaxation relax<3>(System<3>&, const Options&, const sim::StartContext&);

}  // namespace lamella::bubble
