#include "lamella/solvers/melp/normal_motion.h"

#include "lamella/solvers/melp/film_stiffness.h"
#include "lamella/solvers/melp/flight.h"
#include "lamella/solvers/melp/fold_springs.h"
#include "lamella/solvers/melp/free_clusters.h"
#include "lamella/solvers/melp/loops.h"
#include "lamella/solvers/melp/normal_matrix.h"
#include "lamella/solvers/melp/pair_forces.h"

namespace lamella::melp {
namespace {

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
        force[i] +=
            folds.force(i) +
            p.gas[static_cast<std::size_t>(p.coarse.region[i])].gauge_pressure(p.outside_pressure) * gas.area(i);
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
    std::vector<double> added = inertia.momenta(velocity);
    for_each_particle(added.size(), [&](std::size_t i) { added[i] -= given[i]; });
    const std::vector<double> before = added;
    const std::vector<Vec3> nothing(added.size());
    for (const FreeCluster& cluster : free) cluster.remove_resultant(added, nothing, inertia.rigid());
    for_each_particle(added.size(), [&](std::size_t i) { velocity[i] += (added[i] - before[i]) / inertia.rigid()[i]; });
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
    const FoldSprings folds(p, pairs);
    FilmStiffness films(p, pairs, folds);
    const GasStiffness gas(p);
    const std::vector<double> given = given_momentum(p, pairs, folds, gas, walls, free);

    const double mixed = p.theta * (1.0 - p.theta) * p.dt * p.dt;
    std::vector<double> right(count);
    if (mixed > 0.0) films.move(p.velocity);
    for_each_particle(count, [&](std::size_t i) {
        right[i] = given[i] + p.theta * p.dt * p.dt * films.of_rims(i);
        if (mixed > 0.0) right[i] += mixed * films.force(i);
    });
    NormalMatrix matrix(p, flight, inertia, gas, films);
    NormalStep step;
    step.velocity.assign(p.velocity.begin(), p.velocity.end());
    constexpr int kMostIterations = 2000;
    step.solution = linalg::preconditioned_conjugate_gradient(
        [&](const std::vector<double>& v, std::vector<double>& y) { matrix.apply(v, y); },
        [&](const std::vector<double>& u, std::vector<double>& v) { matrix.precondition(u, v); }, right, step.velocity,
        p.tolerance, kMostIterations);
    keep_resultant(inertia, given, free, step.velocity);
    step.mean.resize(count);
    for_each_particle(
        count, [&](std::size_t i) { step.mean[i] = p.theta * step.velocity[i] + (1.0 - p.theta) * p.velocity[i]; });
    step.swept = gas.growth(step.velocity);
    for (double& volume : step.swept) volume *= p.dt;
    return step;
}

}  // namespace lamella::melp
