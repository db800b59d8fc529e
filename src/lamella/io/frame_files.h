#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include "lamella/sim/frame.h"

namespace lamella::io {

/// Writes a frame as VTK PolyData (.vtp, zlib-compressed, appended base64): triangles as polygons, points as
/// vertices, every field under its name with its unit as the array's UNITS_LABEL, the frame's scalars, time, step,
/// solver name and box as field data. Atomic: the name appears when the file is whole.
/// @throws IoError  it cannot be written
void write_vtp(const std::filesystem::path& path, const sim::Frame& frame);

/// Reads back what write_vtp wrote. @throws IoError, InputError (names the file and what is wrong in it)
sim::Frame read_vtp(const std::filesystem::path& path);

/// Extended XYZ (OVITO, ASE): one line per point, the box as Lattice, every field a named column.
void write_extended_xyz(std::ostream& out, const sim::Frame& frame);

/// Binary PLY: positions, radius and fields as vertex properties, triangles as faces with their region labels.
void write_ply(std::ostream& out, const sim::Frame& frame);

/// A table with one row per point: x, y, z, radius, then every field; header names carry units: "velocity_x[m/s]".
void write_points_csv(std::ostream& out, const sim::Frame& frame);

/// The formats of `lamella export`: name, file suffix, one line on what it is for, and the writer.
struct FrameFormat {
    std::string name;
    std::string suffix;
    std::string summary;
    void (*write)(std::ostream& out, const sim::Frame& frame);
};
const std::vector<FrameFormat>& frame_formats();

/// One frame that a .pvd collection lists.
struct FrameEntry {
    double time = 0.0;
    std::string file;  ///< relative to the collection
};

/// Writes a ParaView collection. Atomic.
void write_pvd(const std::filesystem::path& path, const std::vector<FrameEntry>& entries);
/// @throws IoError, InputError
std::vector<FrameEntry> read_pvd(const std::filesystem::path& path);

}  // namespace lamella::io
