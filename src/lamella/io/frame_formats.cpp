#include "lamella/io/frame_files.h"

namespace lamella::io {

const std::vector<FrameFormat>& frame_formats() {
    static const std::vector<FrameFormat> formats{
        {"ply", ".ply", "surfaces and points with their fields, binary: Blender, MeshLab, Houdini", write_ply},
        {"obj", ".obj", "films, a group for each pair of regions, Wavefront OBJ: any 3D program", write_obj},
        {"glb", ".glb", "films and balls with normals and colors, binary glTF: Blender, three.js, engines", write_glb, true},
        {"usda", ".usda", "the same as USD text: Houdini, Blender, Omniverse", write_usda, true},
        {"fe", ".fe", "films with their volumes and wires: Surface Evolver", write_surface_evolver},
        {"xyz", ".xyz", "points with box and fields, extended XYZ text: OVITO, ASE", write_extended_xyz},
        {"csv", ".csv", "a table with one row per point: spreadsheets, pandas, gnuplot", write_points_csv},
    };
    return formats;
}

}  // namespace lamella::io
