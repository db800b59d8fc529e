#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/film_preconditioner.h"
#include "lamella/solvers/melp/film_stiffness.h"
#include "lamella/solvers/melp/flight.h"
#include "lamella/solvers/melp/normal_motion.h"
#include "lamella/solvers/melp/pair_forces.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

// The matrix of move_along_normals() and its parts. All of them read the problem and each other, which have to outlive
// them.

namespace lamella::melp {

/// What a change of the velocities has to overcome, M (1 + dt damping + dt shape_damping (1 - F)): the masses with the
/// drag on them, and the damping of shapes, which lose what their films move beside the flight of their regions; the
/// springs of walls count here, too.
class Inertia {
public:
    Inertia(const NormalProblem& problem, const Flight& flight, std::span<const Spring> walls);

    /// Of a film that flies as a whole. [kg]
    const std::vector<double>& rigid() const { return rigid_; }

    double diagonal(std::size_t i) const { return rigid_[i] + shape_ * p_.mass[i]; }

    /// Of velocities along the normals the momenta that it takes to get there. [kg m/s]
    std::vector<double> momenta(const std::vector<double>& v) const;

private:
    const NormalProblem& p_;
    const Flight& flight_;
    double shape_;
    std::vector<double> rigid_;
};

/// How gas resists: g b b^T for each region, with the areas b that it pushes on and g = dt^2 p / V.
class GasStiffness {
public:
    explicit GasStiffness(const NormalProblem& problem);

    double area(std::size_t i) const { return area_[i]; }
    double stiffness(std::size_t r) const { return stiffness_[r]; }

    /// How fast the gas of each region grows. [m^3/s]
    std::vector<double> growth(const std::vector<double>& v) const;

private:
    const NormalProblem& p_;
    std::vector<double> area_;
    std::vector<double> stiffness_;
};

/// What stands before v1 in eq. 10: inertia, gas and films.
class NormalMatrix {
public:
    NormalMatrix(const NormalProblem& problem,
                 const Flight& flight,
                 const Inertia& inertia,
                 const GasStiffness& gas,
                 FilmStiffness& films);

    /// y = A v
    void apply(const std::vector<double>& v, std::vector<double>& y);

    /// v about A^-1 u: what FilmPreconditioner makes of inertia and films, P^-1, with the gases, P + sum_r g_r b_r
    /// b_r^T, inverted exactly as each particle belongs to one gas (Sherman and Morrison). Without them each bubble of
    /// a foam has a stiff direction of its own, and takes an iteration.
    void precondition(const std::vector<double>& u, std::vector<double>& v);

private:
    using Whole = Vec<4>;  // what a region does as a whole: its momentum sum m v n, and how its gas grows

    const NormalProblem& p_;
    const Flight& flight_;
    const GasStiffness& gas_;
    FilmStiffness& films_;
    double implicit_, shape_;
    std::vector<double> inertia_;  // its diagonal
    std::vector<Whole> whole_;     // per velocity, of each particle
    std::optional<FilmPreconditioner> without_gas_;
    std::vector<double> yield_;  // P^-1 b
    std::vector<double> share_;  // g / (1 + g b P^-1 b) per region
};

}  // namespace lamella::melp
