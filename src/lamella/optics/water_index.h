#pragma once

namespace lamella::optics {

/// Refractive index of pure water.
///
///   (n^2 - 1) / (n^2 + 2) / r = a0 + a1 r + a2 t + a3 l^2 t + a4 / l^2 + a5 / (l^2 - l_uv^2) + a6 / (l^2 - l_ir^2) + a7 r^2
///
/// with r = density / (1000 kg/m^3), t = temperature / (273.15 K), l = wavelength / (589 nm). Valid for 200 to 1100 nm,
/// 261 to 773 K and densities up to 1060 kg/m^3; in liquid water around room temperature the formula is good to 2e-5.
///
/// @param wavelength_nm  in vacuum
/// @param temperature    [K]
/// @param density        [kg/m^3]; the default is water's at 25 degrees Celsius and 1 atm
/// @see [Harvey98], [IAPWS97]
double water_index(double wavelength_nm, double temperature = 298.15, double density = 997.047);

}  // namespace lamella::optics
