#include "lamella/optics/thin_film.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lamella/optics/water_index.h"

namespace lamella::optics {
namespace {

constexpr double kIndices[] = {1.33, 1.4, 1.5};
constexpr double kCosines[] = {1.0, 0.9, 0.6, 0.3, 0.05};

TEST(WaterIndex, IsThatOfTheReleaseOfIapws) {
    // Table 3 of the release gives five digits: 0 C at 0.1 MPa, density 999.843 kg/m^3.
    EXPECT_NEAR(water_index(226.50, 273.15, 999.843), 1.394527, 1e-5);
    EXPECT_NEAR(water_index(589.00, 273.15, 999.843), 1.334344, 1e-5);
    EXPECT_NEAR(water_index(1013.98, 273.15, 999.843), 1.326135, 1e-5);
    EXPECT_NEAR(water_index(589.3), 1.33250 * 1.00027, 2e-5);  // handbooks: 25 C, relative to air
}

TEST(WaterIndex, FallsFromBlueToRed) {
    for (double nm = 380.0; nm < 780.0; nm += 5.0) EXPECT_GT(water_index(nm), water_index(nm + 5.0)) << nm;
}

TEST(ThinFilm, IsBlackWithoutThickness) {
    for (const double n : kIndices)
        for (const double c : kCosines) {
            const Polarized r = film_reflectance({n, 0.0, c, 500.0});
            EXPECT_EQ(r.s, 0.0);
            EXPECT_EQ(r.p, 0.0);
        }
}

TEST(ThinFilm, ConservesPower) {
    for (const double n : kIndices)
        for (const double c : kCosines)
            for (double h = 0.0; h < 2e-6; h += 7.3e-9) {
                const FilmWave wave{n, h, c, 480.0};
                const Polarized r = film_reflectance(wave), t = film_transmittance(wave);
                // Rounding of the phase (up to 30 rad) is worth 4e-15, a resonance near grazing multiplies it by 1e2.
                EXPECT_NEAR(r.s + t.s, 1.0, 1e-12) << n << " " << c << " " << h;
                EXPECT_NEAR(r.p + t.p, 1.0, 1e-12) << n << " " << c << " " << h;
            }
}

TEST(ThinFilm, IsDarkAtMultiplesOfHalfAWaveInside) {
    constexpr double kIndex = 1.4, kNanometers = 560.0;
    const double r = interface_amplitude(kIndex, 1.0).s;
    const double brightest = 4.0 * r * r / ((1.0 + r * r) * (1.0 + r * r));
    for (int m = 1; m <= 6; ++m) {
        const double dark = m * kNanometers * 1e-9 / (2.0 * kIndex), bright = (m - 0.5) * kNanometers * 1e-9 / (2.0 * kIndex);
        EXPECT_NEAR(film_reflectance({kIndex, dark, 1.0, kNanometers}).mean(), 0.0, 1e-28);
        EXPECT_NEAR(film_reflectance({kIndex, bright, 1.0, kNanometers}).mean(), brightest, 1e-15);
    }
}

TEST(ThinFilm, HasNoBrewsterLightInThePlaneOfIncidence) {
    constexpr double kIndex = 1.5;
    const double brewster = std::cos(std::atan(kIndex));
    EXPECT_NEAR(interface_amplitude(kIndex, brewster).p, 0.0, 1e-15);
    EXPECT_NEAR(film_reflectance({kIndex, 300e-9, brewster, 500.0}).p, 0.0, 1e-15);
    EXPECT_GT(film_reflectance({kIndex, 300e-9, brewster, 500.0}).s, 0.1);
}

TEST(ThinFilm, BecomesAMirrorAtGrazingIncidence) {
    for (const double n : kIndices) {
        EXPECT_EQ(film_reflectance({n, 300e-9, 0.0, 500.0}).mean(), 1.0);
        EXPECT_EQ(thick_film_reflectance(n, 0.0).mean(), 1.0);
        double before = 0.0;
        for (const double c : {0.1, 0.01, 0.001, 0.0001}) {
            const double r = film_reflectance({n, 300e-9, c, 500.0}).mean();
            EXPECT_GT(r, before);
            before = r;
        }
        EXPECT_GT(before, 0.999);
    }
}

TEST(ThinFilm, HasItsMeanOverThePhaseAsThickLimit) {
    for (const double n : kIndices)
        for (const double c : kCosines) {
            constexpr int kPhases = 4096;  // R is smooth and periodic in the phase: the sum converges exponentially
            const double inside = std::sqrt(1.0 - (1.0 - c * c) / (n * n));
            const double period = 500e-9 / (2.0 * n * inside);
            double s = 0.0, p = 0.0;
            for (int k = 0; k < kPhases; ++k) {
                const Polarized r = film_reflectance({n, 1e-6 + period * k / kPhases, c, 500.0});
                s += r.s / kPhases;
                p += r.p / kPhases;
            }
            const Polarized limit = thick_film_reflectance(n, c);
            EXPECT_NEAR(s, limit.s, 1e-11);
            EXPECT_NEAR(p, limit.p, 1e-11);
        }
    EXPECT_NEAR(thick_film_reflectance(1.3339, 1.0).mean(), 0.040, 5e-4);
}

}  // namespace
}  // namespace lamella::optics
