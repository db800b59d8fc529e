// Films as OBJ and as Surface Evolver datafiles.

#include "lamella/core/error.h"
#include "lamella/io/frame_files.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace lamella::io {
namespace {

/// A tetrahedron: region 1 in the outside, and beside it a triangle held by a wire between regions 2 and 0.
sim::Frame films() {
    sim::Frame frame;
    frame.solver = "test";
    sim::Surface& s = frame.surface;
    s.position = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{5, 0, 0}}, {{6, 0, 0}}, {{5, 1, 0}}};
    s.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {4, 5, 6}};
    s.regions = {{1, 0}, {1, 0}, {1, 0}, {1, 0}, {2, 0}};
    s.vertex_fields.push_back({"on_wire", "-", 1, true, {0, 0, 0, 0, 1, 1, 1}});
    return frame;
}

TEST(SurfaceEvolver, WritesVerticesEdgesFacesAndBodies) {
    std::ostringstream out;
    write_surface_evolver(out, films());
    const std::string text = out.str();
    for (const char* line : {"\nvertices\n1 0 0 0\n", "\n5 5 0 0 fixed\n", "\nedges\n1 1 2\n", "\nfaces\n", "\nbodies\n",
                             "1 1 2 3 4 volume 0.1666666666666"})
        EXPECT_NE(text.find(line), std::string::npos) << line << text;
    EXPECT_NE(text.find(" 5 6 fixed\n"), std::string::npos) << text;  // an edge of the rim
    EXPECT_EQ(text.find("\n2 5"), std::string::npos) << text;         // region 2 is open: no body
}

TEST(SurfaceEvolver, TurnsFacesSeenFromTheFront) {
    sim::Frame frame = films();
    std::swap(frame.surface.triangles[0][1], frame.surface.triangles[0][2]);
    frame.surface.regions[0] = {0, 1};
    std::ostringstream out;
    write_surface_evolver(out, frame);
    EXPECT_NE(out.str().find("1 -1 2 3 4 volume 0.1666666666666"), std::string::npos) << out.str();
}

TEST(SurfaceEvolver, RefusesWhatItCannotHold) {
    std::ostringstream out;
    EXPECT_THROW(write_surface_evolver(out, {}), InputError);
    sim::Frame frame = films();
    frame.surface.triangles[0][0] = 99;
    EXPECT_THROW(write_surface_evolver(out, frame), InputError);
}

TEST(Obj, GroupsFilmsByTheirRegions) {
    std::ostringstream out;
    write_obj(out, films());
    EXPECT_NE(out.str().find("g film_1_0\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\ng film_2_0\nf 5 6 7\n"), std::string::npos)
        << out.str();
    EXPECT_THROW(write_obj(out, {}), InputError);
}

}  // namespace
}  // namespace lamella::io
