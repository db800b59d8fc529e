#include "lamella/solvers/melp/normal_motion.h"

#include "lamella/solvers/melp/flight.h"
#include "lamella/solvers/melp/free_clusters.h"
#include "lamella/solvers/melp/loops.h"

#include <algorithm>
#include <cmath>

namespace lamella::melp {

Cohesion cohesion(double gamma, double beta) {
    // Beyond 1 the attraction falls as fast as this: with gamma^-2 borders of three bubbles crumpled, without a fall
    // single particles were drawn into the point where three bubbles and the air meet.
    constexpr double kPower = 6.0;
    const double shared = std::min(gamma, 1.0), excess = std::max(gamma, 1.0);
    const double slope = gamma < 1.0 ? 1.0 + beta * (1.0 - 2.0 * gamma) : (1.0 - beta) * std::pow(gamma, -kPower);
    const double f = shared + beta * shared * (1.0 - shared) +
                     (1.0 - beta) * (1.0 - std::pow(excess, 1.0 - kPower)) / (kPower - 1.0);
    return {2.0 - f - gamma * slope, slope};
}

namespace {

std::size_t region_of(const CoarseParticles& coarse, std::size_t i) {
    return static_cast<std::size_t>(coarse.region[i]);
}

/// What keeps films that fly at each other from passing through, as a spring along the normals of a pair: it is
/// strained where particle i stands deeper in the other bubble than films may. Gas alone presses joined films a quarter
/// of a spacing into each other; those that have not joined keep a spacing of air between them.
struct Spring {
    double stiffness = 0.0;  ///< force along n_i over the velocity along n_i, or along n_j, times the time [N/m]
    double force = 0.0;      ///< along n_i, into the own bubble [N]
};

/// Strengths of the pairs: c_ij, of one region and of two. [N/m]
struct Pairs {
    std::vector<double> own;    ///< tau_i per particle
    std::vector<double> same;   ///< per entry of neighbors.same
    std::vector<double> other;  ///< per entry of neighbors.other
    std::vector<double> image;  ///< per entry of images
    std::vector<Spring> push;   ///< per entry of neighbors.other: what keeps films apart
};

constexpr double kStiff = 36.0;  // of these springs and of walls, tension / support radius^2

Spring spring_between(const NormalProblem& p, std::size_t i, std::size_t k) {
    constexpr double kJoined = 0.5 / 3.0, kApart = -1.0 / 3.0;  // support radii, which are 3 spacings by default
    const Neighbors& other = p.geometry.neighbors.other;
    const std::size_t j = other.index[k];
    const double cosine = dot(p.geometry.normal[i], p.geometry.normal[j]);
    if (cosine > 0.0) return {};  // films that do not face each other
    const Vec3 between = (p.geometry.normal[i] - p.geometry.normal[j]) / std::sqrt(2.0 - 2.0 * cosine);
    const double reach = other.kernel.support_radius;
    const double share = p.joined.empty() ? 1.0 : p.joined[k];
    const double free = reach * (share * kJoined + (1.0 - share) * kApart);
    const double depth = dot(p.coarse.position[i] - p.coarse.position[j], between) - free;
    if (depth <= 0.0) return {};
    const double tension = p.interface_tension[i] + p.interface_tension[j];
    const double along = std::sqrt(0.5 * (1.0 - cosine));  // between . n_i
    const double pressure = kStiff * tension / (reach * reach) * other.weight[k];
    const double area = p.geometry.area[i] * p.geometry.area[j];
    return {area * pressure * along * along, area * pressure * along * depth};
}

/// The springs of all walls on one particle.
Spring spring_of_walls(const NormalProblem& p, std::size_t i) {
    const double reach = p.geometry.neighbors.same.kernel.support_radius;
    Spring all;
    for (const film::Wall& wall : p.walls) {
        const double depth = dot(wall.point - p.coarse.position[i], wall.normal);
        if (depth <= 0.0) continue;
        const double along = dot(wall.normal, p.geometry.normal[i]);
        const double stiffness = p.geometry.area[i] * kStiff * 2.0 * p.interface_tension[i] / (reach * reach);
        all.stiffness += stiffness * along * along;
        all.force += stiffness * along * depth;
    }
    return all;
}

Pairs pair_strengths(const NormalProblem& p) {
    const Neighbors& same = p.geometry.neighbors.same;
    const Neighbors& other = p.geometry.neighbors.other;
    const Images& images = p.geometry.images;
    const std::vector<double>& a = p.geometry.area;
    Pairs pairs;
    pairs.own.resize(a.size());
    pairs.same.resize(same.index.size());
    pairs.other.resize(other.index.size());
    pairs.image.resize(images.index.size());
    pairs.push.resize(other.index.size());
    std::vector<double> toward(a.size());  // sigma f'
    for_each_particle(a.size(), [&](std::size_t i) {
        double gamma = 0.0;
        for (std::size_t k = other.begin(i); k < other.end(i); ++k)
            gamma += (p.joined.empty() ? 1.0 : p.joined[k]) * a[other.index[k]] * other.weight[k];
        const Cohesion c = cohesion(gamma, p.junction_correction);
        pairs.own[i] = p.interface_tension[i] * c.own;
        toward[i] = p.interface_tension[i] * c.other;
    });
    for_each_particle(a.size(), [&](std::size_t i) {
        const auto strength = [&](const auto& list, std::size_t k, const std::vector<double>& tension) {
            const std::size_t j = list.index[k];
            return 0.5 * (tension[i] + tension[j]) * (a[i] * a[j]) * list.laplacian[k];
        };
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) pairs.same[k] = strength(same, k, pairs.own);
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
            pairs.other[k] = (p.joined.empty() ? 1.0 : p.joined[k]) * strength(other, k, toward);
            pairs.push[k] = spring_between(p, i, k);
        }
        for (std::size_t k = images.begin(i); k < images.end(i); ++k) pairs.image[k] = strength(images, k, pairs.own);
    });
    return pairs;
}

