#include "lamella/solvers/vortex_particle/start.h"

#include "lamella/core/error.h"
#include "lamella/film/noise.h"
#include "lamella/film/surfactant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lamella::vortex_particle {
namespace {

using Profile = film::Vortex::Profile;

constexpr double kPi = 3.14159265358979323846;
constexpr int kSweeps = 5;

/// Two directions that make a right-handed frame with a unit vector.
std::array<Vec3, 2> frame_of(const Vec3& axis) {
    const Vec3 other = std::abs(axis[0]) < 0.9 ? Vec3{{1.0, 0.0, 0.0}} : Vec3{{0.0, 1.0, 0.0}};
    const Vec3 x = other - dot(other, axis) * axis;
    const Vec3 unit = x / norm(x);
    return {unit, cross(axis, unit)};
}

double rossby_haurwitz(const film::Vortex& vortex, const Vec3& from_center) {
    const double radius = norm(from_center);
    const auto [ex, ey] = frame_of(vortex.axis);
    const Vec3 d = from_center / radius;
    const double x = dot(d, ex), y = dot(d, ey), z = dot(d, vortex.axis);
    return -20.0 * vortex.circulation * z * (x * x * x - 3.0 * x * y * y) / (radius * radius);
}

/// Values of particles are corrected until they put `target` on the vertices.
/// @param change  change(p, relative surplus to be made up for, density [per area] to be added)
void fit_circulation(const Surface& s,
                     const Transfer& transfer,
                     const Bins& bins,
                     const std::vector<double>& target,
                     Particles& particles) {
    const std::vector<double> area = transfer.deposit(s, particles, bins, particles.area);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        std::vector<double> missing = transfer.deposit(s, particles, bins, particles.circulation);
        for (std::size_t v = 0; v < missing.size(); ++v) missing[v] = (target[v] - missing[v]) / area[v];
        const std::vector<double> more = transfer.gather(s, particles, missing);
        for (std::size_t p = 0; p < particles.size(); ++p) particles.circulation[p] += more[p] * particles.area[p];
    }
}

void fit_areas(const Surface& s, const Transfer& transfer, const Bins& bins, Particles& particles) {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        std::vector<double> factor = transfer.deposit(s, particles, bins, particles.area);
        for (std::size_t v = 0; v < factor.size(); ++v) factor[v] = s.vertex_area[v] / factor[v];
        const std::vector<double> change = transfer.gather(s, particles, factor);
        for (std::size_t p = 0; p < particles.size(); ++p) particles.area[p] *= change[p];
    }
    double sum = 0.0;
    for (const double a : particles.area) sum += a;
    for (double& a : particles.area) a *= s.total_area / sum;
}

/// What has to be added to Gamma at vertices so that (2 R T / rho) grad Gamma = eta a, as far as a gradient can be; its
/// mean over each component is 0.
/// @param acceleration  a, of triangles, along the film [m/s^2]
std::vector<double> pulling_surfactant(const Surface& s,
                                       const FlowSolver& flow,
                                       const film::Problem& films,
                                       const Deposit& sum,
                                       std::vector<Vec3> acceleration) {
    const double strength = 2.0 * film::thermal_energy(films.material) / films.material.liquid_density;
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        double thickness = 0.0;
        for (const std::uint32_t v : s.corner[t]) thickness += sum.volume[v] / (3.0 * s.vertex_share[v] * sum.area[v]);
        acceleration[t] *= thickness / strength;
    }
    std::vector<double> surfactant = flow.potential(s, divergence(s, acceleration));
    const std::vector<std::uint32_t> connected = connected_components(s);
    const auto of = [&](std::size_t v) { return connected[s.component[v]]; };
    std::vector<double> total(s.components, 0.0), part(s.components, 0.0);
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        total[of(v)] += surfactant[v] * s.vertex_area[v];
        part[of(v)] += s.vertex_area[v];
    }
    for (std::size_t v = 0; v < s.vertices(); ++v) surfactant[v] -= total[of(v)] / part[of(v)];
    return surfactant;
}

std::vector<Vec3> gravity_along(const Surface& s, const Vec3& g) {
    std::vector<Vec3> along(s.triangles());
    for (std::size_t t = 0; t < s.triangles(); ++t) along[t] = g - dot(g, s.normal[t]) * s.normal[t];
    return along;
}

