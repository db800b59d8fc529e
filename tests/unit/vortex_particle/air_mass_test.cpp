#include "lamella/solvers/vortex_particle/air_mass.h"

#include <gtest/gtest.h>

#include "surfaces.h"
#include <cmath>

namespace lamella::vortex_particle {
namespace {

double legendre(int l, double z) { return l == 2 ? 0.5 * (3 * z * z - 1) : 0.5 * z * (5 * z * z - 3); }

/// v . m v over v . v of speeds v.
double inertia_of(const Surface& s, const AirMass& air, const std::vector<double>& v) {
    std::vector<double> momentum(s.vertices(), 0.0);
    air.add(v, momentum);
    double sum = 0.0, square = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) {
        sum += v[i] * momentum[i];
        square += s.vertex_area[i] * v[i] * v[i];
    }
    return sum / square;
}

TEST(AirMass, OfASphereIsThatOfTheHarmonics) {
    constexpr double kRadius = 0.05, kDensity = 1.2;
    const Surface s = surface_of(mesh::spheres({{Vec3{}, kRadius}}, 0.0025));
    AirMass air(s, kDensity, std::vector<std::uint8_t>(s.vertices(), 0));
    air.factorize(s);
    for (const int l : {2, 3}) {
        std::vector<double> v(s.vertices());
        for (std::size_t i = 0; i < v.size(); ++i) v[i] = legendre(l, s.position[i][2] / norm(s.position[i]));
        const double exact = kDensity * kRadius * (1.0 / l + 1.0 / (l + 1));
        EXPECT_NEAR(inertia_of(s, air, v) / exact, 1.0, 3e-3) << l;  // the square of the edge, 2.5e-3, l^2 / 12 of it
    }
}

/// Above a wave of wave number k on a plane lies air of the depth 1 / k, and below too.
TEST(AirMass, OfAFlatFilmIsThatOfItsWaves) {
    constexpr double kDensity = 1.2, kPi = 3.14159265358979323846;
    const Surface s = surface_of(mesh::rectangle({}, {{1, 0, 0}}, {{0, 1, 0}}, 0.025));
    std::vector<std::uint8_t> still(s.vertices());
    for (std::size_t i = 0; i < still.size(); ++i) still[i] = s.place[i] != Place::kInside ? 1 : 0;
    AirMass air(s, kDensity, still);
    air.factorize(s);
    for (const int n : {1, 2, 4}) {
        std::vector<double> v(s.vertices());
        for (std::size_t i = 0; i < v.size(); ++i)
            v[i] = std::sin(n * kPi * s.position[i][0]) * std::sin(n * kPi * s.position[i][1]);
        const double exact = 2.0 * kDensity / (std::sqrt(2.0) * n * kPi);
        EXPECT_NEAR(inertia_of(s, air, v) / exact, 1.0, 1e-2) << n;
    }
}

}  // namespace
}  // namespace lamella::vortex_particle
