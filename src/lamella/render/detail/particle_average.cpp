#include "lamella/render/detail/particle_average.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::render::detail {
namespace {

constexpr std::int32_t kAnyRegion = -1;

}  // namespace

std::optional<FilmParticles> thickness_particles(const sim::Frame& frame) {
    const sim::Points& points = frame.points;
    const auto column = [&](const char* name) -> const std::vector<double>* {
        const sim::Field* field = points.find(name);
        return field != nullptr && field->components == 1 && field->values.size() == points.size() ? &field->values
                                                                                                   : nullptr;
    };
    const std::vector<double>*thickness = column("thickness"), *fine = column("fine"), *region = column("region");
    if (frame.surface.empty() || points.empty() || !points.radius.empty() || thickness == nullptr) return std::nullopt;
    FilmParticles particles;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (fine != nullptr && (*fine)[i] == 0.0) continue;
        particles.position.push_back(points.position[i]);
        particles.value.push_back((*thickness)[i]);
        if (region != nullptr) particles.region.push_back(static_cast<std::int32_t>((*region)[i]));
    }
    if (particles.position.empty()) return std::nullopt;
    return particles;
}

double particle_spacing(const sim::Surface& films, std::size_t particles) {
    double area = 0.0;
    for (const auto& [a, b, c] : films.triangles)
        area += 0.5 * norm(cross(films.position[b] - films.position[a], films.position[c] - films.position[a]));
    return std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, particles)));
}

ParticleAverage::ParticleAverage(const FilmParticles& particles, double spacing) {
    constexpr double kSpacings = 2.0;
    radius_ = kSpacings * std::max(spacing, std::numeric_limits<double>::min());
    for (std::size_t i = 0; i < particles.position.size(); ++i)
        entries_.push_back({key(particles.position[i], 0, 0, 0), particles.position[i], particles.value[i],
                            particles.region.empty() ? kAnyRegion : particles.region[i]});
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
}

std::uint64_t ParticleAverage::key(const Vec3& place, int dx, int dy, int dz) const {
    const auto cell = [&](double x, int shift) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / radius_)) + shift + (1 << 20)) &
               0x1fffff;
    };
    return cell(place[0], dx) << 42 | cell(place[1], dy) << 21 | cell(place[2], dz);
}

std::optional<double> ParticleAverage::at(const Vec3& place, const std::array<std::int32_t, 2>& regions) const {
    double sum = 0.0, weights = 0.0, nearest = std::numeric_limits<double>::infinity(), nearest_value = 0.0;
    for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
            for (int dz = -1; dz <= 1; ++dz) {
                const std::uint64_t k = key(place, dx, dy, dz);
                auto it = std::lower_bound(entries_.begin(), entries_.end(), k,
                                           [](const Entry& e, std::uint64_t want) { return e.key < want; });
                for (; it != entries_.end() && it->key == k; ++it) {
                    if (it->region != kAnyRegion && it->region != regions[0] && it->region != regions[1]) continue;
                    const double square = squared_norm(it->place - place);
                    if (square < nearest) nearest = square, nearest_value = it->value;
                    const double t = 1.0 - square / (radius_ * radius_);
                    if (t <= 0.0) continue;
                    sum += t * t * it->value;
                    weights += t * t;
                }
            }
    if (weights > 0.0) return sum / weights;
    return nearest < 4.0 * radius_ * radius_ ? std::optional(nearest_value) : std::nullopt;
}

}  // namespace lamella::render::detail