/// -(u . grad) u of the flow that the scene's vortices make in a film that keeps its area.
std::vector<Vec3> outward_pull(const Surface& s, const FlowSolver& flow, std::span<const film::Vortex> vortices) {
    const std::vector<Vec3> u =
        rotated_gradient(s, flow.stream_function(s, vertex_circulation(s, vortices), hole_circulation(s, vortices)));
    const std::vector<Vec3> smooth = vertex_velocity(s, u);
    std::vector<Vec3> pull(s.triangles());
    for (std::size_t t = 0; t < s.triangles(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) pull[t] -= dot(u[t], s.hat_slope[t][k]) * smooth[s.corner[t][k]];
        pull[t] -= dot(pull[t], s.normal[t]) * s.normal[t];
    }
    return pull;
}

/// Gives particles the surfactant that carries the film's weight, or liquid and surfactant that hold swirls together:
/// thinner in their cores [method sheet 5.10].
void balance(const Surface& s,
             const Transfer& transfer,
             const Bins& bins,
             const film::Problem& films,
             const StartOptions& options,
             Particles& particles) {
    const bool weight = options.surfactant == SurfactantProfile::kBalanced;
    if (!weight && !options.swirls_in_balance) return;
    const FlowSolver flow(s);
    const Deposit sum = transfer.deposit(s, particles, bins);
    const double rest = film::start_surfactant(films.material);
    const auto scaled = [&](const std::vector<double>& more, const auto& from, bool liquid_too) {
        std::vector<double> factor(s.vertices());
        for (std::size_t v = 0; v < factor.size(); ++v) {
            factor[v] = (from(v) + more[v]) / from(v);
            if (!(factor[v] > 0.0))
                throw InputError(
                    "vortex_particle.start: there is not enough surfactant to carry the film or to hold its "
                    "vortices together; raise material.surfactant, or take a lower, thinner or slower film");
        }
        const std::vector<double> at = transfer.gather(s, particles, factor);
        for (std::size_t p = 0; p < particles.size(); ++p) {
            particles.amount[p] *= at[p];
            if (liquid_too) particles.volume[p] *= at[p];
        }
    };
    if (weight)
        scaled(
            pulling_surfactant(s, flow, films, sum, gravity_along(s, films.material.gravity)),
            [&](std::size_t) { return rest; }, false);
    if (options.swirls_in_balance)
        scaled(
            pulling_surfactant(s, flow, films, sum, outward_pull(s, flow, films.vortices)),
            [&](std::size_t v) { return sum.amount[v] / sum.area[v]; }, true);
}

}  // namespace

Start::Start(const Surface& s, const film::Problem& films, const StartOptions& options)
    : options_(options),
      common_(films.material.thickness),
      bottom_(options.thickness_bottom > 0.0 ? options.thickness_bottom : common_),
      top_(options.thickness_top > 0.0 ? options.thickness_top : common_),
      rest_surfactant_(film::start_surfactant(films.material)),
      up_(norm(options.up) > 0.0 ? options.up : -films.material.gravity),
      low_(std::numeric_limits<double>::infinity()) {
    if (norm(up_) == 0.0) up_ = {{0.0, 1.0, 0.0}};
    double high = -low_;
    for (const Vec3& x : s.position) {
        low_ = std::min(low_, dot(x, up_));
        high = std::max(high, dot(x, up_));
    }
    range_ = high - low_;
}

double Start::thickness(const Vec3& x) const {
    const double height = range_ > 0.0 ? (dot(x, up_) - low_) / range_ : 0.5;  // of the film's, 0 to 1
    switch (options_.thickness) {
        case ThicknessProfile::kLinear:
            return bottom_ + height * (top_ - bottom_);
        case ThicknessProfile::kStep:
            return height < 0.5 ? bottom_ : top_;
        case ThicknessProfile::kCosine:
            return bottom_ + 0.5 * (1.0 - std::cos(kPi * height)) * (top_ - bottom_);
        case ThicknessProfile::kUniform:
            break;
    }
    return common_;
}

double Start::surfactant(const Vec3& x) const {
    return options_.surfactant == SurfactantProfile::kProportional ? rest_surfactant_ * thickness(x) / common_
                                                                   : rest_surfactant_;
}

double vorticity(std::span<const film::Vortex> vortices, const Vec3& x, const Vec3& n) {
    double sum = 0.0;
    for (const film::Vortex& vortex : vortices) {
        const Vec3 d = x - vortex.center;
        const double q = vortex.radius > 0.0 ? squared_norm(d) / (vortex.radius * vortex.radius) : 0.0;
        switch (vortex.profile) {
            case Profile::kGauss:
                sum += vortex.circulation / (kPi * vortex.radius * vortex.radius) * std::exp(-q);
                break;
            case Profile::kTaylor:
                sum += vortex.speed / vortex.radius * (2.0 - q) * std::exp(0.5 * (1.0 - q));
                break;
            case Profile::kRotation:
                sum += 2.0 * vortex.rate * dot(vortex.axis, n);
                break;
            case Profile::kRossbyHaurwitz:
                sum += rossby_haurwitz(vortex, d);
                break;
            case Profile::kHole:
                break;
        }
    }
    return sum;
}

