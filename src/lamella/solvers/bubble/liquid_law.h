#pragma once

#include "lamella/solvers/bubble/options.h"
#include "lamella/spatial/periodic_box.h"

#include <cmath>

namespace lamella::bubble {

/// What the liquid and the walls do to one bubble (method sheet, 2.2 to 2.4): the prescribed flow, the push of a wall
/// and its drag.
///
/// At a wall at distance delta < R with inward normal n (delta is signed, so a center that crossed comes back):
///   v += (F_0/mu_0) (1 - delta/R) n,   and the tangential velocity relative to the wall is reduced by wall_drag.
/// Every wall that is touched scales once, before all normal pushes are added, so the axes need no order. (The
/// published code lets each axis also scale the pushes of the axes before it.)
template <int D>
struct LiquidLaw {
    FlowOptions flow_options;
    Drag drag = Drag::kBackground;
    double wall_drag = 0.0;
    double push_rate = 1.0;  ///< F_0/mu_0
    spatial::PeriodicBox<D> box;

    struct WallTouch {
        Vec<D> push;           ///< sum of n (1 - delta/R)
        double tangential[D];  ///< factor of each velocity component
        Vec<D> velocity;       ///< of the wall
    };

    static LiquidLaw from(const Options& options, double push_rate, const spatial::PeriodicBox<D>& box) {
        return {options.flow, options.drag, options.wall_drag, push_rate, box};
    }

    LAMELLA_HOST_DEVICE bool has_walls() const {
        bool walls = false;
        for (std::size_t k = 0; k < D; ++k) walls = walls || !box.periodic[k];
        return walls;
    }
    /// Nothing to do: background drag in a liquid at rest without walls.
    LAMELLA_HOST_DEVICE bool trivial() const {
        return !has_walls() && flow_options.kind == FlowKind::kNone && drag == Drag::kBackground;
    }

    /// 1 inside the region widened by the bubble's radius (per axis), falling to 0 over edge_width.
    LAMELLA_HOST_DEVICE double region_weight(const Vec<D>& x, double radius) const {
        double weight = 1.0;
        for (std::size_t k = 0; k < D; ++k) {
            const double low = flow_options.region_low[k] * box.lengths[k];
            const double high = flow_options.region_high[k] * box.lengths[k];
            double from_center = x[k] - 0.5 * (low + high);
            if (box.periodic[k]) from_center -= box.lengths[k] * std::nearbyint(from_center / box.lengths[k]);
            const double outside = std::fabs(from_center) - 0.5 * (high - low) - radius;
            if (outside <= 0.0) continue;
            if (outside >= flow_options.edge_width) return 0.0;
            const double s = 1.0 - outside / flow_options.edge_width;
            weight *= s * s * (3.0 - 2.0 * s);
        }
        return weight;
    }

    /// Prescribed velocity of the liquid for a bubble at x [length/time].
    LAMELLA_HOST_DEVICE Vec<D> flow(const Vec<D>& x, double radius) const {
        Vec<D> u;
        switch (flow_options.kind) {
            case FlowKind::kNone:
                break;
            case FlowKind::kShear:
                u[0] = flow_options.shear_rate * (x[1] - 0.5 * box.lengths[1]);
                break;
            case FlowKind::kRegion:
            case FlowKind::kUniform: {
                const double weight = flow_options.kind == FlowKind::kRegion ? region_weight(x, radius) : 1.0;
                for (std::size_t k = 0; k < D; ++k) u[k] = weight * flow_options.velocity[k];
            }
        }
        return u;
    }

    /// Whether a bubble takes the mean velocity of its neighbors (drag = "neighbor_lagged") instead of the flow.
    LAMELLA_HOST_DEVICE bool takes_mean_of_neighbors(const Vec<D>& x, double radius) const {
        if (drag != Drag::kNeighborLagged) return false;
        if (flow_options.kind == FlowKind::kUniform || flow_options.kind == FlowKind::kShear) return false;
        return flow_options.kind != FlowKind::kRegion || !(region_weight(x, radius) > 0.0);
    }

    LAMELLA_HOST_DEVICE WallTouch touch_walls(const Vec<D>& x, double radius) const {
        WallTouch touch;
        for (double& factor : touch.tangential) factor = 1.0;
        for (std::size_t k = 0; k < D; ++k) {
            if (box.periodic[k]) continue;
            for (int wall = 0; wall < 2; ++wall) {
                const double side = wall == 0 ? 1.0 : -1.0;  // inward normal of the lower and of the upper wall
                const double delta = wall == 0 ? x[k] : box.lengths[k] - x[k];
                if (delta >= radius) continue;
                touch.push[k] += side * (1.0 - delta / radius);
                for (std::size_t other = 0; other < D; ++other)
                    if (other != k) touch.tangential[other] *= 1.0 - wall_drag;
                // The walls across the gradient of a shear move with it.
                if (flow_options.kind == FlowKind::kShear && k == 1)
                    touch.velocity[0] = -side * 0.5 * flow_options.shear_rate * box.lengths[1];
            }
        }
        return touch;
    }

    LAMELLA_HOST_DEVICE Vec<D> reduce_tangential(const WallTouch& touch, Vec<D> v) const {
        for (std::size_t k = 0; k < D; ++k) v[k] = touch.velocity[k] + touch.tangential[k] * (v[k] - touch.velocity[k]);
        return v;
    }

    /// Velocity of a bubble that the contacts push with `v` in a liquid of velocity `u`.
    LAMELLA_HOST_DEVICE Vec<D> velocity(const WallTouch& touch, const Vec<D>& v, const Vec<D>& u) const {
        return reduce_tangential(touch, v + u) + push_rate * touch.push;
    }

    /// Relaxation rate of a bubble's wall contacts [1/time].
    LAMELLA_HOST_DEVICE double wall_rate(const WallTouch& touch, double radius) const {
        return norm(touch.push) > 0.0 ? push_rate / radius : 0.0;
    }
};

}  // namespace lamella::bubble
