#include "lamella/solvers/melp/normal_motion.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/dense.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lamella::melp {

Cohesion cohesion(double gamma, double beta) {
    const double g = std::min(gamma, 1.0);
    const double f = g + beta * g * (1.0 - g), slope = 1.0 + beta * (1.0 - 2.0 * g);
    return {2.0 - f - g * slope, slope};
}

namespace {

std::size_t region_of(const CoarseParticles& coarse, std::size_t i) { return static_cast<std::size_t>(coarse.region[i]); }

/// Strengths of the pairs: c_ij, of one region and of two. [N/m]
struct Pairs {
    std::vector<double> own;    ///< tau_i per particle
    std::vector<double> same;   ///< per entry of neighbors.same
    std::vector<double> other;  ///< per entry of neighbors.other
};

Pairs pair_strengths(const NormalProblem& p) {
    const Neighbors& same = p.geometry.neighbors.same;
    const Neighbors& other = p.geometry.neighbors.other;
    const std::vector<double>& a = p.geometry.area;
    Pairs pairs;
    pairs.own.resize(a.size());
    pairs.same.resize(same.index.size());
    pairs.other.resize(other.index.size());
    std::vector<double> toward(a.size());  // sigma f'
    parallel_for(a.size(), [&](std::size_t i) {
        double gamma = 0.0;
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) gamma += a[other.index[k]] * other.weight[k];
        const Cohesion c = cohesion(gamma, p.junction_correction);
        pairs.own[i] = p.interface_tension[i] * c.own;
        toward[i] = p.interface_tension[i] * c.other;
    });
    parallel_for(a.size(), [&](std::size_t i) {
        const auto strength = [&](const Neighbors& list, std::size_t k, const std::vector<double>& tension) {
            const std::size_t j = list.index[k];
            return 0.5 * (tension[i] + tension[j]) * (a[i] * a[j]) * list.laplacian[k];
        };
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) pairs.same[k] = strength(same, k, pairs.own);
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) pairs.other[k] = strength(other, k, toward);
    });
    return pairs;
}

/// Tension, cohesion and gas pressure along the normals. [N]
std::vector<double> forces(const NormalProblem& p, const Pairs& pairs) {
    const Geometry& g = p.geometry;
    const std::vector<Vec3>& x = p.coarse.position;
    std::vector<double> force(g.size());
    parallel_for(g.size(), [&](std::size_t i) {
        Vec3 pull;
        const Neighbors& same = g.neighbors.same;
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) pull += pairs.same[k] * (x[same.index[k]] - x[i]);
        const Neighbors& other = g.neighbors.other;
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) pull += pairs.other[k] * (x[other.index[k]] - x[i]);
        force[i] = dot(pull, g.normal[i]) + p.gas[region_of(p.coarse, i)].gauge_pressure(p.outside_pressure) * g.area[i];
    });
    return force;
}

/// For each region the smallest one of the cluster it belongs to by contact.
std::vector<std::size_t> clusters(const NormalProblem& p) {
    std::vector<std::size_t> cluster(p.gas.size());
    std::iota(cluster.begin(), cluster.end(), std::size_t{0});
    const auto root = [&](std::size_t r) {
        while (cluster[r] != r) r = cluster[r];
        return r;
    };
    const Neighbors& other = p.geometry.neighbors.other;
    for (std::size_t i = 0; i < p.coarse.size(); ++i)
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
            const std::size_t a = root(region_of(p.coarse, i)), b = root(region_of(p.coarse, other.index[k]));
            cluster[std::max(a, b)] = std::min(a, b);
        }
    for (std::size_t& r : cluster) r = root(r);
    return cluster;
}

/// Films push and twist a free cluster by nothing as a whole. Forces that have lost their part along the film do, a little;
/// the smallest change of the forces along the normals per area that mends it is made. [method sheet 16.4 c']
void remove_rigid_residual(const NormalProblem& p, std::size_t cluster, const std::vector<std::size_t>& cluster_of, std::vector<double>& force) {
    std::vector<std::size_t> members;
    Vec3 center;
    double area = 0.0;
    for (std::size_t i = 0; i < p.coarse.size(); ++i) {
        const std::size_t r = region_of(p.coarse, i);
        if (cluster_of[r] != cluster) continue;
        if (!p.gas[r].closed) return;  // a film on a wire is held
        members.push_back(i);
        center += p.geometry.area[i] * p.coarse.position[i];
        area += p.geometry.area[i];
    }
    if (members.empty()) return;
    center = center / area;
    const double length = std::sqrt(area);
    constexpr std::size_t kRigid = 6;
    const auto rigid = [&](std::size_t i, const Vec3& f) {
        const Vec3 twist = cross(p.coarse.position[i] - center, f) / length;
        return std::array<double, kRigid>{f[0], f[1], f[2], twist[0], twist[1], twist[2]};
    };
    std::array<double, kRigid * kRigid> matrix{};
    std::array<double, kRigid> residual{};
    for (const std::size_t i : members) {
        const auto e = rigid(i, p.geometry.normal[i]);
        const Vec3 whole = force[i] * p.geometry.normal[i] + p.internal[i] + (p.floating ? p.external[i] : Vec3{});
        const auto f = rigid(i, whole);
        for (std::size_t a = 0; a < kRigid; ++a) {
            residual[a] += f[a];
            for (std::size_t b = 0; b < kRigid; ++b) matrix[a * kRigid + b] += p.geometry.area[i] * e[a] * e[b];
        }
    }
    // A sphere cannot be twisted by forces along its normals: such directions stay as they are.
    constexpr double kCannot = 1e-4;
    const auto z = linalg::solve_symmetric(kRigid, matrix, residual, kCannot).x;
    for (const std::size_t i : members) {
        const auto e = rigid(i, p.geometry.normal[i]);
        for (std::size_t a = 0; a < kRigid; ++a) force[i] -= p.geometry.area[i] * e[a] * z[a];
    }
}

