#include "lamella/solvers/melp/surface.h"

#include "lamella/core/parallel.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace lamella::melp {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr std::uint32_t kNobody = 0xffffffffU;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The same triangle with its smallest corner first.
Triangle turned(Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

/// A corner of a Voronoi cell in the tangent plane of its particle.
struct Corner {
    double u, v;
    std::uint32_t next;  // whose bisector the side after this corner lies on
};

/// The Voronoi cell of particle i among its neighbors, laid into its tangent plane: it is cut out of a large square by
/// the bisectors of one neighbor after the other.
std::vector<Corner> voronoi_cell(std::span<const Vec3> position,
                                 const Vec3& normal,
                                 const Neighbors& same,
                                 std::size_t i) {
    const double far = same.kernel.support_radius;
    std::vector<Corner> cell{{-far, -far, kNobody}, {far, -far, kNobody}, {far, far, kNobody}, {-far, far, kNobody}},
        cut;
    const Frame frame = frame_of(normal);
    double farthest = 2.0 * far * far;  // corner, squared
    const auto cut_off = [&](std::uint32_t j, double u, double v) {
        const double half = 0.5 * (u * u + v * v);
        if (half == 0.0 || half > 2.0 * farthest) return;  // its bisector passes beyond all corners
        const auto beyond = [&](const Corner& c) { return c.u * u + c.v * v - half; };
        if (std::none_of(cell.begin(), cell.end(), [&](const Corner& c) { return beyond(c) > 0.0; })) return;
        cut.clear();
        for (std::size_t c = 0; c < cell.size(); ++c) {
            const Corner& a = cell[c];
            const Corner& b = cell[(c + 1) % cell.size()];
            const double at_a = beyond(a), at_b = beyond(b);
            const auto crossing = [&](std::uint32_t next) {
                const double s = at_a / (at_a - at_b);
                return Corner{a.u + s * (b.u - a.u), a.v + s * (b.v - a.v), next};
            };
            if (at_a <= 0.0) cut.push_back(a);
            if (at_a <= 0.0 && at_b > 0.0) cut.push_back(crossing(j));
            if (at_a > 0.0 && at_b <= 0.0) cut.push_back(crossing(a.next));
        }
        cell.swap(cut);
        farthest = 0.0;
        for (const Corner& c : cell) farthest = std::max(farthest, c.u * c.u + c.v * c.v);
    };
    // Near ones first: few of the others touch what they leave.
    const double near = 0.5 * far;
    for (const bool nearer : {true, false})
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
            const Vec3 d = position[same.index[k]] - position[i];
            if ((squared_norm(d) < near * near) == nearer) cut_off(same.index[k], dot(frame.e1, d), dot(frame.e2, d));
        }
    return cell;
}

/// The neighbors that the cell touches, in turn.
std::vector<std::uint32_t> delaunay_ring(std::span<const Vec3> position,
                                         const Vec3& normal,
                                         const Neighbors& same,
                                         std::size_t i) {
    std::vector<std::uint32_t> ring;
    for (const Corner& c : voronoi_cell(position, normal, same, i)) ring.push_back(c.next);
    return ring;
}

/// Triangles around particle i, nobody's sides left out.
void append_star(std::uint32_t i, const std::vector<std::uint32_t>& ring, std::vector<Triangle>& found) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const std::uint32_t a = ring[k], b = ring[(k + 1) % ring.size()];
        if (a != kNobody && b != kNobody && a != b) found.push_back(turned({i, a, b}));
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
        for (std::size_t i = first; i < last; ++i)
            ring[i] = delaunay_ring(coarse.position, geometry.normal[i], geometry.neighbors.same, i);
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

double star_volume(const CoarseParticles& coarse, const Geometry& geometry, std::size_t i, const Vec3& center) {
    const std::vector<std::uint32_t> ring =
        delaunay_ring(coarse.position, geometry.normal[i], geometry.neighbors.same, i);
    const std::vector<Vec3>&x = coarse.position, &n = geometry.normal;
    double sum = 0.0;
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const std::uint32_t a = ring[k], b = ring[(k + 1) % ring.size()];
        if (a == kNobody || b == kNobody || a == b) continue;
        const Vec3 area = 0.5 * cross(x[a] - x[i], x[b] - x[i]);
        const double bulge =
            dot(n[a] - n[i], x[a] - x[i]) + dot(n[b] - n[a], x[b] - x[a]) + dot(n[i] - n[b], x[i] - x[b]);
        sum += dot(x[i] - center, area) / 3.0 + norm(area) * bulge / 24.0;
    }
    return sum / 3.0;
}

double cell_area(const CoarseParticles& coarse, const Geometry& geometry, std::size_t i) {
    const std::vector<Corner> cell = voronoi_cell(coarse.position, geometry.normal[i], geometry.neighbors.same, i);
    double sum = 0.0;
    for (std::size_t k = 0; k < cell.size(); ++k) {
        const Corner& b = cell[(k + 1) % cell.size()];
        sum += cell[k].u * b.v - cell[k].v * b.u;
    }
    return 0.5 * sum;
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
