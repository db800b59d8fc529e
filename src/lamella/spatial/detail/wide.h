#pragma once

#include "lamella/core/host_device.h"

#include <cmath>
#include <cstddef>

#if defined(__AVX512F__) || (defined(__AVX2__) && defined(__FMA__))
#include <immintrin.h>
#endif

// Vectors of one cache line (8 doubles, 16 floats) with the fused multiply-add and the reciprocal square root that
// sums over pairs live on. Unlike core/simd.h the last bit depends on the instruction set: AVX-512, AVX2 with FMA, or
// plain C++.
//
// Reciprocal square root: from an estimate y of 1/sqrt(q) the residual e = 1 - q y^2 gives
//     1/sqrt(q) = y (1 - e)^(-1/2) = y + y e (1/2 + 3/8 e + 5/16 e^2 + ...).

namespace lamella::spatial::detail {

#if defined(__AVX512F__)

struct WideDouble {
    using Scalar = double;
    static constexpr std::size_t kSize = 8;
    __m512d v;

    LAMELLA_ALWAYS_INLINE static WideDouble load(const double* p) { return {_mm512_loadu_pd(p)}; }
    LAMELLA_ALWAYS_INLINE static WideDouble all(double a) { return {_mm512_set1_pd(a)}; }
    LAMELLA_ALWAYS_INLINE friend WideDouble operator+(WideDouble a, WideDouble b) { return {_mm512_add_pd(a.v, b.v)}; }
    LAMELLA_ALWAYS_INLINE friend WideDouble operator-(WideDouble a, WideDouble b) { return {_mm512_sub_pd(a.v, b.v)}; }
    LAMELLA_ALWAYS_INLINE friend WideDouble operator*(WideDouble a, WideDouble b) { return {_mm512_mul_pd(a.v, b.v)}; }
};
/// a b + c, a b - c, c - a b, each rounded once.
LAMELLA_ALWAYS_INLINE WideDouble fma(WideDouble a, WideDouble b, WideDouble c) {
    return {_mm512_fmadd_pd(a.v, b.v, c.v)};
}
LAMELLA_ALWAYS_INLINE WideDouble fms(WideDouble a, WideDouble b, WideDouble c) {
    return {_mm512_fmsub_pd(a.v, b.v, c.v)};
}
LAMELLA_ALWAYS_INLINE WideDouble fnma(WideDouble a, WideDouble b, WideDouble c) {
    return {_mm512_fnmadd_pd(a.v, b.v, c.v)};
}

/// The estimate is good to 2^-14, so e < 2^-13 and the first term left out (35/128 e^4) is below 2^-53.
LAMELLA_ALWAYS_INLINE WideDouble inverse_square_root(WideDouble q) {
    const WideDouble y{_mm512_maskz_rsqrt14_pd(0xff, q.v)};
    const WideDouble e = fnma(q, y * y, WideDouble::all(1.0));
    const WideDouble series = fma(fma(WideDouble::all(0.3125), e, WideDouble::all(0.375)), e, WideDouble::all(0.5));
    return fma(y * e, series, y);
}
/// Adds the lanes to eight doubles.
LAMELLA_ALWAYS_INLINE void add_to(double* sum, WideDouble a) {
    _mm512_storeu_pd(sum, _mm512_add_pd(_mm512_loadu_pd(sum), a.v));
}

struct WideFloat {
    using Scalar = float;
    static constexpr std::size_t kSize = 16;
    __m512 v;

