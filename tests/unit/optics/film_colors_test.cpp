#include "lamella/optics/film_colors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "lamella/optics/film_color_table.h"
#include "lamella/optics/thin_film.h"
#include "lamella/optics/water_index.h"

namespace lamella::optics {
namespace {

/// A film picture's exposure: the brightest film of all becomes as bright as white.
constexpr double kExposure = 12.0;

double film_luminance(const FilmColors& film, double thickness_nm) {
    return luminance(film.reflected(thickness_nm * 1e-9, 1.0));
}

/// Thicknesses [nm] from 60 nm on where `sign` * luminance has a maximum.
std::vector<double> extrema(double sign) {
    const FilmColors film;
    std::vector<double> found;
    for (double h = 60.0; h < 600.0; h += 0.25) {
        const double here = sign * film_luminance(film, h);
        if (here > sign * film_luminance(film, h - 0.25) && here >= sign * film_luminance(film, h + 0.25)) found.push_back(h);
    }
    return found;
}

TEST(FilmColors, AreBrightestAndDarkestWhereTheEyeSaysSo) {
    const std::vector<double> bright = extrema(1.0), dark = extrema(-1.0);
    ASSERT_GE(bright.size(), 3U);
    ASSERT_GE(dark.size(), 2U);
    for (const auto& [found, expected] : {std::pair(bright[0], 103.0), {bright[1], 310.0}, {bright[2], 519.0}, {dark[0], 206.0}, {dark[1], 414.0}})
        EXPECT_NEAR(found, expected, 2.0);
}

TEST(FilmColors, AreBlackWithoutThicknessAndWhiteAtGrazingIncidence) {
    for (const std::string& light : illuminant_names()) {
        const FilmColors film({.light = illuminant(light)});
        EXPECT_EQ(norm(film.reflected(0.0, 0.7)), 0.0);
        const Rgb grazing = film.reflected(400e-9, 0.0);
        for (const double c : grazing.v) EXPECT_NEAR(c, 1.0, 1e-13);
        EXPECT_NEAR(luminance(film.reflected_by_thick_film(1.0)), 0.040, 5e-4);
    }
}

TEST(FilmColors, LoseTheirFringesInThickFilms) {
    const FilmColors film;
    for (const double cosine : {1.0, 0.5})
        for (double h = 3.5e-6; h < 4e-6; h += 13e-9)
            EXPECT_LT(norm(film.reflected(h, cosine) - film.reflected_by_thick_film(cosine)), 2e-3) << h;
}

TEST(FilmColors, FollowNewtonsOrders) {
    const FilmColors film;
    std::vector<std::string> names;
    for (double h = 0.0; h <= 560.0; h += 1.0) {
        const std::string name{color_name(kExposure * film.reflected(h * 1e-9, 1.0))};
        if (names.empty() || names.back() != name) names.push_back(name);
    }
    // First order: black, bluish gray, white, straw, amber to red-purple; second: violet, blue, green, yellow, crimson.
    const std::vector<std::string> orders{"black", "white", "yellow", "amber", "red",   "violet",
                                          "blue",  "green", "yellow", "amber", "crimson", "violet", "turquoise", "green"};
    auto at = names.begin();
    std::string all;
    for (const std::string& name : names) all += name + " ";
    for (const std::string& name : orders) {
        at = std::find(at, names.end(), name);
        ASSERT_NE(at, names.end()) << name << " is missing or too early in: " << all;
    }
}

TEST(FilmColorTable, AgreesWithWhatItWasMadeFrom) {
    const FilmColors film;
    const FilmColorTable table;
    double worst = 0.0, worst_steep = 0.0, worst_grazing = 0.0;
    for (double h = 0.0; h < 1500e-9; h += 3.1e-9)
        for (double c = 0.0; c <= 1.0; c += 0.013) {
            const double error = norm(table.reflected(h, c) - film.reflected(h, c));
            double& bin = c > 0.5 ? worst : c > 0.1 ? worst_steep : worst_grazing;
            bin = std::max(bin, error);
        }
    RecordProperty("worst", std::to_string(worst) + " " + std::to_string(worst_steep) + " " + std::to_string(worst_grazing));
    // Linear interpolation over a step du errs by du^2/8 |d^2 C/du^2|; the table's steps are chosen for a tenth of what
    // the fit of the matching functions costs (below). Where a film turns into a mirror, within 6 degrees of grazing, the
    // color rises from 0 to 1 over a few entries.
    EXPECT_LT(worst, 2e-4);          // colors up to 0.25
    EXPECT_LT(worst_steep, 1e-3);    // up to 0.8
    EXPECT_LT(worst_grazing, 4e-2);  // up to 1
}

TEST(FilmColorTable, TakesTheLimitBeyondItsRange) {
    const FilmColorTable table({}, {.thicknesses = 101, .cosines = 17, .max_thickness = 1e-6});
    const FilmColors film;
    EXPECT_LT(norm(table.reflected(1.0, 1.0) - film.reflected_by_thick_film(1.0)), 1e-7);
    EXPECT_EQ(table.reflected(-1.0, 2.0), table.reflected(0.0, 1.0));
    EXPECT_EQ(table.values().size(), 102U * 17U);
}

// ---- against functions as the CIE tabulates them, which Debian's package colord-data has

const std::filesystem::path kColord = "/usr/share/colord";

/// The rows of one of its files and the wavelengths of their columns [nm].
struct CieTable {
    std::vector<double> nm;
    std::vector<std::vector<double>> rows;

