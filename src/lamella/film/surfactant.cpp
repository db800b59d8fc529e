#include "lamella/film/surfactant.h"

#include "lamella/core/error.h"

#include <cmath>

namespace lamella::film {

double start_surfactant(const Material& material) {
    const int given = (material.surfactant > 0.0) + (material.elasticity > 0.0) + (material.elastic_wave_speed > 0.0);
    if (given > 1)
        throw InputError("material.surfactant, elasticity and elastic_wave_speed say the same thing; give one of them");
    if (material.elasticity > 0.0) return material.elasticity / thermal_energy(material);
    if (material.elastic_wave_speed > 0.0)
        return 0.5 * material.liquid_density * material.thickness * material.elastic_wave_speed *
               material.elastic_wave_speed / thermal_energy(material);
    constexpr double kCommon = 4e-6;  // near the saturation of sodium dodecyl sulfate
    return material.surfactant > 0.0 ? material.surfactant : kCommon;
}

double elasticity(const Material& material) { return thermal_energy(material) * start_surfactant(material); }

double elastic_wave_speed(const Material& material) {
    return std::sqrt(2.0 * elasticity(material) / (material.liquid_density * material.thickness));
}

double film_viscosity(const Material& material) {
    return material.kinematic_viscosity +
           2.0 * material.surface_viscosity / (material.liquid_density * material.thickness);
}

}  // namespace lamella::film
