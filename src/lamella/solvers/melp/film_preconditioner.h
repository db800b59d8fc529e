#pragma once

#include "lamella/solvers/melp/geometry.h"

#include <span>
#include <vector>

namespace lamella::melp {

/// About the inverse of the inertia of films and their stiffness along the normals, of which D is the diagonal:
///
///   P^-1 = D^-1 + E W E,   E_i^2 = beta a_i / D_i,   1 / beta = mean inertia / D
///
/// with the kernel's weights W, whose products are averages over the film around each particle. Springs at folds make D
/// large, but hold no wave that a patch follows: what W keeps has the inertia and the tension against it only, and
/// moves beta times as far. Halves the iterations of a packed foam. Without springs W costs as much as it saves, and is
/// left out.
class FilmPreconditioner {
public:
    /// It reads the geometry, which has to outlive it.
    FilmPreconditioner(const Geometry& geometry,
                       std::span<const double> inertia,
                       std::span<const double> diagonal,
                       bool springs);

    /// v = P^-1 u
    void apply(const std::vector<double>& u, std::vector<double>& v);

private:
    const Neighbors& same_;
    std::vector<double> scale_;   // 1 / D
    std::vector<double> smooth_;  // E; empty: no springs
    std::vector<double> eased_;   // E u
};

}  // namespace lamella::melp
