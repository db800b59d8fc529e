#pragma once

namespace lamella::film {

/// Molar gas constant [J/(mol K)].
inline constexpr double kGasConstant = 8.31446261815324;

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
