#pragma once

#include "lamella/film/problem.h"

namespace lamella::film {

// Soap on the two interfaces of a film, spread as a dilute gas: the tension of ONE interface falls with what lies on
// it, sigma = sigma_0 - R T Gamma. A film that is stretched has less soap per area and pulls harder: it is elastic, and
// waves of its thickness run along it with the speed c = sqrt(2 R T Gamma_0 / (rho eta_0)).

inline constexpr double kGasConstant = 8.31446261815324;  ///< R [J/(mol K)]

/// R T [J/mol].
inline double thermal_energy(const Material& material) { return kGasConstant * material.temperature; }

/// Gamma_0 from the one of material.surfactant, .elasticity and .elastic_wave_speed that is given [mol/m^2]; a common
/// 4e-6 where none is.
/// @throws InputError  more than one is given
double start_surfactant(const Material& material);

/// E = R T Gamma_0, the Gibbs elasticity of one interface [N/m].
double elasticity(const Material& material);

/// c = sqrt(2 E / (rho eta_0)) [m/s].
double elastic_wave_speed(const Material& material);

/// The liquid's viscosity and that of the two interfaces that it is between, nu + 2 mu_s / (rho eta_0) [m^2/s]
/// [Trapeznikov57].
double film_viscosity(const Material& material);

/// How surfactant lowers the tension of one liquid-air interface, linear around a reference:
///
///   sigma(Gamma) = sigma_ref - R T (Gamma - Gamma_ref)
///
/// Gamma is the amount per area of one interface; both interfaces of a film have the same. [Deng22, eq. 3.3]
struct SurfactantLaw {
    double reference_tension = 0.0;        ///< sigma_ref [N/m]
    double reference_concentration = 0.0;  ///< Gamma_ref [mol/m^2]
    double temperature = 298.15;           ///< T [K]

    double thermal_energy() const { return kGasConstant * temperature; }  ///< R T [J/mol]
    /// Of one interface [N/m].
    double tension(double concentration) const {
        return reference_tension - thermal_energy() * (concentration - reference_concentration);
    }
};

}  // namespace lamella::film
