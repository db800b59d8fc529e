#include "lamella/render/canvas.h"

#include "lamella/render/color_chart.h"

#include <gtest/gtest.h>

namespace lamella::render {
namespace {

constexpr ScreenColor kBlack{0, 0, 0, 1}, kWhite{1, 1, 1, 1};

double ink(const Canvas& canvas) {
    double sum = 0.0;
    for (std::size_t y = 0; y < canvas.height(); ++y)
        for (std::size_t x = 0; x < canvas.width(); ++x) sum += static_cast<double>(canvas.at(x, y)[0]);
    return sum;
}

TEST(Canvas, FillsFractionsOfPixels) {
    Canvas canvas(10, 10, kBlack);
    canvas.fill({{1.5, 2.0}}, {{4.0, 3.25}}, kWhite);
    EXPECT_NEAR(ink(canvas), 2.5 * 1.25, 1e-6);
    canvas.fill({{-5.0, -5.0}}, {{50.0, 50.0}}, kWhite);
    EXPECT_NEAR(ink(canvas), 100.0, 1e-5);
}

TEST(Canvas, KeepsItsLinesInside) {
    Canvas canvas(20, 20, kBlack);
    canvas.draw_line({{-30.0, 10.0}}, {{50.0, 10.0}}, 2.0, kWhite);
    EXPECT_NEAR(ink(canvas), 2.0 * 20.0, 1e-5);
}

TEST(Canvas, WritesEveryCharacterAsWideAsItSays) {
    for (char c = '!'; c < 127; ++c) {
        Canvas canvas(80, 60, kBlack);
        canvas.draw_text({{20.0, 40.0}}, 24.0, std::string(1, c), kWhite);
        EXPECT_GT(ink(canvas), 3.0) << c;
        const double right = 20.0 + text_width(24.0, std::string(1, c)) + 3.0;  // half a pen beyond
        for (std::size_t y = 0; y < 60; ++y)
            for (std::size_t x = 0; x < 80; ++x)
                if (static_cast<double>(x) > right || x < 17) {
                    EXPECT_EQ(canvas.at(x, y)[0], 0.0F) << c << " at " << x << ", " << y;
                }
    }
    EXPECT_EQ(text_width(10.0, ""), 0.0);
}

TEST(Canvas, BecomesIntegers) {
    Canvas canvas(1, 1, {0.5F, 2.0F, -1.0F, 0.25F});
    EXPECT_EQ(canvas.raster(8, 4).values, (std::vector<std::uint16_t>{128, 255, 0, 64}));
    EXPECT_EQ(canvas.raster(16, 3).values, (std::vector<std::uint16_t>{32768, 65535, 0}));
}

TEST(ColorChart, ShowsBlackFilmsBlackAndGrazingOnesGray) {
    const Canvas chart = color_chart({}, 400, 200);
    const ScreenColor black = chart.at(31, 30), bright = chart.at(30 + 25, 30);  // 0 and 100 nm
    EXPECT_LT(black[1], 0.1F);
    EXPECT_GT(bright[1], 0.8F);
    EXPECT_EQ(color_rows({}, 100e-9).size(), 16U);
    EXPECT_EQ(color_rows({}, 100e-9)[0].name, "black");
}

}  // namespace
}  // namespace lamella::render
