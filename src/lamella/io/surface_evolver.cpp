#include "lamella/core/error.h"
#include "lamella/io/detail/frame_table.h"
#include "lamella/io/detail/text_rows.h"
#include "lamella/io/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <ostream>
#include <set>
#include <utility>
#include <vector>

namespace lamella::io {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Edges in order of their vertices, with the numbers that a datafile gives them.
std::map<Edge, std::size_t> numbered_edges(const sim::Surface& s) {
    std::map<Edge, std::size_t> edges;
    for (const auto& t : s.triangles)
        for (std::size_t k = 0; k < 3; ++k) edges.try_emplace(std::minmax(t[k], t[(k + 1) % 3]), 0);
    std::size_t number = 0;
    for (auto& [edge, n] : edges) n = ++number;
    return edges;
}

/// Regions, other than the outside, that films close in all around: what enters along any edge leaves there.
std::set<std::int32_t> closed_regions(const sim::Surface& s) {
    std::map<std::pair<Edge, std::int32_t>, int> balance;
    std::set<std::int32_t> closed;
    for (std::size_t f = 0; f < s.triangles.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = s.triangles[f][k], b = s.triangles[f][(k + 1) % 3];
            for (const std::size_t side : {0U, 1U}) {
                const int sign = (a < b) == (side == 0) ? 1 : -1;
                balance[{std::minmax(a, b), s.regions[f][side]}] += sign;
                if (s.regions[f][side] > 0) closed.insert(s.regions[f][side]);
            }
        }
    for (const auto& [key, sum] : balance)
        if (sum != 0) closed.erase(key.second);
    return closed;
}

double volume_of(const sim::Surface& s, std::int32_t region) {
    Vec3 origin;
    for (const Vec3& x : s.position) origin += x / static_cast<double>(s.position.size());
    double volume = 0.0;
    for (std::size_t f = 0; f < s.triangles.size(); ++f)
        for (const std::size_t side : {0U, 1U}) {
            if (s.regions[f][side] != region) continue;
            const auto& t = s.triangles[f];
            const double cone =
                dot(s.position[t[0]] - origin, cross(s.position[t[1]] - origin, s.position[t[2]] - origin)) / 6.0;
            volume += side == 0 ? cone : -cone;
        }
    return volume;
}

}  // namespace

void write_surface_evolver(std::ostream& stream, const sim::Frame& frame) {
    detail::check_frame(frame);
    const sim::Surface& s = frame.surface;
    if (s.empty()) throw InputError("the frame has no films; a Surface Evolver datafile holds nothing else");
    if (s.position.size() == 3 * s.triangles.size())
        throw InputError("a foam in a periodic box is not written as a Surface Evolver datafile");
    std::vector<std::uint8_t> held(s.position.size(), 0);
    for (const sim::Field& field : s.vertex_fields)
        if (field.name == "on_wire" && field.values.size() == held.size())
            for (std::size_t v = 0; v < held.size(); ++v) held[v] = field.values[v] != 0.0 ? 1 : 0;

    auto out = std::ostream_iterator<char>(stream);
    fmt::format_to(out, "// Films of lamella, solver {}, time {}. Lengths in m, film tension 1.\n", frame.solver, frame.time);
    // Extra attributes that the Evolver keeps and lamella reads back: open regions are no bodies.
    fmt::format_to(out, "\ndefine facet attribute region_back integer\ndefine facet attribute region_front integer\n");
    fmt::format_to(out, "\nvertices\n");
    for (std::size_t v = 0; v < s.position.size(); ++v)
        fmt::format_to(out, "{} {:.17g} {:.17g} {:.17g}{}\n", v + 1, s.position[v][0], s.position[v][1], s.position[v][2],
                       held[v] != 0 ? " fixed" : "");
    fmt::format_to(out, "\nedges\n");
    const auto edges = numbered_edges(s);
    for (const auto& [edge, n] : edges)
        fmt::format_to(out, "{} {} {}{}\n", n, edge.first + 1, edge.second + 1,
                       held[edge.first] != 0 && held[edge.second] != 0 ? " fixed" : "");
    fmt::format_to(out, "\nfaces\n");
    for (std::size_t f = 0; f < s.triangles.size(); ++f) {
        fmt::format_to(out, "{}", f + 1);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = s.triangles[f][k], b = s.triangles[f][(k + 1) % 3];
            fmt::format_to(out, " {}{}", a < b ? "" : "-", edges.at(std::minmax(a, b)));
        }
        fmt::format_to(out, " region_back {} region_front {}\n", s.regions[f][0], s.regions[f][1]);
    }
    const std::set<std::int32_t> closed = closed_regions(s);
    if (!closed.empty()) fmt::format_to(out, "\nbodies\n");
    for (const std::int32_t region : closed) {  // normals point out of the region behind a face
        fmt::format_to(out, "{}", region);
        std::size_t on_line = 0;
        for (std::size_t f = 0; f < s.triangles.size(); ++f)
            for (const std::size_t side : {0U, 1U})
                if (s.regions[f][side] == region)
                    fmt::format_to(out, "{}{}{}", ++on_line % 16 == 0 ? " \\\n " : " ", side == 0 ? "" : "-", f + 1);
        fmt::format_to(out, " volume {:.17g}\n", volume_of(s, region));
    }
    detail::finish(stream);
}

}  // namespace lamella::io
