#pragma once

#include "lamella/core/host_device.h"
#include "lamella/core/vec.h"
#include "lamella/spatial/periodic_box.h"

#include <cmath>
#include <cstddef>

namespace lamella::dist {

/// The image of a point that lies in the box, on periodic axes.
template <int D>
LAMELLA_HOST_DEVICE Vec<D> first_image(const spatial::PeriodicBox<D>& box, Vec<D> x) {
    for (std::size_t k = 0; k < D; ++k)
        if (box.periodic[k]) x[k] -= box.lengths[k] * std::floor(x[k] / box.lengths[k]);
    return x;
}

/// The place of one part of a Partition, in plain values: a GPU can ask it too.
template <int D>
struct Part {
    spatial::PeriodicBox<D> box;  ///< the whole
    Vec<D> from, to;              ///< the cuts around the part, the upper ones not in it; infinite where there is none

    /// Whether the part owns this place.
    LAMELLA_HOST_DEVICE bool holds(Vec<D> x) const {
        x = first_image(box, x);
        bool all = true;
        for (std::size_t k = 0; k < D; ++k) all = all && x[k] >= from[k] && x[k] < to[k];
        return all;
    }

    /// Whether all places within `reach` of `center`, which the part holds, are its own.
    LAMELLA_HOST_DEVICE bool holds_all_near(Vec<D> center, double reach) const {
        center = first_image(box, center);
        const double limit = reach * (1.0 + 1e-9);  // as in Partition::for_each_near
        bool all = true;
        for (std::size_t k = 0; k < D; ++k) {
            // Around a periodic box the part at its end has the one at its beginning for a neighbor.
            const bool cut = std::isfinite(from[k]) || std::isfinite(to[k]);
            const bool ends_low = std::isfinite(from[k]) || (cut && box.periodic[k]);
            const bool ends_high = std::isfinite(to[k]) || (cut && box.periodic[k]);
            if (ends_low && center[k] - low(k) <= limit) all = false;
            if (ends_high && high(k) - center[k] <= limit) all = false;
        }
        return all;
    }

    /// The part's ends on an axis.
    LAMELLA_HOST_DEVICE double low(std::size_t k) const { return std::isfinite(from[k]) ? from[k] : 0.0; }
    LAMELLA_HOST_DEVICE double high(std::size_t k) const { return std::isfinite(to[k]) ? to[k] : box.lengths[k]; }
};

}  // namespace lamella::dist
