#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#ifndef __CUDACC__
#include <experimental/simd>
#if defined(__AVX512F__) && defined(__AVX512VL__)
#include <immintrin.h>
#endif
#endif

#include "lamella/core/host_device.h"

// Eight doubles that are computed with together, and the few functions that a kernel functor needs so that the same
// source line works on one double (tests, GPU) and on eight. Eight lanes on every instruction set: the order of
// operations, and with it every bit, does not depend on the machine.

namespace lamella {

inline constexpr std::size_t kLanes = 8;

LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE double select(bool condition, double yes, double no) {
    return condition ? yes : no;
}
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE double square_root(double a) { return std::sqrt(a); }
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE double larger(double a, double b) { return a > b ? a : b; }
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE double smaller(double a, double b) { return b < a ? b : a; }
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE double absolute(double a) { return std::fabs(a); }
/// Nearest whole number, ties to even.
LAMELLA_HOST_DEVICE LAMELLA_ALWAYS_INLINE double nearest(double a) { return std::nearbyint(a); }

#ifndef __CUDACC__  // nvcc cannot read <experimental/simd>, and a GPU has one bubble per thread anyway

namespace stdx = std::experimental;
using Simd = stdx::simd<double, stdx::simd_abi::deduce_t<double, kLanes>>;
static_assert(Simd::size() == kLanes);

LAMELLA_ALWAYS_INLINE Simd load_lanes(const double* p) {
    Simd v;
    v.copy_from(p, stdx::element_aligned);
    return v;
}
LAMELLA_ALWAYS_INLINE void store_lanes(const Simd& v, double* p) { v.copy_to(p, stdx::element_aligned); }
LAMELLA_ALWAYS_INLINE Simd gather_lanes(const double* p, const std::uint32_t* index) {
    return Simd([&](auto lane) { return p[index[lane]]; });
}

/// Of the first `count` lanes, 1 to 8, zeros in the others: the ends of rows. Compilers do not find the instructions
/// that some machines have for it, which take two thirds of the time.
#if defined(__AVX512F__) && defined(__AVX512VL__)
LAMELLA_ALWAYS_INLINE Simd load_some(const float* p, std::size_t count) {
    const auto mask = static_cast<__mmask8>((1U << count) - 1U);
    return Simd(_mm512_maskz_cvtps_pd(mask, _mm256_maskz_loadu_ps(mask, p)));
}
LAMELLA_ALWAYS_INLINE Simd load_some(const double* p, std::size_t count) {
    const auto mask = static_cast<__mmask8>((1U << count) - 1U);
    return Simd(_mm512_maskz_loadu_pd(mask, p));
}
LAMELLA_ALWAYS_INLINE Simd gather_some(const double* p, const std::uint32_t* index, std::size_t count) {
    constexpr int kBytes = sizeof(double);
    const auto mask = static_cast<__mmask8>((1U << count) - 1U);
    return Simd(_mm512_mask_i32gather_pd(_mm512_setzero_pd(), mask, _mm256_maskz_loadu_epi32(mask, index), p, kBytes));
}
/// Puts those of the first `count` values that are less than `limit` behind each other, and what `index` says of each;
/// all eight places of both may be written to. @returns how many there are
LAMELLA_ALWAYS_INLINE std::size_t pack_smaller(const Simd& value,
                                               double limit,
                                               const std::uint32_t* index,
                                               std::size_t count,
                                               double* packed_value,
                                               std::uint32_t* packed_index) {
    const auto mask = static_cast<__mmask8>((1U << count) - 1U);
    const auto a = static_cast<__m512d>(value);
    const __mmask8 smaller = _mm512_mask_cmp_pd_mask(mask, a, _mm512_set1_pd(limit), _CMP_LT_OQ);
    _mm512_storeu_pd(packed_value, _mm512_maskz_compress_pd(smaller, a));
    _mm256_storeu_epi32(packed_index, _mm256_maskz_compress_epi32(smaller, _mm256_maskz_loadu_epi32(mask, index)));
    return static_cast<std::size_t>(__builtin_popcount(smaller));
}
#else
template <class Value>
LAMELLA_ALWAYS_INLINE Simd load_some(const Value* p, std::size_t count) {
    return Simd([&](auto lane) { return lane < count ? double{p[lane]} : 0.0; });
}
LAMELLA_ALWAYS_INLINE Simd gather_some(const double* p, const std::uint32_t* index, std::size_t count) {
    return Simd([&](auto lane) { return lane < count ? p[index[lane]] : 0.0; });
}
LAMELLA_ALWAYS_INLINE std::size_t pack_smaller(const Simd& value,
                                               double limit,
                                               const std::uint32_t* index,
                                               std::size_t count,
                                               double* packed_value,
                                               std::uint32_t* packed_index) {
    std::size_t packed = 0;
    for (std::size_t lane = 0; lane < count; ++lane) {  // no branch: there is no order in it to guess
        packed_value[packed] = value[lane];
        packed_index[packed] = index[lane];
        packed += value[lane] < limit ? 1 : 0;
    }
    return packed;
}
#endif

/// Of all lanes, in an order that does not depend on the machine.
LAMELLA_ALWAYS_INLINE double sum_of_lanes(const Simd& a) {
    return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

LAMELLA_ALWAYS_INLINE Simd select(const Simd::mask_type& condition, const Simd& yes, const Simd& no) {
    Simd result = no;
    stdx::where(condition, result) = yes;
    return result;
}
#if defined(__AVX512F__) && defined(__AVX512VL__)
// Not stdx::sqrt(): g++ 12 warns that its own header reads something uninitialized there.
LAMELLA_ALWAYS_INLINE Simd square_root(const Simd& a) {
    return Simd(_mm512_maskz_sqrt_pd(0xff, static_cast<__m512d>(a)));
}
#else
LAMELLA_ALWAYS_INLINE Simd square_root(const Simd& a) { return stdx::sqrt(a); }
#endif
LAMELLA_ALWAYS_INLINE Simd larger(const Simd& a, const Simd& b) { return stdx::max(a, b); }
LAMELLA_ALWAYS_INLINE Simd smaller(const Simd& a, const Simd& b) { return stdx::min(a, b); }
LAMELLA_ALWAYS_INLINE Simd absolute(const Simd& a) { return stdx::abs(a); }
LAMELLA_ALWAYS_INLINE Simd nearest(const Simd& a) { return stdx::nearbyint(a); }

#endif

}  // namespace lamella