/// Tension, cohesion and gas pressure along the normals. [N]
std::vector<double> forces(const NormalProblem& p, const Pairs& pairs, const std::vector<double>& gas_area) {
    const Geometry& g = p.geometry;
    const std::vector<Vec3>& x = p.coarse.position;
    std::vector<double> force(g.size());
    for_each_particle(g.size(), [&](std::size_t i) {
        Vec3 pull;
        double push = p.gas[region_of(p.coarse, i)].gauge_pressure(p.outside_pressure) * gas_area[i];
        const Neighbors& same = g.neighbors.same;
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) pull += pairs.same[k] * (x[same.index[k]] - x[i]);
        const Neighbors& other = g.neighbors.other;
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
            pull += pairs.other[k] * (x[other.index[k]] - x[i]);
            push -= pairs.push[k].force;
        }
        const Images& images = g.images;
        for (std::size_t k = images.begin(i); k < images.end(i); ++k) pull += pairs.image[k] * (images.place[k] - x[i]);
        force[i] = dot(pull, g.normal[i]) + push;
    });
    return force;
}

/// How forces of tension and cohesion change with velocities along the normals.
class FilmStiffness {
public:
    FilmStiffness(const NormalProblem& p, const Pairs& pairs)
        : p_(p), pairs_(pairs), diagonal_(p.coarse.size()), other_(pairs.other.size()) {
        const Neighbors& same = p.geometry.neighbors.same;
        const Neighbors& other = p.geometry.neighbors.other;
        const std::vector<Vec3>& n = p.geometry.normal;
        for_each_particle(diagonal_.size(), [&](std::size_t i) {
            // At a junction films fold: full stiffness there, none of it forgiven for moving as a whole.
            const bool free = other.index.empty();
            double sum = 0.0;
            for (std::size_t k = same.begin(i); k < same.end(i); ++k)
                sum -= pairs.same[k] * (free ? dot(n[i], n[same.index[k]]) : 1.0);
            for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
                sum -= pairs.other[k] + pairs.push[k].stiffness;
                other_[k] = pairs.other[k] * dot(n[i], n[other.index[k]]) - pairs.push[k].stiffness;
            }
            const Images& images = p.geometry.images;
            for (std::size_t k = images.begin(i); k < images.end(i); ++k)
                sum -= pairs.image[k] * dot(n[i], images.normal[k]);
            diagonal_[i] = sum;
        });
    }

    double diagonal(std::size_t i) const { return diagonal_[i]; }

    /// (J_film v)_i
    template <class Values>
    double apply(const Values& v, std::size_t i) const {
        const Neighbors& same = p_.geometry.neighbors.same;
        const Neighbors& other = p_.geometry.neighbors.other;
        double sum = diagonal_[i] * v[i];
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) sum += pairs_.same[k] * v[same.index[k]];
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) sum += other_[k] * v[other.index[k]];
        const Images& images = p_.geometry.images;
        for (std::size_t k = images.begin(i); k < images.end(i); ++k)
            sum += pairs_.image[k] * images.mirrors[images.mirror[k]].sign * images.follow[k] * v[images.index[k]];
        return sum;
    }

    /// What the motion of rims adds to (J_film v)_i.
    double of_rims(std::size_t i) const {
        const Images& images = p_.geometry.images;
        double sum = 0.0;
        for (std::size_t k = images.begin(i); k < images.end(i); ++k)
            sum += pairs_.image[k] * dot(images.mirrors[images.mirror[k]].drift, images.normal[k]);
        return sum;
    }

