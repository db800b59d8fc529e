#pragma once

// The inertia of the air that a film moves.

#include "lamella/linalg/definite_solver.h"
#include "lamella/solvers/vortex_particle/operators.h"
#include "lamella/solvers/vortex_particle/surface.h"

#include <span>
#include <vector>

namespace lamella::vortex_particle {

/// A film that moves along its normal with the speed v pushes air on both sides. On a sphere that has the inertia
/// rho R (1 / l + 1 / (l + 1)) per area for the mode l, above a plane 2 rho / k for the wave number k. Both are
///
///     m = rho sqrt(4 L + G) / L,   L = -Laplacian of the film, G = 1 / R^2 (plane: 0),
///
/// and that is taken for all films, G the mean Gaussian curvature of each. (The method sheet's 5.2 has a number per
/// vertex, which can be right for one mode only.) The root is an integral, and that a sum:
///
///     m = rho [sqrt(G) / L + (1 / pi) int_(G/4)^inf sqrt(4 s - G) / (s (L + s)) ds]
///       = rho [c + sum_j w_j / (L + s_j)],   s_j = G / 4 + exp(y_j), y_j two apart: to 1e-4
///
/// It is symmetric and positive. 1 / L leaves out that a closed film grows as a whole, which gas does not let it. Air
/// that films hand to each other across a gap is not in it.
class AirMass {
public:
    /// @param still  vertices that do not move
    AirMass(const Surface& s, double density, const std::vector<std::uint8_t>& still);

    /// Takes the film as it lies now.
    void factorize(const Surface& s);
    /// momentum_i += the air's, of speeds v_i along vertex normals [kg m/s]
    void add(std::span<const double> speed, std::span<double> momentum) const;
    /// For `yield`: of a film of `mass` per area [kg/m^2] whose tension acts within a step like the inertia
    /// stiffness L, [kg].
    void fit_inverse(double mass, double stiffness);
    /// speed = about (area (mass + m + stiffness L))^-1 momentum, by the same equations in another sum. Good to some
    /// percent as long as the film is even: it preconditions.
    void yield(std::span<const double> momentum, std::span<double> speed) const;

private:
    void factor(const Surface& s, const std::vector<double>& shift, const std::vector<double>& weight);
    void remove_mean(std::vector<double>& density) const;

    std::vector<std::vector<double>> solutions(std::span<const double> right) const;

    struct Term {
        double weight;   ///< w_j
        double shift;    ///< s_j [1/m^2]
        double inverse;  ///< its part in the film's yielding
        linalg::DefiniteSolver factors;
    };
    double density_, constant_ = 0.0;
    double longest_ = 0.0, shortest_ = 0.0;  ///< L of waves, about [1/m^2]
    VertexMatrix matrix_;
    std::vector<Term> terms_;
    std::vector<double> area_;  ///< of vertices when it was factored
    std::vector<std::uint32_t> component_;
    std::vector<double> closed_;  ///< area of each component that nothing holds, else 0 [m^2]
};

}  // namespace lamella::vortex_particle
