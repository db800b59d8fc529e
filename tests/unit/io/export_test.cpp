#include "lamella/core/error.h"
#include "lamella/io/frame_files.h"

#include <gtest/gtest.h>

#include "sample_frames.h"
#include "temporary_folder.h"
#include <cstring>
#include <fstream>
#include <sstream>

namespace lamella::test {
namespace {

sim::Frame two_bubbles() {
    sim::Frame frame;
    frame.solver = "bubble";
    frame.time = 0.25;
    frame.time_unit = "-";
    frame.step = 7;
    frame.box = sim::Box{
        .dimension = 2, .origin = {{0.0, -1.0, 0.0}}, .lengths = {{3.0, 4.0, 0.0}}, .periodic = {true, true, false}};
    frame.points.length_unit = "-";
    frame.points.position = {{{0.1, 0.5, 0.0}}, {{2.0, -0.25, 0.0}}};
    frame.points.radius = {0.5, 0.75};
    frame.points.fields = {{"velocity", "-", 3, false, {1e-9, 0.0, 0.0, kNan, 2.5, -1.0}},
                           {"id", "-", 1, true, {1234567.0, 3.0}}};
    frame.scalars = {{"gas_fraction", "-", 0.9, "gas volume / box volume"}};
    return frame;
}

sim::Frame one_triangle() {
    sim::Frame frame;
    frame.solver = "melp";
    frame.surface.position = {{{0.0, 0.0, 0.0}}, {{1.0, 0.0, 0.0}}, {{0.0, 1.0, 0.0}}};
    frame.surface.triangles = {{0, 1, 2}};
    frame.surface.regions = {{0, 2}};
    frame.surface.vertex_fields = {{"thickness", "m", 1, false, {1e-7, 2e-7, 3e-7}}};
    frame.surface.face_fields = {{"film", "-", 1, true, {5.0}}, {"area", "m^2", 1, false, {0.5}}};
    return frame;
}

std::string text_of(void (*write)(std::ostream&, const sim::Frame&), const sim::Frame& frame) {
    std::ostringstream out;
    write(out, frame);
    return out.str();
}

TEST(ExtendedXyz, IsThisText) {
    EXPECT_EQ(text_of(io::write_extended_xyz, two_bubbles()),
              "2\n"
              "Lattice=\"3 0 0 0 4 0 0 0 1.5\" Origin=\"0 -1 -0.75\" pbc=\"T T F\" "
              "Properties=species:S:1:pos:R:3:radius:R:1:velo:R:3:id:I:1 Time=0.25 step=7 solver=bubble "
              "units=\"Time -, pos -, radius -, velo -, id -, gas_fraction -\" gas_fraction=0.9\n"
              "X 0.1 0.5 0 0.5 1e-09 0 0 1234567\n"
              "X 2 -0.25 0 0.75 nan 2.5 -1 3\n");
}

TEST(ExtendedXyz, KeepsItsSeparatorsOutOfNames) {
    sim::Frame frame;
    frame.solver = "a b=\"c\"";
    frame.points.position = {{{1.0, 2.0, 3.0}}};
    frame.points.fields = {{"my field:x", "m s", 1, false, {4.0}}, {"stress", "Pa", 9, false, std::vector(9, 5.0)}};
    EXPECT_EQ(text_of(io::write_extended_xyz, frame),
              "1\n"
              "pbc=\"F F F\" Properties=species:S:1:pos:R:3:my_field_x:R:1:stress_tensor:R:9 Time=0 step=0 "
              "solver=a_b__c_ units=\"Time s, pos m, my_field_x m_s, stress_tensor Pa\"\n"
              "X 1 2 3 4 5 5 5 5 5 5 5 5 5\n");
}

TEST(PointsCsv, IsThisText) {
    EXPECT_EQ(text_of(io::write_points_csv, two_bubbles()),
              "x[-],y[-],z[-],radius[-],velocity_x[-],velocity_y[-],velocity_z[-],id[-]\n"
              "0.1,0.5,0,0.5,1e-09,0,0,1234567\n"
              "2,-0.25,0,0.75,nan,2.5,-1,3\n");
}

TEST(PointsCsv, KeepsTheOrderOfManyRows) {
    sim::Frame frame;
    const std::size_t count = 300000;  // more than one batch of parallel blocks
    for (std::size_t i = 0; i < count; ++i) frame.points.position.push_back({{static_cast<double>(i), 0.0, 0.0}});
    std::istringstream lines(text_of(io::write_points_csv, frame));
    std::string line;
    std::getline(lines, line);
    for (std::size_t i = 0; i < count; ++i) {
        std::getline(lines, line);
        ASSERT_EQ(std::stod(line), static_cast<double>(i));
    }
    EXPECT_FALSE(std::getline(lines, line));
}

TEST(TextFormats, RefuseASurfaceWithoutPointsButNotAnEmptyFrame) {
    EXPECT_ERROR(text_of(io::write_extended_xyz, one_triangle()), InputError, "surface only; ply holds both");
    EXPECT_ERROR(text_of(io::write_points_csv, one_triangle()), InputError, "surface only; ply holds both");
    EXPECT_EQ(text_of(io::write_points_csv, {}), "x[m],y[m],z[m]\n");
}

template <class Value>
Value take(std::string_view& bytes) {
    Value value;
    std::memcpy(&value, bytes.data(), sizeof value);
    bytes.remove_prefix(sizeof value);
    return value;
}

TEST(Ply, HoldsASurfaceWithItsRegionsAndFields) {
    const std::string text = text_of(io::write_ply, one_triangle());
    const std::string header =
        "ply\nformat binary_little_endian 1.0\n"
        "comment lamella melp frame, time 0 s, step 0\n"
        "comment unit x y z m\ncomment unit thickness m\ncomment unit face film -\ncomment unit face area m^2\n"
        "element vertex 3\nproperty double x\nproperty double y\nproperty double z\nproperty double thickness\n"
        "element face 1\nproperty list uchar int vertex_indices\nproperty int region_back\nproperty int region_front\n"
        "property int film\nproperty double area\nend_header\n";
    ASSERT_EQ(text.substr(0, header.size()), header);
    std::string_view body = std::string_view(text).substr(header.size());
    ASSERT_EQ(body.size(), 3U * 4 * 8 + 1 + 6 * 4 + 8);
    for (const double expected : {0.0, 0.0, 0.0, 1e-7, 1.0, 0.0, 0.0, 2e-7, 0.0, 1.0, 0.0, 3e-7}) {
        EXPECT_EQ(take<double>(body), expected);
    }
    EXPECT_EQ(take<std::uint8_t>(body), 3);
    for (const std::int32_t expected : {0, 1, 2, 0, 2, 5}) EXPECT_EQ(take<std::int32_t>(body), expected);
    EXPECT_EQ(take<double>(body), 0.5);
}

TEST(Ply, ListsSurfaceVerticesBeforePointsAndPadsTheirFields) {
    sim::Frame frame = two_bubbles();
    frame.surface = one_triangle().surface;
    frame.points.fields[1].values[0] = 3e9;  // no 32-bit integer
    const std::string text = text_of(io::write_ply, frame);
    EXPECT_NE(text.find("property double id\n"), std::string::npos);
    std::string_view body = std::string_view(text).substr(text.find("end_header\n") + 11);
    // x y z radius thickness velocity_x velocity_y velocity_z id
    for (int k = 0; k < 3; ++k) take<double>(body);
    EXPECT_TRUE(std::isnan(take<double>(body)));
    EXPECT_EQ(take<double>(body), 1e-7);
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isnan(take<double>(body)));
    EXPECT_EQ(take<double>(body), -1.0);
    body.remove_prefix(2 * 9 * 8);
    EXPECT_EQ(take<double>(body), 0.1);
    EXPECT_EQ(take<double>(body), 0.5);
    take<double>(body);
    EXPECT_EQ(take<double>(body), 0.5);
    EXPECT_TRUE(std::isnan(take<double>(body)));
    EXPECT_EQ(take<double>(body), 1e-9);
    for (int k = 0; k < 2; ++k) take<double>(body);
    EXPECT_EQ(take<double>(body), 3e9);
}

TEST(FrameFormats, HaveDistinctNamesAndTellWhenTheStreamFails) {
    std::set<std::string> names;
    for (const io::FrameFormat& format : io::frame_formats()) {
        EXPECT_TRUE(names.insert(format.name).second);
        EXPECT_FALSE(format.summary.empty());
        std::ofstream full("/dev/full");
        if (!full) GTEST_SKIP() << "this system has no /dev/full";
        const bool films_only = format.name == "obj" || format.name == "fe";
        EXPECT_ERROR(format.write(full, films_only ? surface_frame(4) : two_bubbles()), IoError,
                     "cannot write the exported frame");
    }
    EXPECT_EQ(names, (std::set<std::string>{"ply", "obj", "glb", "usda", "fe", "xyz", "csv"}));
}

TEST(Pvd, ReadsBackTimesAndNames) {
    const TemporaryFolder folder;
    const std::vector<io::FrameEntry> entries{
        {0.0, "frames/000000.vtp"}, {0.1, "frames/a & <b> \"c\".vtp"}, {1.0 / 3.0, "frames/µ.vtp"}};
    io::write_pvd(folder / "frames.pvd", entries);
    const auto read = io::read_pvd(folder / "frames.pvd");
    ASSERT_EQ(read.size(), entries.size());
    for (std::size_t i = 0; i < entries.size(); ++i) {
        EXPECT_EQ(read[i].time, entries[i].time);
        EXPECT_EQ(read[i].file, entries[i].file);
    }
    io::write_pvd(folder / "none.pvd", {});
    EXPECT_TRUE(io::read_pvd(folder / "none.pvd").empty());
    EXPECT_ERROR(io::write_pvd(folder / "bad.pvd", {{0.0, "a\nb"}}), InputError, "not UTF-8 on one line");
}

TEST(Pvd, SaysWhatIsWrong) {
    const std::string start = "<VTKFile type=\"Collection\">\n<Collection>\n";
    EXPECT_ERROR(io::parse_pvd("", "f.pvd"), InputError, "f.pvd:1: is not a ParaView collection");
    EXPECT_ERROR(io::parse_pvd("<VTKFile type=\"PolyData\">", "f.pvd"), InputError, "is not a ParaView collection");
    EXPECT_ERROR(io::parse_pvd(start, "f.pvd"), InputError, "</VTKFile> is missing");
    EXPECT_ERROR(io::parse_pvd(start + "<DataSet timestep=\"x\" file=\"a\"/>", "f.pvd"), InputError,
                 "f.pvd:3: timestep = \"x\"");
    EXPECT_ERROR(io::parse_pvd(start + "<DataSet timestep=\"1\"/>", "f.pvd"), InputError, "has no file");
    EXPECT_ERROR(io::parse_pvd(start + "<DataSet timestep=1/>", "f.pvd"), InputError, "no quoted value");
    EXPECT_ERROR(io::parse_pvd(start + "<DataSet timestep=\"1", "f.pvd"), InputError, "does not end");
    EXPECT_ERROR(io::parse_pvd(start + "<DataSet a=\"&lol;\"/>", "f.pvd"), InputError, "XML entities");
    EXPECT_ERROR(io::parse_pvd("<?xml", "f.pvd"), InputError, "\"?>\" is missing");
    EXPECT_ERROR(io::parse_pvd("<1", "f.pvd"), InputError, "f.pvd:1");
}

}  // namespace
}  // namespace lamella::test
