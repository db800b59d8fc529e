#pragma once

#include "lamella/sim/frame.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace lamella::measure {

/// The film between two regions, a < b.
struct FilmMeasure {
    std::int32_t a = 0, b = 0;
    double area = 0.0;        ///< of its triangles [m^2]
    double curvature = 0.0;   ///< mean of kappa_1 + kappa_2, positive where it bulges out of b, so that at rest
                              ///< p_b - p_a = film tension * curvature [1/m]; NaN without a vertex inside the film
    double fit_radius = 0.0;  ///< of the sphere through its vertices, by least squares [m]; infinite for a flat film
};

/// A bubble.
struct RegionMeasure {
    std::int32_t id = 0;
    double volume = 0.0;    ///< [m^3], with a flat end where films leave it open; NaN where triangles are not connected
    double pressure = 0.0;  ///< above the outside [Pa]; NaN where the frame does not tell
    double area = 0.0;      ///< of all films around it [m^2]
    Vec3 centroid;          ///< of its gas, likewise [m]
};

/// Angles against the law that holds at rest [rad]; NaN without any.
struct AngleMeasure {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    std::size_t count = 0;      ///< of triple edges with three angles each, or of junctions with six
    double mean = kNone;        ///< of the angles themselves
    double mean_error = kNone;  ///< of |angle - law|, between films weighted with the edges' lengths
    double max_error = kNone;
};

/// The angles from flat triangles and straight edges, off by O(h) even at rest, and from curved films and lines: from
/// the frame's own quadratic triangles (sim::kCurvedNodes) if it has them, otherwise fitted to the vertices near by.
struct AnglesByMethod {
    AngleMeasure flat, curved;
};

/// Weighted with the films' area [m].
struct ThicknessMeasure {
    double min = 0.0, mean = 0.0, max = 0.0, deviation = 0.0;
};

struct MeshMeasure {
    std::size_t vertices = 0, faces = 0;
    double mean_edge = 0.0;  ///< [m]
    double min_angle = 0.0;  ///< [rad]
};

/// Everything that can be measured on the films of a frame, whatever solver made them. Areas, volumes, centroids and
/// curvatures are those of the flat triangles: off by O(h^2) from those of the smooth films they stand for.
struct FilmMeasures {
    double total_area = 0.0;             ///< [m^2]; a film counts once, though it has two surfaces
    std::vector<FilmMeasure> films;      ///< ordered by (a, b)
    std::vector<RegionMeasure> regions;  ///< the closed ones, ordered by number
    double volume_error = 0.0;           ///< largest |volume - target| / target; NaN where the frame has no targets
    AnglesByMethod edge_angles;          ///< between films along triple lines, law: 120 degrees
    bool has_patches = false;            ///< the curved angles are those of the frame's quadratic triangles
    AnglesByMethod corner_angles;        ///< between triple lines at junctions, law: 109.47 degrees
    std::optional<ThicknessMeasure> thickness;  ///< where the vertices have the field `thickness`
    MeshMeasure mesh;
};

/// Nothing when the frame has no triangles. The same bits on any number of threads.
/// @throws InputError  triangles or fields that contradict each other (a damaged frame file)
std::optional<FilmMeasures> film_measures(const sim::Frame& frame);

/// How many pairs of triangles cut each other, exactly tested: costs more than all of the above. At most `most` are
/// counted. Nothing when the frame has no triangles, or they are not connected. @throws InputError  as film_measures
std::optional<std::size_t> film_intersections(const sim::Frame& frame, std::size_t most = 100000);

/// What of this goes into every row of a series: total_area, gas_volume, volume_error, the angles' errors in degrees,
/// volumes and pressures of the first twelve bubbles, thickness, mean_edge, min_angle.
std::vector<sim::Scalar> film_scalars(const FilmMeasures& films);

}  // namespace lamella::measure
