#include "lamella/measure/film_measures.h"

#include "lamella/measure/detail/flat_ends.h"
#include "lamella/measure/detail/sphere_fit.h"
#include "lamella/measure/film_mesh.h"
#include "lamella/mesh/angles.h"
#include "lamella/mesh/area.h"
#include "lamella/mesh/check.h"
#include "lamella/mesh/quality.h"
#include "lamella/mesh/vertex_area.h"
#include "lamella/mesh/volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace lamella::measure {
namespace {

using mesh::FaceId;
using mesh::FoamMesh;
using mesh::RegionId;
using mesh::VertexId;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The faces of one film at each of its vertices, summed.
struct FilmVertex {
    Vec3 area_vector;   // a third of each face's, out of b
    double area = 0.0;  // a third of each face's
    int faces = 0;
};

/// One film, as it is gathered.
struct Film {
    double area = 0.0;
    std::map<VertexId, FilmVertex> vertices;
};

using Films = std::map<std::pair<RegionId, RegionId>, Film>;

Films gather_films(const FoamMesh& mesh) {
    const auto vectors = mesh::face_area_vectors(mesh);
    Films films;
    for (const FaceId f : mesh.faces.ids()) {
        const mesh::Face& face = mesh.faces[f];
        Film& film = films[std::minmax(face.back, face.front)];
        const Vec3 out = face.back > face.front ? vectors[f] : -vectors[f];
        const double area = norm(out);
        film.area += area;
        for (const VertexId v : face.vertices) {
            FilmVertex& at = film.vertices[v];
            at.area_vector += out / 3.0;
            at.area += area / 3.0;
            ++at.faces;
        }
    }
    return films;
}

/// Mean curvature from the first variation of area over the first variation of volume, summed over the vertices inside
/// the film: of a mesh at rest it is exactly the pressure difference over the film tension.
double mean_curvature(const Film& film,
                      const FoamMesh& mesh,
                      const IdVector<VertexId, Vec3>& gradient,
                      const IdVector<VertexId, int>& faces) {
    double variation = 0.0, area = 0.0;
    for (const auto& [v, at] : film.vertices) {
        if (at.faces != faces[v] || mesh.on_wire[v] != 0) continue;
        const double size = norm(at.area_vector);
        if (size == 0.0) continue;
        variation += dot(gradient[v], at.area_vector) / size;
        area += size;
    }
    return area > 0.0 ? variation / area : kNan;
}

std::vector<FilmMeasure> measure_films(const FilmMesh& films, const Films& gathered) {
    const FoamMesh& mesh = films.mesh;
    const auto gradient = mesh::area_gradient(mesh);
    IdVector<VertexId, int> faces(mesh.position.size());
    for (const mesh::Face& face : mesh.faces)
        for (const VertexId v : face.vertices) ++faces[v];
    std::vector<FilmMeasure> measures;
    for (const auto& [pair, film] : gathered) {
        std::vector<detail::WeightedPoint> points;
        for (const auto& [v, at] : film.vertices) points.push_back({mesh.position[v], at.area});
        measures.push_back({films.label[index(pair.first)], films.label[index(pair.second)], film.area,
                            films.connected ? mean_curvature(film, mesh, gradient, faces) : kNan,
                            films.connected ? detail::fit_sphere_radius(points) : kNan});
    }
    return measures;
}

/// Moments of the gas of every region about its own mean corner: volume times centroid.
IdVector<RegionId, Vec3> centroids(const FoamMesh& mesh, const IdVector<RegionId, double>& volume) {
    IdVector<RegionId, Vec3> origin(mesh.regions.size()), moment(mesh.regions.size());
    IdVector<RegionId, double> count(mesh.regions.size());
    for (const FaceId f : mesh.faces.ids())
        for (const RegionId r : {mesh.faces[f].back, mesh.faces[f].front}) {
            origin[r] += mesh.corner(f, 0);
            count[r] += 1.0;
        }
    for (const RegionId r : origin.ids())
        if (count[r] > 0.0) origin[r] *= 1.0 / count[r];
    for (const FaceId f : mesh.faces.ids()) {
        const auto add = [&](RegionId r, double sign) {
            const Vec3 a = mesh.corner(f, 0) - origin[r], b = mesh.corner(f, 1) - origin[r],
                       c = mesh.corner(f, 2) - origin[r];
            moment[r] += (sign * dot(a, cross(b, c)) / 24.0) * (a + b + c);  // the cone's centroid is (a + b + c + 0) / 4
        };
        add(mesh.faces[f].back, 1.0);
        add(mesh.faces[f].front, -1.0);
    }
    for (const RegionId r : moment.ids())
        moment[r] = volume[r] != 0.0 ? origin[r] + moment[r] / volume[r] : origin[r];
    return moment;
}

void measure_regions(const FilmMesh& films, const Films& gathered, const sim::Surface& surface, FilmMeasures& out) {
    const FoamMesh& mesh = films.mesh;
    const std::optional<FoamMesh> ended = films.connected ? detail::with_flat_ends(mesh) : std::nullopt;
    const FoamMesh& whole = ended ? *ended : mesh;
    const auto volume = mesh::region_volumes(whole);
    const auto centroid = centroids(whole, volume);
    IdVector<RegionId, double> area(mesh.regions.size());
    for (const auto& [pair, film] : gathered) {
        area[pair.first] += film.area;
        area[pair.second] += film.area;
    }
    const sim::Field* pressure = surface.find_of_regions("pressure");
    out.volume_error = kNan;
    for (const RegionId r : mesh.regions.ids()) {
        const std::int32_t label = films.label[index(r)];
        if (mesh.regions[r].kind != mesh::RegionKind::kClosed || area[r] == 0.0) continue;
        const auto row = static_cast<std::size_t>(label);
        RegionMeasure region{.id = label, .volume = kNan, .pressure = kNan, .area = area[r], .centroid = {{kNan, kNan, kNan}}};
        if (pressure != nullptr && row < pressure->values.size()) region.pressure = pressure->values[row];
        if (films.connected) {
            region.volume = volume[r];
            region.centroid = centroid[r];
            const double target = mesh.regions[r].target_volume;
            if (target > 0.0) out.volume_error = std::fmax(out.volume_error, std::abs(volume[r] - target) / target);
        }
        out.regions.push_back(region);
    }
}

AngleMeasure edge_angle_measure(const std::vector<mesh::TripleEdgeAngles>& angles) {
    if (angles.empty()) return {};
    const mesh::AngleDeviation off = mesh::deviation_from_plateau(angles);
    double mean = 0.0, length = 0.0;
    for (const mesh::TripleEdgeAngles& edge : angles) {
        for (const double angle : edge.angle) mean += edge.length * angle / 3.0;
        length += edge.length;
    }
    return {angles.size(), mean / length, off.mean, off.largest};
}

AngleMeasure corner_angle_measure(const FoamMesh& mesh, std::vector<mesh::JunctionAngles> angles) {
    // Lines that end on a wire do so at any angle.
    std::erase_if(angles, [&](const mesh::JunctionAngles& j) { return mesh.on_wire[j.vertex] != 0; });
    if (angles.empty()) return {};
    const mesh::AngleDeviation off = mesh::deviation_from_plateau(angles);
    double mean = 0.0, count = 0.0;
    for (const mesh::JunctionAngles& junction : angles)
        for (const double angle : junction.angle) {
            mean += angle;
            count += 1.0;
        }
    return {angles.size(), mean / count, off.mean, off.largest};
}

using CurvedFaces = IdVector<FaceId, geometry::CurvedTriangle>;

/// The frame's quadratic triangles, or none.
CurvedFaces curved_faces(const sim::Surface& surface) {
    CurvedFaces curved;
    const sim::Field* nodes = surface.find_of_faces(sim::kCurvedNodes);
    if (nodes == nullptr || nodes->components != 18 || nodes->values.size() != 18 * surface.triangles.size()) return curved;
    for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
        geometry::CurvedTriangle triangle;
        for (std::size_t i = 0; i < 18; ++i) triangle[i / 3][i % 3] = nodes->values[18 * f + i];
        curved.push_back(triangle);
    }
    return curved;
}