    LAMELLA_ALWAYS_INLINE static WideFloat load(const float* p) { return {_mm512_loadu_ps(p)}; }
    LAMELLA_ALWAYS_INLINE static WideFloat all(float a) { return {_mm512_set1_ps(a)}; }
    LAMELLA_ALWAYS_INLINE friend WideFloat operator+(WideFloat a, WideFloat b) { return {_mm512_add_ps(a.v, b.v)}; }
    LAMELLA_ALWAYS_INLINE friend WideFloat operator-(WideFloat a, WideFloat b) { return {_mm512_sub_ps(a.v, b.v)}; }
    LAMELLA_ALWAYS_INLINE friend WideFloat operator*(WideFloat a, WideFloat b) { return {_mm512_mul_ps(a.v, b.v)}; }
};
LAMELLA_ALWAYS_INLINE WideFloat fma(WideFloat a, WideFloat b, WideFloat c) { return {_mm512_fmadd_ps(a.v, b.v, c.v)}; }
LAMELLA_ALWAYS_INLINE WideFloat fms(WideFloat a, WideFloat b, WideFloat c) { return {_mm512_fmsub_ps(a.v, b.v, c.v)}; }
LAMELLA_ALWAYS_INLINE WideFloat fnma(WideFloat a, WideFloat b, WideFloat c) {
    return {_mm512_fnmadd_ps(a.v, b.v, c.v)};
}

LAMELLA_ALWAYS_INLINE WideFloat inverse_square_root(WideFloat q) {  // 3/8 e^2 < 2^-27
    const WideFloat y{_mm512_maskz_rsqrt14_ps(0xffff, q.v)};
    const WideFloat e = fnma(q, y * y, WideFloat::all(1.0F));
    return fma(y * e, WideFloat::all(0.5F), y);
}
/// Adds the lanes to sixteen doubles.
LAMELLA_ALWAYS_INLINE void add_to(double* sum, WideFloat a) {
    alignas(64) float lanes[16];
    _mm512_store_ps(lanes, a.v);
    add_to(sum, WideDouble{_mm512_cvtps_pd(_mm256_load_ps(lanes))});
    add_to(sum + 8, WideDouble{_mm512_cvtps_pd(_mm256_load_ps(lanes + 8))});
}

#elif defined(__AVX2__) && defined(__FMA__)

// Half a cache line at a time: 16 registers hold one such vector of every sum and still leave room to compute in.
struct WideDouble {
    using Scalar = double;
    static constexpr std::size_t kSize = 4;
    __m256d v;

    LAMELLA_ALWAYS_INLINE static WideDouble load(const double* p) { return {_mm256_loadu_pd(p)}; }
    LAMELLA_ALWAYS_INLINE static WideDouble all(double a) { return {_mm256_set1_pd(a)}; }
    LAMELLA_ALWAYS_INLINE friend WideDouble operator+(WideDouble a, WideDouble b) { return {_mm256_add_pd(a.v, b.v)}; }
    LAMELLA_ALWAYS_INLINE friend WideDouble operator-(WideDouble a, WideDouble b) { return {_mm256_sub_pd(a.v, b.v)}; }
    LAMELLA_ALWAYS_INLINE friend WideDouble operator*(WideDouble a, WideDouble b) { return {_mm256_mul_pd(a.v, b.v)}; }
};
LAMELLA_ALWAYS_INLINE WideDouble fma(WideDouble a, WideDouble b, WideDouble c) {
    return {_mm256_fmadd_pd(a.v, b.v, c.v)};
}
LAMELLA_ALWAYS_INLINE WideDouble fms(WideDouble a, WideDouble b, WideDouble c) {
    return {_mm256_fmsub_pd(a.v, b.v, c.v)};
}
LAMELLA_ALWAYS_INLINE WideDouble fnma(WideDouble a, WideDouble b, WideDouble c) {
    return {_mm256_fnmadd_pd(a.v, b.v, c.v)};
}

/// The float estimate is good to 1.5 * 2^-12; one Newton step takes e to 2^-21, two terms of the series to 2^-60. Needs
/// q within the range of float.
LAMELLA_ALWAYS_INLINE WideDouble inverse_square_root(WideDouble q) {
    WideDouble y{_mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(q.v)))};
    const WideDouble half = WideDouble::all(0.5);
    const WideDouble rough = fnma(q, y * y, WideDouble::all(1.0));
    y = fma(y * rough, half, y);
    const WideDouble e = fnma(q, y * y, WideDouble::all(1.0));
    return fma(y * e, fma(WideDouble::all(0.375), e, half), y);
}
LAMELLA_ALWAYS_INLINE void add_to(double* sum, WideDouble a) {
    _mm256_storeu_pd(sum, _mm256_add_pd(_mm256_loadu_pd(sum), a.v));
}

struct WideFloat {
    using Scalar = float;
    static constexpr std::size_t kSize = 8;
    __m256 v;

