#include "lamella/film/surfactant.h"

#include "lamella/core/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lamella::film {
namespace {

TEST(Surfactant, IsTheSameFromAnyOneOfItsThreeMeasures) {
    Material by_amount;
    by_amount.surfactant = 4e-6;
    Material by_elasticity;
    by_elasticity.elasticity = elasticity(by_amount);
    Material by_speed;
    by_speed.elastic_wave_speed = elastic_wave_speed(by_amount);
    EXPECT_NEAR(elasticity(by_amount), 9.916e-3, 1e-6);       // R T Gamma_0 at 298.15 K
    EXPECT_NEAR(elastic_wave_speed(by_amount), 7.041, 1e-3);  // of a film of 400 nm [method sheet 2]
    for (const Material& m : {by_elasticity, by_speed}) EXPECT_NEAR(start_surfactant(m), 4e-6, 1e-20);
    EXPECT_EQ(start_surfactant(Material{}), 4e-6);
    by_speed.surfactant = 1e-6;
    EXPECT_THROW(start_surfactant(by_speed), InputError);
}

TEST(Surfactant, AddsTheViscosityOfTheInterfaces) {
    Material material;
    material.kinematic_viscosity = 1e-6;
    material.surface_viscosity = 1e-9;
    EXPECT_NEAR(film_viscosity(material), 6e-6, 1e-18);
}

TEST(SurfactantLaw, TakesRTPerConcentrationFromTheTension) {
    const SurfactantLaw law{.reference_tension = 0.0725, .reference_concentration = 1e-7, .temperature = 298.15};
    EXPECT_EQ(law.tension(1e-7), 0.0725);
    EXPECT_NEAR(law.tension(0.0) - 0.0725, 2.479e-4, 1e-7);  // [method sheet 12]: R T Gamma = 2.48e-4 N/m
}

}  // namespace
}  // namespace lamella::film
