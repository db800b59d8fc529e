#include "lamella/core/error.h"
#include "lamella/io/frame_files.h"

#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

namespace lamella::test {
namespace {

/// Two triangles that share an edge, each its own film, with what programs that draw want to know.
sim::Frame two_films() {
    sim::Frame frame;
    frame.solver = "melp";
    frame.time = 0.5;
    sim::Surface& s = frame.surface;
    s.position = {{{0.0, 0.0, 0.0}}, {{1.0, 0.0, 0.0}}, {{0.0, 2.0, 0.0}}, {{0.0, 0.0, 3.0}}};
    s.triangles = {{0, 1, 2}, {1, 0, 3}};
    s.regions = {{0, 1}, {0, 2}};
    s.vertex_fields = {{"normal", "-", 3, false, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0}},
                       {"thickness_nm", "nm", 1, false, {100, 200, 300, 600}},
                       {"color", "-", 3, true, {255, 0, 0, 0, 255, 0, 0, 0, 255, 188, 188, 188}}};
    return frame;
}

sim::Frame two_balls() {
    sim::Frame frame;
    frame.solver = "bubble";
    frame.points.position = {{{0.0, 0.0, 0.0}}, {{5.0, 0.0, 0.0}}};
    frame.points.radius = {1.0, 2.0};
    frame.points.fields = {{"pressure", "-", 1, false, {3.0, 4.0}}};
    return frame;
}

std::string text_of(void (*write)(std::ostream&, const sim::Frame&), const sim::Frame& frame) {
    std::ostringstream out;
    write(out, frame);
    return out.str();
}

std::uint32_t number_at(const std::string& bytes, std::size_t place) {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + place, sizeof number);
    return number;
}

struct GlbParts {
    std::string json;
    std::vector<float> floats;  ///< the binary chunk
};

GlbParts parts_of(const std::string& glb) {
    EXPECT_EQ(glb.substr(0, 4), "glTF");
    EXPECT_EQ(number_at(glb, 4), 2U);
    EXPECT_EQ(number_at(glb, 8), glb.size());
    const std::uint32_t size = number_at(glb, 12);
    EXPECT_EQ(size % 4, 0U);
    EXPECT_EQ(glb.substr(16, 4), "JSON");
    EXPECT_EQ(glb.substr(24 + size, 3), "BIN");
    GlbParts parts{glb.substr(20, size), {}};
    parts.floats.resize(number_at(glb, 20 + size) / 4);
    EXPECT_EQ(28 + size + 4 * parts.floats.size(), glb.size());
    std::memcpy(parts.floats.data(), glb.data() + 28 + size, 4 * parts.floats.size());
    return parts;
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Glb, HoldsEachFilmWithItsFieldsAndMaterial) {
    const GlbParts parts = parts_of(text_of(io::write_glb, two_films()));
    for (const char* text :
         {R"("name":"film_0_1")", R"("name":"film_0_2")", R"("region_back":0,"region_front":2)", R"("_THICKNESS_NM":2)",
          R"("iridescenceThicknessMaximum":200}})", R"("iridescenceThicknessMaximum":300}})", R"("time":0.5)"})
        EXPECT_TRUE(holds(parts.json, text)) << text << " in " << parts.json;
    // First film: places, normals, thicknesses, linear colors; (x, y, z) stands as (x, z, -y).
    const std::vector<float> expected{0, 0, 0, 1,   0,   0,   0, 0, -2, 0, 1, 0, 0, 1, 0,
                                      0, 1, 0, 100, 200, 300, 1, 0, 0,  0, 1, 0, 0, 0, 1};
    ASSERT_GE(parts.floats.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(parts.floats[i], expected[i]) << i;
    EXPECT_TRUE(holds(parts.json, R"("min":[0,0,-2],"max":[1,0,0])")) << parts.json;
}

TEST(Glb, MakesPolyhedraOfBalls) {
    const GlbParts parts = parts_of(text_of(io::write_glb, two_balls()));
    EXPECT_TRUE(holds(parts.json, R"("name":"bubbles")"));
    EXPECT_TRUE(holds(parts.json, R"("count":84,"type":"VEC3","min":[)"));  // 42 vertices each
    for (std::size_t v = 0; v < 84; ++v) {
        const float* p = &parts.floats[3 * v];
        const float x = v < 42 ? p[0] : p[0] - 5.0F;
        EXPECT_NEAR(std::sqrt(x * x + p[1] * p[1] + p[2] * p[2]), v < 42 ? 1.0 : 2.0, 1e-6);
    }
    EXPECT_FALSE(holds(parts.json, "iridescence"));
}

TEST(Glb, HoldsSolidsAsAMeshOfTheirOwn) {
    sim::Frame frame = two_films();
    frame.solids = {{{{1.0, 2.0, 3.0}}, 0.5}};
    const GlbParts parts = parts_of(text_of(io::write_glb, frame));
    // Twelve corners of an icosahedron, and 30, 120, 480 middles of edges.
    EXPECT_TRUE(holds(parts.json, R"("name":"solids","primitives":[{"attributes":{"POSITION":10,"NORMAL":11},)"))
        << parts.json;
    EXPECT_TRUE(holds(parts.json, R"("count":642,"type":"VEC3","min":[0.5,)")) << parts.json;
    EXPECT_TRUE(holds(parts.json, R"({"name":"solids","pbrMetallicRoughness":{"baseColorFactor":[0.05,)"));
}

TEST(Usda, HoldsSolidsAsSpheres) {
    sim::Frame frame = two_films();
    frame.solids = {{{{1.0, 2.0, 3.0}}, 0.5}};
    const std::string text = text_of(io::write_usda, frame);
    EXPECT_TRUE(holds(text, "    def Sphere \"solid_0\"\n    {\n        double radius = 0.5\n"));
    EXPECT_TRUE(holds(text, "double3 xformOp:translate = (1, 2, 3)\n"));
}

TEST(Usda, IsThisText) {
    EXPECT_EQ(text_of(io::write_usda, two_films()), R"(#usda 1.0
(
    defaultPrim = "lamella"
    metersPerUnit = 1
    upAxis = "Z"
)

def Xform "lamella"
{
    custom string solver = "melp"
    custom double time = 0.5
    def Mesh "films"
    {
        uniform bool doubleSided = 1
        uniform token subdivisionScheme = "none"
        float3[] extent = [(0, 0, 0), (1, 2, 3)]
        int[] faceVertexCounts = [3, 3]
        int[] faceVertexIndices = [0, 1, 2, 1, 0, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3)]
        normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 1, 0)] (
            interpolation = "vertex"
        )
        float[] primvars:thickness_nm = [100, 200, 300, 600] (
            interpolation = "vertex"
        )
        color3f[] primvars:displayColor = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (0.5028864580325687, 0.5028864580325687, 0.5028864580325687)] (
            interpolation = "vertex"
        )
        int[] primvars:region_back = [0, 0] (
            interpolation = "uniform"
        )
        int[] primvars:region_front = [1, 2] (
            interpolation = "uniform"
        )
    }
}
)");
}