private:
    const NormalProblem& p_;
    const Pairs& pairs_;
    std::vector<double> diagonal_;
    std::vector<double> other_;  // per entry of neighbors.other
};

/// sum of a v over each region: how fast its gas grows [m^3/s].
std::vector<double> growth(const NormalProblem& p, const std::vector<double>& gas_area, const std::vector<double>& v) {
    return sum_over_regions(p.coarse.region, p.gas.size(), [&](std::size_t i) { return gas_area[i] * v[i]; });
}

/// What dampens CG's errors: the diagonal of masses and films with the gases, D + sum_r g_r b_r b_r^T, inverted exactly
/// as each particle belongs to one gas (Sherman and Morrison). With the diagonal alone each bubble of a foam has a
/// stiff direction of its own, and takes an iteration.
class GasPreconditioner {
public:
    /// @param scale  1 / D   @param gas  g per region
    GasPreconditioner(const NormalProblem& p,
                      const std::vector<double>& gas_area,
                      const std::vector<double>& gas,
                      const std::vector<double>& scale)
        : p_(p), gas_area_(gas_area), scale_(scale), share_(gas.size(), 0.0) {
        const std::vector<double> soft =  // b D^-1 b
            sum_over_regions(p.coarse.region, gas.size(),
                             [&](std::size_t i) { return gas_area[i] * gas_area[i] * scale[i]; });
        for (std::size_t r = 0; r < gas.size(); ++r) share_[r] = gas[r] / (1.0 + gas[r] * soft[r]);
    }

    void operator()(const std::vector<double>& u, std::vector<double>& v) const {
        v.resize(u.size());
        for_each_particle(u.size(), [&](std::size_t i) { v[i] = scale_[i] * u[i]; });
        const std::vector<double> grown = growth(p_, gas_area_, v);
        for_each_particle(u.size(), [&](std::size_t i) {
            const std::size_t r = region_of(p_.coarse, i);
            v[i] -= share_[r] * grown[r] * scale_[i] * gas_area_[i];
        });
    }

private:
    const NormalProblem& p_;
    const std::vector<double>& gas_area_;
    const std::vector<double>& scale_;
    std::vector<double> share_;
};

}  // namespace