std::vector<double> vertex_circulation(const Surface& s, std::span<const film::Vortex> vortices) {
    constexpr int kParts = 4;  // along each edge
    std::vector<double> circulation(s.vertices(), 0.0);
    if (vortices.empty()) return circulation;
    const auto add = [&](std::size_t t, double u, double v) {
        const std::array<double, 3> b{1.0 - u - v, u, v};
        const double w = s.area[t] / (kParts * kParts) * vorticity(vortices, s.point(t, b), s.normal[t]);
        for (std::size_t k = 0; k < 3; ++k) circulation[s.corner[t][k]] += b[k] * w;
    };
    for (std::size_t t = 0; t < s.triangles(); ++t)
        for (int i = 0; i < kParts; ++i)
            for (int j = 0; i + j < kParts; ++j) {
                add(t, (i + 1.0 / 3.0) / kParts, (j + 1.0 / 3.0) / kParts);
                if (i + j < kParts - 1) add(t, (i + 2.0 / 3.0) / kParts, (j + 2.0 / 3.0) / kParts);
            }
    std::vector<double> surplus(s.components, 0.0), part(s.components, 0.0);
    for (std::size_t v = 0; v < s.vertices(); ++v) {
        surplus[s.component[v]] += circulation[v];
        part[s.component[v]] += s.vertex_area[v];
    }
    for (const BoundaryLoop& loop : s.loops) surplus[loop.component] = 0.0;
    for (std::size_t v = 0; v < s.vertices(); ++v)
        circulation[v] -= surplus[s.component[v]] * s.vertex_area[v] / part[s.component[v]];
    return circulation;
}

std::vector<double> hole_circulation(const Surface& s, std::span<const film::Vortex> vortices) {
    std::vector<double> circulation(s.loops.size(), 0.0);
    for (const film::Vortex& vortex : vortices) {
        if (vortex.profile != Profile::kHole) continue;
        std::size_t nearest = s.loops.size();
        for (std::size_t l = 0; l < s.loops.size(); ++l)
            if (!s.loops[l].outer && (nearest == s.loops.size() || norm(s.loops[l].center - vortex.center) <
                                                                       norm(s.loops[nearest].center - vortex.center)))
                nearest = l;
        if (nearest == s.loops.size())
            throw InputError("vortex.profile = \"hole\": no film of this scene has a hole that a flow could go around");
        circulation[nearest] += vortex.circulation;
    }
    return circulation;
}

Particles start_particles(const Surface& s,
                          const Transfer& transfer,
                          const film::Problem& films,
                          const Options& options,
                          std::uint64_t seed) {
    Particles particles = spread_particles(s, options.particles_per_triangle, seed);
    const Bins bins = sort_by_triangle(particles, s.triangles());
    if (options.transfer == Reach::kHat) fit_areas(s, transfer, bins, particles);
    const Start fresh(s, films, options.start);
    const double frequency = options.noise.frequency > 0.0 ? options.noise.frequency : 8.0 / std::sqrt(s.total_area);
    const auto noisy = [&](double amplitude, const Vec3& x, std::uint64_t which) {
        return amplitude == 0.0 ? 1.0
                                : std::max(0.1, 1.0 + amplitude * film::gradient_noise(frequency * x, 2 * seed + which,
                                                                                       options.noise.octaves));
    };
    const double surfactant = fresh.rest_surfactant();
    for (std::size_t p = 0; p < particles.size(); ++p) {
        const std::size_t t = particles.triangle[p];
        const Vec3 x = s.point(t, particles.place[p]);
        const double share_of_film = s.share[t];
        particles.volume[p] =
            share_of_film * particles.area[p] * fresh.thickness(x) * noisy(options.noise.thickness, x, 0);
        const double share = options.start.surfactant == SurfactantProfile::kProportional
                                 ? particles.volume[p] / (share_of_film * particles.area[p]) / films.material.thickness
                                 : 1.0;
        particles.amount[p] = particles.area[p] * surfactant * share * noisy(options.noise.surfactant, x, 1);
        particles.circulation[p] = particles.area[p] * vorticity(films.vortices, x, s.normal[t]);
    }
    balance(s, transfer, bins, films, options.start, particles);
    if (!films.vortices.empty()) fit_circulation(s, transfer, bins, vertex_circulation(s, films.vortices), particles);
    return particles;
}

}  // namespace lamella::vortex_particle