/// How forces of tension and cohesion change with velocities along the normals.
class FilmStiffness {
public:
    FilmStiffness(const NormalProblem& p, const Pairs& pairs) : p_(p), pairs_(pairs), diagonal_(p.coarse.size()) {
        const Neighbors& same = p.geometry.neighbors.same;
        const Neighbors& other = p.geometry.neighbors.other;
        parallel_for(diagonal_.size(), [&](std::size_t i) {
            double sum = pairs.own[i] * p.geometry.area[i] * p.geometry.squared_curvature[i];
            for (std::size_t k = same.begin(i); k < same.end(i); ++k) sum -= pairs.same[k];
            for (std::size_t k = other.begin(i); k < other.end(i); ++k) sum -= pairs.other[k];
            diagonal_[i] = sum;
        });
    }

    double diagonal(std::size_t i) const { return diagonal_[i]; }

    /// (J_film v)_i
    template <class Values>
    double apply(const Values& v, std::size_t i) const {
        const Neighbors& same = p_.geometry.neighbors.same;
        const Neighbors& other = p_.geometry.neighbors.other;
        const std::vector<Vec3>& n = p_.geometry.normal;
        double sum = diagonal_[i] * v[i];
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) sum += pairs_.same[k] * v[same.index[k]];
        for (std::size_t k = other.begin(i); k < other.end(i); ++k)
            sum += pairs_.other[k] * dot(n[i], n[other.index[k]]) * v[other.index[k]];
        return sum;
    }

private:
    const NormalProblem& p_;
    const Pairs& pairs_;
    std::vector<double> diagonal_;
};

/// sum of a v over each region: how fast its gas grows [m^3/s].
std::vector<double> growth(const NormalProblem& p, const std::vector<double>& v) {
    std::vector<double> sum(p.gas.size(), 0.0);
    for (std::size_t i = 0; i < v.size(); ++i) sum[region_of(p.coarse, i)] += p.geometry.area[i] * v[i];
    return sum;
}

}  // namespace

NormalStep move_along_normals(const NormalProblem& p) {
    const std::size_t count = p.coarse.size();
    const Pairs pairs = pair_strengths(p);
    std::vector<double> force = forces(p, pairs);
    const std::vector<std::size_t> cluster_of = clusters(p);
    for (std::size_t r = 0; r < p.gas.size(); ++r)
        if (cluster_of[r] == r) remove_rigid_residual(p, r, cluster_of, force);

    const FilmStiffness stiffness(p, pairs);
    const double implicit = p.theta * p.theta * p.dt * p.dt, mixed = p.theta * (1.0 - p.theta) * p.dt * p.dt;
    std::vector<double> gas(p.gas.size());  // dt^2 p / V
    for (std::size_t r = 0; r < gas.size(); ++r)
        gas[r] = p.gas[r].closed ? p.dt * p.dt * p.gas[r].amount / (p.gas[r].volume * p.gas[r].volume) : 0.0;
    std::vector<double> inertia(count), right(count), scale(count);
    parallel_for(count, [&](std::size_t i) {
        const double a = p.geometry.area[i];
        inertia[i] = p.mass[i] * (1.0 + p.dt * p.damping);
        right[i] = p.mass[i] * p.velocity[i] + p.dt * (force[i] + dot(p.external[i], p.geometry.normal[i])) +
                   mixed * stiffness.apply(p.velocity, i);
        scale[i] = 1.0 / (inertia[i] - implicit * stiffness.diagonal(i) + gas[region_of(p.coarse, i)] * a * a);
    });
    const auto apply = [&](const std::vector<double>& v, std::vector<double>& y) {
        y.resize(count);
        const std::vector<double> grown = growth(p, v);
        parallel_for(count, [&](std::size_t i) {
            const std::size_t r = region_of(p.coarse, i);
            y[i] = inertia[i] * v[i] - implicit * stiffness.apply(v, i) + gas[r] * grown[r] * p.geometry.area[i];
        });
    };
    NormalStep step;
    step.velocity.assign(p.velocity.begin(), p.velocity.end());
    constexpr int kMostIterations = 2000;
    step.solution = linalg::conjugate_gradient(apply, scale, right, step.velocity, p.tolerance, kMostIterations);
    step.mean.resize(count);
    for (std::size_t i = 0; i < count; ++i) step.mean[i] = p.theta * step.velocity[i] + (1.0 - p.theta) * p.velocity[i];
    return step;
}

}  // namespace lamella::melp
