#include "lamella/core/random.h"

#include "lamella/core/error.h"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

namespace lamella {

namespace {

constexpr std::uint64_t kStepLimit = std::uint64_t{1} << 40;
constexpr std::uint32_t kDrawLimit = 1U << 8;
constexpr std::uint32_t kStreamLimit = 1U << 16;

constexpr std::uint32_t low_word(std::uint64_t x) { return static_cast<std::uint32_t>(x & 0xffffffffU); }
constexpr std::uint32_t high_word(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }

}  // namespace

RandomBits random_bits(
    std::uint64_t seed, RandomStream stream, std::uint64_t step, std::uint64_t item, std::uint32_t draw) {
    const auto stream_number = static_cast<std::uint32_t>(stream);
    LAMELLA_ASSERT(step < kStepLimit);
    LAMELLA_ASSERT(draw < kDrawLimit);
    LAMELLA_ASSERT(stream_number < kStreamLimit);

    // 128 counter bits: item 64, step 40, draw 8, stream 16. Distinct arguments are distinct counters.
    const r123::Philox4x32::ctr_type counter = {
        {low_word(item), high_word(item), low_word(step), (high_word(step) << 24) | (draw << 16) | stream_number}};
    const r123::Philox4x32::key_type key = {{low_word(seed), high_word(seed)}};
    const auto words = r123::Philox4x32()(counter, key);
    return {{words[0], words[1], words[2], words[3]}};
}

template <>
Vec2 uniform_vector<2>(const RandomBits& bits) {
    return {{uniform01(bits, 0), uniform01(bits, 1)}};
}

template <>
Vec3 uniform_vector<3>(const RandomBits& bits) {
    // 42 bits each: the top of either half, and the 22 + 20 bits that those leave over.
    constexpr std::uint64_t kLowMask = (std::uint64_t{1} << 22) - 1;
    const std::uint64_t third = ((bits.half(0) & kLowMask) << 20) | ((bits.half(1) & kLowMask) >> 2);
    constexpr double kScale = 0x1.0p-42;
    return {{static_cast<double>(bits.half(0) >> 22) * kScale, static_cast<double>(bits.half(1) >> 22) * kScale,
             static_cast<double>(third) * kScale}};
}

Vec2 normal_pair(const RandomBits& bits) {
    const double positive = 1.0 - uniform01(bits, 0);  // in (0, 1]: the logarithm exists
    const double radius = std::sqrt(-2.0 * std::log(positive));
    const double angle = 2.0 * std::numbers::pi * uniform01(bits, 1);
    return {{radius * std::cos(angle), radius * std::sin(angle)}};
}

double normal(const RandomBits& bits) { return normal_pair(bits)[0]; }

double lognormal(const RandomBits& bits, double mean, double deviation) {
    const double relative = deviation / mean;
    const double log_variance = std::log1p(relative * relative);
    return mean * std::exp(std::sqrt(log_variance) * normal(bits) - 0.5 * log_variance);
}

template <>
Vec2 unit_vector<2>(const RandomBits& bits) {
    const double angle = 2.0 * std::numbers::pi * uniform01(bits, 0);
    return {{std::cos(angle), std::sin(angle)}};
}

template <>
Vec3 unit_vector<3>(const RandomBits& bits) {
    // Archimedes: the height of a uniform point on the sphere is uniform.
    const double height = 2.0 * uniform01(bits, 0) - 1.0;
    const double radius = std::sqrt(1.0 - height * height);
    const double angle = 2.0 * std::numbers::pi * uniform01(bits, 1);
    return {{radius * std::cos(angle), radius * std::sin(angle), height}};
}

}  // namespace lamella