TEST(Usda, GivesBallsTheirWidths) {
    const std::string text = text_of(io::write_usda, two_balls());
    EXPECT_TRUE(holds(text, "float[] widths = [2, 4]"));
    EXPECT_TRUE(holds(text, "float[] primvars:pressure = [3, 4]"));
    EXPECT_TRUE(holds(text, "extent = [(-2, -2, -2), (7, 2, 2)]"));
}

TEST(DrawingFormats, RefuseFramesWithoutAnything) {
    EXPECT_THROW(text_of(io::write_glb, {}), InputError);
    EXPECT_THROW(text_of(io::write_usda, {}), InputError);
}

TEST(Ply, GivesNormalsAndColorsTheNamesThatOthersKnow) {
    const std::string text = text_of(io::write_ply, two_films());
    EXPECT_TRUE(holds(text,
                      "property double nx\nproperty double ny\nproperty double nz\nproperty double thickness_nm\n"
                      "property uchar red\nproperty uchar green\nproperty uchar blue\n"));
    const std::size_t row = 3 * 8 + 3 * 8 + 8 + 3, body = text.find("end_header\n") + 11;
    EXPECT_EQ(text.size(), body + 4 * row + 2 * (1 + 3 * 4 + 2 * 4));
    EXPECT_EQ(text[body + row - 3], '\xff');
}

TEST(Obj, HasNormalsColorsAndThicknessesWhereTheFrameHasThem) {
    const std::string text = text_of(io::write_obj, two_films());
    EXPECT_TRUE(holds(text, "v 0 0 0 1 0 0\n"));
    EXPECT_TRUE(holds(text, "vt 0.1 0\n"));
    EXPECT_TRUE(holds(text, "vn 0 1 0\n"));
    EXPECT_TRUE(holds(text, "f 1/1/1 2/2/2 3/3/3\n"));
}

}  // namespace
}  // namespace lamella::test
