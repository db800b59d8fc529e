#include "lamella/mesh/angles.h"

#include "lamella/core/error.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/detail/film_direction.h"
#include "lamella/mesh/detail/triangle.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace lamella::mesh {
namespace {


bool on_wire(const FoamMesh& mesh, const EdgeKey& edge) {
    return mesh.on_wire[edge.a] != 0 && mesh.on_wire[edge.b] != 0;
}

/// The three regions around an edge, or nothing if it is no free triple edge.
std::optional<std::array<RegionId, 3>> triple_regions(const FoamMesh& mesh, const EdgeFaces& edges, std::size_t e) {
    const auto uses = edges.of(e);
    if (uses.size() != 3 || on_wire(mesh, edges.edge[e])) return std::nullopt;
    std::array<RegionId, 6> sides{};
    for (std::size_t i = 0; i < 3; ++i) {
        sides[2 * i] = mesh.faces[uses[i].face].back;
        sides[2 * i + 1] = mesh.faces[uses[i].face].front;
    }
    std::ranges::sort(sides);
    const bool paired = sides[0] == sides[1] && sides[2] == sides[3] && sides[4] == sides[5];
    if (!paired || sides[1] == sides[2] || sides[3] == sides[4]) return std::nullopt;
    return std::array{sides[0], sides[2], sides[4]};
}

/// The angle inside region r between two films that leave an edge, each perpendicular to it.
///
/// Going around the edge direction counterclockwise, one of the two films has r ahead of it. A face that runs forward
/// along the edge has its front ahead, since then its normal is along x (its direction).
double angle_inside(
    RegionId r, const Face& face, bool forward, const Vec3& film, const Vec3& other, const Vec3& along) {
    const bool is_ahead = (forward ? face.front : face.back) == r;
    const double sine = dot(cross(film, other), along);
    const double turn = std::atan2(is_ahead ? sine : -sine, dot(film, other));
    return turn < 0.0 ? turn + 2.0 * std::numbers::pi : turn;
}

std::array<double, 3> angles_around(const FoamMesh& mesh,
                                    std::span<const EdgeUse> uses,
                                    const std::array<RegionId, 3>& regions,
                                    const std::array<Vec3, 3>& film,
                                    const Vec3& along) {
    std::array<double, 3> angle{};
    for (std::size_t k = 0; k < 3; ++k) {
        std::array<std::size_t, 2> side{};
        std::size_t found = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const Face& face = mesh.faces[uses[i].face];
            if (face.back == regions[k] || face.front == regions[k]) side[found++] = i;
        }
        const EdgeUse& use = uses[side[0]];
        angle[k] = angle_inside(regions[k], mesh.faces[use.face], use.forward, film[side[0]], film[side[1]], along);
    }
    return angle;
}

/// A step along a triple line.
struct LineStep {
    VertexId to;
    Vec3 vector;  // [m]
};

/// The parabola of an edge, from its vertex a to its vertex b.
struct CurvedEdge {
    Vec3 start, middle, end;
};

CurvedEdge curved_edge(const IdVector<FaceId, geometry::CurvedTriangle>& curved, const EdgeUse& use) {
    const geometry::CurvedTriangle& x = curved[use.face];
    const std::size_t tail = (use.opposite + 1) % 3, head = (use.opposite + 2) % 3;
    return use.forward ? CurvedEdge{x[tail], x[3 + tail], x[head]} : CurvedEdge{x[head], x[3 + tail], x[tail]};
}

using TripleLines = std::map<VertexId, std::vector<LineStep>>;

TripleLines triple_lines(const FoamMesh& mesh) {
    const EdgeFaces edges = edge_faces(mesh);
    TripleLines lines;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (!triple_regions(mesh, edges, e)) continue;
        const Vec3 vector = edge_vector(mesh, edges.of(e).front());
        lines[edges.edge[e].a].push_back({edges.edge[e].b, vector});
        lines[edges.edge[e].b].push_back({edges.edge[e].a, -vector});
    }
    return lines;
}

