#pragma once

#include <numbers>

#include "lamella/core/simd.h"
#include "lamella/solvers/bubble/model.h"
#include "lamella/solvers/bubble/shape.h"
#include "lamella/spatial/periodic_box.h"

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

/// The symmetric matrix sum_j n n^T / S of a bubble's contacts, lower triangle.
template <int D, class Real>
struct StiffnessMatrix {
    static constexpr int kEntries = D * (D + 1) / 2;
    Real entry[kEntries] = {};

    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE void add(const Real (&unit)[D], const Real& weight) {
        int e = 0;
        for (int a = 0; a < D; ++a)
            for (int b = 0; b <= a; ++b) entry[e++] += weight * unit[a] * unit[b];
    }

    /// Exact in 2D; in 3D the largest row sum of absolute values, an upper bound.
    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real largest_eigenvalue() const {
        if constexpr (D == 2) {
            const Real mean = 0.5 * (entry[0] + entry[2]);
            const Real half = 0.5 * (entry[0] - entry[2]);
            return mean + square_root(half * half + entry[1] * entry[1]);
        } else {
            const Real xy = absolute(entry[1]);
            const Real xz = absolute(entry[3]);
            const Real yz = absolute(entry[4]);
            return larger(larger(entry[0] + xy + xz, entry[2] + xy + yz), entry[5] + xz + yz);
        }
    }
};

/// What the contacts of one bubble (or of eight) add up to; added in the order of the neighbors' ids.
template <int D, class Real, bool kGas, bool kStiffness>
struct ContactSums {
    Real velocity[D] = {};  ///< per F_0/mu_0
    Real film = 0.0;        ///< sum_j A_ij (1/R_j - 1/R_i)
    Real covered = 0.0;     ///< sum_j A_ij
    StiffnessMatrix<D, Real> matrix;

    /// @param separation  x_i - x_j, nearest image
    LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE void add(const Real (&separation)[D],
                                                       const Real& radius,
                                                       const Real& inverse_radius,
                                                       const Real& other_radius,
                                                       const Real& other_inverse_radius) {
        Real squared = 0.0;
        for (int k = 0; k < D; ++k) squared += separation[k] * separation[k];
        const auto touch = touching(squared, radius, other_radius);
        const Overlap<Real> overlap(squared, radius, other_radius);

        const Real factor = select(touch, push(overlap), Real(0.0));
        for (int k = 0; k < D; ++k) velocity[k] += factor * separation[k];
        if constexpr (kGas) {
            const Real area = select(touch, film_size<D>(squared, overlap, radius, other_radius), Real(0.0));
            film += area * (other_inverse_radius - inverse_radius);
            covered += area;
        }
        if constexpr (kStiffness) {
            Real unit[D];
            for (int k = 0; k < D; ++k) unit[k] = separation[k] * overlap.inverse_distance();
            matrix.add(unit, select(touch, overlap.inverse_sum(), Real(0.0)));
        }
    }
};

/// Surface that bubbles press against walls: a chord of 2 sqrt(R^2 - delta^2) or a disc of pi (R^2 - delta^2) per wall.
template <int D, class Real>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real wall_contact(const spatial::PeriodicBox<D>& box,
                                                            const Real (&position)[D],
                                                            const Real& radius) {
    Real blocked = 0.0;
    for (int k = 0; k < D; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        if (box.periodic[axis]) continue;
        for (int side = 0; side < 2; ++side) {
            const Real delta = side == 0 ? position[k] : box.lengths[axis] - position[k];
            const Real rest = larger(radius * radius - delta * delta, Real(0.0));
            blocked += D == 2 ? 2.0 * square_root(rest) : std::numbers::pi * rest;
        }
    }
    return blocked;
}

/// Weight w_i of a bubble's exchange through the liquid: its free surface A^f, or R A^f/A. The chords of strong
/// overlaps can add up to more than the surface: then none of it is free.
/// @param covered  sum of its films
template <int D, class Real>
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE Real medium_weight(const Model& model,
                                                             const spatial::PeriodicBox<D>& box,
                                                             const Real (&position)[D],
                                                             const Real& radius,
                                                             const Real& inverse_radius,
                                                             Real covered) {
    if (model.wall_blocks_gas) covered += wall_contact<D>(box, position, radius);
    Real weight = larger(Shape<D>::surface(radius) - covered, Real(0.0));
    if (model.medium_scaling == MediumScaling::kLsw) weight *= inverse_radius * (1.0 / Shape<D>::kSurface);
    return weight;
}

}  // namespace lamella::bubble
