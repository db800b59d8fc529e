#include "lamella/solvers/vortex_particle/exchange.h"

#include "lamella/core/parallel.h"

#include <algorithm>
#include <cmath>

namespace lamella::vortex_particle {

void exchange_between_leaves(const Surface& s, const Bins& bins, double exposure, Particles& particles) {
    const auto sum = [&](std::size_t t, const std::vector<double>& column) {
        double total = 0.0;
        for (std::size_t p = bins[t]; p < bins[t + 1]; ++p) total += column[p];
        return total;
    };
    parallel_for(s.triangles(), [&](std::size_t t) {
        const std::size_t other = s.partner[t];
        if (s.partner[t] == kNoPartner || other < t || bins[t] == bins[t + 1] || bins[other] == bins[other + 1]) return;
        std::size_t giver = t, taker = other;
        double given = sum(giver, particles.amount) / sum(giver, particles.area);
        double there = sum(taker, particles.amount) / sum(taker, particles.area);
        if (given < there) std::swap(given, there), std::swap(giver, taker);
        const double left = std::exp(-exposure * (1.0 - there / given)), room = sum(taker, particles.area);
        for (std::vector<double>* column : {&particles.volume, &particles.amount}) {
            const double moved = (1.0 - left) * sum(giver, *column);
            for (std::size_t p = bins[giver]; p < bins[giver + 1]; ++p) (*column)[p] *= left;
            for (std::size_t p = bins[taker]; p < bins[taker + 1]; ++p)
                (*column)[p] += moved * particles.area[p] / room;
        }
    });
}

}  // namespace lamella::vortex_particle
