#pragma once

// The dialect of VTK XML PolyData that lamella writes and reads; docs/file-formats.md describes it for users. VTK
// ignores XML attributes it does not know, so what VTK has no place for is kept in attributes of ours:
//
//   VTKFile   lamella_frame="1"   the version of this dialect: other files are refused by name
//   DataArray surface_field="k"   the array holds vertex field k of the surface
//             point_field="k"     ... and field k of the points; an array may be both, rows of one set follow the
//             other's face_field="k"      face field k; rows of point cells come first scalar="k"          scalar k of
//             the frame, with its meaning as text="..."
//             region_field="k"    field k of the regions, one row per region; its name has region_ before it
//
// Array names: kTimeValue is the one ParaView looks for.

#include <cstdint>

namespace lamella::io::detail {

inline constexpr const char* kVtpVersion = "1";
inline constexpr const char* kTimeValue = "TimeValue";
inline constexpr const char* kCompressor = "vtkZLibDataCompressor";
inline constexpr std::int32_t kNoRegion = -1;  ///< region labels of point cells

}  // namespace lamella::io::detail