    double at(std::size_t row, double wavelength) const {  // linear between the entries, as the CIE allows
        if (wavelength <= nm.front() || wavelength >= nm.back()) return 0.0;
        const auto i = static_cast<std::size_t>(std::upper_bound(nm.begin(), nm.end(), wavelength) - nm.begin());
        const double t = (wavelength - nm[i - 1]) / (nm[i] - nm[i - 1]);
        return (1.0 - t) * rows[row][i - 1] + t * rows[row][i];
    }
};

CieTable read_cie(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string text(std::istreambuf_iterator<char>(in), {});
    CieTable table;
    std::istringstream names(text.substr(text.find("BEGIN_DATA_FORMAT") + 17));
    for (std::string word; names >> word && word != "END_DATA_FORMAT";) {
        const double wavelength = std::stod(word.substr(5));
        table.nm.push_back(wavelength > 1e4 ? wavelength / 1000.0 : wavelength);  // some files write picometers
    }
    std::istringstream values(text.substr(text.find("BEGIN_DATA\n") + 11));
    for (std::string word; values >> word && word != "END_DATA";) {
        if (table.rows.empty() || table.rows.back().size() == table.nm.size()) table.rows.emplace_back();
        table.rows.back().push_back(std::stod(word));
    }
    return table;
}

TEST(FilmColors, AgreeWithTabulatedFunctionsInStepsOfOneNanometer) {
    if (!std::filesystem::exists(kColord / "cmf/CIE1931-2deg-XYZ.cmf"))
        GTEST_SKIP() << "the tables of Debian's package colord-data are not installed";
    const CieTable observer = read_cie(kColord / "cmf/CIE1931-2deg-XYZ.cmf");
    const CieTable d65 = read_cie(kColord / "illuminant/CIE-D65.sp");
    ASSERT_EQ(observer.rows.size(), 3U);
    ASSERT_EQ(d65.rows.size(), 1U);
    const FilmColors film;
    Xyz white;
    for (double nm = 360.0; nm <= 830.0; nm += 1.0)
        for (std::size_t k = 0; k < 3; ++k) white[k] += d65.at(0, nm) * observer.at(k, nm);
    double sum = 0.0, worst = 0.0;
    int count = 0;
    for (const double cosine : {1.0, 0.8, 0.5})
        for (double h = 0.0; h <= 1500.0; h += 5.0, ++count) {
            Xyz exact;
            for (double nm = 360.0; nm <= 830.0; nm += 1.0) {
                const double r = film_reflectance({water_index(nm), h * 1e-9, cosine, nm}).mean();
                for (std::size_t k = 0; k < 3; ++k) exact[k] += r * d65.at(0, nm) * observer.at(k, nm) / white[1];
            }
            const double difference = difference_76(lab(exact, white / white[1]),
                                                    lab(xyz_of(film.reflected(h * 1e-9, cosine)), kSrgbWhite));
            sum += difference;
            worst = std::max(worst, difference);
        }
    RecordProperty("mean_and_worst", std::to_string(sum / count) + " " + std::to_string(worst));
    EXPECT_LT(sum / count, 0.5);
    EXPECT_LT(worst, 1.6);
}

TEST(Illuminant, D65IsTheTabulatedOne) {
    if (!std::filesystem::exists(kColord / "illuminant/CIE-D65.sp"))
        GTEST_SKIP() << "the tables of Debian's package colord-data are not installed";
    const CieTable table = read_cie(kColord / "illuminant/CIE-D65.sp"), a = read_cie(kColord / "illuminant/CIE-A.sp");
    for (std::size_t i = 0; i < kWavelengths; ++i) {
        EXPECT_NEAR(illuminant("D65").power[i], 100.0 * table.at(0, wavelength_nm(i)), 1e-3);
        EXPECT_NEAR(illuminant("A").power[i] / 100.0, a.at(0, wavelength_nm(i)) / a.at(0, 560.0), 1e-4);
    }
}

}  // namespace
}  // namespace lamella::optics
