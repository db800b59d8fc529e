#include "lamella/solvers/bubble/liquid.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/solvers/bubble/contact.h"

namespace lamella::bubble {
namespace {

template <int D>
Vec<D> at(const Columns<D>& columns, std::size_t i) {
    Vec<D> v;
    for (std::size_t k = 0; k < D; ++k) v[k] = columns[k][i];
    return v;
}

template <int D>
void put(const Vec<D>& v, std::size_t i, Columns<D>& columns) {
    for (std::size_t k = 0; k < D; ++k) columns[k][i] = v[k];
}

}  // namespace

template <int D>
Liquid<D>::Liquid(const Options& options, const Model& model, const spatial::PeriodicBox<D>& box)
    : options_(options), law_(LiquidLaw<D>::from(options, model.push_rate, box)) {}

template <int D>
void Liquid<D>::find_contacts(const spatial::NeighborList<D>& neighbors, const Stage<D>& stage) {
    const std::size_t length = neighbors.groups() * kLanes;
    const Vec<D> inverse = law_.box.inverse_lengths();
    const auto for_each_contact = [&](std::size_t i, auto&& found) {
        const std::size_t group = i / kLanes;
        for (std::uint64_t e = neighbors.group_start[group] + i % kLanes; e < neighbors.group_start[group + 1];
             e += kLanes) {
            const std::uint32_t j = neighbors.index[e];
            double squared = 0.0;
            for (std::size_t k = 0; k < D; ++k) {
                const double s = stage.position[k][i] - stage.position[k][j];
                const double image = neighbors.has_images() ? neighbors.image[k][e] : std::nearbyint(s * inverse[k]);
                squared += (s - law_.box.lengths[k] * image) * (s - law_.box.lengths[k] * image);
            }
            if (touching(squared, stage.radius[i], stage.radius[j])) found(j);
        }
    };
    contact_start_.assign(length + 1, 0);
    parallel_for(length, [&](std::size_t i) {
        for_each_contact(i, [&](std::uint32_t) { ++contact_start_[i + 1]; });
    });
    for (std::size_t i = 0; i < length; ++i) contact_start_[i + 1] += contact_start_[i];
    contact_.resize(contact_start_[length]);
    parallel_for(length, [&](std::size_t i) {
        std::uint64_t place = contact_start_[i];
        for_each_contact(i, [&](std::uint32_t j) { contact_[place++] = j; });
    });
}

/// (1 + r Z_i) v_i - r sum_j v_j = b_i with r = mu_b/mu_0 over touching bubbles j: conjugate gradients with the
/// diagonal as preconditioner, started from the velocity that stands in `velocity`; b in right_side_.
template <int D>
void Liquid<D>::solve_pairwise(Domain& domain, std::size_t count, Columns<D>& velocity) {
    constexpr double kTolerance = 1e-10;  // of the residual, relative to the right-hand side
    constexpr int kMostIterations = 2000;
    const double ratio = options_.pair_viscosity / options_.viscosity;
    for (auto* columns : {&residual_, &direction_, &image_})
        for (auto& column : *columns) column.assign(count, 0.0);
    const auto diagonal = [&](std::size_t i) {
        return 1.0 + ratio * static_cast<double>(contact_start_[i + 1] - contact_start_[i]);
    };
    const auto multiply = [&](Columns<D>& v, Columns<D>& result) {
        domain.refresh_all(v);
        parallel_for(count, [&](std::size_t i) {
            Vec<D> sum = diagonal(i) * at<D>(v, i);
            for (std::uint64_t c = contact_start_[i]; c < contact_start_[i + 1]; ++c)
                sum -= ratio * at<D>(v, contact_[c]);
            put<D>(sum, i, result);
        });
    };
    const auto product = [&](const Columns<D>& a, const Columns<D>& b, bool preconditioned) {
        return domain.exact_sum(count, [&](std::size_t i) {
            const double p = dot(at<D>(a, i), at<D>(b, i));
            return preconditioned ? p / diagonal(i) : p;
        });
    };

    multiply(velocity, image_);
    parallel_for(count, [&](std::size_t i) { put<D>(at<D>(right_side_, i) - at<D>(image_, i), i, residual_); });
    parallel_for(count, [&](std::size_t i) { put<D>(at<D>(residual_, i) / diagonal(i), i, direction_); });
    const double target = kTolerance * kTolerance * product(right_side_, right_side_, false);
    double rho = product(residual_, residual_, true);
    for (int iteration = 0; product(residual_, residual_, false) > target; ++iteration) {
        if (iteration == kMostIterations)
            throw NumericalError(fmt::format("pairwise drag: the linear system has not converged after {} iterations",
                                             kMostIterations));
        multiply(direction_, image_);
        const double alpha = rho / product(direction_, image_, false);
        parallel_for(count, [&](std::size_t i) {
            put<D>(at<D>(velocity, i) + alpha * at<D>(direction_, i), i, velocity);
            put<D>(at<D>(residual_, i) - alpha * at<D>(image_, i), i, residual_);
        });
        const double next = product(residual_, residual_, true);
        const double beta = next / rho;
        rho = next;
        parallel_for(count, [&](std::size_t i) {
            put<D>(at<D>(residual_, i) / diagonal(i) + beta * at<D>(direction_, i), i, direction_);
        });
    }
}

template <int D>
double Liquid<D>::apply(const spatial::NeighborList<D>& neighbors,
                        const Stage<D>& stage,
                        Columns<D>& last_velocity,
                        Domain& domain,
                        Rates<D>& rates) {
    if (law_.trivial()) return 0.0;
    const std::size_t count = neighbors.groups() * kLanes;
    const bool pairwise = options_.drag == Drag::kPairwise;
    if (options_.drag != Drag::kBackground) find_contacts(neighbors, stage);
    if (options_.drag == Drag::kNeighborLagged) domain.refresh_all(last_velocity);

    const auto liquid_velocity = [&](std::size_t i, const Vec<D>& x) {
        if (!law_.takes_mean_of_neighbors(x, stage.radius[i])) return law_.flow(x, stage.radius[i]);
        Vec<D> mean;
        const std::uint64_t contacts = contact_start_[i + 1] - contact_start_[i];
        for (std::uint64_t c = contact_start_[i]; c < contact_start_[i + 1]; ++c)
            mean += at<D>(last_velocity, contact_[c]);
        return contacts > 0 ? mean / static_cast<double>(contacts) : mean;
    };

    if (pairwise) {
        // The system couples all velocities, so the pushes of the walls belong to its right-hand side.
        for (auto& column : right_side_) column.assign(count, 0.0);
        parallel_for(count, [&](std::size_t i) {
            if (stage.radius[i] == 0.0) return;
            const Vec<D> x = at<D>(stage.position, i);
            const Vec<D> push = law_.touch_walls(x, stage.radius[i]).push;
            put<D>(at<D>(rates.velocity, i) + law_.push_rate * push + liquid_velocity(i, x), i, right_side_);
        });
        parallel_for(count, [&](std::size_t i) { put<D>(at<D>(last_velocity, i), i, rates.velocity); });
        solve_pairwise(domain, count, rates.velocity);
    }
    parallel_for(count, [&](std::size_t i) {
        if (stage.radius[i] == 0.0) return put<D>(Vec<D>{}, i, rates.velocity);
        const Vec<D> x = at<D>(stage.position, i);
        const auto touch = law_.touch_walls(x, stage.radius[i]);
        const Vec<D> v = at<D>(rates.velocity, i);
        put<D>(pairwise ? law_.reduce_tangential(touch, v) : law_.velocity(touch, v, liquid_velocity(i, x)), i,
               rates.velocity);
    });
    if (!law_.has_walls()) return 0.0;
    return domain.largest(parallel_max(count, 0.0, [&](std::size_t i) {
        if (!(stage.radius[i] > 0.0)) return 0.0;
        return law_.wall_rate(law_.touch_walls(at<D>(stage.position, i), stage.radius[i]), stage.radius[i]);
    }));
}

template class Liquid<2>;
template class Liquid<3>;

}  // namespace lamella::bubble
