#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/options.h"
#include "lamella/solvers/melp/particles.h"

#include <span>

namespace lamella::melp {

/// What heat does to a film, and where it comes from: the air, which is warmer or colder in one place. Films are so
/// thin that they take the air's temperature within a tenth of a second: for a film of 500 nm with 10 W/(m^2 K) on each
/// side, rho eta c / (2 h) = 0.1 s.
class Heat {
public:
    Heat() = default;
    /// @param options  [melp.heat]  @param temperature  T_0 of the air elsewhere, and of films at the start [K]
    /// @param up       unit, against gravity
    Heat(const HeatOptions& options, double temperature, const Vec3& up)
        : options_(options), rest_(temperature), up_(up) {}

    bool on() const { return options_.source != HeatSource::kNone; }
    /// Of the air at a place [K].
    double air(const Vec3& x) const;
    /// Fine particles come nearer to the air's: dT/dt = (T_air - T) / time. [method sheet 9]
    void warm(double dt, FineParticles& fine) const;

    /// How much tenser an interface is than at T_0, its surfactant aside [N/m].
    double extra_tension(double temperature) const {
        return on() ? options_.tension_slope * (temperature - rest_) : 0.0;
    }
    /// What surfactant pushes with at this temperature, over what it does at T_0: it is a gas of two dimensions.
    double pressure_factor(double temperature) const { return on() ? temperature / rest_ : 1.0; }
    /// Of the weight along the film, 1 as films weigh the same however warm they are; less for warm ones in [Deng22].
    double weight_factor(double temperature) const {
        return on() ? 1.0 - options_.buoyancy * (temperature - rest_) : 1.0;
    }

private:
    HeatOptions options_;
    double rest_ = 0.0;
    Vec3 up_;
};

}  // namespace lamella::melp
