// Hostile frames, collections and tables. The input is tried as a file of each kind; it is also taken as a list of
// changes to a valid frame, as random bytes would hardly ever get past the XML.

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"
#include "lamella/io/csv.h"
#include "lamella/io/frame_files.h"

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace {

using lamella::sim::Frame;

std::string valid_vtp() {
    Frame frame;
    frame.solver = "bubble";
    frame.box = lamella::sim::Box{2, {}, {{1.0, 1.0, 0.0}}, {true, true, false}};
    frame.scalars = {{"energy", "J", 0.5, "a & b"}};
    frame.points.position = {{{0.0, 0.5, 0.0}}, {{1.0, 0.5, 0.0}}};
    frame.points.radius = {0.1, 0.2};
    frame.points.fields = {{"velocity", "m/s", 3, false, {1, 2, 3, 4, 5, 6}}, {"id", "-", 1, true, {7, 8}}};
    frame.surface.position = {{{0.0, 0.0, 0.0}}, {{1.0, 0.0, 0.0}}, {{0.0, 1.0, 0.0}}};
    frame.surface.triangles = {{0, 1, 2}};
    frame.surface.regions = {{0, 1}};
    frame.surface.vertex_fields = {{"thickness", "m", 1, false, {1, 2, 3}}};
    frame.surface.face_fields = {{"tension", "N/m", 1, false, {0.025}}};
    frame.surface.region_fields = {{"closed", "-", 1, true, {0, 1}}, {"pressure", "Pa", 1, false, {0, 2.5}}};
    const auto path = std::filesystem::temp_directory_path() / ("lamella-frame-fuzz." + std::to_string(getpid()));
    lamella::io::write_vtp(path, frame);
    const std::string text = lamella::io::read_file(path);
    std::filesystem::remove(path);
    return text;
}

/// Three bytes of input are one change: two say where, the third is put there.
std::string changed(std::string text, std::string_view changes) {
    for (; changes.size() >= 3; changes.remove_prefix(3)) {
        const auto byte = [&](std::size_t k) { return std::size_t{static_cast<std::uint8_t>(changes[k])}; };
        text[(byte(0) << 8 | byte(1)) % text.size()] = changes[2];
    }
    return text;
}

void expect_no_crash(const std::function<void()>& read) {
    try {
        read();
    } catch (const lamella::InputError&) {  // the only polite answer; anything else ends the fuzzer
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string valid = valid_vtp();
    const std::string_view input(reinterpret_cast<const char*>(data), size);
    expect_no_crash([&] { lamella::io::parse_vtp(input, "fuzz.vtp"); });
    expect_no_crash([&] { lamella::io::parse_vtp(changed(valid, input), "fuzz.vtp"); });
    expect_no_crash([&] { lamella::io::parse_pvd(input, "fuzz.pvd"); });
    expect_no_crash([&] { lamella::io::parse_csv(input, "fuzz.csv"); });
    return 0;
}
