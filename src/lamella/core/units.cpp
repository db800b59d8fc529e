#include "lamella/core/units.h"

#include "lamella/core/error.h"
#include "lamella/core/nearest_word.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {
namespace {

struct NamedUnit {
    std::string_view name;
    Unit unit;
    bool takes_prefix = true;
};

constexpr Dimension kForce{.length = 1, .mass = 1, .time = -2};
constexpr Dimension kPressure{.length = -1, .mass = 1, .time = -2};
constexpr Dimension kViscosity{.length = -1, .mass = 1, .time = -1};

constexpr NamedUnit kUnits[] = {
    {"m", {1.0, 0, {.length = 1}}},
    {"g", {1.0, -3, {.mass = 1}}},
    {"s", {1.0, 0, {.time = 1}}},
    {"K", {1.0, 0, {.temperature = 1}}},
    {"mol", {1.0, 0, {.amount = 1}}},
    {"N", {1.0, 0, kForce}},
    {"Pa", {1.0, 0, kPressure}},
    {"J", {1.0, 0, {.length = 2, .mass = 1, .time = -2}}},
    {"W", {1.0, 0, {.length = 2, .mass = 1, .time = -3}}},
    {"Hz", {1.0, 0, {.time = -1}}},
    {"L", {1.0, -3, {.length = 3}}},
    {"l", {1.0, -3, {.length = 3}}},
    {"bar", {1.0, 5, kPressure}},
    {"dyn", {1.0, -5, kForce}},
    {"P", {1.0, -1, kViscosity}},
    {"min", {60.0, 0, {.time = 1}}, false},
    {"h", {3600.0, 0, {.time = 1}}, false},
    {"rad", {1.0, 0, {}}},
    {"deg", {std::numbers::pi / 180.0, 0, {}}, false},
    {"\u00b0", {std::numbers::pi / 180.0, 0, {}}, false},
};

constexpr std::pair<std::string_view, int> kPrefixes[] = {
    {"da", 1}, {"h", 2},  {"k", 3},  {"M", 6},       {"G", 9},       {"T", 12}, {"d", -1},
    {"c", -2}, {"m", -3}, {"u", -6}, {"\u00b5", -6}, {"\u03bc", -6}, {"n", -9}, {"p", -12}};

// Powers beyond these are typing errors, and would overflow the sums below.
constexpr int kLargestPower = 20;
constexpr int kLargestDepth = 8;

bool is_space(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// The text in quotes, on one line and not too long.
std::string quoted(std::string_view text) {
    std::string shown;
    for (const char c : text.substr(0, 60)) shown += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    return fmt::format("\"{}{}\"", shown, text.size() > 60 ? "..." : "");
}

std::optional<Unit> find_unit(std::string_view name) {
    // A whole name goes before prefix + name: "min" is a minute, "Pa" is no poise.
    for (const NamedUnit& known : kUnits)
        if (known.name == name) return known.unit;
    for (const auto& [prefix, exponent] : kPrefixes) {
        if (!name.starts_with(prefix)) continue;
        for (const NamedUnit& known : kUnits) {
            if (!known.takes_prefix || known.name != name.substr(prefix.size())) continue;
            Unit unit = known.unit;
            unit.exponent += exponent;
            return unit;
        }
    }
    return std::nullopt;
}

[[noreturn]] void refuse_unit(std::string_view name) {
    static constexpr std::pair<std::string_view, std::string_view> kSpelledOut[] = {
        {"meter", "m"},    {"metre", "m"},    {"meters", "m"},    {"second", "s"}, {"seconds", "s"}, {"sec", "s"},
        {"minute", "min"}, {"hour", "h"},     {"gram", "g"},      {"newton", "N"}, {"pascal", "Pa"}, {"kelvin", "K"},
        {"micron", "um"},  {"degree", "deg"}, {"degrees", "deg"}, {"hertz", "Hz"}, {"liter", "L"},   {"mole", "mol"}};
    for (const auto& [word, unit] : kSpelledOut)
        if (edit_distance(word, name) == 0)
            throw InputError(fmt::format("unknown unit {}; did you mean \"{}\"?", quoted(name), unit));
    std::vector<std::string> candidates;
    for (const NamedUnit& known : kUnits) candidates.emplace_back(known.name);
    for (const std::string_view prefixed : {"kg", "cm", "mm", "um", "nm", "km", "ms", "mN", "kPa", "mPa", "mL"})
        candidates.emplace_back(prefixed);
    if (const auto near = nearest_word(name, candidates))
        throw InputError(fmt::format("unknown unit {}; did you mean \"{}\"?", quoted(name), *near));
    throw InputError(
        fmt::format("unknown unit {}; known are m, g, s, K, mol, N, Pa, J, W, Hz, L, min, h, rad, deg"
                    " and more, with SI prefixes",
                    quoted(name)));
}

Unit power(const Unit& unit, int n) {
    const Dimension& d = unit.dimension;
    return {std::pow(unit.factor, n),
            unit.exponent * n,
            {d.length * n, d.mass * n, d.time * n, d.temperature * n, d.amount * n}};
}

Unit product(const Unit& a, const Unit& b) {
    const Dimension &p = a.dimension, &q = b.dimension;
    return {
        a.factor * b.factor,
        a.exponent + b.exponent,
        {p.length + q.length, p.mass + q.mass, p.time + q.time, p.temperature + q.temperature, p.amount + q.amount}};
}

/// Recursive descent over "N/m", "kg m^2/s^2", "J/(mol K)", "1/s".
class UnitParser {
public:
    explicit UnitParser(std::string_view text) : text_(text) {}

    Unit parse() {
        const Unit unit = terms(0);
        if (at_ < text_.size()) refuse();
        return unit;
    }

private:
    Unit terms(int depth) {
        if (depth > kLargestDepth) refuse();
        Unit all;
        int factors = 0;
        for (bool first = true;; first = false) {
            skip_spaces();
            if (at_ == text_.size() || text_[at_] == ')') return all;
            // "/s" stands for "1/s": the number before it may have been taken as the value.
            const bool divide = text_[at_] == '/';
            const bool sign =
                divide || text_[at_] == '*' || text_[at_] == '.' || text_.substr(at_).starts_with("\u00b7");
            if (sign) {
                if (first && !divide) refuse();
                at_ += text_.substr(at_).starts_with("\u00b7") ? 2 : 1;
                skip_spaces();
            }
            if (++factors > kLargestPower) refuse();
            const Unit unit = factor(depth);
            all = product(all, divide ? power(unit, -1) : unit);
        }
    }

    Unit factor(int depth) {
        if (at_ == text_.size()) refuse();
        Unit unit;
        if (text_[at_] == '(') {
            ++at_;
            unit = terms(depth + 1);
            if (at_ == text_.size()) refuse();
            ++at_;
        } else if (text_[at_] == '1') {
            ++at_;
        } else {
            unit = name();
        }
        return exponent(unit);
    }

    Unit name() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && !is_space(text_[at_]) &&
               std::string_view("*/.^()").find(text_[at_]) == std::string_view::npos && !is_digit(text_[at_]) &&
               text_[at_] != '-' && !text_.substr(at_).starts_with("\u00b7"))
            ++at_;
        const std::string_view word = text_.substr(begin, at_ - begin);
        if (word.empty()) refuse();
        if (const auto unit = find_unit(word)) return *unit;
        refuse_unit(word);
    }

