#include "lamella/core/units.h"

#include "lamella/core/error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace lamella {
namespace {

template <class Call>
std::string error_of(Call&& call) {
    try {
        call();
    } catch (const InputError& problem) {
        return problem.what();
    }
    return "no error";
}

TEST(Units, OfPowersOfTenAreExactToTheLastBit) {
    const std::pair<const char*, double> cases[] = {
        {"5 cm", 0.05},      {"7 cm", 0.07},    {"0.1 mm", 1e-4},     {"400 nm", 400e-9},      {"1e3 um", 1e-3},
        {"-5.2 cm", -0.052}, {"+3 km", 3000.0}, {"2.5E-1m", 0.25},    {"0.3 \u00b5m", 0.3e-6}, {".5 dm", 0.05},
        {"5.cm", 0.05},      {"  1  m  ", 1.0}, {"1e-320 km", 1e-317}};
    for (const auto& [text, meters] : cases) EXPECT_EQ(parse_quantity(text, "m"), meters) << text;
}

TEST(Units, CombineByProductsQuotientsAndPowers) {
    const auto close = [](const char* text, const char* unit, double value) {
        EXPECT_DOUBLE_EQ(parse_quantity(text, unit), value) << text;
    };
    close("25 mN/m", "N/m", 0.025);
    close("1.2 kg/m^3", "kg/m^3", 1.2);
    close("1 g/cm^3", "kg/m^3", 1000.0);
    close("60 1/s", "1/s", 60.0);
    close("60 /s", "1/s", 60.0);
    close("60 Hz", "1/s", 60.0);
    close("60 s^-1", "1/s", 60.0);
    close("2 min", "s", 120.0);
    close("1.5 h", "min", 90.0);
    close("1 mPa s", "Pa s", 1e-3);
    close("1 mPa*s", "Pa s", 1e-3);
    close("1 mPa\u00b7s", "kg/m/s", 1e-3);
    close("1 cP", "Pa s", 1e-3);
    close("72 dyn/cm", "N/m", 0.072);
    close("8.314 J/(mol K)", "J/mol/K", 8.314);
    close("8.314 J/mol/K", "kg m^2/s^2/(mol K)", 8.314);
    close("3 umol/m^2", "mol/m^2", 3e-6);
    close("2 mL", "m^3", 2e-6);
    close("4 mm^2", "m^2", 4e-6);
    close("20 kPa", "bar", 0.2);
    close("1 kg m^2/s^2", "J", 1.0);
}

TEST(Units, TakeAnglesAsPureNumbersInRadians) {
    EXPECT_DOUBLE_EQ(parse_quantity("120 deg", "rad"), 2.0 * std::numbers::pi / 3.0);
    EXPECT_EQ(parse_quantity("120 deg", "deg"), 120.0);
    EXPECT_EQ(parse_quantity("45\u00b0", "deg"), 45.0);
    EXPECT_EQ(parse_quantity("2 mrad", ""), 0.002);
    EXPECT_EQ(parse_quantity("120 deg").dimension, Dimension{});
}

TEST(Units, TakeWholeNamesBeforePrefixes) {
    EXPECT_EQ(parse_unit("min").dimension, (Dimension{.time = 1}));
    EXPECT_EQ(parse_unit("mol").dimension, (Dimension{.amount = 1}));
    EXPECT_EQ(parse_unit("Pa").dimension, (Dimension{.length = -1, .mass = 1, .time = -2}));
    EXPECT_EQ(parse_unit("kg").dimension, (Dimension{.mass = 1}));
    EXPECT_EQ(parse_unit("kg").exponent, 0);
    EXPECT_EQ(parse_unit("").dimension, Dimension{});
}

TEST(Units, SayWhichDimensionWasFoundAndWhichIsExpected) {
    EXPECT_EQ(error_of([] { parse_quantity("5 kg", "m"); }),
              "\"5 kg\" is a mass [kg]; a length [m] is expected, e.g. \"5 cm\"");
    EXPECT_EQ(error_of([] { parse_quantity("5", "N/m"); }),
              "\"5\" is a pure number; a surface tension [N/m] is expected, e.g. \"25 mN/m\"");
    EXPECT_EQ(error_of([] { parse_quantity("5 m/kg", "K mol"); }),
              "\"5 m/kg\" is a quantity [m/kg]; a quantity [K mol] is expected, e.g. \"1 K mol\"");
    EXPECT_EQ(describe(Dimension{.length = -2, .time = -1}), "a quantity [1/m^2/s]");
}

TEST(Units, SuggestTheNearestKnownUnit) {
    EXPECT_NE(error_of([] { parse_quantity("5 meters", "m"); }).find("did you mean \"m\"?"), std::string::npos);
    EXPECT_NE(error_of([] { parse_quantity("5 micron", "m"); }).find("did you mean \"um\"?"), std::string::npos);
    EXPECT_NE(error_of([] { parse_quantity("5 Mol", "mol"); }).find("did you mean \"mol\"?"), std::string::npos);
    EXPECT_NE(error_of([] { parse_quantity("5 furlong", "m"); }).find("known are m, g, s"), std::string::npos);
    EXPECT_NE(error_of([] { parse_quantity("5 kmin", "s"); }).find("unknown unit"), std::string::npos);
}

TEST(Units, RefuseWhatIsNoQuantity) {
    for (const char* text : {"",
                             "cm",
                             "five cm",
                             "5 cm cm/",
                             "5 m^",
                             "5 m^x",
                             "5 m^99",
                             "5 m^2^3",
                             "5 (m",
                             "5 m)",
                             "5 *m",
                             "5 m//s",
                             "1e999 m",
                             "1e-999 m",
                             "nan m",
                             "inf",
                             "5 m\n",
                             "0x10 m",
                             "1e99999999999 m",
                             "- m",
                             "5 12",
                             "5 ((((((((((m))))))))))"})
        EXPECT_THROW(parse_quantity(text), InputError) << text;
    EXPECT_THROW(parse_quantity("5 " + std::string(10000, '(')), InputError);
    EXPECT_THROW(parse_quantity("1" + std::string(10000, '0') + " m"), InputError);
}

TEST(Units, MessagesStayOnOneShortLine) {
    for (const std::string& text :
         {std::string("5 \n\x01\x7f m"), std::string(5000, 'x'), "5 " + std::string(5000, 'y')}) {
        const std::string error = error_of([&] { parse_quantity(text, "m"); });
        EXPECT_EQ(error.find('\n'), std::string::npos);
        EXPECT_LT(error.size(), 300u) << error;
    }
}

}  // namespace
}  // namespace lamella
