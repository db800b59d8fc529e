#include "lamella/sim/film_surface.h"

#include <gtest/gtest.h>

#include "lamella/mesh/shapes/periodic_foam.h"
#include "lamella/mesh/shapes/sphere.h"

namespace lamella::sim {
namespace {

TEST(FilmBox, IsTheUnitCellOfAPeriodicFoam) {
    const mesh::FoamMesh foam = mesh::periodic_foam(mesh::PeriodicFoam::kWeairePhelan, 1.0, 0.4);
    const std::optional<Box> box = film_box(foam);
    ASSERT_TRUE(box);
    EXPECT_NEAR(box->lengths[0] * box->lengths[1] * box->lengths[2], 8.0, 1e-12);  // of eight bubbles
    EXPECT_EQ(box->periodic, (std::array{true, true, true}));
}

TEST(FilmBox, IsNoneForObliquePeriodsAndInOpenAir) {
    mesh::FoamMesh foam = mesh::periodic_foam(mesh::PeriodicFoam::kKelvin, 1.0, 0.4);
    foam.period[0][1] = 0.25;
    EXPECT_FALSE(film_box(foam));
    EXPECT_FALSE(film_box(mesh::spheres({{{}, 1.0}}, 0.5)));
}

}  // namespace
}  // namespace lamella::sim
