#pragma once

// Quantities with units, as scene files write them: "5 cm", "25 mN/m", "1.2 kg/m^3", "60 1/s", "1 mPa s".
//
// A unit is a product or quotient of named units with SI prefixes and whole powers. Written between two of them, a
// space, '*' or '.' multiplies and '/' divides by the next one only ("J/mol/K", or "J/(mol K)"). Angles are pure
// numbers in radians.

#include <string>
#include <string_view>

namespace lamella {

/// Powers of meter, kilogram, second, kelvin and mole.
struct Dimension {
    int length = 0;
    int mass = 0;
    int time = 0;
    int temperature = 0;
    int amount = 0;

    friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// One unit is `factor * 10^exponent` SI units. The two are kept apart so that "7 cm" is exactly 0.07.
struct Unit {
    double factor = 1.0;
    int exponent = 0;
    Dimension dimension;
};

/// A value in SI units.
struct Quantity {
    double value = 0.0;
    Dimension dimension;
};

/// @param text  "m", "mN/m", "kg/m^3", "1/s"; "" is a pure number
/// @throws InputError  unknown unit, with the nearest known one; text that is no unit
Unit parse_unit(std::string_view text);

/// @param text  a number and a unit: "5 cm"
/// @throws InputError  no number, not finite, unknown unit; the message begins with the quoted text
Quantity parse_quantity(std::string_view text);

/// The value of `text` in `unit`, exact to the last bit where only powers of ten are between them.
///
/// @param text  "5 cm"
/// @param unit  of the returned number: "m"; its dimension is the one that `text` must have
/// @throws InputError  as above, or `"5 kg" is a mass [kg]; a length [m] is expected, e.g. "5 cm"`
double parse_quantity(std::string_view text, std::string_view unit);

/// "a length [m]", "a surface tension [N/m]", "a quantity [kg m/s^3]", "a pure number".
std::string describe(const Dimension& dimension);

}  // namespace lamella
