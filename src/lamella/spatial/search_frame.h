#pragma once

#include "lamella/core/host_device.h"
#include "lamella/core/vec.h"
#include "lamella/spatial/periodic_box.h"

#include <cmath>
#include <cstddef>

namespace lamella::spatial {

/// Where balls are sought: the whole box, or a window of it around the balls of one process. An axis that is a window
/// has ends like a wall, and what lies beyond them is too far to matter.
template <int D>
struct SearchFrame {
    PeriodicBox<D> box;  ///< of the frame
    Vec<D> origin;       ///< of the frame
    Vec<D> period;       ///< of the whole box on the axes that are a window around it; else 0

    explicit SearchFrame(const PeriodicBox<D>& whole) : box(whole) {}

    void narrow(std::size_t axis, double from, double length) {
        period[axis] = box.periodic[axis] ? box.lengths[axis] : 0.0;
        origin[axis] = from;
        box.lengths[axis] = length;
        box.periodic[axis] = false;
    }

    /// A coordinate as the frame sees it.
    LAMELLA_HOST_DEVICE double place(std::size_t axis, double x) const {
        x -= origin[axis];
        return period[axis] > 0.0 ? x - period[axis] * std::floor(x / period[axis]) : x;
    }
};

}  // namespace lamella::spatial