    Unit exponent(const Unit& unit) {
        if (at_ == text_.size() || text_[at_] != '^') return unit;
        ++at_;
        int n = 0;
        const char* const begin = text_.data() + at_;
        const auto [end, failed] = std::from_chars(begin, text_.data() + text_.size(), n);
        if (failed != std::errc{} || std::abs(n) > kLargestPower) refuse();
        at_ += static_cast<std::size_t>(end - begin);
        return power(unit, n);
    }

    void skip_spaces() {
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    }

    [[noreturn]] void refuse() const {
        throw InputError(fmt::format("{} is no unit; write e.g. \"kg/m^3\"", quoted(text_)));
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

/// "-1.5e-3 mm" -> "-1.5", -3, " mm".
struct SplitNumber {
    std::string mantissa;
    int exponent = 0;
    std::string_view rest;
};

std::optional<SplitNumber> split_number(std::string_view text) {
    SplitNumber split;
    std::size_t at = 0;
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) {
        if (text[at] == '-') split.mantissa = "-";
        ++at;
    }
    bool any_digit = false;
    for (bool any_point = false; at < text.size(); ++at) {
        if (is_digit(text[at]))
            any_digit = true;
        else if (text[at] == '.' && !any_point)
            any_point = true;
        else
            break;
        split.mantissa += text[at];
    }
    if (!any_digit) return std::nullopt;
    if (at + 1 < text.size() && (text[at] == 'e' || text[at] == 'E')) {
        const std::size_t digits = at + (text[at + 1] == '+' ? 2 : 1);
        const auto [end, failed] = std::from_chars(text.data() + digits, text.data() + text.size(), split.exponent);
        if (failed != std::errc{} || std::abs(split.exponent) > 10000) return std::nullopt;
        at = static_cast<std::size_t>(end - text.data());
    }
    split.rest = trimmed(text.substr(at));
    return split;
}

/// The number before the unit, times 10^exponent, rounded once.
double scaled_number(const SplitNumber& number, int exponent) {
    const std::string text = fmt::format("{}e{}", number.mantissa, number.exponent + exponent);
    double value = 0.0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
    static_cast<void>(end);
    if (failed != std::errc{}) return std::numeric_limits<double>::infinity();
    return value;
}

struct WrittenQuantity {
    SplitNumber number;
    Unit unit;
};

WrittenQuantity split_quantity(std::string_view text) {
    const auto number = split_number(trimmed(text));
    if (!number) throw InputError(fmt::format("{} does not begin with a number; write e.g. \"5 cm\"", quoted(text)));
    try {
        return {*number, parse_unit(number->rest)};
    } catch (const InputError& problem) {
        throw InputError(fmt::format("{}: {}", quoted(text), problem.what()));
    }
}

double finite_value(const WrittenQuantity& written, const Unit& target, std::string_view text) {
    const double value =
        scaled_number(written.number, written.unit.exponent - target.exponent) * (written.unit.factor / target.factor);
    if (!std::isfinite(value)) throw InputError(fmt::format("{} is too large or too small", quoted(text)));
    return value;
}

struct KnownDimension {
    Dimension dimension;
    std::string_view name;
    std::string_view unit;
    std::string_view example;
};

constexpr KnownDimension kKnownDimensions[] = {
    {{}, "a pure number", "", "90 deg"},
    {{.length = 1}, "a length", "m", "5 cm"},
    {{.length = 2}, "an area", "m^2", "4 mm^2"},
    {{.length = 3}, "a volume", "m^3", "2 mL"},
    {{.mass = 1}, "a mass", "kg", "3 g"},
    {{.time = 1}, "a time", "s", "20 ms"},
    {{.time = -1}, "a rate", "1/s", "60 1/s"},
    {{.temperature = 1}, "a temperature", "K", "293 K"},
    {{.amount = 1}, "an amount of substance", "mol", "2 mmol"},
    {{.length = 1, .time = -1}, "a velocity", "m/s", "3 cm/s"},
    {{.length = 1, .time = -2}, "an acceleration", "m/s^2", "9.81 m/s^2"},
    {{.length = 2, .time = -1}, "a diffusivity or circulation", "m^2/s", "2 mm^2/s"},
    {{.length = -3, .mass = 1}, "a density", "kg/m^3", "1.2 kg/m^3"},
    {kForce, "a force", "N", "3 mN"},
    {kPressure, "a pressure", "Pa", "20 Pa"},
    {kViscosity, "a viscosity", "Pa s", "1 mPa s"},
    {{.mass = 1, .time = -2}, "a surface tension", "N/m", "25 mN/m"},
    {{.length = 2, .mass = 1, .time = -2}, "an energy", "J", "3 mJ"},
    {{.length = 2, .mass = 1, .time = -3}, "a power", "W", "2 W"},
    {{.length = -2, .amount = 1}, "a surface concentration", "mol/m^2", "3 umol/m^2"},
    {{.length = -3, .amount = 1}, "a concentration", "mol/m^3", "8 mmol/L"},
};

std::string base_unit_text(const Dimension& d) {
    std::string above, below;
    for (const auto& [symbol, n] : {std::pair{"kg", d.mass}, std::pair{"m", d.length}, std::pair{"s", d.time},
                                    std::pair{"K", d.temperature}, std::pair{"mol", d.amount}}) {
        if (n == 0) continue;
        std::string& side = n > 0 ? above : below;
        side += n > 0 ? (above.empty() ? "" : " ") : "/";
        side += std::abs(n) == 1 ? symbol : fmt::format("{}^{}", symbol, std::abs(n));
    }
    return (above.empty() ? "1" : above) + below;
}

const KnownDimension* find_known(const Dimension& dimension) {
    const auto* it = std::find_if(std::begin(kKnownDimensions), std::end(kKnownDimensions),
                                  [&](const KnownDimension& known) { return known.dimension == dimension; });
    return it == std::end(kKnownDimensions) ? nullptr : it;
}

}  // namespace

Unit parse_unit(std::string_view text) { return UnitParser(trimmed(text)).parse(); }

Quantity parse_quantity(std::string_view text) {
    const WrittenQuantity written = split_quantity(text);
    return {finite_value(written, Unit{}, text), written.unit.dimension};
}

double parse_quantity(std::string_view text, std::string_view unit) {
    const Unit target = parse_unit(unit);
    const WrittenQuantity written = split_quantity(text);
    if (written.unit.dimension == target.dimension) return finite_value(written, target, text);
    const KnownDimension* known = find_known(target.dimension);
    throw InputError(fmt::format("{} is {}; {} is expected, e.g. \"{}\"", quoted(text),
                                 describe(written.unit.dimension), describe(target.dimension),
                                 known ? std::string(known->example) : fmt::format("1 {}", unit)));
}

std::string describe(const Dimension& dimension) {
    if (dimension == Dimension{}) return "a pure number";
    if (const KnownDimension* known = find_known(dimension)) return fmt::format("{} [{}]", known->name, known->unit);
    return fmt::format("a quantity [{}]", base_unit_text(dimension));
}

}  // namespace lamella
