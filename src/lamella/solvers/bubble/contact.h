#pragma once

#include <numbers>

#include "lamella/core/simd.h"

// What happens between two bubbles, written once for one pair (double) and for eight (Simd).

namespace lamella::bubble {

/// Two bubbles at distance d with S = R_i + R_j. A bubble that was removed has radius 0 and touches nothing.
template <class Real>
struct Overlap {
    Real sum;                ///< S
    Real distance;           ///< d
    Real inverse_product;    ///< 1/(S d): one division serves every use

    /// @param squared  d^2
    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Overlap(const Real& squared, const Real& radius_i, const Real& radius_j)
        : sum(radius_i + radius_j),
          distance(square_root(larger(squared, Real(1e-300)))),
          inverse_product(Real(1.0) / larger(sum * distance, Real(1e-300))) {}

    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real depth() const { return sum - distance; }
    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real inverse_distance() const { return sum * inverse_product; }
    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real inverse_sum() const { return distance * inverse_product; }
};

/// True where the bubbles touch: d < S and both still exist.
template <class Real>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE auto touching(const Real& squared, const Real& radius_i, const Real& radius_j) {
    const Real sum = radius_i + radius_j;
    return squared < sum * sum && radius_i * radius_j > Real(0.0);
}

/// Factor c of the velocity c (x_i - x_j) that bubble i takes from touching bubble j, per F_0/mu_0:
///   v_ij = (F_0/mu_0) (1/d - 1/S) (x_i - x_j)      [Lankinen20, eq. 2.15]
/// Coincident centers have no direction: the separation, and so the velocity, is zero.
template <class Real>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real push(const Overlap<Real>& o) {
    return o.depth() * o.inverse_product;
}

/// Size of the film between touching bubbles: the chord of the lens (2D, length 2h) or its disc (3D, area pi h^2).
///   h^2 = R_s^2 - w^2/d^2,  w = (d^2 + R_s^2 - R_l^2)/2     R_s the smaller, R_l the larger radius
/// [Lankinen20, eq. 2.24 with its missing bracket]. Where the smaller center lies beyond the chord, d^2 <= R_l^2 -
/// R_s^2, the lens is as wide as the smaller bubble: h = R_s, which is continuous (the published code jumps).
/// Exactly symmetric in i and j, so that the two bubbles exchange the same gas.
template <int D, class Real>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real film_size(const Real& squared,
                                   const Overlap<Real>& o,
                                   const Real& radius_i,
                                   const Real& radius_j) {
    const Real small = smaller(radius_i, radius_j);
    const Real large = larger(radius_i, radius_j);
    const Real small_squared = small * small;
    const Real difference = large * large - small_squared;
    const Real offset = select(squared <= difference, Real(0.0),
                               Real(0.5) * (squared - difference) * o.inverse_distance());
    const Real half_chord_squared = larger(small_squared - offset * offset, Real(0.0));
    if constexpr (D == 2)
        return Real(2.0) * square_root(half_chord_squared);
    else
        return Real(std::numbers::pi) * half_chord_squared;
}

/// Potential of the contact force per sigma_0 <R_in>: U_ij = (S - d)^2 / (2 S), so that F = -grad U (eq. 2.13).
template <class Real>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real contact_energy(const Overlap<Real>& o) {
    return Real(0.5) * o.depth() * o.depth() * o.inverse_sum();
}

}  // namespace lamella::bubble