NormalStep move_along_normals(const NormalProblem& p) {
    const std::size_t count = p.coarse.size();
    const Pairs pairs = pair_strengths(p);
    const Flight flight(p.geometry, p.coarse, p.mass, p.gas.size());
    const std::vector<Tensor> maps = p.even ? flight.over_sphere() : std::vector<Tensor>{};
    const std::vector<FreeCluster> free = free_clusters(p.coarse, p.geometry, p.gas, p.rims, maps);
    const std::vector<double> gas_area = gas_areas(p.coarse, p.geometry, p.gas, p.rims);
    std::vector<double> force = forces(p, pairs, gas_area);
    std::vector<Vec3> beside(p.internal.begin(), p.internal.end());
    for (std::size_t i = 0; p.floating && i < count; ++i) beside[i] += p.external[i];
    for (const FreeCluster& cluster : free) cluster.remove_resultant(force, beside, p.geometry.area);

    const FilmStiffness stiffness(p, pairs);
    const double implicit = p.theta * p.theta * p.dt * p.dt, mixed = p.theta * (1.0 - p.theta) * p.dt * p.dt;
    std::vector<double> gas(p.gas.size());  // dt^2 p / V
    for (std::size_t r = 0; r < gas.size(); ++r)
        gas[r] = p.gas[r].closed ? p.dt * p.dt * p.gas[r].amount / (p.gas[r].volume * p.gas[r].volume) : 0.0;
    // Shapes lose what their films move beside the flight of their regions.
    const double shape = p.dt * p.shape_damping;
    const auto flown = [&](const std::vector<double>& v) { return shape > 0.0 ? flight.of(v) : std::vector<Vec3>{}; };
    const auto kept = [&](const std::vector<Vec3>& flown_by, std::size_t i) {
        return shape > 0.0 ? shape * p.mass[i] * dot(flown_by[region_of(p.coarse, i)], p.geometry.normal[i]) : 0.0;
    };
    std::vector<double> rigid(count), inertia(count), given(count), right(count), scale(count);
    for_each_particle(count, [&](std::size_t i) {
        const Spring walls = spring_of_walls(p, i);
        rigid[i] = p.mass[i] * (1.0 + p.dt * p.damping) + p.dt * p.dt * walls.stiffness;
        inertia[i] = rigid[i] + shape * p.mass[i];
        given[i] =
            p.mass[i] * p.velocity[i] + p.dt * (force[i] + dot(p.external[i], p.geometry.normal[i]) + walls.force);
        right[i] = given[i] + mixed * stiffness.apply(p.velocity, i) + p.theta * p.dt * p.dt * stiffness.of_rims(i);
        scale[i] = 1.0 / (inertia[i] - implicit * stiffness.diagonal(i));
    });
    const auto apply = [&](const std::vector<double>& v, std::vector<double>& y) {
        y.resize(count);
        const std::vector<double> grown = growth(p, gas_area, v);
        const std::vector<Vec3> flight_of_v = flown(v);
        for_each_particle(count, [&](std::size_t i) {
            const std::size_t r = region_of(p.coarse, i);
            y[i] = inertia[i] * v[i] - implicit * stiffness.apply(v, i) + gas[r] * grown[r] * gas_area[i] -
                   kept(flight_of_v, i);
        });
    };
    NormalStep step;
    step.velocity.assign(p.velocity.begin(), p.velocity.end());
    constexpr int kMostIterations = 2000;
    step.solution = linalg::preconditioned_conjugate_gradient(apply, GasPreconditioner(p, gas_area, gas, scale), right,
                                                              step.velocity, p.tolerance, kMostIterations);

    // What the implicit terms have added pushes nothing as a whole either: a rigid motion mends that, which strains no
    // film.
    const std::vector<Vec3> flight_of_step = flown(step.velocity);
    std::vector<double> added(count);
    for_each_particle(
        count, [&](std::size_t i) { added[i] = inertia[i] * step.velocity[i] - kept(flight_of_step, i) - given[i]; });
    const std::vector<double> before = added;
    const std::vector<Vec3> nothing(count);
    for (const FreeCluster& cluster : free) cluster.remove_resultant(added, nothing, rigid);
    step.mean.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        step.velocity[i] += (added[i] - before[i]) / rigid[i];
        step.mean[i] = p.theta * step.velocity[i] + (1.0 - p.theta) * p.velocity[i];
    }
    step.swept = growth(p, gas_area, step.velocity);
    for (double& volume : step.swept) volume *= p.dt;
    return step;
}

}  // namespace lamella::melp