/// Tangent at the start of the parabola through 0, p and p + q, parametrized by chord length:
/// the derivative of the interpolating polynomial, p/|p| + (p/|p| - q/|q|) |p| / (|p| + |q|).
Vec3 parabola_tangent(const Vec3& p, const Vec3& q) {
    const double a = norm(p);
    const double b = norm(q);
    return detail::direction(p / a + (a / (a + b)) * (p / a - q / b));
}

Vec3 line_direction(const TripleLines& lines, VertexId from, const LineStep& step, AngleMethod method) {
    const std::vector<LineStep>& onward = lines.at(step.to);
    if (method == AngleMethod::kFlat || onward.size() != 2) return detail::direction(step.vector);
    return parabola_tangent(step.vector, onward[onward[0].to == from ? 1 : 0].vector);
}

/// A curved step along a triple line, away from a vertex.
struct CurvedStep {
    std::size_t edge;
    VertexId to;
    CurvedEdge curve;  // its start is the vertex
};

using CurvedLines = std::map<VertexId, std::vector<CurvedStep>>;

/// Every free edge with three films counts: in a periodic foam a bubble may meet itself there.
CurvedLines curved_lines(const FoamMesh& mesh, const IdVector<FaceId, geometry::CurvedTriangle>& curved) {
    const EdgeFaces edges = edge_faces(mesh);
    CurvedLines lines;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges.of(e).size() != 3 || on_wire(mesh, edges.edge[e])) continue;
        const CurvedEdge line = curved_edge(curved, edges.of(e).front());
        lines[edges.edge[e].a].push_back({e, edges.edge[e].b, line});
        lines[edges.edge[e].b].push_back({e, edges.edge[e].a, {line.end, line.middle, line.start}});
    }
    return lines;
}

/// Tangent at the start of the line that begins with this step: of the cubic that fits the nodes of its first two edges
/// best, or of the parabola of its only one. At a triple bubble of 4,564 faces the angles are 0.06 degrees off on average;
/// 0.13 with the first edge's parabola, 0.25 with the polynomial through all five nodes.
Vec3 curved_direction(const CurvedLines& lines, const CurvedStep& step) {
    constexpr std::size_t kMostEdges = 2, kDegree = 3;
    std::vector<Vec3> points{step.curve.start, step.curve.middle, step.curve.end};
    const CurvedStep* last = &step;
    for (std::size_t k = 1; k < kMostEdges; ++k) {
        const std::vector<CurvedStep>& onward = lines.at(last->to);
        if (onward.size() != 2) break;
        last = &onward[onward[0].edge == last->edge ? 1 : 0];
        const Vec3 image = points.back() - last->curve.start;  // periodic foams: next to the step before
        points.push_back(last->curve.middle + image);
        points.push_back(last->curve.end + image);
    }
    return geometry::end_tangent(points, kDegree);
}

double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

}  // namespace

std::vector<TripleEdgeAngles> triple_edge_angles(const FoamMesh& mesh, AngleMethod method) {
    const EdgeFaces edges = edge_faces(mesh);
    const VertexCorners corners = vertex_corners(mesh);
    const int rings = method == AngleMethod::kWide ? 2 : 1;
    std::vector<TripleEdgeAngles> result;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto regions = triple_regions(mesh, edges, e);
        if (!regions) continue;
        const auto uses = edges.of(e);
        std::array<Vec3, 3> film;
        for (std::size_t i = 0; i < 3; ++i)
            film[i] = method == AngleMethod::kFlat ? detail::flat_film_direction(mesh, uses[i])
                                                   : detail::quadratic_film_direction(mesh, corners, uses[i], rings);
        result.push_back({edges.edge[e].a, edges.edge[e].b, norm(edge_vector(mesh, uses[0])), *regions,
                          angles_around(mesh, uses, *regions, film, detail::direction(edge_vector(mesh, uses[0])))});
    }
    return result;
}

