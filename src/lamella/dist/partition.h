#pragma once

#include "lamella/core/vec.h"
#include "lamella/dist/communicator.h"
#include "lamella/dist/part.h"
#include "lamella/spatial/periodic_box.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::dist {

/// A box cut into parts that hold points in given proportions, by recursive bisection: every cut shares out the points
/// of its piece across the piece's longest edge. Parts are boxes, so that their borders are short and a void costs its
/// owner nothing.
template <int D>
class Partition {
public:
    /// One part.
    explicit Partition(const spatial::PeriodicBox<D>& box) : Partition(box, 1) {}

    /// The points are those of all processes; the result is the same on all of them.
    /// @param position  D columns of `count` coordinates; on periodic axes any image will do
    /// @param weights  of the parts, above 0: a part gets its weight over the sum of all weights
    Partition(Communicator& processes,
              const spatial::PeriodicBox<D>& box,
              std::array<const double*, D> position,
              std::size_t count,
              std::span<const std::int64_t> weights);

    int parts() const { return parts_; }

    /// The part that a point belongs to. What lies beyond a wall belongs to the part at that wall.
    int owner(Vec<D> x) const {
        x = in_box(x);
        std::int32_t n = 0;
        while (nodes_[static_cast<std::size_t>(n)].axis >= 0) {
            const Node& node = nodes_[static_cast<std::size_t>(n)];
            n = x[static_cast<std::size_t>(node.axis)] < node.cut ? node.below : node.below + 1;
        }
        return nodes_[static_cast<std::size_t>(n)].first;
    }

    /// Calls visit(part), once each, for the parts that have a point (or an image of one) within `reach` of `center`.
    template <class Visit>
    void for_each_near(Vec<D> center, double reach, Visit&& visit) const {
        center = in_box(center);
        const double limit = reach * (1.0 + 1e-9);  // rounding must not lose a part
        visit_near(0, center, limit * limit, visit);
    }

    /// The place of one part: what can be asked of it alone needs no look at the others.
    Part<D> part(int n) const;

private:
    struct Node {
        Vec<D> low, high;
        int first = 0, parts = 1;  ///< parts first, first + 1, ... lie in it
        int axis = -1;             ///< of the cut; -1: a single part
        double cut = 0.0;
        std::int32_t below = 0;  ///< the half below the cut; the other is the next node
    };

    Partition(const spatial::PeriodicBox<D>& box, int parts);

    Vec<D> in_box(const Vec<D>& x) const { return first_image(box_, x); }

    /// Distance along an axis from x to the node, around the box where it is periodic.
    double distance(const Node& node, std::size_t k, double x) const {
        if (box_.periodic[k]) {
            if (x >= node.low[k] && x < node.high[k]) return 0.0;
            const double to_low = std::abs(x - node.low[k]);
            const double to_high = std::abs(x - node.high[k]);
            const double length = box_.lengths[k];
            return std::min(std::min(to_low, length - to_low), std::min(to_high, length - to_high));
        }
        if (x < node.low[k] && node.low[k] > 0.0) return node.low[k] - x;
        if (x > node.high[k] && node.high[k] < box_.lengths[k]) return x - node.high[k];
        return 0.0;
    }

    template <class Visit>
    void visit_near(std::int32_t n, const Vec<D>& x, double squared_limit, Visit& visit) const {
        const Node& node = nodes_[static_cast<std::size_t>(n)];
        double squared = 0.0;
        for (std::size_t k = 0; k < D; ++k) {
            const double d = distance(node, k, x[k]);
            squared += d * d;
        }
        if (squared > squared_limit) return;
        if (node.axis < 0) {
            visit(node.first);
            return;
        }
        visit_near(node.below, x, squared_limit, visit);
        visit_near(node.below + 1, x, squared_limit, visit);
    }

    void cut_level(Communicator& processes,
                   std::array<const double*, D> position,
                   std::span<const std::int64_t> weights,
                   std::vector<std::int32_t>& node_of_point,
                   const std::vector<std::int32_t>& open);

    spatial::PeriodicBox<D> box_;
    int parts_;
    std::vector<Node> nodes_;
};

}  // namespace lamella::dist
