#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/io/frame_files.h"

#include <gtest/gtest.h>

#include "sample_frames.h"
#include "temporary_folder.h"
#include <functional>
#include <regex>

namespace lamella::test {
namespace {

using io::parse_vtp;
using io::read_vtp;
using io::write_vtp;

std::string vtp_text(const sim::Frame& frame) {
    const TemporaryFolder folder;
    write_vtp(folder / "frame.vtp", frame);
    return contents_of(folder / "frame.vtp");
}

void expect_round_trip(const sim::Frame& frame) { expect_same(parse_vtp(vtp_text(frame), "frame.vtp"), frame); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(Vtp, ReadsBackPointsWithEveryKindOfField) { expect_round_trip(points_frame(1000)); }
TEST(Vtp, ReadsBackASurfaceWithRegionsAndFaceFields) { expect_round_trip(surface_frame(500)); }
TEST(Vtp, ReadsBackSurfaceAndPointsTogether) { expect_round_trip(full_frame(700, 300)); }
TEST(Vtp, ReadsBackAnEmptyFrame) {
    expect_round_trip({});
    expect_round_trip(described_frame());
    expect_round_trip(full_frame(0, 0));
}

TEST(Vtp, KeepsFieldsOfASetThatIsEmptyNow) {
    sim::Frame frame = points_frame(5);
    frame.surface.vertex_fields = {{"thickness", "m", 1, false, {}}, {"film", "-", 1, true, {}}};
    frame.surface.face_fields = {{"tension", "N/m", 1, false, {}}};
    expect_round_trip(frame);
}

TEST(Vtp, KeepsTheOrderOfFieldsThatSurfaceAndPointsShare) {
    sim::Frame frame = full_frame(4, 3);
    std::reverse(frame.points.fields.begin(), frame.points.fields.end());
    expect_round_trip(frame);
}

TEST(Vtp, ReadsBackPointsWithoutRadiusInADimensionlessBox) {
    sim::Frame frame = points_frame(3);
    frame.points.radius.clear();
    frame.points.length_unit = "-";
    frame.time_unit = "-";
    frame.box->dimension = 3;
    expect_round_trip(frame);
}

TEST(Vtp, ReadsBackArraysOfManyCompressedBlocks) {
    sim::Frame frame;  // 256 KiB per block: a partial last block, a full one, and one that just begins
    for (const std::size_t count : {std::size_t{32768}, std::size_t{65536}, std::size_t{65537}}) {
        frame.points.position.assign(count, {{1.0, 2.0, 3.0}});
        frame.points.fields = {whole_field("id", count), awkward_field("pressure", "Pa", 1, count)};
        expect_round_trip(frame);
    }
}

TEST(Vtp, WritesTheSameBytesOnAnyNumberOfThreads) {
    const sim::Frame frame = full_frame(60000, 20000);
    std::string one;
    {
        const ThreadLimit limit(1);
        one = vtp_text(frame);
    }
    const ThreadLimit limit(4);
    EXPECT_TRUE(one == vtp_text(frame));
}

TEST(Vtp, WritesTheSameBytesPieceByPiece) {
    const sim::Frame frame = points_frame(70001);  // several compressed blocks, and a partial one
    sim::Frame bare = frame;
    bare.points.position.clear();
    bare.points.radius.clear();
    for (sim::Field& field : bare.points.fields) field.values.clear();
    const std::string whole = vtp_text(frame);
    for (const std::size_t most : {std::size_t{1009}, std::size_t{32768}, std::size_t{600000}}) {
        const TemporaryFolder folder;
        io::VtpStream stream(folder / "a.vtp", bare, frame.points.size(), true);
        std::vector<double> values = frame.points.radius;  // pieces go across columns
        for (const sim::Field& field : frame.points.fields)
            values.insert(values.end(), field.values.begin(), field.values.end());
        for (const Vec3& x : frame.points.position) values.insert(values.end(), x.v, x.v + 3);
        for (std::span<const double> rest(values); !rest.empty();) {
            const std::size_t now = std::min(most, rest.size());
            stream.append(rest.first(now));
            rest = rest.subspan(now);
        }
        EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"a.vtp.tmp"});
        stream.commit();
        EXPECT_TRUE(contents_of(folder / "a.vtp") == whole) << most;
    }
}

TEST(Vtp, StreamsAFrameWithoutPoints) {
    sim::Frame frame = points_frame(0);
    const TemporaryFolder folder;
    io::VtpStream stream(folder / "a.vtp", frame, 0, false);
    stream.commit();
    expect_same(read_vtp(folder / "a.vtp"), frame);
}

TEST(Vtp, LeavesNothingButTheFileBehind) {
    const TemporaryFolder folder;
    write_vtp(folder / "a.vtp", points_frame(3));
    write_vtp(folder / "a.vtp", points_frame(4));
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"a.vtp"});
    EXPECT_EQ(read_vtp(folder / "a.vtp").points.size(), 4U);
}

