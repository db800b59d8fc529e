#pragma once

#include "lamella/core/random.h"
#include "lamella/core/vec.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace lamella::render::detail {

/// The numbers in [0, 1) that one sample of one pixel uses.
///
/// The first few are spread evenly over the samples of a pixel (additive recurrences, shifted for each pixel, with
/// powers of the root of x^(d+1) = x + 1 as steps: the golden ratio's relatives in d dimensions); the others are
/// random.
class SampleNumbers {
public:
    SampleNumbers(const RandomBits& pixel, int sample) : sample_(sample) {
        std::uint64_t state = pixel.half(0);
        for (double& shift : shift_) shift = draw(&state);
        state_ = pixel.half(1) + 0x632BE59BD9B4E019U * static_cast<std::uint64_t>(sample);
    }

    /// Where in its pixel the ray starts.
    Vec2 place() const { return {{even(0, 0.7548776662466927), even(1, 0.5698402909980532)}}; }
    /// Four numbers for what the ray meets first.
    double lot(std::size_t k) const {  // k = 0 to 3
        constexpr std::array<double, 4> kStep{0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                              0.5385972572236101};
        return even(2 + k, kStep[k]);
    }
    double next() { return draw(&state_); }

private:
    static double draw(std::uint64_t* state) {  // splitmix64
        std::uint64_t z = (*state += 0x9E3779B97F4A7C15U);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
    }
    double even(std::size_t k, double step) const {
        const double x = shift_[k] + step * sample_;
        return x - std::floor(x);
    }

    std::array<double, 6> shift_;
    int sample_;
    std::uint64_t state_;
};

}  // namespace lamella::render::detail
