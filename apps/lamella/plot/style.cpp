#include "style.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lamella::app {
namespace {

/// viridis at x = 0, 1/8, ... 1 (Smith, van der Walt and Firing; CC0).
constexpr std::array<unsigned, 9> kColorMap{0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c,
                                            0x28ae80, 0x5ec962, 0xaddc30, 0xfde725};

unsigned mix(unsigned a, unsigned b, double share) {
    unsigned result = 0;
    for (const unsigned shift : {16U, 8U, 0U}) {
        const double from = (a >> shift) & 0xffU;
        const double to = (b >> shift) & 0xffU;
        result |= static_cast<unsigned>(std::lround(from + share * (to - from))) << shift;
    }
    return result;
}

}  // namespace

std::string panel_style() {
    std::string palette;
    for (std::size_t i = 0; i < kColorMap.size(); ++i)
        palette += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, color_text(kColorMap[i]));
    return "reset\n"
           "set encoding utf8\n"
           "set minussign\n"
           "set border 15 lc rgb '#333333' lw 0.6\n"
           "set tics scale 0.6,0.3 tc rgb '#333333'\n"
           "set xtics nomirror\nset ytics nomirror\n"
           "set key noenhanced samplen 1.5 spacing 1.1 tc rgb '#333333' opaque fc rgb '#ffffff'\n"
           "set palette defined (" +
           palette + ")\n";
}

unsigned map_color(double x) {
    const double at = std::clamp(std::isfinite(x) ? x : 0.0, 0.0, 1.0) * static_cast<double>(kColorMap.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), kColorMap.size() - 2);
    return mix(kColorMap[i], kColorMap[i + 1], at - static_cast<double>(i));
}

std::string color_text(unsigned rgb) { return fmt::format("#{:06x}", rgb); }

unsigned shaded(unsigned rgb, double share) { return mix(rgb, share > 0.0 ? 0xffffffU : 0x000000U, std::abs(share)); }

std::string log_tics(char axis, double low, double high) {
    if (!(low > 0.0 && high > low && std::isfinite(high))) return "";
    const double decades = std::log10(high / low);
    if (decades > 2.5)
        return fmt::format("set format {} '10^{{%L}}'\nset {}tics 10\nset m{}tics 10\n", axis, axis, axis);
    std::string list;
    for (int power = static_cast<int>(std::floor(std::log10(low))); power <= std::ceil(std::log10(high)); ++power)
        for (int digit = 1; digit <= 9; ++digit) {
            const bool labeled = digit == 1 || digit == 2 || digit == 5 || (decades < 1.0 && digit == 3);
            const double value = digit * std::pow(10.0, power);
            list += fmt::format("{}'{}' {:.6g} {}", list.empty() ? "" : ", ",
                                labeled ? fmt::format("{:.6g}", value) : "", value, labeled ? 0 : 1);
        }
    return fmt::format("set {}tics ({})\n", axis, list);
}

}  // namespace lamella::app