void measure_angles(const FoamMesh& mesh, const sim::Surface& surface, FilmMeasures& out) {
    using mesh::AngleMethod;
    const CurvedFaces curved = curved_faces(surface);
    out.has_patches = !curved.empty();
    out.edge_angles.flat = edge_angle_measure(mesh::triple_edge_angles(mesh, AngleMethod::kFlat));
    out.corner_angles.flat = corner_angle_measure(mesh, mesh::junction_angles(mesh, AngleMethod::kFlat));
    out.edge_angles.curved = edge_angle_measure(out.has_patches ? mesh::triple_edge_angles(mesh, curved)
                                                                : mesh::triple_edge_angles(mesh, AngleMethod::kQuadratic));
    out.corner_angles.curved =
        corner_angle_measure(mesh, out.has_patches ? mesh::junction_angles(mesh, curved)
                                                   : mesh::junction_angles(mesh, AngleMethod::kQuadratic));
}

std::optional<ThicknessMeasure> measure_thickness(const FoamMesh& mesh, const sim::Surface& surface) {
    const sim::Field* field = surface.find_of_vertices("thickness");
    if (field == nullptr || field->components != 1) return std::nullopt;
    const auto area = mesh::barycentric_areas(mesh);
    ThicknessMeasure t{std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0};
    double total = 0.0;
    for (const VertexId v : mesh.position.ids()) {
        if (area[v] == 0.0) continue;  // of no film
        const double value = field->values[index(v)];
        t.min = std::min(t.min, value);
        t.max = std::max(t.max, value);
        t.mean += area[v] * value;
        total += area[v];
    }
    if (total == 0.0) return std::nullopt;
    t.mean /= total;
    for (const VertexId v : mesh.position.ids()) {
        const double off = field->values[index(v)] - t.mean;
        t.deviation += area[v] * off * off / total;
    }
    t.deviation = std::sqrt(t.deviation);
    return t;
}

}  // namespace

