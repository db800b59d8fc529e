#pragma once

#include "lamella/solvers/bubble/foam.h"
#include "lamella/solvers/bubble/model.h"

#include <cmath>
#include <cstdint>

// A foam to start from where there is neither a scene nor a minimizer: a jittered grid of bubbles.

namespace lamella::bubble {

struct FoamInPlace {
    /// Uniform in [0, 1): the middle of a multiplicative hash.
    static double uniform(std::uint64_t n) {
        n = (n ^ (n >> 31)) * 0x9E3779B97F4A7C15ULL;
        n = (n ^ (n >> 29)) * 0xBF58476D1CE4E5B9ULL;
        n ^= n >> 32;
        return static_cast<double>(n >> 11) * 0x1.0p-53;
    }

    template <int D>
    static Foam<D> make(const Options& o, std::uint64_t seed = 0) {
        const std::uint64_t first = seed << 40;
        const auto per_axis = static_cast<std::size_t>(std::lround(std::ceil(std::pow(o.count, 1.0 / D) - 1e-9)));
        std::size_t count = 1;
        for (int k = 0; k < D; ++k) count *= per_axis;
        Foam<D> foam;
        foam.resize(count);
        double volume = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const double radius = 1.0 + 0.36 * (2.0 * uniform(first + 7 * i + 5) - 1.0);  // standard deviation 0.21
            foam.size[i] = Shape<D>::size(radius);
            foam.id[i] = static_cast<std::int64_t>(i);
            volume += Shape<D>::kVolume * foam.size[i];
        }
        const double edge = std::pow(volume / o.gas_fraction, 1.0 / D);
        const double spacing = edge / static_cast<double>(per_axis);
        for (std::size_t k = 0; k < D; ++k) {
            foam.box.lengths[k] = edge;
            foam.box.periodic[k] = !o.walls[k];
        }
        for (std::size_t i = 0; i < count; ++i) {
            std::size_t rest = i;
            for (std::size_t k = 0; k < D; ++k) {
                const double at = static_cast<double>(rest % per_axis) + 0.5 + 0.4 * (uniform(first + 7 * i + k) - 0.5);
                rest /= per_axis;
                foam.position[k][i] = foam.start[k][i] = foam.marked[k][i] = at * spacing;
            }
        }
        return foam;
    }

    template <int D>
    static Model model(const Options& o, const Foam<D>& foam) {
        Model m = Model::from(o);
        m.largest_count = static_cast<double>(foam.live);
        m.total_size = m.initial_mean_radius = m.initial_mean_surface = 0.0;
        for (std::size_t i = 0; i < foam.slots; ++i) {
            const double radius = Shape<D>::radius(foam.size[i]);
            m.total_size += foam.size[i];
            m.initial_mean_radius += radius / m.largest_count;
            m.initial_mean_surface += Shape<D>::surface(radius) / m.largest_count;
        }
        return m;
    }
};

}  // namespace lamella::bubble
