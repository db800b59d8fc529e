#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <experimental/simd>

#include "lamella/core/host_device.h"

// Eight doubles that are computed with together, and the few functions that a kernel functor needs so that the same
// source line works on one double (tests, GPU) and on eight. Eight lanes on every instruction set: the order of
// operations, and with it every bit, does not depend on the machine.

namespace lamella {

inline constexpr std::size_t kLanes = 8;

namespace stdx = std::experimental;
using Simd = stdx::simd<double, stdx::simd_abi::deduce_t<double, kLanes>>;
static_assert(Simd::size() == kLanes);

inline Simd load_lanes(const double* p) {
    Simd v;
    v.copy_from(p, stdx::element_aligned);
    return v;
}
inline void store_lanes(const Simd& v, double* p) { v.copy_to(p, stdx::element_aligned); }
inline Simd gather_lanes(const double* p, const std::uint32_t* index) {
    return Simd([&](auto lane) { return p[index[lane]]; });
}

LAMELLA_HOST_DEVICE inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
inline Simd select(const Simd::mask_type& condition, const Simd& yes, const Simd& no) {
    Simd result = no;
    stdx::where(condition, result) = yes;
    return result;
}

LAMELLA_HOST_DEVICE inline double square_root(double a) { return std::sqrt(a); }
inline Simd square_root(const Simd& a) { return stdx::sqrt(a); }

LAMELLA_HOST_DEVICE inline double larger(double a, double b) { return a > b ? a : b; }
inline Simd larger(const Simd& a, const Simd& b) { return stdx::max(a, b); }
LAMELLA_HOST_DEVICE inline double smaller(double a, double b) { return b < a ? b : a; }
inline Simd smaller(const Simd& a, const Simd& b) { return stdx::min(a, b); }

/// Nearest whole number, ties to even.
LAMELLA_HOST_DEVICE inline double nearest(double a) { return std::nearbyint(a); }
inline Simd nearest(const Simd& a) { return stdx::nearbyint(a); }

}  // namespace lamella
