#pragma once

#include "lamella/sim/frame.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace lamella::io::detail {

/// Refuses a frame that no file could hold: arrays whose lengths do not fit together, names that are empty, used
/// twice or not printable, integer fields with other values than whole numbers up to 2^53, triangles that refer
/// to missing vertices, solids without a place or a size. @throws InputError  naming the field
void check_frame(const sim::Frame& frame);

/// Before the name of a region's field, where it stands among other data: region_pressure.
inline const std::string kRegionPrefix = "region_";

/// The solids of a frame, where it has any.
inline const std::string kSolidCenter = "solid_center";
inline const std::string kSolidRadius = "solid_radius";

/// A column of the one table that a file with a single list of points has: surface vertices first, then points.
/// Rows that the column says nothing about hold NaN, or -1 in an integer column.
struct TableColumn {
    std::string name;
    std::string unit;
    int components = 1;
    bool integer = false;
    std::span<const double> on_first = {};   ///< of the surface vertices (of the point cells in a table of cells)
    std::span<const double> on_second = {};  ///< of the points (of the triangles in a table of cells)
    int first_index = -1;                    ///< its place among the fields of the first set; -1: not one of them
    int second_index = -1;                   ///< its place among the fields of the second set

    /// All values, padded: `first` and `second` rows. Uses `scratch` only when they do not lie together already.
    std::span<const double> values(std::size_t first, std::size_t second, std::vector<double>& scratch) const;
};

/// The columns of surface vertices and points: `radius`, then the surface's fields, then those that only the points
/// have. Fields with the same name, unit and shape share a column.
/// @param radii  whether the points have radii
/// @throws InputError  two fields share a name but not unit and shape
std::vector<TableColumn> vertex_table(const sim::Frame& frame, bool radii);
inline std::vector<TableColumn> vertex_table(const sim::Frame& frame) {
    return vertex_table(frame, !frame.points.radius.empty());
}

/// What the k-th of `components` values of one item is called: "" , "x" to "z", "xx" to "zz", or a number.
std::string component_suffix(int components, int k);
/// "velocity_x", or the name itself for a single value.
std::string component_name(const std::string& name, int components, int k);

/// A value of an integer field as such; check_frame has seen to it that it is one.
std::int64_t whole(double value);

}  // namespace lamella::io::detail
