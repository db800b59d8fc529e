#include "lamella/solvers/vortex_particle/particles.h"

#include "lamella/core/parallel.h"
#include "lamella/core/random.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

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

double remove_gone(Particles& particles) {
    std::vector<std::size_t> kept;
    double liquid = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
        if (particles.triangle[p] != kGone)
            kept.push_back(p);
        else
            liquid += particles.volume[p];
    }
    if (kept.size() == particles.size()) return 0.0;
    Particles::for_each_column(particles, [&](const char*, auto& column) {
        for (std::size_t i = 0; i < kept.size(); ++i) column[i] = column[kept[i]];
        column.resize(kept.size());
    });
    return liquid;
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

namespace {

/// What particle q has goes to p.
void join(std::size_t p, std::size_t q, Particles& particles) {
    const double share = particles.volume[q] / (particles.volume[p] + particles.volume[q]);
    for (std::size_t k = 0; k < 3; ++k)
        particles.place[p][k] += share * (particles.place[q][k] - particles.place[p][k]);
    particles.velocity[p] += share * (particles.velocity[q] - particles.velocity[p]);
    for (auto* column : {&particles.circulation, &particles.volume, &particles.amount, &particles.area}) {
        (*column)[p] += (*column)[q];
        (*column)[q] = 0.0;
    }
    particles.triangle[q] = kGone;
}

/// Closest first, `here` become `most`. Whom each is nearest to is kept, so that a pair costs one look at each.
void join_closest(const Surface& s, std::size_t most, std::vector<std::size_t>& here, Particles& particles) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const auto distance = [&](std::size_t i, std::size_t j) {
        const std::uint32_t t = particles.triangle[here[i]];
        return squared_norm(s.point(t, particles.place[here[i]]) - s.point(t, particles.place[here[j]]));
    };
    struct Nearest {
        std::size_t other;  // behind it in `here`
        double distance;
    };
    std::vector<Nearest> nearest(here.size());
    const auto look = [&](std::size_t i) {
        nearest[i] = {i, kFar};
        for (std::size_t j = i + 1; j < here.size(); ++j)
            if (const double d = distance(i, j); d < nearest[i].distance) nearest[i] = {j, d};
    };
    for (std::size_t i = 0; i < here.size(); ++i) look(i);
    while (here.size() > most) {
        const auto closest = std::min_element(
            nearest.begin(), nearest.end(), [](const Nearest& x, const Nearest& y) { return x.distance < y.distance; });
        const auto first = static_cast<std::size_t>(closest - nearest.begin());
        const std::size_t second = closest->other;
        join(here[first], here[second], particles);
        here.erase(here.begin() + static_cast<std::ptrdiff_t>(second));
        nearest.erase(nearest.begin() + static_cast<std::ptrdiff_t>(second));
        look(first);
        for (std::size_t i = 0; i < second; ++i) {
            if (i == first) continue;
            Nearest& n = nearest[i];
            if (n.other == first || n.other == second) {
                look(i);
                continue;
            }
            if (n.other > second) --n.other;
            if (i > first) continue;
            if (const double d = distance(i, first); d < n.distance || (d == n.distance && first < n.other))
                n = {first, d};
        }
        for (std::size_t i = second; i < nearest.size(); ++i) --nearest[i].other;
    }
}

/// Those that are near each other in the triangle come near each other in the list: along Morton's curve.
void sort_along_curve(std::vector<std::size_t>& here, const Particles& particles) {
    const auto code = [&](std::size_t p) {
        const auto cell = [&](std::size_t k) {
            return static_cast<std::uint32_t>(65535.0 * std::clamp(particles.place[p][k], 0.0, 1.0));
        };
        const std::uint32_t x = cell(1), y = cell(2);
        std::uint64_t mixed = 0;
        for (unsigned bit = 0; bit < 16; ++bit)
            mixed |= static_cast<std::uint64_t>((x >> bit & 1U) | (y >> bit & 1U) << 1U) << (2 * bit);
        return mixed;
    };
    std::vector<std::pair<std::uint64_t, std::size_t>> key;
    for (const std::size_t p : here) key.emplace_back(code(p), p);
    std::sort(key.begin(), key.end());
    for (std::size_t i = 0; i < here.size(); ++i) here[i] = key[i].second;
}

/// Large crowds are halved in groups of neighbors until few are left, so that the work grows with their number.
void thin_out(const Surface& s, std::size_t begin, std::size_t end, std::size_t most, Particles& particles) {
    constexpr std::size_t kGroup = 64;
    std::vector<std::size_t> here(end - begin), left, group;
    std::iota(here.begin(), here.end(), begin);
    if (here.size() > kGroup) sort_along_curve(here, particles);
    while (here.size() > std::max(most, kGroup)) {
        const std::size_t count = here.size(), wanted = std::max(most, (count + 1) / 2);
        left.clear();
        for (std::size_t from = 0; from < count; from += kGroup) {
            const std::size_t to = std::min(count, from + kGroup);
            group.assign(here.begin() + static_cast<std::ptrdiff_t>(from),
                         here.begin() + static_cast<std::ptrdiff_t>(to));
            join_closest(s, to * wanted / count - from * wanted / count, group, particles);
            left.insert(left.end(), group.begin(), group.end());
        }
        here.swap(left);
    }
    if (here.size() > most) join_closest(s, most, here, particles);
}

}  // namespace

void merge_crowds(const Surface& s, std::size_t most, Particles& particles, Bins& bins) {
    const std::size_t before = particles.size();
    parallel_blocks(s.triangles(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t)
            if (bins[t + 1] - bins[t] > most) thin_out(s, bins[t], bins[t + 1], most, particles);
    });
    remove_gone(particles);
    if (particles.size() != before) bins = sort_by_triangle(particles, s.triangles());
}

Particles spread_particles(const Surface& s, int per_triangle, std::uint64_t seed) {
    Particles particles;
    const auto count = static_cast<std::size_t>(per_triangle);
    Particles::for_each_column(particles, [&](const char*, auto& column) { column.resize(count * s.triangles()); });
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        const RandomBits bits = random_bits(seed, RandomStream::kFilmParticle, 0, t);
        EvenPoints points(uniform01(bits, 0), uniform01(bits, 1));
        for (std::size_t k = 0; k < count; ++k) {
            auto [u, v] = points.next();
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
