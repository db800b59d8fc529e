#include "lamella/core/error.h"
#include "lamella/io/detail/frame_table.h"
#include "lamella/io/detail/text_rows.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <ostream>
#include <utility>
#include <vector>

namespace lamella::io {
namespace {

/// Vertices on wires as points of a group `wire`: programs that draw faces leave them out.
void write_wire(std::ostream& stream, const sim::Surface& s) {
    for (const sim::Field& field : s.vertex_fields) {
        if (field.name != "on_wire" || field.values.size() != s.position.size()) continue;
        bool first = true;
        for (std::size_t v = 0; v < s.position.size(); ++v) {
            if (field.values[v] == 0.0) continue;
            if (std::exchange(first, false)) stream << "g wire\n";
            stream << "p " << v + 1 << '\n';
        }
    }
}

}  // namespace

void write_obj(std::ostream& stream, const sim::Frame& frame) {
    detail::check_frame(frame);
    const sim::Surface& s = frame.surface;
    if (s.empty()) throw InputError("the frame has no films; OBJ holds nothing else");
    auto out = std::ostream_iterator<char>(stream);
    fmt::format_to(out, "# Films of lamella, solver {}, time {}. Group film_B_F: region B behind, F in front\n",
                   frame.solver, frame.time);
    for (const Vec3& x : s.position) fmt::format_to(out, "v {:.17g} {:.17g} {:.17g}\n", x[0], x[1], x[2]);
    std::map<std::array<std::int32_t, 2>, std::vector<std::size_t>> films;
    for (std::size_t f = 0; f < s.triangles.size(); ++f) films[s.regions[f]].push_back(f);
    for (const auto& [regions, faces] : films) {
        fmt::format_to(out, "g film_{}_{}\n", regions[0], regions[1]);
        for (const std::size_t f : faces)
            fmt::format_to(out, "f {} {} {}\n", s.triangles[f][0] + 1, s.triangles[f][1] + 1, s.triangles[f][2] + 1);
    }
    write_wire(stream, s);
    detail::finish(stream);
}

}  // namespace lamella::io
