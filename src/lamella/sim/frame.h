#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lamella/core/vec.h"

namespace lamella::sim {

/// One value that belongs to a whole frame: an energy, a pressure, a count.
struct Scalar {
    std::string name;  ///< snake_case words, the same in every file and read-out
    std::string unit;  ///< "J", "m^2/s", "-" for a pure number
    double value = 0.0;
    std::string text = {};  ///< what it means, for read-outs
};

/// Values of one quantity for every point (or triangle) of a set.
struct Field {
    std::string name;
    std::string unit;              ///< "m/s", "-" for a pure number
    int components = 1;            ///< 1 scalar, 3 vector, 9 tensor (row by row)
    bool integer = false;          ///< written as an integer; the values hold whole numbers up to 2^53
    std::vector<double> values;    ///< components * size, one item after the other
};

/// The rectangular domain of a simulation. In two dimensions the third axis has length 0.
struct Box {
    int dimension = 3;
    Vec3 origin;
    Vec3 lengths;
    std::array<bool, 3> periodic{};  ///< per axis; false: a wall at both ends
};

/// Particles, bubbles, nodes. With `radius` they are balls (discs in two dimensions), otherwise points.
struct Points {
    std::vector<Vec3> position;
    std::vector<double> radius;  ///< empty, or one per position
    std::vector<Field> fields;
    std::string length_unit = "m";  ///< of position and radius; "-" in a dimensionless simulation

    bool empty() const { return position.empty(); }
    std::size_t size() const { return position.size(); }
    const Field* find(std::string_view name) const;
};

/// The face field with 18 components of a solver that knows its films better than flat triangles do: the quadratic
/// triangle that each face stands for, its corners, then its points between corners 0-1, 1-2 and 2-0 [m].
inline constexpr const char* kCurvedNodes = "curved_nodes";

/// Triangles, each between two regions of gas; region 0 is the outside.
struct Surface {
    std::vector<Vec3> position;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<std::int32_t, 2>> regions;  ///< per triangle: on its back and on its front side
    std::vector<Field> vertex_fields;
    std::vector<Field> face_fields;
    /// What is known of each region, in the order of their numbers; all of one length, or none. Measures look for
    /// `closed` (1: a bubble, whose films close it in), `target_volume` [m^3] (what its gas fills at rest) and
    /// `pressure` [Pa] (above region 0).
    std::vector<Field> region_fields;

    bool empty() const { return triangles.empty(); }
    const Field* find_of_vertices(std::string_view name) const;
    const Field* find_of_faces(std::string_view name) const;
    const Field* find_of_regions(std::string_view name) const;
    /// Regions that region_fields tell of, 0 without any.
    std::size_t regions_described() const;
};

/// A ball that films run around, as a stick through a film.
struct Solid {
    Vec3 center;          ///< [m]
    double radius = 0.0;  ///< [m]
};

/// What can be seen of a simulation at one time. Everything downstream of a solver (files, measures, plots,
/// pictures) sees this and nothing else.
struct Frame {
    std::string solver;            ///< registered name, e.g. "bubble"
    double time = 0.0;             ///< in `time_unit`
    std::string time_unit = "s";   ///< "-" in a dimensionless simulation
    std::int64_t step = 0;
    std::optional<Box> box;
    Surface surface;
    Points points;
    std::vector<Solid> solids;
    std::vector<Scalar> scalars;   ///< what only the solver knows: energies, pressures, residuals

    const Scalar* find_scalar(std::string_view name) const;
};

}  // namespace lamella::sim
