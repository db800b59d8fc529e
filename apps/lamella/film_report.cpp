#include "film_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "output.h"
#include <cmath>
#include <utility>

namespace lamella::app {
namespace {

using measure::AngleMeasure;
using measure::AnglesByMethod;
using measure::FilmMeasure;
using measure::FilmMeasures;
using measure::RegionMeasure;
using nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

std::string film_name(const FilmMeasure& film) { return fmt::format("{}-{}", film.a, film.b); }

ordered_json number(double value) { return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr); }

/// How the curved angles were taken.
std::string curved_method(bool patches) { return patches ? "quadratic" : "quadratic fit"; }

ordered_json angles_object(const AngleMeasure& angles) {
    return {{"mean", number(kDegrees * angles.mean)},
            {"mean_error", number(kDegrees * angles.mean_error)},
            {"max_error", number(kDegrees * angles.max_error)}};
}

ordered_json both_methods(const AnglesByMethod& angles, bool patches) {
    ordered_json object{{"count", angles.curved.count}};
    object.update(angles_object(angles.curved));
    object["method"] = curved_method(patches);
    object["flat"] = angles_object(angles.flat);
    return object;
}

constexpr char kAngleRow[] = "  {:<16} {:>8} {:>12} {:>12} {:>12}  {}\n";

void angle_rows(std::string& text, const char* name, const AnglesByMethod& angles, bool patches, const char* law) {
    if (angles.curved.count == 0) return;
    for (const auto& [method, a] :
         {std::pair{curved_method(patches), &angles.curved}, std::pair{std::string("flat"), &angles.flat}})
        text += fmt::format(kAngleRow, name, a->count, number_text(kDegrees * a->mean),
                            number_text(kDegrees * a->mean_error), number_text(kDegrees * a->max_error),
                            fmt::format("{}, law {}", method, law));
}

void bubble_rows(std::string& text, const FilmMeasures& films) {
    if (films.regions.empty()) return;
    text += fmt::format("\n  {:<16} {:>14} {:>14} {:>14}   centroid [m]\n", "bubble", "volume [m^3]", "pressure [Pa]",
                        "area [m^2]");
    for (const RegionMeasure& r : films.regions)
        text += fmt::format("  {:<16} {:>14} {:>14} {:>14}   ({:.4g}, {:.4g}, {:.4g})\n", r.id, number_text(r.volume),
                            number_text(r.pressure), number_text(r.area), r.centroid[0], r.centroid[1], r.centroid[2]);
}

void film_rows(std::string& text, const FilmMeasures& films) {
    text += fmt::format("\n  {:<16} {:>14} {:>16} {:>14}\n", "film", "area [m^2]", "curvature [1/m]", "radius [m]");
    for (const FilmMeasure& f : films.films)
        text += fmt::format("  {:<16} {:>14} {:>16} {:>14}\n", film_name(f), number_text(f.area),
                            number_text(f.curvature), number_text(f.fit_radius));
}

}  // namespace

void add_films(ordered_json& object, const FilmMeasures& films, std::optional<std::size_t> intersections) {
    object["total_area"] = number(films.total_area);
    ordered_json areas = ordered_json::object(), curvatures = ordered_json::object();
    for (const FilmMeasure& f : films.films) {
        areas[film_name(f)] = number(f.area);
        curvatures[film_name(f)] = {{"mean", number(f.curvature)}, {"fit_radius", number(f.fit_radius)}};
    }
    object["film_area"] = std::move(areas);
    object["regions"] = ordered_json::array();
    for (const RegionMeasure& r : films.regions)
        object["regions"].push_back({{"id", r.id},
                                     {"volume", number(r.volume)},
                                     {"pressure", number(r.pressure)},
                                     {"area", number(r.area)},
                                     {"centroid", {number(r.centroid[0]), number(r.centroid[1]), number(r.centroid[2])}}});
    object["edge_angles"] = both_methods(films.edge_angles, films.has_patches);
    object["corner_angles"] = both_methods(films.corner_angles, films.has_patches);
    object["film_curvature"] = std::move(curvatures);
    if (films.thickness)
        object["thickness"] = {{"min", number(films.thickness->min)},
                               {"mean", number(films.thickness->mean)},
                               {"max", number(films.thickness->max)},
                               {"std", number(films.thickness->deviation)}};
    if (!std::isnan(films.volume_error) || !object.contains("volume_error"))
        object["volume_error"] = number(films.volume_error);
    object["mesh"] = {{"vertices", films.mesh.vertices},
                      {"faces", films.mesh.faces},
                      {"mean_edge", number(films.mesh.mean_edge)},
                      {"min_angle", number(kDegrees * films.mesh.min_angle)},
                      {"intersections", intersections ? ordered_json(*intersections) : ordered_json(nullptr)}};
    object["methods"] = {{"total_area", "flat triangles"},
                         {"film_area", "flat triangles"},
                         {"regions", "flat triangles; pressures from the solver"},
                         {"edge_angles", "quadratic: the solver's quadratic triangles; quadratic fit: films fitted to the vertices "
                                         "near by; flat: triangles at the edge"},
                         {"corner_angles", "quadratic: edges of the solver's quadratic triangles; quadratic fit: "
                                           "parabolas through three vertices; flat: first edges"},
                         {"film_curvature", "mean: first variation of area; fit_radius: least squares over vertices"}};
}

std::string film_table(const FilmMeasures& films, std::optional<std::size_t> intersections) {
    std::string text = fmt::format("\nfilms of flat triangles: total_area {} m^2, {} vertices, {} faces, mean edge {} m, "
                                   "smallest angle {} deg, {} intersections\n",
                                   number_text(films.total_area), films.mesh.vertices, films.mesh.faces,
                                   number_text(films.mesh.mean_edge), number_text(kDegrees * films.mesh.min_angle),
                                   intersections ? std::to_string(*intersections) : "unknown");
    if (!std::isnan(films.volume_error))
        text += fmt::format("largest error of a volume: {}\n", number_text(films.volume_error));
    if (films.thickness)
        text += fmt::format("thickness [m]: min {}, mean {}, max {}, std {}\n", number_text(films.thickness->min),
                            number_text(films.thickness->mean), number_text(films.thickness->max),
                            number_text(films.thickness->deviation));
    bubble_rows(text, films);
    film_rows(text, films);
    if (films.edge_angles.curved.count + films.corner_angles.curved.count == 0) return text;
    text += "\n" + fmt::format(kAngleRow, "angles [deg]", "count", "mean", "mean error", "max error", "method");
    angle_rows(text, "between films", films.edge_angles, films.has_patches, "120");
    angle_rows(text, "between lines", films.corner_angles, films.has_patches, "109.471");
    return text;
}

}  // namespace lamella::app
