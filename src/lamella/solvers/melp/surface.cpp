#include "lamella/solvers/melp/surface.h"

#include "lamella/core/parallel.h"
#include "lamella/solvers/melp/voronoi.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace lamella::melp {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The same triangle with its smallest corner first.
Triangle turned(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

/// Triangles around particle i, nobody's sides left out.
void append_star(std::uint32_t i, const std::vector<std::uint32_t>& ring, std::vector<Triangle>& found) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const std::uint32_t a = ring[k], b = ring[(k + 1) % ring.size()];
        if (a != VoronoiCell::kNobody && b != VoronoiCell::kNobody && a != b) found.push_back(turned({i, a, b}));
    }
}

/// Triangles in the making: every directed edge belongs to at most one.
class Builder {
public:
    bool add(const Triangle& t) {
        for (std::size_t k = 0; k < 3; ++k)
            if (owner_.count({t[k], t[(k + 1) % 3]}) != 0) return false;
        for (std::size_t k = 0; k < 3; ++k) owner_[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
        triangles_.push_back(t);
        return true;
    }

    /// Closes rings of free edges with at most `longest` edges by triangles around their first corner.
    void close_holes(std::size_t longest) {
        std::map<std::uint32_t, std::uint32_t> next;  // along free edges, the film on the left
        for (const auto& [edge, corner] : owner_)
            if (owner_.count({edge.second, edge.first}) == 0) next[edge.second] = edge.first;
        std::vector<std::vector<std::uint32_t>> holes;
        while (!next.empty()) {
            std::vector<std::uint32_t> ring{next.begin()->first};
            bool closed = false;
            for (;;) {
                const auto step = next.find(ring.back());
                if (step == next.end()) break;
                const std::uint32_t to = step->second;
                next.erase(step);
                if (to == ring.front()) {
                    closed = true;
                    break;
                }
                ring.push_back(to);
            }
            if (closed && ring.size() >= 3 && ring.size() <= longest) holes.push_back(std::move(ring));
        }
        for (const auto& ring : holes)
            for (std::size_t k = 1; k + 1 < ring.size(); ++k) add(turned({ring[0], ring[k], ring[k + 1]}));
    }

    Triangles take() { return std::move(triangles_); }

private:
    std::map<Edge, std::uint32_t> owner_;  // of a directed edge: the third corner of its triangle
    Triangles triangles_;
};

}  // namespace

Triangles surface_triangles(const CoarseParticles& coarse, const Geometry& geometry) {
    const std::size_t count = coarse.size();
    std::vector<std::vector<std::uint32_t>> ring(count);
    parallel_blocks(count, 256, [&](std::size_t first, std::size_t last) {
        VoronoiCell cell;
        for (std::size_t i = first; i < last; ++i) {
            cell.build(coarse.position, geometry.normal[i], geometry.neighbors.same, i);
            for (const VoronoiCell::Corner& c : cell.corners()) ring[i].push_back(c.next);
        }
    });
    std::vector<Triangle> found;
    for (std::size_t i = 0; i < count; ++i) append_star(static_cast<std::uint32_t>(i), ring[i], found);
    std::sort(found.begin(), found.end());

    Builder builder;
    for (const std::ptrdiff_t votes : {3, 2})
        for (auto it = found.begin(); it != found.end();) {
            const auto end = std::find_if(it, found.end(), [&](const Triangle& t) { return t != *it; });
            if (end - it == votes) builder.add(*it);
            it = end;
        }
    constexpr std::size_t kLongestHole = 8;
    builder.close_holes(kLongestHole);
    return builder.take();
}

std::size_t open_edges(const Triangles& triangles) {
    std::map<Edge, int> uses;
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            ++uses[{std::min(a, b), std::max(a, b)}];
        }
    return static_cast<std::size_t>(
        std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second == 1; }));
}

}  // namespace lamella::melp
