#pragma once

#include "lamella/core/host_device.h"
#include "lamella/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace lamella {

/// A sum whose bits do not depend on the order of its terms, and so not on threads, processes or storage order.
///
/// Each term is split into a high and a low integer of two fixed scales, and integers are added exactly:
///     term = high * 2^-s + low * 2^-(s + 31) + (a rest below 2^-(s + 31), dropped)
/// with s such that the sum of all |terms| <= `bound` stays below 2^60. The dropped rests are below
/// 2^-91 * bound per term. Holds up to 2^31 terms, and more where parts of that many are carried before they are added.
class FixedSum {
public:
    /// A sum of zeros.
    LAMELLA_HOST_DEVICE FixedSum() : FixedSum(0.0) {}
    /// @param bound  an upper bound of the sum of |terms|; twice as much is still safe
    LAMELLA_HOST_DEVICE explicit FixedSum(double bound) {
        // Below 2^-900 a scale would be infinite: such terms are dropped.
        const int exponent = bound > 0.0 && std::isfinite(bound) ? std::max(std::ilogb(bound), -900) : 0;
        high_scale_ = std::ldexp(1.0, 59 - exponent);
        high_unit_ = std::ldexp(1.0, exponent - 59);
    }

    LAMELLA_HOST_DEVICE void add(double term) {
        const double scaled = term * high_scale_;
        const auto high = static_cast<std::int64_t>(scaled);
        const double rest = scaled - static_cast<double>(high);
        high_ += high;
        low_ += static_cast<std::int64_t>(rest * kLowScale);
    }

    /// Adds `count` terms; the loop vectorizes.
    void add(const double* terms, std::size_t count) {
        std::int64_t high_sum = 0;
        std::int64_t low_sum = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double scaled = terms[i] * high_scale_;
            const auto high = static_cast<std::int64_t>(scaled);
            high_sum += high;
            low_sum += static_cast<std::int64_t>((scaled - static_cast<double>(high)) * kLowScale);
        }
        high_ += high_sum;
        low_ += low_sum;
    }

    /// Adds another sum of the same bound.
    LAMELLA_HOST_DEVICE FixedSum& operator+=(const FixedSum& other) {
        high_ += other.high_;
        low_ += other.low_;
        return *this;
    }

    /// The same sum with the low integer in [0, 2^31): parts that were carried add up however many terms they have.
    LAMELLA_HOST_DEVICE void carry() {
        const std::int64_t whole = low_ >> 31;
        high_ += whole;
        low_ -= whole * (std::int64_t{1} << 31);
    }

    LAMELLA_HOST_DEVICE double value() const {
        FixedSum one = *this;  // the same sum can be split in many ways; its value must not depend on that
        one.carry();
        return static_cast<double>(one.high_) * high_unit_ + static_cast<double>(one.low_) * (high_unit_ / kLowScale);
    }

    /// The two integers, for sums over processes and GPU threads.
    LAMELLA_HOST_DEVICE std::int64_t& high() { return high_; }
    LAMELLA_HOST_DEVICE std::int64_t& low() { return low_; }

private:
    static constexpr double kLowScale = 2147483648.0;  // 2^31
    std::int64_t high_ = 0;
    std::int64_t low_ = 0;
    double high_scale_ = 1.0;
    double high_unit_ = 1.0;
};

/// FixedSum of term(i) over [0, count), each block on its own thread; `bound` as in FixedSum.
template <class Term>
FixedSum fixed_sum(std::size_t count, double bound, Term&& term) {
    return parallel_reduce(
        count, FixedSum(bound),
        [&](std::size_t begin, std::size_t end) {
            FixedSum sum(bound);
            for (std::size_t i = begin; i < end; ++i) sum.add(term(i));
            return sum;
        },
        [](FixedSum a, const FixedSum& b) { return a += b; });
}

/// Terms that a FixedSum holds for certain.
inline constexpr double kMostTerms = 2147483648.0;  // 2^31

/// The same without a known bound: a first pass finds the largest |term|. The scale follows from that term alone, so
/// terms that are zero (vacant slots) change no bit; what is dropped is below 2^-60 of the largest term, per term.
template <class Term>
double exact_sum(std::size_t count, Term&& term) {
    const double largest = parallel_max(count, 0.0, [&](std::size_t i) { return std::abs(term(i)); });
    return fixed_sum(count, largest * kMostTerms, term).value();
}

}  // namespace lamella
