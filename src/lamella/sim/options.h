#pragma once

// One description of a solver's options feeds the scene reader, the range checks, `lamella explain`, the resolved
// scene and the docs. An options struct lists its members once:
//
//     enum class Drag { kBackground, kPairwise };
//
//     struct FlowOptions {
//         double speed = 0.0;
//         template <class Visitor>
//         void visit(Visitor&& option) {
//             option("speed", speed, at_least(0.0), {"liquid speed", "m/s", "[Key, eq. 3]"});
//         }
//     };
//
//     struct Options {
//         int count = 10'000;
//         Drag drag = Drag::kBackground;
//         FlowOptions flow;
//         template <class Visitor>
//         void visit(Visitor&& option) {
//             option("count", count, at_least(1), {"bubbles at the start"});
//             option("drag", drag, choices<Drag>({{"background", Drag::kBackground}, ...}), {"drag law"});
//             option.group("flow", flow, "a prescribed flow of the liquid");
//         }
//     };
//
// Member types: bool, int, std::int64_t, double, std::string, an enum with `choices`, Vec3, std::array<bool, 3>.

#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace lamella::sim {

/// What an option means. A unit that is not "-" lets the scene give a string with any unit of the same dimension.
struct Doc {
    std::string text;
    std::string unit = "-";
    std::string source = "";  ///< where it comes from: paper and equation, or who chose the default
};

/// The interval of allowed values; each end may be excluded.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_open = false;
    bool high_open = false;
};
inline Range any_number() { return {}; }
inline Range at_least(double low) { return {.low = low}; }
inline Range more_than(double low) { return {.low = low, .low_open = true}; }
inline Range between(double low, double high) { return {.low = low, .high = high}; }
inline Range strictly_between(double low, double high) { return {low, high, true, true}; }

/// The words that stand for the values of an enum.
template <class Enum>
using Choices = std::vector<std::pair<std::string, Enum>>;
template <class Enum>
Choices<Enum> choices(std::vector<std::pair<std::string, Enum>> list) {
    return list;
}

}  // namespace lamella::sim
