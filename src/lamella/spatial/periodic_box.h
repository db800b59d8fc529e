#pragma once

#include <array>

#include "lamella/core/host_device.h"
#include "lamella/core/vec.h"

namespace lamella::spatial {

/// A rectangular domain with its lower corner at the origin. Each axis is periodic, or has a wall at both ends.
template <int D>
struct PeriodicBox {
    Vec<D> lengths;
    std::array<bool, D> periodic{};

    /// 1/L on periodic axes and 0 on the others, so that separation - L * nearest(separation * inverse) is the
    /// nearest image on either kind.
    LAMELLA_HOST_DEVICE Vec<D> inverse_lengths() const {
        Vec<D> inverse;
        for (std::size_t k = 0; k < D; ++k) inverse[k] = periodic[k] ? 1.0 / lengths[k] : 0.0;
        return inverse;
    }
    LAMELLA_HOST_DEVICE double volume() const {
        double product = 1.0;
        for (std::size_t k = 0; k < D; ++k) product *= lengths[k];
        return product;
    }
    LAMELLA_HOST_DEVICE double shortest_edge() const {
        double shortest = lengths[0];
        for (std::size_t k = 1; k < D; ++k) shortest = lengths[k] < shortest ? lengths[k] : shortest;
        return shortest;
    }
};

}  // namespace lamella::spatial
