#include "lamella/solvers/melp/normal_motion.h"

#include "lamella/solvers/melp/flight.h"
#include "lamella/solvers/melp/fold_springs.h"
#include "lamella/solvers/melp/free_clusters.h"
#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/pair_forces.h"

namespace lamella::melp {
namespace {

std::size_t region_of(const CoarseParticles& coarse, std::size_t i) {
    return static_cast<std::size_t>(coarse.region[i]);
}

/// What a change of the velocities has to overcome, M (1 + dt damping + dt shape_damping (1 - F)): the masses with the
/// drag on them, and the damping of shapes, which lose what their films move beside the flight of their regions; the
/// springs of walls count here, too.
class Inertia {
public:
    Inertia(const NormalProblem& p, const Flight& flight, std::span<const Spring> walls)
        : p_(p), flight_(flight), shape_(p.dt * p.shape_damping), rigid_(p.coarse.size()) {
        for_each_particle(rigid_.size(), [&](std::size_t i) {
            rigid_[i] = p.mass[i] * (1.0 + p.dt * p.damping) + p.dt * p.dt * walls[i].stiffness;
        });
    }

    /// Of a film that flies as a whole. [kg]
    const std::vector<double>& rigid() const { return rigid_; }

    double diagonal(std::size_t i) const { return rigid_[i] + shape_ * p_.mass[i]; }

    void apply(const std::vector<double>& v, std::vector<double>& y) const {
        y.resize(v.size());
        std::vector<Vec3> flight(p_.gas.size());
        if (shape_ > 0.0) flight = flight_.of(v);
        for_each_particle(v.size(), [&](std::size_t i) {
            const double flown = dot(flight[region_of(p_.coarse, i)], p_.geometry.normal[i]);
            y[i] = diagonal(i) * v[i] - shape_ * p_.mass[i] * flown;
        });
    }

private:
    const NormalProblem& p_;
    const Flight& flight_;
    double shape_;
    std::vector<double> rigid_;
};

/// How gas resists: g b b^T for each region, with the areas b that it pushes on and g = dt^2 p / V.
class GasStiffness {
public:
    explicit GasStiffness(const NormalProblem& p)
        : p_(p), area_(gas_areas(p.coarse, p.geometry, p.gas, p.rims)), stiffness_(p.gas.size(), 0.0) {
        for (std::size_t r = 0; r < stiffness_.size(); ++r) {
            const Gas& gas = p.gas[r];
            if (gas.closed) stiffness_[r] = p.dt * p.dt * gas.amount / (gas.volume * gas.volume);
        }
    }

    double area(std::size_t i) const { return area_[i]; }
    double stiffness(std::size_t r) const { return stiffness_[r]; }

    /// How fast the gas of each region grows. [m^3/s]
    std::vector<double> growth(const std::vector<double>& v) const {
        return sum_over_regions(p_.coarse.region, p_.gas.size(), [&](std::size_t i) { return area_[i] * v[i]; });
    }

private:
    const NormalProblem& p_;
    std::vector<double> area_;
    std::vector<double> stiffness_;
};

/// What dampens CG's errors: the diagonal of masses and films with the gases, D + sum_r g_r b_r b_r^T, inverted exactly
/// as each particle belongs to one gas (Sherman and Morrison). With the diagonal alone each bubble of a foam has a
/// stiff direction of its own, and takes an iteration.
class GasPreconditioner {
public:
    /// @param scale  1 / D
    GasPreconditioner(const NormalProblem& p, const GasStiffness& gas, const std::vector<double>& scale)
        : p_(p), gas_(gas), scale_(scale), share_(p.gas.size(), 0.0) {
        const std::vector<double> soft =  // b D^-1 b
            sum_over_regions(p.coarse.region, p.gas.size(),
                             [&](std::size_t i) { return gas.area(i) * gas.area(i) * scale[i]; });
        for (std::size_t r = 0; r < share_.size(); ++r)
            share_[r] = gas.stiffness(r) / (1.0 + gas.stiffness(r) * soft[r]);
    }

