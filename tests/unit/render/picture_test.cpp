#include "lamella/render/picture.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/optics/film_colors.h"

#include <gtest/gtest.h>

#include "shown_frames.h"

namespace lamella::render {
namespace {

class RenderFrame : public testing::Test {
protected:
    void SetUp() override {
        if (!can_render()) GTEST_SKIP() << "built without Embree";
    }
};

/// A small picture straight from above in light that is 1 from everywhere.
PictureOptions from_above() {
    PictureOptions options;
    options.width = 48;
    options.height = 36;
    options.samples = 4;
    options.view.azimuth_deg = -90.0;
    options.view.elevation_deg = 90.0;
    options.environment = "gray";
    options.background = "#000000";
    options.border_width = 0.0;
    return options;
}

optics::Rgb color_at(const Picture& picture, std::size_t x, std::size_t y) {
    const float* p = picture.light.pixel(x, y);
    return {{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])}};
}

double largest_difference(const optics::Rgb& a, const optics::Rgb& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

TEST_F(RenderFrame, HidesFilmsInLightFromEverywhere) {
    // What a film mirrors and what it lets through add up to the light: nothing is to be seen but the gray room.
    PictureOptions options = from_above();
    options.background = "environment";
    options.view = {};
    for (const sim::Frame& frame : {sphere_film(3), flat_film(4, 300e-9)}) {
        const Picture picture = render_frame(frame, options);
        for (std::size_t y = 0; y < options.height; ++y)
            for (std::size_t x = 0; x < options.width; ++x)
                EXPECT_LT(largest_difference(color_at(picture, x, y), {{1.0, 1.0, 1.0}}), 2e-5) << x << ", " << y;
    }
}

TEST_F(RenderFrame, GivesAFilmTheColorOfItsThickness) {
    for (const double thickness : {100e-9, 300e-9, 550e-9}) {
        const Picture picture = render_frame(flat_film(3, thickness), from_above());
        const optics::Rgb expected = optics::FilmColors().reflected(thickness, 1.0);
        // The pixel's rays are up to half a degree off the normal; the table of colors is good to 2e-4.
        EXPECT_LT(largest_difference(color_at(picture, 24, 18), expected), 5e-4) << thickness;
        EXPECT_EQ(picture.thickness_origin, "frame");
    }
    PictureOptions options = from_above();
    options.thickness = 300e-9;
    const Picture given = render_frame(flat_film(3), options);
    EXPECT_EQ(given.light.values, render_frame(flat_film(3, 300e-9), from_above()).light.values);
    EXPECT_EQ(given.thickness_origin, "given");
}

TEST_F(RenderFrame, ShowsNothingOfABlackFilm) {
    PictureOptions options = from_above();
    options.environment = "studio";
    const Picture picture = render_frame(flat_film(3, 0.0), options);
    for (const float value : picture.light.values) EXPECT_TRUE(value == 0.0F || value == 1.0F);  // black, opaque
}

TEST_F(RenderFrame, IsTransparentWhereTheBackgroundWouldBe) {
    PictureOptions options = from_above();
    options.background = "transparent";
    const Picture picture = render_frame(flat_film(3, 300e-9), options);
    EXPECT_EQ(picture.light.pixel(0, 0)[3], 0.0F);
    const double reflected = optics::luminance(optics::FilmColors().reflected(300e-9, 1.0));
    EXPECT_NEAR(static_cast<double>(picture.light.pixel(24, 18)[3]), reflected, 5e-4);
    EXPECT_EQ(render_frame(one_ball(), options).light.pixel(24, 18)[3], 1.0F);
}

TEST_F(RenderFrame, GivesTheSameBitsOnAnyNumberOfThreads) {
    PictureOptions options = from_above();
    options.environment = "studio";
    options.view = {};
    options.border_width = 1.0;
    options.ground = true;
    sim::Frame frame = sphere_film(3);
    frame.points = one_ball().points;
    const auto picture = [&](int threads) {
        const ThreadLimit limit(threads);
        return render_frame(frame, options);
    };
    const Picture one = picture(1), two = picture(2);
    EXPECT_EQ(one.light.values, two.light.values);
    EXPECT_EQ(one.shown.values, two.shown.values);
    options.seed = 2;
    EXPECT_NE(one.light.values, render_frame(frame, options).light.values);
}

TEST_F(RenderFrame, ColorsBallsAndFilmsByAField) {
    PictureOptions options = from_above();
    options.field = "pressure";
    const Picture ball = render_frame(one_ball(), options);
    ASSERT_TRUE(ball.scale);
    EXPECT_EQ(ball.scale->low, 2.0);
    const optics::Rgb gloss{{0.0101, 0.0101, 0.0101}};  // half of water's 2 percent, mirrored light of 1
    EXPECT_LT(largest_difference(color_at(ball, 24, 18), ball.scale->color(2.0) + gloss), 1e-3);

    options.field = "thickness";
    options.scale = ColorScale{"thickness", "m", 0.0, 1e-6, false};
    const Picture low = render_frame(flat_film(2, 0.0), options), high = render_frame(flat_film(2, 1e-6), options);
    EXPECT_GT(color_at(low, 24, 18)[2], color_at(low, 24, 18)[1]);    // violet
    EXPECT_GT(color_at(high, 24, 18)[1], color_at(high, 24, 18)[2]);  // yellow
    EXPECT_EQ(low.thickness_origin, "none");
}

TEST_F(RenderFrame, PutsATableUnderThings) {
    PictureOptions options = from_above();
    options.view = {};
    options.background = "#808080";
    options.ground = true;
    const Picture picture = render_frame(one_ball(), options);
    const double gray = optics::decode_srgb(128.0 / 255.0);
    EXPECT_NEAR(color_at(picture, 0, 0)[0], gray, 1e-6);               // the wall
    EXPECT_NEAR(color_at(picture, 0, 35)[0], 0.8 * gray, 0.2 * gray);  // the table, a little shaded here already
    double darkest = 1.0;
    for (std::size_t x = 0; x < 48; ++x) darkest = std::min(darkest, color_at(picture, x, 33)[0]);
    EXPECT_LT(darkest, 0.55 * gray);  // the ball's shadow
}

TEST_F(RenderFrame, TakesThicknessesFromParticles) {
    sim::Frame frame = flat_film(4);
    for (int j = -20; j <= 20; ++j)
        for (int i = -20; i <= 20; ++i) frame.points.position.push_back({{i / 20.0, j / 20.0, 0.0}});
    frame.points.fields.push_back({"thickness", "m", 1, false, std::vector<double>(frame.points.size(), 300e-9)});
    const Picture picture = render_frame(frame, from_above());
    EXPECT_EQ(picture.thickness_origin, "particles");
    EXPECT_LT(largest_difference(color_at(picture, 24, 18), optics::FilmColors().reflected(300e-9, 1.0)), 5e-4);
}

TEST_F(RenderFrame, ShowsParticlesAtTheirOwnResolution) {
    // Stripes of 100 and 220 nm, 0.2 wide, on a film whose four vertices only know the mean: black-and-white.
    sim::Frame frame = flat_film(1, 160e-9);
    std::vector<double> thickness;
    for (int j = 0; j < 100; ++j)
        for (int i = 0; i < 100; ++i) {
            frame.points.position.push_back({{0.02 * i - 0.99, 0.02 * j - 0.99, 0.0}});
            thickness.push_back(i / 10 % 2 == 0 ? 100e-9 : 220e-9);
        }
    frame.points.fields.push_back({"thickness", "m", 1, false, thickness});
    PictureOptions options = from_above();
    options.width = options.height = 100;
    const Picture picture = render_frame(frame, options);
    EXPECT_EQ(picture.thickness_origin, "particles");
    const optics::FilmColors colors;
    const double tall = colors.reflected(100e-9, 1.0)[1], low = colors.reflected(220e-9, 1.0)[1];
    const Camera camera(options.view, frame_bounds(frame), 100, 100);
    const auto seen_at = [&](std::size_t column) {
        const Vec3 ray = camera.direction(static_cast<double>(column) + 0.5, 50.0);
        return camera.position()[2] * ray[0] / -ray[2];
    };
    for (int stripe = 1; stripe < 9; ++stripe) {
        const double x = 0.2 * stripe - 0.9;  // its middle; the particles there lie five spacings from its edges
        std::size_t column = 0;
        while (seen_at(column) < x) ++column;
        EXPECT_NEAR(color_at(picture, column, 50)[1], stripe % 2 == 0 ? tall : low, 0.03 * std::abs(tall - low))
            << stripe;
    }
}

TEST_F(RenderFrame, ShowsSolids) {
    sim::Frame frame = flat_film(3, 100e-9);
    frame.solids = {{{{0.0, 0.0, 0.0}}, 0.4}};
    PictureOptions options = from_above();
    options.background = "transparent";
    const Picture picture = render_frame(frame, options);
    EXPECT_EQ(picture.light.pixel(24, 18)[3], 1.0F);  // opaque
    EXPECT_LT(picture.light.pixel(40, 18)[3], 0.1F);  // the film beside it
    options.field = "thickness";                      // fields color films; solids stay as they are
    EXPECT_LT(color_at(render_frame(frame, options), 24, 18)[1], 0.2);

    frame.solids[0].center = {{0.0, 0.0, 3.0}};  // what the camera looks at has them in it
    EXPECT_NEAR(frame_bounds(frame).center[2], 1.7, 1e-12);
}

TEST_F(RenderFrame, SaysThatAThicknessIsAssumed) {
    EXPECT_EQ(render_frame(sphere_film(1), from_above()).thickness_origin.substr(0, 8), "assumed:");
}

TEST_F(RenderFrame, TellsHowFarItIsAndStopsWhenTold) {
    double last = 0.0;
    render_frame(one_ball(), from_above(), [&](double fraction) {
        EXPECT_GT(fraction, last);
        last = fraction;
    });
    EXPECT_EQ(last, 1.0);
    EXPECT_THROW(render_frame(one_ball(), from_above(), [](double) { throw Interrupted(); }), Interrupted);
}

TEST_F(RenderFrame, RefusesWhatMakesNoPicture) {
    const auto refuses = [](const sim::Frame& frame, const PictureOptions& options, const char* words) {
        try {
            render_frame(frame, options);
            ADD_FAILURE() << words;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    };
    refuses({}, from_above(), "nothing to be seen");
    PictureOptions options = from_above();
    options.field = "presure";
    refuses(one_ball(), options, "did you mean pressure?");
    options = from_above();
    options.environment = "studoi";
    refuses(one_ball(), options, "did you mean studio?");
    options = from_above();
    options.background = "#12345";
    refuses(one_ball(), options, "no background #12345");
    options = from_above();
    options.samples = 0;
    refuses(one_ball(), options, "samples = 0");
    sim::Frame broken = flat_film(1);
    broken.surface.triangles[0][0] = 99;
    refuses(broken, from_above(), "vertex 99");
    broken = flat_film(1);
    broken.surface.position[0][0] = std::nan("");
    refuses(broken, from_above(), "");
}

TEST(Develop, CompressesHighlightsAndDrawsTheLegend) {
    Picture picture;
    picture.shown = {2, 1, 4, {0.2F, 0.2F, 0.2F, 1.0F, 0.2F, 0.2F, 0.2F, 1.0F}};
    EXPECT_NEAR(static_cast<double>(develop(picture).at(0, 0)[0]), optics::encode_srgb(0.2), 1e-5);
    picture.shown = {200, 150, 4, std::vector<float>(200 * 150 * 4, 0.0F)};
    picture.scale = ColorScale{"radius", "m", 0.0, 1.0, false};
    const Canvas with_legend = develop(picture);
    double ink = 0.0;
    for (std::size_t y = 0; y < 150; ++y)
        ink += static_cast<double>(with_legend.at(150, y)[1] + with_legend.at(160, y)[1]);
    EXPECT_GT(ink, 10.0);
}

}  // namespace
}  // namespace lamella::render