    LAMELLA_ALWAYS_INLINE static WideFloat load(const float* p) { return {_mm256_loadu_ps(p)}; }
    LAMELLA_ALWAYS_INLINE static WideFloat all(float a) { return {_mm256_set1_ps(a)}; }
    LAMELLA_ALWAYS_INLINE friend WideFloat operator+(WideFloat a, WideFloat b) { return {_mm256_add_ps(a.v, b.v)}; }
    LAMELLA_ALWAYS_INLINE friend WideFloat operator-(WideFloat a, WideFloat b) { return {_mm256_sub_ps(a.v, b.v)}; }
    LAMELLA_ALWAYS_INLINE friend WideFloat operator*(WideFloat a, WideFloat b) { return {_mm256_mul_ps(a.v, b.v)}; }
};
LAMELLA_ALWAYS_INLINE WideFloat fma(WideFloat a, WideFloat b, WideFloat c) { return {_mm256_fmadd_ps(a.v, b.v, c.v)}; }
LAMELLA_ALWAYS_INLINE WideFloat fms(WideFloat a, WideFloat b, WideFloat c) { return {_mm256_fmsub_ps(a.v, b.v, c.v)}; }
LAMELLA_ALWAYS_INLINE WideFloat fnma(WideFloat a, WideFloat b, WideFloat c) {
    return {_mm256_fnmadd_ps(a.v, b.v, c.v)};
}

LAMELLA_ALWAYS_INLINE WideFloat inverse_square_root(WideFloat q) {  // 3/8 e^2 < 2^-22; see the tests for what it costs
    const WideFloat y{_mm256_rsqrt_ps(q.v)};
    const WideFloat e = fnma(q, y * y, WideFloat::all(1.0F));
    return fma(y * e, fma(WideFloat::all(0.375F), e, WideFloat::all(0.5F)), y);
}
LAMELLA_ALWAYS_INLINE void add_to(double* sum, WideFloat a) {
    add_to(sum, WideDouble{_mm256_cvtps_pd(_mm256_castps256_ps128(a.v))});
    add_to(sum + 4, WideDouble{_mm256_cvtps_pd(_mm256_extractf128_ps(a.v, 1))});
}

#else

/// Plain C++: loops that the compiler turns into whatever vectors the target has.
template <class T, std::size_t N>
struct PlainWide {
    using Scalar = T;
    static constexpr std::size_t kSize = N;
    T v[N];

    template <class F>
    LAMELLA_ALWAYS_INLINE static PlainWide each(F&& f) {
        PlainWide r;
        for (std::size_t i = 0; i < N; ++i) r.v[i] = f(i);
        return r;
    }
    LAMELLA_ALWAYS_INLINE static PlainWide load(const T* p) {
        return each([&](std::size_t i) { return p[i]; });
    }
    LAMELLA_ALWAYS_INLINE static PlainWide all(T a) {
        return each([&](std::size_t) { return a; });
    }
    LAMELLA_ALWAYS_INLINE friend PlainWide operator+(const PlainWide& a, const PlainWide& b) {
        return each([&](std::size_t i) { return a.v[i] + b.v[i]; });
    }
    LAMELLA_ALWAYS_INLINE friend PlainWide operator-(const PlainWide& a, const PlainWide& b) {
        return each([&](std::size_t i) { return a.v[i] - b.v[i]; });
    }
    LAMELLA_ALWAYS_INLINE friend PlainWide operator*(const PlainWide& a, const PlainWide& b) {
        return each([&](std::size_t i) { return a.v[i] * b.v[i]; });
    }
    LAMELLA_ALWAYS_INLINE friend PlainWide fma(const PlainWide& a, const PlainWide& b, const PlainWide& c) {
        return a * b + c;
    }
    LAMELLA_ALWAYS_INLINE friend PlainWide fms(const PlainWide& a, const PlainWide& b, const PlainWide& c) {
        return a * b - c;
    }
    LAMELLA_ALWAYS_INLINE friend PlainWide fnma(const PlainWide& a, const PlainWide& b, const PlainWide& c) {
        return c - a * b;
    }
    LAMELLA_ALWAYS_INLINE friend PlainWide inverse_square_root(const PlainWide& q) {
        return each([&](std::size_t i) { return T(1) / std::sqrt(q.v[i]); });
    }
    LAMELLA_ALWAYS_INLINE friend void add_to(double* sum, const PlainWide& a) {
        for (std::size_t i = 0; i < N; ++i) sum[i] += static_cast<double>(a.v[i]);
    }
};
using WideDouble = PlainWide<double, 2>;
using WideFloat = PlainWide<float, 4>;

#endif

}  // namespace lamella::spatial::detail
