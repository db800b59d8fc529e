#pragma once

// From vorticity and dilatation to velocity: u = grad Phi + J grad Psi.

#include "lamella/linalg/definite_solver.h"
#include "lamella/solvers/vortex_particle/operators.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <span>
#include <utility>
#include <vector>

namespace lamella::vortex_particle {

/// Whether films keep their shape; where they move, their equations are factored anew often, and between that the last
/// factors only precondition an iteration [method sheet 15.1].
enum class Films { kStill, kMoving };

/// The two Poisson equations of a film, factored once [method sheet 5.6, 10]:
///
///     K Psi = -Omega   Psi is constant along each wall: 0 on the outer one, and on the wall around a hole such that
///                      the circulation around it is what is given (this is the harmonic part of the flow)
///     K Phi = -D       walls let nothing through
///
/// Where film runs out at an open end, dPsi/dn = 0 and Phi = 0: it runs straight out, as much as comes.
/// Where Psi or Phi is free up to a constant, one value of each component is 0.
class FlowSolver {
public:
    explicit FlowSolver(const Surface& s, Films films = Films::kStill);

    /// Factors the equations of the film as it lies now [method sheet 15.1].
    void factorize(const Surface& s);
    /// Most iterations of an equation since the last call.
    int take_iterations() const { return std::exchange(iterations_, 0); }

    /// @param circulation       Omega_i [m^2/s]; sums to zero on a component without walls
    /// @param hole_circulation  one per loop of the surface, counterclockwise around the hole seen from the tip of the
    ///                          normal; outer loops are not read
    std::vector<double> stream_function(const Surface& s,
                                        std::span<const double> circulation,
                                        std::span<const double> hole_circulation) const;
    /// @param outflow  D_i [m^2/s]; sums to zero on each component
    std::vector<double> potential(const Surface& s, std::span<const double> outflow) const;

private:
    struct Poisson {
        VertexMatrix matrix;
        linalg::DefiniteSolver factors;

        Poisson(const Surface& s, std::vector<int> unknown, Films films);
        void factorize(const Surface& s);
        std::vector<double> solve(const Surface& s,
                                  const std::vector<double>& right,
                                  bool lagging,
                                  int& iterations) const;

    private:
        std::vector<double> sums(std::span<const double> at_vertices) const;
        std::vector<double> spread(const std::vector<double>& x) const;
    };
    Poisson stream_, potential_;
    bool lagging_;
    mutable int iterations_ = 0;
};

/// (diag(mass) + scale K_w) x = b with a factorization that is kept while mass, scale and weights stay the same.
class ShiftedStiffness {
public:
    explicit ShiftedStiffness(const Surface& s, Films films = Films::kStill);

    /// @throws NumericalError  the matrix is not definite
    void factorize(const Surface& s, double scale, std::span<const double> weight, std::span<const double> mass);
    void solve(std::span<double> x) const { factors_.solve(x); }
    void precondition(std::span<double> x) const { factors_.precondition(x); }
    /// The same where film, mass, scale or weights are others by now than those that were factored.
    /// @returns  iterations
    int solve_lagging(const Surface& s,
                      double scale,
                      std::span<const double> weight,
                      std::span<const double> mass,
                      std::vector<double>& x) const;

private:
    VertexMatrix matrix_;
    linalg::DefiniteSolver factors_;
};

}  // namespace lamella::vortex_particle