    void operator()(const std::vector<double>& u, std::vector<double>& v) const {
        v.resize(u.size());
        for_each_particle(u.size(), [&](std::size_t i) { v[i] = scale_[i] * u[i]; });
        const std::vector<double> grown = gas_.growth(v);
        for_each_particle(u.size(), [&](std::size_t i) {
            const std::size_t r = region_of(p_.coarse, i);
            v[i] -= share_[r] * grown[r] * scale_[i] * gas_.area(i);
        });
    }

private:
    const NormalProblem& p_;
    const GasStiffness& gas_;
    const std::vector<double>& scale_;
    std::vector<double> share_;
};

/// M v0 + dt F0: what velocities and forces at the start of the step give. [kg m/s]
std::vector<double> given_momentum(const NormalProblem& p,
                                   const Pairs& pairs,
                                   const FoldSprings& folds,
                                   const GasStiffness& gas,
                                   std::span<const Spring> walls,
                                   const std::vector<FreeCluster>& free) {
    const std::size_t count = p.coarse.size();
    std::vector<double> force = pair_forces(p, pairs);
    for_each_particle(count, [&](std::size_t i) {
        force[i] += folds.force(i) + p.gas[region_of(p.coarse, i)].gauge_pressure(p.outside_pressure) * gas.area(i);
    });
    std::vector<Vec3> beside(p.internal.begin(), p.internal.end());
    for (std::size_t i = 0; p.floating && i < count; ++i) beside[i] += p.external[i];
    for (const FreeCluster& cluster : free) cluster.remove_resultant(force, beside, p.geometry.area);
    std::vector<double> given(count);
    for_each_particle(count, [&](std::size_t i) {
        const double outer = dot(p.external[i], p.geometry.normal[i]) + walls[i].force;
        given[i] = p.mass[i] * p.velocity[i] + p.dt * (force[i] + outer);
    });
    return given;
}

/// What the implicit terms have added pushes nothing as a whole either: a rigid motion mends that, which strains no
/// film.
void keep_resultant(const Inertia& inertia,
                    const std::vector<double>& given,
                    const std::vector<FreeCluster>& free,
                    std::vector<double>& velocity) {
    std::vector<double> added;
    inertia.apply(velocity, added);
    for (std::size_t i = 0; i < added.size(); ++i) added[i] -= given[i];
    const std::vector<double> before = added;
    const std::vector<Vec3> nothing(added.size());
    for (const FreeCluster& cluster : free) cluster.remove_resultant(added, nothing, inertia.rigid());
    for (std::size_t i = 0; i < added.size(); ++i) velocity[i] += (added[i] - before[i]) / inertia.rigid()[i];
}

}  // namespace

NormalStep move_along_normals(const NormalProblem& p) {
    const std::size_t count = p.coarse.size();
    const Pairs pairs = pair_strengths(p);
    std::vector<Spring> walls(count);
    for_each_particle(count, [&](std::size_t i) { walls[i] = spring_of_walls(p, i); });
    const Flight flight(p.geometry, p.coarse, p.mass, p.gas.size());
    const std::vector<Tensor> maps = p.even ? flight.over_sphere() : std::vector<Tensor>{};
    const std::vector<FreeCluster> free = free_clusters(p.coarse, p.geometry, p.gas, p.rims, maps);
    const Inertia inertia(p, flight, walls);
    const FilmStiffness films(p, pairs);
    const FoldSprings folds(p, pairs);
    const GasStiffness gas(p);
    const std::vector<double> given = given_momentum(p, pairs, folds, gas, walls, free);

    const double implicit = p.theta * p.theta * p.dt * p.dt, mixed = p.theta * (1.0 - p.theta) * p.dt * p.dt;
    std::vector<double> right(count), scale(count);
    for_each_particle(count, [&](std::size_t i) {
        right[i] = given[i] + mixed * films.apply(p.velocity, i) + p.theta * p.dt * p.dt * films.of_rims(i);
        scale[i] = 1.0 / (inertia.diagonal(i) - implicit * films.diagonal(i) + p.dt * p.dt * folds.diagonal(i));
    });
    const auto apply = [&](const std::vector<double>& v, std::vector<double>& y) {
        inertia.apply(v, y);
        const std::vector<double> grown = gas.growth(v), strain = folds.strain(v);
        for_each_particle(count, [&](std::size_t i) {
            const std::size_t r = region_of(p.coarse, i);
            y[i] += p.dt * p.dt * folds.product(strain, i) + gas.stiffness(r) * grown[r] * gas.area(i) -
                    implicit * films.apply(v, i);
        });
    };
    NormalStep step;
    step.velocity.assign(p.velocity.begin(), p.velocity.end());
    constexpr int kMostIterations = 2000;
    step.solution = linalg::preconditioned_conjugate_gradient(apply, GasPreconditioner(p, gas, scale), right,
                                                              step.velocity, p.tolerance, kMostIterations);
    keep_resultant(inertia, given, free, step.velocity);
    step.mean.resize(count);
    for (std::size_t i = 0; i < count; ++i) step.mean[i] = p.theta * step.velocity[i] + (1.0 - p.theta) * p.velocity[i];
    step.swept = gas.growth(step.velocity);
    for (double& volume : step.swept) volume *= p.dt;
    return step;
}

}  // namespace lamella::melp
