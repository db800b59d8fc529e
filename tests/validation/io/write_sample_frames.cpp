// Writes four frames into a folder for read_vtp_with_vtk.py, which knows the same formulas for their values.

#include "lamella/io/frame_files.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace {

using lamella::Vec3;
using lamella::sim::Field;
using lamella::sim::Frame;

Field field(const std::string& name, const std::string& unit, int components, std::size_t count) {
    Field f{name, unit, components, false, {}};
    for (std::size_t i = 0; i < count * static_cast<std::size_t>(components); ++i) {
        f.values.push_back(static_cast<double>(i) / 3.0 - 1e-9);
    }
    return f;
}

Field whole(const std::string& name, std::size_t count) {
    Field f{name, "-", 1, true, {}};
    for (std::size_t i = 0; i < count; ++i) f.values.push_back(9007199254740992.0 - static_cast<double>(i));
    return f;
}

Frame described() {
    Frame frame;
    frame.solver = "bubble";
    frame.time = 0.1;
    frame.step = 42;
    frame.box = lamella::sim::Box{2, {{-1.0, 0.5, 0.0}}, {{3.0, 4.0, 0.0}}, {true, false, false}};
    frame.scalars = {{"energy", "J", 1.0 / 3.0, "kinetic & <potential>"}, {"gas_fraction", "-", 0.9, ""}};
    return frame;
}

/// A count beyond one compressed block of 32768 doubles.
void add_points(Frame& frame, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto x = static_cast<double>(i);
        frame.points.position.push_back({{x, -x / 3.0, 0.5}});
        frame.points.radius.push_back(1.0 / (1.0 + x));
    }
    frame.points.fields = {field("velocity", "m/s", 3, count), field("pressure", "Pa", 1, count), whole("id", count),
                           field("stress", "Pa", 9, count)};
}

void add_surface(Frame& frame, std::uint32_t triangles) {
    auto& surface = frame.surface;
    for (std::uint32_t i = 0; i < triangles + 2; ++i) surface.position.push_back({{0.5 * i, 0.25, -1.0 * i}});
    for (std::uint32_t i = 0; i < triangles; ++i) {
        surface.triangles.push_back({0, i + 1, i + 2});
        surface.regions.push_back({static_cast<std::int32_t>(i % 3), 4});
    }
    surface.vertex_fields = {field("thickness", "m", 1, triangles + 2), field("velocity", "m/s", 3, triangles + 2)};
    surface.face_fields = {field("tension", "N/m", 1, triangles), whole("film", triangles)};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: write_sample_frames FOLDER\n");
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    lamella::io::write_vtp(folder / "empty.vtp", described());
    Frame points = described();
    add_points(points, 40000);
    lamella::io::write_vtp(folder / "points.vtp", points);
    Frame surface = described();
    add_surface(surface, 500);
    lamella::io::write_vtp(folder / "surface.vtp", surface);
    Frame both = described();
    add_surface(both, 500);
    add_points(both, 400);
    lamella::io::write_vtp(folder / "both.vtp", both);
    return 0;
}
