#pragma once

#include "lamella/linalg/ldlt.h"
#include "lamella/solvers/equilibrium/rest_system.h"

#include <cstddef>
#include <vector>

namespace lamella::equilibrium {

/// What Newton's method is after.
enum class Goal {
    kMinimum,     ///< shifts the Hessian where it is not positive: leaves saddles
    kStationary,  ///< no shift: finds saddles too
};

/// One step and where it led.
struct NewtonReport {
    double residual = 0.0;       ///< |g - G p| / scale before the step
    double missing = 0.0;        ///< largest |target - volume| / target before the step
    bool accepted = false;       ///< false: no shorter step lowers the area; positions are unchanged
    double longest_move = 0.0;   ///< of a node, relative to the mean edge at it
    int index = 0;               ///< negative eigenvalues of the Hessian at fixed volumes, before the step
};

/// Newton's method on the Lagrangian in the normal space, volumes by their Schur complement.
///
///   (K + shift M) x = -g,  (K + shift M) Y = G,  S = G^T Y,  S p = missing - G^T x,  dx = x + Y p
///
/// The number of negative eigenvalues of K on the space of fixed volumes is neg(K) - neg(S). While there are any, a
/// minimizer adds M until there are none. Steps are cut to 0.7 of the edges, and halved until the area at the target
/// volumes falls, or the residual does.
class Newton {
public:
    Newton(RestSystem& system, Goal goal) : system_(system), goal_(goal) {}

    NewtonReport step();
    /// Steps until the residual is below `tolerance` and the volumes are right to 1e-10, at most `most_steps`.
    /// @returns true when it is there
    bool solve(double tolerance, int most_steps);

    const std::vector<double>& pressure() const { return pressure_; }
    const NewtonReport& last() const { return last_; }
    int steps() const { return steps_; }

private:
    struct Direction {
        std::vector<double> dx;
        std::vector<double> pressure;
        int index = 0;
        bool solved = false;
    };
    Direction direction(const Balance& balance, double shift);
    bool accept_shortened(const Balance& before, const std::vector<double>& dx, double residual);

    RestSystem& system_;
    Goal goal_;
    linalg::Ldlt factors_;
    bool analyzed_ = false;
    double shift_ = 0.0;  ///< times M, in units of 1 / length^2
    std::vector<double> pressure_;
    NewtonReport last_;
    int steps_ = 0;
};

}  // namespace lamella::equilibrium