std::optional<FilmMeasures> film_measures(const sim::Frame& frame) {
    if (frame.surface.empty()) return std::nullopt;
    const FilmMesh films = film_mesh(frame.surface);
    const Films gathered = gather_films(films.mesh);
    FilmMeasures out;
    out.total_area = mesh::total_area(films.mesh);
    out.films = measure_films(films, gathered);
    measure_regions(films, gathered, frame.surface, out);
    if (films.connected) measure_angles(films.mesh, frame.surface, out);
    out.thickness = measure_thickness(films.mesh, frame.surface);
    out.mesh = {films.mesh.position.size(), films.mesh.faces.size(), mesh::edge_lengths(films.mesh).mean,
                mesh::min_angle(films.mesh)};
    return out;
}

std::optional<std::size_t> film_intersections(const sim::Frame& frame, std::size_t most) {
    if (frame.surface.empty()) return std::nullopt;
    const FilmMesh films = film_mesh(frame.surface);
    if (!films.connected) return std::nullopt;
    return mesh::intersecting_pairs(films.mesh, most);
}

std::vector<sim::Scalar> film_scalars(const FilmMeasures& films) {
    constexpr double kDegrees = 180.0 / 3.14159265358979323846;
    constexpr std::size_t kMostRegions = 12;
    double gas = 0.0;
    for (const RegionMeasure& r : films.regions) gas += r.volume;
    std::vector<sim::Scalar> scalars{
        {"total_area", "m^2", films.total_area, "of all films, flat triangles"},
        {"gas_volume", "m^3", gas, "of all bubbles, flat triangles"},
        {"volume_error", "-", films.volume_error, "largest relative error of a bubble's volume"},
        {"edge_angle_mean_error", "deg", kDegrees * films.edge_angles.curved.mean_error,
         "from 120 degrees, between curved films"},
        {"edge_angle_max_error", "deg", kDegrees * films.edge_angles.curved.max_error, "the largest"},
        {"corner_angle_mean_error", "deg", kDegrees * films.corner_angles.curved.mean_error,
         "from 109.47 degrees, between curved triple lines"},
        {"corner_angle_max_error", "deg", kDegrees * films.corner_angles.curved.max_error, "the largest"},
        {"vertices", "-", static_cast<double>(films.mesh.vertices), "of the films"},
        {"faces", "-", static_cast<double>(films.mesh.faces), "triangles"},
        {"mean_edge", "m", films.mesh.mean_edge, "mean length of the triangles' edges"},
        {"min_angle", "deg", kDegrees * films.mesh.min_angle, "smallest angle of a triangle"}};
    if (films.thickness) {
        scalars.push_back({"thickness_min", "m", films.thickness->min, "of the films"});
        scalars.push_back({"thickness_mean", "m", films.thickness->mean, "weighted with area"});
        scalars.push_back({"thickness_max", "m", films.thickness->max, "of the films"});
        scalars.push_back({"thickness_std", "m", films.thickness->deviation, "standard deviation, weighted with area"});
    }
    for (std::size_t k = 0; k < std::min(films.regions.size(), kMostRegions); ++k) {
        const RegionMeasure& r = films.regions[k];
        scalars.push_back({fmt::format("volume_{}", r.id), "m^3", r.volume, fmt::format("of bubble {}", r.id)});
        scalars.push_back(
            {fmt::format("pressure_{}", r.id), "Pa", r.pressure, fmt::format("of bubble {} above the outside", r.id)});
    }
    return scalars;
}

}  // namespace lamella::measure
