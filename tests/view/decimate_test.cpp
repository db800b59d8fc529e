#include "lamella/core/error.h"

#include <gtest/gtest.h>

#include "films.h"
#include "view/decimate.h"
#include <algorithm>
#include <limits>
#include <set>

namespace lamella::app::view {
namespace {

TEST(Thinned, LeavesWhatIsSmallEnoughAsItIs) {
    const sim::Surface surface = three_sheets(4).surface;
    EXPECT_EQ(thinned(surface, surface.triangles.size()).triangles, surface.triangles);
}

TEST(Thinned, KeepsFilmsAreasAndValuesOfAFineSurface) {
    const sim::Surface fine = three_sheets(60).surface;  // 21600 triangles
    const sim::Surface coarse = thinned(fine, 3000);
    EXPECT_LE(coarse.triangles.size(), 3000u);
    EXPECT_GT(coarse.triangles.size(), 1000u);  // no coarser than needed
    ASSERT_EQ(coarse.regions.size(), coarse.triangles.size());
    const std::set<std::array<std::int32_t, 2>> regions(coarse.regions.begin(), coarse.regions.end());
    EXPECT_EQ(regions.size(), 6u);

    double area = 0.0;
    for (const auto& [a, b, c] : coarse.triangles)
        area += 0.5 * norm(cross(coarse.position[b] - coarse.position[a], coarse.position[c] - coarse.position[a]));
    EXPECT_NEAR(area, 3.0, 3.0 * 0.1);  // a cell is 0.045 wide: up to half of that is lost along the rims
    const sim::Field* height = coarse.find_of_vertices("height");
    ASSERT_NE(height, nullptr);
    for (std::size_t v = 0; v < coarse.position.size(); ++v) EXPECT_EQ(height->values[v], coarse.position[v][2]);
    ASSERT_NE(coarse.find_of_faces("sheet"), nullptr);
    EXPECT_EQ(coarse.find_of_faces("sheet")->values.size(), coarse.triangles.size());
}

TEST(Thinned, TakesEveryKthPointWithItsFields) {
    sim::Points points;
    sim::Field number{"number", "-", 1, true, {}};
    for (int i = 0; i < 1000; ++i) {
        points.position.push_back({{double(i), 0.0, 0.0}});
        points.radius.push_back(double(i));
        number.values.push_back(double(i));
    }
    points.fields.push_back(number);
    const sim::Points few = thinned(points, 300);
    ASSERT_EQ(few.size(), 250u);
    for (std::size_t i = 0; i < few.size(); ++i) {
        EXPECT_EQ(few.position[i][0], 4.0 * double(i));
        EXPECT_EQ(few.radius[i], 4.0 * double(i));
        EXPECT_EQ(few.fields[0].values[i], 4.0 * double(i));
    }
}

TEST(Thinned, RefusesDamagedSurfaces) {
    sim::Surface surface = three_sheets(8).surface;
    surface.position[3][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(thinned(surface, 10), InputError);
    surface = three_sheets(8).surface;
    surface.vertex_fields[0].values.pop_back();
    EXPECT_THROW(thinned(surface, 10), InputError);
}

}  // namespace
}  // namespace lamella::app::view
