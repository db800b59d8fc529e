#include "lamella/solvers/vortex_particle/particles.h"

#include "lamella/core/parallel.h"
#include "lamella/core/random.h"

#include <cmath>
#include <numeric>

namespace lamella::vortex_particle {

Bins sort_by_triangle(Particles& particles, std::size_t triangles) {
    Bins start(triangles + 1, 0);
    for (const std::uint32_t t : particles.triangle) ++start[t + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::size_t> next(start.begin(), start.end() - 1), from(particles.size());
    for (std::size_t p = 0; p < particles.size(); ++p) from[next[particles.triangle[p]]++] = p;
    Particles::for_each_column(particles, [&](const char*, auto& column) {
        auto sorted = column;
        parallel_for(column.size(), [&](std::size_t p) { sorted[p] = column[from[p]]; });
        column.swap(sorted);
    });
    return start;
}

namespace {

/// Appends the half of particle p that goes to the middle of triangle t.
void split(const Surface& s, std::size_t p, std::uint32_t t, Particles& particles) {
    for (auto* column : {&particles.circulation, &particles.volume, &particles.amount, &particles.area})
        (*column)[p] *= 0.5;
    Particles::for_each_column(particles, [p](const char*, auto& column) { column.push_back(column[p]); });
    particles.velocity.back() = turned(particles.velocity[p], s.normal[particles.triangle[p]], s.normal[t]);
    particles.triangle.back() = t;
    particles.place.back() = {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
}

}  // namespace

void fill_empty_triangles(const Surface& s, Particles& particles, Bins& bins) {
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds; ++round) {
        const std::size_t before = particles.size();
        for (std::uint32_t t = 0; t < s.triangles(); ++t) {
            if (bins[t] != bins[t + 1]) continue;
            std::size_t largest = before;
            for (const std::int32_t n : s.neighbor[t]) {
                if (n == kNoNeighbor) continue;
                for (std::size_t p = bins[static_cast<std::size_t>(n)]; p < bins[static_cast<std::size_t>(n) + 1]; ++p)
                    if (largest == before || particles.area[p] > particles.area[largest]) largest = p;
            }
            if (largest != before) split(s, largest, t, particles);
        }
        if (particles.size() == before) return;
        bins = sort_by_triangle(particles, s.triangles());
    }
}

Particles spread_particles(const Surface& s, int per_triangle, std::uint64_t seed) {
    // The plastic number g, g^3 = g + 1: steps of 1/g and 1/g^2 fill a square more evenly than any others known.
    constexpr double kStepU = 0.75487766624669276, kStepV = 0.56984029099805327;
    Particles particles;
    const auto count = static_cast<std::size_t>(per_triangle);
    Particles::for_each_column(particles, [&](const char*, auto& column) { column.resize(count * s.triangles()); });
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        const RandomBits bits = random_bits(seed, RandomStream::kFilmParticle, 0, t);
        for (std::size_t k = 0; k < count; ++k) {
            double u = uniform01(bits, 0) + kStepU * static_cast<double>(k);
            double v = uniform01(bits, 1) + kStepV * static_cast<double>(k);
            u -= std::floor(u), v -= std::floor(v);
            if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
            const std::size_t p = t * count + k;
            particles.triangle[p] = static_cast<std::uint32_t>(t);
            particles.place[p] = {1.0 - u - v, u, v};
            particles.area[p] = s.area[t] / static_cast<double>(count);
        }
    }
    return particles;
}

}  // namespace lamella::vortex_particle
