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
/// Where films flow on into each other over triple lines, Phi is the same on all of them, and lines are walls to Psi.
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
    };
    Poisson stream_, potential_;
    bool lagging_;
    mutable int iterations_ = 0;
};

/// (diag(mass) + scale K_w) x = b with a factorization that is kept while mass, scale and weights stay the same.
/// Vertices at one place are one unknown.
class ShiftedStiffness {
public:
    explicit ShiftedStiffness(const Surface& s, Films films = Films::kStill);

    /// @throws NumericalError  the matrix is not definite
    void factorize(const Surface& s, double scale, std::span<const double> weight, std::span<const double> mass);
    void solve(std::span<double> x) const { factors_.solve(x); }
    void precondition(std::span<double> x) const { factors_.precondition(x); }
    /// From vertices to its unknowns and back.
    const VertexMatrix& unknowns() const { return matrix_; }

private:
    VertexMatrix matrix_;
    linalg::DefiniteSolver factors_;
};

/// What viscosity does to densities omega of which the vertices hold Omega_i:
///
///     M omega + scale K omega = Omega,    Omega' = Omega - scale K omega
///
/// M is the mean of the vertices' areas and the integrals of phi_i phi_j. Each alone has an error of second order in
/// the edges, of opposite signs: swirls of five edges across fade by 5 % too slowly or too fast.
class Diffusion {
public:
    explicit Diffusion(const Surface& s, Films films = Films::kStill);

    /// @param scale  viscosity times step [m^2]
    void factorize(const Surface& s, double scale);
    void spread(const Surface& s, std::vector<double>& cells) const;
    /// The same where the film or `scale` are others by now than those that were factored.
    void spread_lagging(const Surface& s, double scale, std::vector<double>& cells) const;

private:
    VertexMatrix matrix_;
    linalg::DefiniteSolver factors_;
    double scale_ = 0.0;
};

}  // namespace lamella::vortex_particle
