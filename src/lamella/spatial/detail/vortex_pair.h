#pragma once

#include "lamella/core/host_device.h"
#include "lamella/spatial/vortex_sum.h"

namespace lamella::spatial::detail {

/// Sums of one vector of targets over sources: u[0..2], then A[0..2]. Lengths are in units of delta.
template <class Wide>
struct PairSums {
    Wide u[3], a[3];
};

/// Adds one source (x, y, z; gx, gy, gz) to the sums of the targets at (tx, ty, tz), all in units of delta:
/// with t = 1 / (r^2 + 1) and y = sqrt(t),
///   plummer  K = y^3                        psi = y
///   k2       K = y^3 (1 + 3 t)              psi = y + y^3
///   k3       K = y^3 (1 + 3/2 t + 15/2 t^2) psi = y + y^3 (1/2 + 3/2 t)
template <VortexKernel kernel, bool with_potential, class Wide>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE void add_pair(
    PairSums<Wide>& sums, Wide tx, Wide ty, Wide tz, Wide x, Wide y, Wide z, Wide gx, Wide gy, Wide gz) {
    using T = typename Wide::Scalar;
    const auto constant = [](double c) { return Wide::all(static_cast<T>(c)); };
    const Wide rx = tx - x, ry = ty - y, rz = tz - z;
    const Wide q = fma(rx, rx, fma(ry, ry, fma(rz, rz, constant(1.0))));
    const Wide inverse = inverse_square_root(q);
    const Wide t = inverse * inverse;
    const Wide cube = inverse * t;
    Wide k = cube, psi = inverse;
    if constexpr (kernel == VortexKernel::kK2) {
        k = cube * fma(constant(3.0), t, constant(1.0));
        psi = inverse + cube;
    } else if constexpr (kernel == VortexKernel::kK3) {
        k = cube * fma(t, fma(constant(7.5), t, constant(1.5)), constant(1.0));
        psi = fma(cube, fma(constant(1.5), t, constant(0.5)), inverse);
    }
    sums.u[0] = fma(k, fms(gy, rz, gz * ry), sums.u[0]);
    sums.u[1] = fma(k, fms(gz, rx, gx * rz), sums.u[1]);
    sums.u[2] = fma(k, fms(gx, ry, gy * rx), sums.u[2]);
    if constexpr (with_potential) {
        sums.a[0] = fma(psi, gx, sums.a[0]);
        sums.a[1] = fma(psi, gy, sums.a[1]);
        sums.a[2] = fma(psi, gz, sums.a[2]);
    }
}

}  // namespace lamella::spatial::detail