TEST(Vtp, RefusesFramesThatContradictThemselves) {
    const auto expect_refused = [](const std::function<void(sim::Frame&)>& damage, const std::string& message) {
        sim::Frame frame = full_frame(6, 4);
        damage(frame);
        const TemporaryFolder folder;
        EXPECT_ERROR(write_vtp(folder / "a.vtp", frame), InputError, message);
        EXPECT_TRUE(names_in(folder.path()).empty());
    };
    expect_refused([](auto& f) { f.points.fields[1].values.pop_back(); }, "field \"pressure\" has 5 values; 6 items");
    expect_refused([](auto& f) { f.points.fields[1].components = 0; }, "\"pressure\"");
    expect_refused([](auto& f) { f.points.radius.pop_back(); }, "5 radii for 6 points");
    expect_refused([](auto& f) { f.points.fields[2].values[0] = 0.5; },
                   "\"id\" holds a value that is not a whole number");
    expect_refused([](auto& f) { f.points.fields[2].values[0] = kNan; },
                   "\"id\" holds a value that is not a whole number");
    expect_refused([](auto& f) { f.points.fields[2].values[0] = 1e300; },
                   "\"id\" holds a value that is not a whole number");
    expect_refused([](auto& f) { f.points.fields[1].name = "radius"; }, "\"radius\" twice");
    expect_refused([](auto& f) { f.points.fields[1].name = "id"; }, "\"id\" twice");
    expect_refused([](auto& f) { f.points.fields[1].name = ""; }, "without a name");
    expect_refused([](auto& f) { f.points.fields[1].unit = "a\nb"; }, "not one line of UTF-8");
    expect_refused([](auto& f) { f.points.fields[1].name = "\xff"; }, "not one line of UTF-8");
    expect_refused([](auto& f) { f.points.fields[0].unit = "km/h"; }, "\"velocity\" differs in unit or shape");
    expect_refused([](auto& f) { f.scalars[0].name = "step"; }, "\"step\" twice");
    expect_refused([](auto& f) { f.scalars[0].text = "two\nlines"; }, "\"energy\" is not one line");
    expect_refused([](auto& f) { f.surface.triangles[1][2] = 6; }, "vertex 6 of 6");
    expect_refused([](auto& f) { f.surface.regions.pop_back(); }, "4 triangles but 3 pairs of regions");
    expect_refused([](auto& f) { f.surface.face_fields[0].name = "region_back"; }, "\"region_back\" twice");
    expect_refused([](auto& f) { f.surface.region_fields[0].values.pop_back(); },
                   "field \"closed\" has 6 values; 5 items");
    expect_refused([](auto& f) { f.surface.region_fields[1].name = "pressure"; }, "\"pressure\" twice");
    expect_refused([](auto& f) { f.surface.regions[1][0] = 6; },
                   "region 6 beside it, but the fields of regions tell of 6");
    expect_refused([](auto& f) { f.surface.regions[1][1] = -1; }, "region -1 beside it");
    expect_refused([](auto& f) { f.scalars[0].name = "region_pressure"; }, "\"region_pressure\" twice");
    expect_refused([](auto& f) { f.scalars[0].name = "solid_radius"; }, "\"solid_radius\" twice");
    expect_refused([](auto& f) { f.solids[1].radius = 0.0; }, "solid 1 has no place or no size");
    expect_refused([](auto& f) { f.solids[0].center[2] = kNan; }, "solid 0 has no place or no size");
}

TEST(Vtp, ReadsFilesFromBeforeFieldsOfRegions) {
    sim::Frame frame = surface_frame(5);
    frame.surface.region_fields.clear();
    frame.surface.regions[0] = {-7, 1000000};  // nothing is known of them, so any number will do
    EXPECT_EQ(vtp_text(frame).find("region_field"), std::string::npos);
    expect_round_trip(frame);
}

TEST(Vtp, NamesPathAndReasonWhenItCannotWrite) {
    EXPECT_ERROR(write_vtp("/nonexistent/a.vtp", {}), IoError, "cannot write /nonexistent/a.vtp: No such file");
    EXPECT_ERROR(write_vtp("/dev/null", {}), IoError, "/dev/null: it exists and is not a regular file");
    EXPECT_ERROR(read_vtp("/nonexistent/a.vtp"), IoError, "cannot read /nonexistent/a.vtp: No such file");
}

