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

const sim::Field* field_of(const sim::Surface& s, const char* name, int components) {
    const sim::Field* field = s.find_of_vertices(name);
    return field != nullptr && field->components == components ? field : nullptr;
}

/// Places, with colors where there are some, then texture coordinates and normals.
void write_vertices(std::ostream& stream, const sim::Surface& s) {
    auto out = std::ostream_iterator<char>(stream);
    const sim::Field* color = field_of(s, "color", 3);
    for (std::size_t v = 0; v < s.position.size(); ++v) {
        const Vec3& x = s.position[v];
        fmt::format_to(out, "v {:.17g} {:.17g} {:.17g}", x[0], x[1], x[2]);
        for (std::size_t k = 0; color != nullptr && k < 3; ++k)
            fmt::format_to(out, " {:.4g}", color->values[3 * v + k] / 255.0);
        stream << '\n';
    }
    if (const sim::Field* thickness = field_of(s, "thickness_nm", 1))
        for (const double nm : thickness->values) fmt::format_to(out, "vt {:.6g} 0\n", 1e-3 * nm);
    if (const sim::Field* normal = field_of(s, "normal", 3))
        for (std::size_t v = 0; v < s.position.size(); ++v)
            fmt::format_to(out, "vn {:.6g} {:.6g} {:.6g}\n", normal->values[3 * v], normal->values[3 * v + 1],
                           normal->values[3 * v + 2]);
}

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
    write_vertices(stream, s);
    const bool textured = field_of(s, "thickness_nm", 1) != nullptr, lit = field_of(s, "normal", 3) != nullptr;
    std::map<std::array<std::int32_t, 2>, std::vector<std::size_t>> films;
    for (std::size_t f = 0; f < s.triangles.size(); ++f) films[s.regions[f]].push_back(f);
    for (const auto& [regions, faces] : films) {
        fmt::format_to(out, "g film_{}_{}\n", regions[0], regions[1]);
        for (const std::size_t f : faces) {
            stream << 'f';
            for (const std::uint32_t v : s.triangles[f]) {
                stream << ' ' << v + 1;
                if (textured || lit) stream << '/';
                if (textured) stream << v + 1;
                if (lit) stream << '/' << v + 1;
            }
            stream << '\n';
        }
    }
    write_wire(stream, s);
    detail::finish(stream);
}

}  // namespace lamella::io
