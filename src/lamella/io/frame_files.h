#pragma once

#include "lamella/sim/frame.h"

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::io {

/// Writes a frame as VTK PolyData (.vtp, zlib-compressed, appended base64): triangles as polygons, points as
/// vertices, every field under its name with its unit as the array's UNITS_LABEL, the frame's scalars, time, step,
/// solver name and box as field data. Atomic: the name appears when the file is whole.
///
/// A frame with both a surface and points becomes one list of points, surface vertices first; a field that only one
/// of the two has is padded with NaN (integers: -1) for the other. Region labels are the cell data region_back and
/// region_front; the cells of points come first there and hold -1. Same frame, same bytes, on any number of threads.
/// @throws IoError     it cannot be written
/// @throws InputError  the frame contradicts itself: lengths that do not fit together, a name twice, a name that the
///                     format needs (radius, region_back, region_front; scalars: TimeValue, step, solver, ...), text
///                     that is not UTF-8 on one line, an integer field with other values than whole numbers up to 2^53
void write_vtp(const std::filesystem::path& path, const sim::Frame& frame);

/// The file of write_vtp for a frame of points that are never all in memory: their values come piece by piece.
class VtpStream {
public:
    /// @param frame   the whole but for the values of its points and of their fields, which are not looked at; it has
    /// no
    ///                surface
    /// @param points  how many there are   @param radii  whether they have radii
    /// @throws as write_vtp
    VtpStream(const std::filesystem::path& path, const sim::Frame& frame, std::size_t points, bool radii);
    ~VtpStream();
    VtpStream(const VtpStream&) = delete;
    VtpStream& operator=(const VtpStream&) = delete;

    /// The next values: all radii, then all of each field, in order, then all coordinates; cut anywhere.
    /// @throws as write_vtp
    void append(std::span<const double> values);
    /// All values are there: the file appears. @throws IoError
    void commit();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Reads back what write_vtp wrote, to the last bit. @throws IoError, InputError (the file and what is wrong in it)
sim::Frame read_vtp(const std::filesystem::path& path);
/// The same from memory (tests, fuzzing); `name` stands for the file in messages.
sim::Frame parse_vtp(std::string_view contents, const std::string& name);

// The writers below throw what write_vtp throws; IoError when the stream fails. XYZ and CSV hold points only, and
// refuse a frame that has a surface and no points.

/// Extended XYZ (OVITO, ASE): one line per point, the box as Lattice, every field a named column.
/// `velocity` is called `velo`, as these programs expect; scalars of the frame, time and units stand in the second
/// line. A flat box gets a slab as thick as the largest disc, as the format cannot hold a side of length 0.
void write_extended_xyz(std::ostream& out, const sim::Frame& frame);

/// Binary PLY: positions, radius and fields as vertex properties, triangles as faces with their region labels. The
/// vertex fields `normal` and `color` get the names that other programs know: nx, ny, nz; red, green, blue (uchar).
/// Surface and points share one list as in write_vtp. Integer fields beyond 32 bit become doubles (PLY has no more).
void write_ply(std::ostream& out, const sim::Frame& frame);

/// Wavefront OBJ of the films alone: a group film_B_F for the films with region B behind and F in front. Vertex fields
/// `normal` and `color` become its normals and colors of vertices, `thickness_nm` the first texture coordinate [um].
void write_obj(std::ostream& out, const sim::Frame& frame);

/// Surface Evolver datafile of the films alone: vertices and edges on wires are fixed, every region that films close in
/// is a body with its volume, the tension is 1. @throws InputError  also for a foam in a periodic box
void write_surface_evolver(std::ostream& out, const sim::Frame& frame);

/// A table with one row per point: x, y, z, radius, then every field; header names carry units: "velocity_x[m/s]".
void write_points_csv(std::ostream& out, const sim::Frame& frame);

// What follows is for programs that draw; give it frames with normals, thickness and color (render/baked_frame.h).

/// Binary glTF 2.0: a mesh with a material of its own for every film (KHR_materials_iridescence for its mean
/// thickness), balls as polyhedra; vertex fields as attributes, `thickness_nm` as _THICKNESS_NM; region labels as
/// extras of the meshes.
void write_glb(std::ostream& out, const sim::Frame& frame);

/// USD as text: films as one mesh with vertex fields and region labels as primvars, balls as points with widths.
void write_usda(std::ostream& out, const sim::Frame& frame);

/// The formats of `lamella export`: name, file suffix, one line on what it is for, and the writer.
struct FrameFormat {
    std::string name;
    std::string suffix;
    std::string summary;
    void (*write)(std::ostream& out, const sim::Frame& frame);
    bool for_drawing = false;  ///< it expects a baked frame
};
const std::vector<FrameFormat>& frame_formats();

/// One frame that a .pvd collection lists.
struct FrameEntry {
    double time = 0.0;
    std::string file;  ///< relative to the collection
};

/// Writes a ParaView collection. Atomic. @throws IoError, InputError (a file name that XML cannot hold)
void write_pvd(const std::filesystem::path& path, const std::vector<FrameEntry>& entries);
/// @throws IoError, InputError
std::vector<FrameEntry> read_pvd(const std::filesystem::path& path);
/// The same from text (tests, fuzzing); `name` stands for the file in messages.
std::vector<FrameEntry> parse_pvd(std::string_view text, const std::string& name);

}  // namespace lamella::io