TEST(Vtp, SaysWhatIsWrongWithAFile) {
    const std::string good = vtp_text(full_frame(6, 4));
    const auto expect_refused = [&](const std::string& from, const std::string& to, const std::string& message) {
        EXPECT_ERROR(parse_vtp(replaced(good, from, to), "f.vtp"), InputError, message);
    };
    EXPECT_ERROR(parse_vtp("", "f.vtp"), InputError, "f.vtp:1: was not written by lamella");
    EXPECT_ERROR(parse_vtp("solid cube", "f.vtp"), InputError, "was not written by lamella");
    EXPECT_ERROR(parse_vtp("<VTKFile type=\"PolyData\"/>", "f.vtp"), InputError, "f.vtp:1: was not written by lamella");
    expect_refused("lamella_frame=\"1\"", "lamella_frame=\"2\"",
                   "f.vtp:2: has version \"2\" of lamella's frame format");
    expect_refused("LittleEndian", "BigEndian", "was changed since lamella wrote it");
    expect_refused("NumberOfVerts=\"6\"", "NumberOfVerts=\"66\"", "more point cells than points");
    expect_refused("NumberOfPoints=\"12\"", "NumberOfPoints=\"-1\"",
                   "NumberOfPoints is missing or not a possible number");
    expect_refused("NumberOfPoints=\"12\"", "NumberOfPoints=\"99999999999999999999\"", "NumberOfPoints");
    expect_refused("NumberOfPoints=\"12\"", "NumberOfPoints=\"1099511627776\"", "instead of");
    expect_refused("NumberOfPolys=\"4\"", "NumberOfPolys=\"1099511627776\"", "instead of");
    expect_refused("Name=\"radius\"", "Name=\"radios\"", "\"radios\" in PointData is none of lamella's");
    expect_refused("Name=\"box_lengths\"", "Name=\"box_length\"", "is none of lamella's");
    expect_refused("type=\"Int32\" Name=\"region_back\"", "type=\"Int64\" Name=\"region_back\"", "not of type Int32");
    expect_refused("Name=\"region_front\"", "Name=\"region_back\"", "lacks its positions, triangles or region labels");
    expect_refused("<Points>", "<Point>", "not nested");
    expect_refused("offset=\"0\"", "offset=\"1\"", "is not where it should be");
    expect_refused("\n</AppendedData>", "A\n</AppendedData>", "does not end where its last array does");
    expect_refused("region_field=\"0\"", "region_field=\"x\"", "\"region_pressure\" in FieldData is none of lamella's");
    expect_refused("NumberOfTuples=\"6\" region_field=\"0\"", "NumberOfTuples=\"1099511627776\" region_field=\"0\"",
                   "instead of");
    expect_refused("Name=\"region_pressure\"", "Name=\"regio_pressure\"", "is none of lamella's");
    expect_refused("NumberOfTuples=\"2\" format=\"appended\"", "NumberOfTuples=\"1\" format=\"appended\"",
                   "does not fit to the other solids");
    expect_refused("Name=\"solid_center\"", "Name=\"solid_radius\"", "does not fit to the other solids");
    expect_refused("Name=\"solid_radius\"", "Name=\"solid_radii\"", "is none of lamella's");
    expect_refused("_", "-", "f.vtp");
}

TEST(Vtp, RefusesAFileCutAnywhere) {
    const std::string good = vtp_text(full_frame(40, 30));
    for (std::size_t length = 0; length + 1 < good.size(); length += 1 + good.size() / 997) {
        EXPECT_THROW(parse_vtp(good.substr(0, length), "f.vtp"), InputError) << length;
    }
}

TEST(Vtp, SurvivesFlippedBitsAndNoticesThemInTheData) {
    const sim::Frame frame = full_frame(40, 30);
    const std::string good = vtp_text(frame);
    const std::size_t data = good.find('_', good.find("<AppendedData"));
    std::size_t noticed = 0;
    std::size_t in_data = 0;
    for (std::size_t i = 0; i < good.size(); i += 1 + good.size() / 1999) {
        std::string bad = good;
        bad[i] = static_cast<char>(bad[i] ^ (1 << i % 8));
        in_data += i > data ? 1 : 0;
        try {
            const sim::Frame read = parse_vtp(bad, "f.vtp");
            if (i > data) expect_same(read, frame);  // a padding bit that base64 does not use
        } catch (const InputError&) {
            noticed += i > data ? 1 : 0;
        }
    }
    EXPECT_GT(in_data, 1000U);
    EXPECT_GT(noticed, in_data * 97 / 100);
}

TEST(Vtp, RefusesABlockThatClaimsMoreThanDeflateCanHold) {
    // 2^32 bytes in a block of 8 compressed ones: read before memory is taken.
    sim::Frame frame;
    frame.points.position.assign(3, {});
    std::string text = vtp_text(frame);
    text = replaced(text, "NumberOfPoints=\"3\"", "NumberOfPoints=\"178956970\"");
    text = replaced(text, "NumberOfVerts=\"3\"", "NumberOfVerts=\"178956970\"");
    EXPECT_ERROR(parse_vtp(text, "f.vtp"), InputError, "damaged");
}

}  // namespace
}  // namespace lamella::test
