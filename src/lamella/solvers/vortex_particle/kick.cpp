#include "lamella/solvers/vortex_particle/kick.h"

#include "lamella/core/error.h"
#include "lamella/linalg/dense.h"
#include "lamella/linalg/gmres.h"
#include "lamella/mesh/volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lamella::vortex_particle {
namespace {

using mesh::RegionId;
using mesh::VertexId;

/// The closed regions, and how their volumes change with the membrane's unknowns.
struct Gas {
    std::vector<RegionId> region;
    std::vector<std::vector<double>> slope;  ///< dV / dx along the unknowns [m^2]
    std::vector<double> area;                ///< of each region's films [m^2]
};

Gas gas_of(const KickProblem& p) {
    Gas gas;
    std::vector<std::size_t> place(p.mesh.regions.size(), p.mesh.regions.size());
    for (const RegionId r : p.mesh.regions.ids())
        if (p.mesh.regions[r].kind == mesh::RegionKind::kClosed) {
            place[index(r)] = gas.region.size();
            gas.region.push_back(r);
        }
    std::vector<Vectors> slope(gas.region.size(), Vectors(p.mesh.position.size()));
    const mesh::VolumeGradient gradient = mesh::volume_gradient(p.mesh);
    for (const VertexId v : p.mesh.position.ids())
        for (std::size_t i = gradient.entries.start[index(v)]; i < gradient.entries.start[index(v) + 1]; ++i)
            slope[place[index(gradient.entries.region[i])]][v] = gradient.value[i];
    for (const Vectors& each : slope) {
        gas.slope.push_back(p.membrane.components(each));
        double area = 0.0;
        for (const Vec3& a : each) area += norm(a);
        gas.area.push_back(area);
    }
    return gas;
}

double dot(const std::vector<double>& a, const double* b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// All unknowns in one vector: speeds, surfactant, pressures. Rows are scaled such that each is a velocity.
class System {
public:
    explicit System(const KickProblem& p)
        : p_(p),
          gas_(gas_of(p)),
          speeds_(p.membrane.size()),
          soap_(p.surfactant != nullptr ? p.surface.vertices() : 0),
          inertia_(p.membrane.mean_inertia()),
          width_(p.surface.mean_edge * static_cast<double>(p.surface.vertices()) / p.surface.total_area),
          unknown_(p.mesh.position.size(), p.membrane.size()) {
        for (std::size_t u = 0; u < speeds_; ++u) unknown_[p.membrane.vertex(u)] = u;
        for (const auto& slope : gas_.slope) {
            std::vector<double> y = slope;
            yield(y);
            yield_.push_back(std::move(y));
        }
        const std::size_t count = gas_.region.size();
        for (std::size_t a = 0; a < count; ++a)
            for (std::size_t b = 0; b < count; ++b) coupling_.push_back(dot(gas_.slope[a], yield_[b].data()));
    }

    std::size_t size() const { return speeds_ + soap_ + gas_.region.size(); }
    std::size_t speeds() const { return speeds_; }
    std::size_t soap() const { return soap_; }
    const Gas& gas() const { return gas_; }
    const std::vector<std::vector<double>>& yield() const { return yield_; }
    /// Pressures that give regions these growths, at the membrane's factored inertia.
    std::vector<double> pressures(const std::vector<double>& growth) const {
        if (growth.empty()) return {};
        return linalg::solve_symmetric(growth.size(), coupling_, growth).x;
    }

    std::vector<double> right_side(const std::vector<double>& missing) const {
        std::vector<double> b(size()), start(size(), 0.0), momentum(size());
        std::copy(p_.speed.begin(), p_.speed.end(), start.begin());
        inertia(start.data(), b.data());
        for (std::size_t u = 0; u < speeds_; ++u) b[u] = (b[u] + p_.dt * p_.force[u]) / inertia_;
        for (std::size_t v = 0; v < soap_; ++v) b[speeds_ + v] = p_.surfactant->right[v] * width_;
        for (std::size_t r = 0; r < missing.size(); ++r)
            b[speeds_ + soap_ + r] = 2.0 / p_.dt * missing[r] / gas_.area[r];
        return b;
    }

    void apply(const std::vector<double>& x, std::vector<double>& y) const {
        y.assign(size(), 0.0);
        const double* soap = x.data() + speeds_;
        const double* pressure = soap + soap_;
        inertia(x.data(), y.data());
        if (soap_ > 0) {
            std::vector<double> pull(p_.surface.triangles());
            for (std::size_t t = 0; t < pull.size(); ++t) {
                const auto& [a, b, c] = p_.surface.corner[t];
                pull[t] = p_.surface.share[t] * p_.dt * p_.surfactant->energy * (soap[a] + soap[b] + soap[c]) / 3.0;
            }
            const std::vector<double> force =
                p_.membrane.components(tension_force(p_.surface, p_.mesh.position.size(), pull));
            for (std::size_t u = 0; u < speeds_; ++u) y[u] += force[u];
            const std::vector<double> stretch = stretch_of(x);
            for (std::size_t v = 0; v < soap_; ++v)
                y[speeds_ + v] = p_.surfactant->mass[v] * soap[v] + 0.5 * stretch[v];
            add_stiffness(p_.surface, p_.surfactant->stiffness, p_.surfactant->weight, std::span(soap, soap_),
                          std::span(y).subspan(speeds_, soap_));
            for (std::size_t v = 0; v < soap_; ++v) y[speeds_ + v] *= width_;
        }
        for (std::size_t r = 0; r < gas_.region.size(); ++r) {
            for (std::size_t u = 0; u < speeds_; ++u) y[u] -= p_.dt * pressure[r] * gas_.slope[r][u];
            y[speeds_ + soap_ + r] = dot(gas_.slope[r], x.data()) / gas_.area[r];
        }
        for (std::size_t u = 0; u < speeds_; ++u) y[u] /= inertia_;
    }

    /// Speeds first, gas with them; then the surfactant that they stretch.
    void precondition(const std::vector<double>& y, std::vector<double>& x) const {
        x = y;
        const std::span speed(x.data(), speeds_);
        for (double& s : speed) s *= inertia_;
        yield(speed);
        const std::size_t count = gas_.region.size();
        std::vector<double> growth(count);
        for (std::size_t r = 0; r < count; ++r)
            growth[r] = y[speeds_ + soap_ + r] * gas_.area[r] - dot(gas_.slope[r], x.data());
        const std::vector<double> push = pressures(growth);
        for (std::size_t r = 0; r < count; ++r) {
            for (std::size_t u = 0; u < speeds_; ++u) speed[u] += push[r] * yield_[r][u];
            x[speeds_ + soap_ + r] = push[r] / p_.dt;
        }
        if (soap_ == 0) return;
        const std::vector<double> stretch = stretch_of(x);
        const std::span soap(x.data() + speeds_, soap_);
        for (std::size_t v = 0; v < soap_; ++v) soap[v] = soap[v] / width_ - 0.5 * stretch[v];
        p_.surfactant->factors->precondition(soap);
    }

    std::vector<double> stretch_of(const std::vector<double>& x) const {
        return stretch_rate(p_.surface, p_.membrane.velocities(std::span(x.data(), speeds_)));
    }

private:
    /// y = M' x, air included.
    void inertia(const double* x, double* y) const {
        p_.membrane.multiply(std::span(x, speeds_), std::span(y, speeds_));
        if (p_.air == nullptr) return;
        const std::vector<double> speed = at_surface(x);
        std::vector<double> momentum(speed.size(), 0.0);
        p_.air->add(speed, momentum);
        add_from_surface(momentum, y);
    }

    /// x = about M'^-1 x.
    void yield(std::span<double> x) const {
        if (p_.air == nullptr) return p_.membrane.precondition(x);
        const std::vector<double> momentum = at_surface(x.data());
        std::vector<double> speed(momentum.size());
        p_.air->yield(momentum, speed);
        std::fill(x.begin(), x.end(), 0.0);
        add_from_surface(speed, x.data());
    }

    /// Of unknowns, along the normals of the surface; air is not built where a vertex of the films has several.
    std::vector<double> at_surface(const double* x) const {
        std::vector<double> value(p_.surface.vertices(), 0.0);
        for (std::size_t v = 0; v < value.size(); ++v)
            if (const std::size_t u = unknown_[p_.surface.site[v]]; u < speeds_) value[v] = p_.share[v] * x[u];
        return value;
    }
    void add_from_surface(const std::vector<double>& value, double* x) const {
        for (std::size_t v = 0; v < value.size(); ++v)
            if (const std::size_t u = unknown_[p_.surface.site[v]]; u < speeds_) x[u] += p_.share[v] * value[v];
    }

    const KickProblem& p_;
    Gas gas_;
    std::size_t speeds_, soap_;
    double inertia_, width_;
    std::vector<std::size_t> unknown_;        ///< of each vertex of the films; speeds_ where there is none
    std::vector<std::vector<double>> yield_;  ///< M'^-1 grad V, as factored
    std::vector<double> coupling_;            ///< grad V_a . M'^-1 grad V_b
};

std::vector<double> missing_volumes(const KickProblem& p, const Gas& gas, const Vectors& displacement) {
    mesh::FoamMesh moved = p.mesh;
    for (const VertexId v : moved.position.ids()) moved.position[v] += displacement[v];
    const IdVector<RegionId, double> volume = mesh::region_volumes(moved);
    std::vector<double> missing;
    for (const RegionId r : gas.region) missing.push_back(p.mesh.regions[r].target_volume - volume[r]);
    return missing;
}

/// The linear volumes of the solve are right up to the square of the step: what is left is taken up as gas would.
void close_volumes(const KickProblem& p, const System& system, std::vector<double>& speed) {
    constexpr int kMostRounds = 6;
    constexpr double kClosed = 1e-13;  // relative
    for (int round = 0; round < kMostRounds && !system.gas().region.empty(); ++round) {
        Vectors ahead = p.membrane.velocities(speed);
        for (Vec3& d : ahead) d *= 0.5 * p.dt;
        std::vector<double> growth = missing_volumes(p, system.gas(), ahead);
        double worst = 0.0;
        for (std::size_t r = 0; r < growth.size(); ++r) {
            worst = std::max(worst, std::abs(growth[r]) / p.mesh.regions[system.gas().region[r]].target_volume);
            growth[r] *= 2.0 / p.dt;
        }
        if (!(worst > kClosed)) return;
        const std::vector<double> push = system.pressures(growth);
        for (std::size_t r = 0; r < push.size(); ++r)
            for (std::size_t u = 0; u < speed.size(); ++u) speed[u] += push[r] * system.yield()[r][u];
    }
}

}  // namespace

KickStep kick(const KickProblem& p) {
    const System system(p);
    const std::vector<double> missing = missing_volumes(p, system.gas(), Vectors(p.mesh.position.size()));
    const std::vector<double> b = system.right_side(missing);
    std::vector<double> x(system.size(), 0.0);
    std::copy(p.speed.begin(), p.speed.end(), x.begin());
    for (std::size_t r = 0; r < system.gas().region.size(); ++r)
        x[system.speeds() + system.soap() + r] = p.pressure[index(system.gas().region[r])];
    constexpr int kMostIterations = 100;
    const linalg::GmresSolution done = linalg::gmres([&](const auto& in, auto& out) { system.apply(in, out); },
                                                     [&](const auto& in, auto& out) { system.precondition(in, out); },
                                                     b, x, p.tolerance, kMostIterations);
    KickStep step;
    step.iterations = done.iterations;
    step.residual = done.residual;
    step.speed.assign(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(system.speeds()));
    step.surfactant.assign(x.begin() + static_cast<std::ptrdiff_t>(system.speeds()),
                           x.begin() + static_cast<std::ptrdiff_t>(system.speeds() + system.soap()));
    step.stretch = system.stretch_of(x);
    step.pressure.assign(p.mesh.regions.size(), 0.0);
    for (std::size_t r = 0; r < system.gas().region.size(); ++r)
        step.pressure[index(system.gas().region[r])] = x[system.speeds() + system.soap() + r];
    close_volumes(p, system, step.speed);
    return step;
}

}  // namespace lamella::vortex_particle
