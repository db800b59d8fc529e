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
    : options_(options), push_rate_(model.push_rate), box_(box) {
    for (std::size_t k = 0; k < D; ++k) has_walls_ = has_walls_ || !box.periodic[k];
    trivial_ = !has_walls_ && options.flow.kind == FlowKind::kNone && options.drag == Drag::kBackground;
}

/// 1 inside the region widened by the bubble's radius (per axis), falling to 0 over edge_width.
template <int D>
double Liquid<D>::region_weight(const Vec<D>& x, double radius) const {
    double weight = 1.0;
    for (std::size_t k = 0; k < D; ++k) {
        const double low = options_.flow.region_low[k] * box_.lengths[k];
        const double high = options_.flow.region_high[k] * box_.lengths[k];
        double from_center = x[k] - 0.5 * (low + high);
        if (box_.periodic[k]) from_center -= box_.lengths[k] * std::nearbyint(from_center / box_.lengths[k]);
        const double outside = std::abs(from_center) - 0.5 * (high - low) - radius;
        if (outside <= 0.0) continue;
        if (outside >= options_.flow.edge_width) return 0.0;
        const double s = 1.0 - outside / options_.flow.edge_width;
        weight *= s * s * (3.0 - 2.0 * s);
    }
    return weight;
}

template <int D>
Vec<D> Liquid<D>::flow(const Vec<D>& x, double radius) const {
    Vec<D> u;
    const auto& f = options_.flow;
    switch (f.kind) {
        case FlowKind::kNone: break;
        case FlowKind::kShear: u[0] = f.shear_rate * (x[1] - 0.5 * box_.lengths[1]); break;
        case FlowKind::kRegion:
        case FlowKind::kUniform: {
            const double weight = f.kind == FlowKind::kRegion ? region_weight(x, radius) : 1.0;
            for (std::size_t k = 0; k < D; ++k) u[k] = weight * f.velocity[k];
        }
    }
    return u;
}

template <int D>
typename Liquid<D>::WallTouch Liquid<D>::touch_walls(const Vec<D>& x, double radius) const {
    WallTouch touch;
    touch.tangential.fill(1.0);
    for (std::size_t k = 0; k < D; ++k) {
        if (box_.periodic[k]) continue;
        for (const double side : {1.0, -1.0}) {  // inward normal of the lower and of the upper wall
            const double delta = side > 0.0 ? x[k] : box_.lengths[k] - x[k];
            if (delta >= radius) continue;
            touch.push[k] += side * (1.0 - delta / radius);
            for (std::size_t other = 0; other < D; ++other)
                if (other != k) touch.tangential[other] *= 1.0 - options_.wall_drag;
            // The walls across the gradient of a shear move with it.
            if (options_.flow.kind == FlowKind::kShear && k == 1)
                touch.velocity[0] = -side * 0.5 * options_.flow.shear_rate * box_.lengths[1];
        }
    }
    return touch;
}

template <int D>
void Liquid<D>::find_contacts(const spatial::NeighborList<D>& neighbors, const Stage<D>& stage) {
    const std::size_t length = neighbors.groups() * kLanes;
    const Vec<D> inverse = box_.inverse_lengths();
    const auto for_each_contact = [&](std::size_t i, auto&& found) {
        const std::size_t group = i / kLanes;
        for (std::uint64_t e = neighbors.group_start[group] + i % kLanes; e < neighbors.group_start[group + 1];
             e += kLanes) {
            const std::uint32_t j = neighbors.index[e];
            double squared = 0.0;
            for (std::size_t k = 0; k < D; ++k) {
                const double s = stage.position[k][i] - stage.position[k][j];
                const double image = neighbors.has_images() ? neighbors.image[k][e] : std::nearbyint(s * inverse[k]);
                squared += (s - box_.lengths[k] * image) * (s - box_.lengths[k] * image);
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
        for (auto& column : v) {
            Column* const one[] = {&column};
            domain.halo(one);
        }
        parallel_for(count, [&](std::size_t i) {
            Vec<D> sum = diagonal(i) * at<D>(v, i);
            for (std::uint64_t c = contact_start_[i]; c < contact_start_[i + 1]; ++c)
                sum -= ratio * at<D>(v, contact_[c]);
            put<D>(sum, i, result);
        });
    };
    const auto product = [&](const Columns<D>& a, const Columns<D>& b, bool preconditioned) {
        return exact_sum(count, [&](std::size_t i) {
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
                        const Columns<D>& last_velocity,
                        Domain& domain,
                        Rates<D>& rates) {
    if (trivial_) return 0.0;
    const std::size_t count = neighbors.groups() * kLanes;
    const bool pairwise = options_.drag == Drag::kPairwise;
    if (options_.drag != Drag::kBackground) find_contacts(neighbors, stage);

    const auto liquid_velocity = [&](std::size_t i, const Vec<D>& x) {
        const Vec<D> u = flow(x, stage.radius[i]);
        if (options_.drag != Drag::kNeighborLagged) return u;
        if (options_.flow.kind == FlowKind::kUniform || options_.flow.kind == FlowKind::kShear) return u;
        if (options_.flow.kind == FlowKind::kRegion && region_weight(x, stage.radius[i]) > 0.0) return u;
        Vec<D> mean;
        const std::uint64_t contacts = contact_start_[i + 1] - contact_start_[i];
        for (std::uint64_t c = contact_start_[i]; c < contact_start_[i + 1]; ++c)
            mean += at<D>(last_velocity, contact_[c]);
        return contacts > 0 ? mean / static_cast<double>(contacts) : mean;
    };
    const auto reduce_tangential = [&](const WallTouch& touch, Vec<D> v) {
        for (std::size_t k = 0; k < D; ++k)
            v[k] = touch.velocity[k] + touch.tangential[k] * (v[k] - touch.velocity[k]);
        return v;
    };

    if (pairwise) {
        // The system couples all velocities, so the pushes of the walls belong to its right-hand side.
        for (auto& column : right_side_) column.assign(count, 0.0);
        parallel_for(count, [&](std::size_t i) {
            if (stage.radius[i] == 0.0) return;
            const Vec<D> x = at<D>(stage.position, i);
            put<D>(at<D>(rates.velocity, i) + push_rate_ * touch_walls(x, stage.radius[i]).push + liquid_velocity(i, x),
                   i, right_side_);
        });
        parallel_for(count, [&](std::size_t i) { put<D>(at<D>(last_velocity, i), i, rates.velocity); });
        solve_pairwise(domain, count, rates.velocity);
    }
    parallel_for(count, [&](std::size_t i) {
        if (stage.radius[i] == 0.0) return put<D>(Vec<D>{}, i, rates.velocity);
        const Vec<D> x = at<D>(stage.position, i);
        const WallTouch touch = touch_walls(x, stage.radius[i]);
        Vec<D> v = at<D>(rates.velocity, i);
        if (pairwise) return put<D>(reduce_tangential(touch, v), i, rates.velocity);
        v = reduce_tangential(touch, v + liquid_velocity(i, x));
        put<D>(v + push_rate_ * touch.push, i, rates.velocity);
    });
    if (!has_walls_) return 0.0;
    return domain.largest(parallel_max(count, 0.0, [&](std::size_t i) {
        const bool touches = stage.radius[i] > 0.0 && norm(touch_walls(at<D>(stage.position, i), stage.radius[i]).push) > 0.0;
        return touches ? push_rate_ / stage.radius[i] : 0.0;
    }));
}

template class Liquid<2>;
template class Liquid<3>;

}  // namespace lamella::bubble