std::vector<TripleEdgeAngles> triple_edge_angles(const FoamMesh& mesh,
                                                 const IdVector<FaceId, geometry::CurvedTriangle>& curved) {
    LAMELLA_ASSERT(curved.size() == mesh.faces.size());
    const EdgeFaces edges = edge_faces(mesh);
    std::vector<TripleEdgeAngles> result;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto regions = triple_regions(mesh, edges, e);
        if (!regions) continue;
        const auto uses = edges.of(e);
        std::array<Vec3, 3> film;
        for (std::size_t i = 0; i < 3; ++i)
            film[i] = detail::direction(geometry::edge_conormal(curved[uses[i].face], uses[i].opposite));
        const CurvedEdge edge = curved_edge(curved, uses[0]);
        const Vec3 along = edge.end - edge.start;
        result.push_back({edges.edge[e].a, edges.edge[e].b, norm(along), *regions,
                          angles_around(mesh, uses, *regions, film, detail::direction(along))});
    }
    return result;
}

std::vector<JunctionAngles> junction_angles(const FoamMesh& mesh, AngleMethod method) {
    const TripleLines lines = triple_lines(mesh);
    std::vector<JunctionAngles> result;
    for (const auto& [vertex, steps] : lines) {
        if (steps.size() < 3) continue;
        JunctionAngles junction{vertex, {}};
        for (std::size_t i = 0; i < steps.size(); ++i)
            for (std::size_t j = i + 1; j < steps.size(); ++j)
                junction.angle.push_back(angle_between(line_direction(lines, vertex, steps[i], method),
                                                       line_direction(lines, vertex, steps[j], method)));
        result.push_back(std::move(junction));
    }
    return result;
}

std::vector<JunctionAngles> junction_angles(const FoamMesh& mesh,
                                            const IdVector<FaceId, geometry::CurvedTriangle>& curved) {
    LAMELLA_ASSERT(curved.size() == mesh.faces.size());
    const CurvedLines lines = curved_lines(mesh, curved);
    std::vector<JunctionAngles> result;
    for (const auto& [vertex, steps] : lines) {
        if (steps.size() < 3) continue;
        std::vector<Vec3> tangent;
        for (const CurvedStep& step : steps) tangent.push_back(curved_direction(lines, step));
        JunctionAngles junction{vertex, {}};
        for (std::size_t i = 0; i < tangent.size(); ++i)
            for (std::size_t j = i + 1; j < tangent.size(); ++j)
                junction.angle.push_back(angle_between(tangent[i], tangent[j]));
        result.push_back(std::move(junction));
    }
    return result;
}

AngleDeviation deviation_from_plateau(const std::vector<TripleEdgeAngles>& angles) {
    constexpr double kLaw = 2.0 * std::numbers::pi / 3.0;
    AngleDeviation deviation;
    double total_length = 0.0;
    for (const TripleEdgeAngles& edge : angles) {
        total_length += edge.length;
        for (const double angle : edge.angle) {
            deviation.mean += edge.length * std::abs(angle - kLaw) / 3.0;
            deviation.largest = std::max(deviation.largest, std::abs(angle - kLaw));
        }
    }
    if (total_length > 0.0) deviation.mean /= total_length;
    return deviation;
}

AngleDeviation deviation_from_plateau(const std::vector<JunctionAngles>& angles) {
    const double law = std::acos(-1.0 / 3.0);
    AngleDeviation deviation;
    double count = 0.0;
    for (const JunctionAngles& junction : angles)
        for (const double angle : junction.angle) {
            count += 1.0;
            deviation.mean += std::abs(angle - law);
            deviation.largest = std::max(deviation.largest, std::abs(angle - law));
        }
    if (count > 0.0) deviation.mean /= count;
    return deviation;
}

}  // namespace lamella::mesh
