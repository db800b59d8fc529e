#include "lamella/solvers/melp/normal_matrix.h"

#include "lamella/solvers/melp/free_clusters.h"
#include "lamella/solvers/melp/loops.h"

namespace lamella::melp {
namespace {

std::size_t region_of(const CoarseParticles& coarse, std::size_t i) {
    return static_cast<std::size_t>(coarse.region[i]);
}

}  // namespace

Inertia::Inertia(const NormalProblem& p, const Flight& flight, std::span<const Spring> walls)
    : p_(p), flight_(flight), shape_(p.dt * p.shape_damping), rigid_(p.coarse.size()) {
    for_each_particle(rigid_.size(), [&](std::size_t i) {
        rigid_[i] = p.mass[i] * (1.0 + p.dt * p.damping) + p.dt * p.dt * walls[i].stiffness;
    });
}

std::vector<double> Inertia::momenta(const std::vector<double>& v) const {
    std::vector<double> momentum(v.size());
    const std::vector<Vec3> flight = flight_.of(v);
    for_each_particle(v.size(), [&](std::size_t i) {
        const double flown = dot(flight[region_of(p_.coarse, i)], p_.geometry.normal[i]);
        momentum[i] = diagonal(i) * v[i] - shape_ * p_.mass[i] * flown;
    });
    return momentum;
}

GasStiffness::GasStiffness(const NormalProblem& p)
    : p_(p), area_(gas_areas(p.coarse, p.geometry, p.gas, p.rims)), stiffness_(p.gas.size(), 0.0) {
    for (std::size_t r = 0; r < stiffness_.size(); ++r) {
        const Gas& gas = p.gas[r];
        if (gas.closed) stiffness_[r] = p.dt * p.dt * gas.amount / (gas.volume * gas.volume);
    }
}

std::vector<double> GasStiffness::growth(const std::vector<double>& v) const {
    return sum_over_regions(p_.coarse.region, p_.gas.size(), [&](std::size_t i) { return area_[i] * v[i]; });
}

NormalMatrix::NormalMatrix(
    const NormalProblem& p, const Flight& flight, const Inertia& inertia, const GasStiffness& gas, FilmStiffness& films)
    : p_(p),
      flight_(flight),
      gas_(gas),
      films_(films),
      implicit_(p.theta * p.theta * p.dt * p.dt),
      shape_(p.dt * p.shape_damping),
      inertia_(p.coarse.size()),
      whole_(p.coarse.size()),
      share_(p.gas.size()) {
    const std::size_t count = p.coarse.size();
    std::vector<double> diagonal(count), pushed(count);
    for_each_particle(count, [&](std::size_t i) {
        const Vec3 flown = p.mass[i] * p.geometry.normal[i];
        inertia_[i] = inertia.diagonal(i);
        pushed[i] = gas.area(i);
        whole_[i] = {{flown[0], flown[1], flown[2], pushed[i]}};
        diagonal[i] = inertia_[i] - implicit_ * films.diagonal(i);
    });
    without_gas_.emplace(p.geometry, inertia_, diagonal, films.has_springs());
    without_gas_->apply(pushed, yield_);
    const std::vector<double> soft =  // b . P^-1 b
        sum_over_regions(p.coarse.region, p.gas.size(), [&](std::size_t i) { return pushed[i] * yield_[i]; });
    for (std::size_t r = 0; r < share_.size(); ++r) share_[r] = gas.stiffness(r) / (1.0 + gas.stiffness(r) * soft[r]);
}

void NormalMatrix::apply(const std::vector<double>& v, std::vector<double>& y) {
    y.resize(v.size());
    std::vector<Whole> whole =
        sum_over_regions(p_.coarse.region, p_.gas.size(), [&](std::size_t i) { return v[i] * whole_[i]; });
    for (std::size_t r = 0; r < whole.size(); ++r) {
        const Vec3 freed = -shape_ * flight_.of_momentum(r, {{whole[r][0], whole[r][1], whole[r][2]}});
        whole[r] = {{freed[0], freed[1], freed[2], gas_.stiffness(r) * whole[r][3]}};
    }
    films_.move(v);
    for_each_particle(v.size(), [&](std::size_t i) {
        y[i] = inertia_[i] * v[i] + dot(whole_[i], whole[region_of(p_.coarse, i)]) - implicit_ * films_.force(i);
    });
}

void NormalMatrix::precondition(const std::vector<double>& u, std::vector<double>& v) {
    without_gas_->apply(u, v);
    std::vector<double> held =
        sum_over_regions(p_.coarse.region, p_.gas.size(), [&](std::size_t i) { return gas_.area(i) * v[i]; });
    for (std::size_t r = 0; r < held.size(); ++r) held[r] *= share_[r];
    for_each_particle(u.size(), [&](std::size_t i) { v[i] -= held[region_of(p_.coarse, i)] * yield_[i]; });
}

}  // namespace lamella::melp
