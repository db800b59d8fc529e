#pragma once

#include "lamella/mesh/detail/edit_mesh.h"
#include "lamella/mesh/tracker.h"

#include <functional>
#include <initializer_list>
#include <optional>
#include <vector>

namespace lamella::mesh::detail {

/// What the passes of one remesh share.
struct Workbench {
    EditMesh& mesh;
    const TrackerOptions& options;
    const std::function<void(const Resampling&)>& resampler;
    const std::vector<Crossing>& held;  ///< these are not parted
    RemeshReport& report;
    std::vector<TopologyEvent>& events;
    bool topology_changed = false;  ///< regions may have come apart: relabel

    double length(double in_edges) const { return in_edges * options.edge_length; }
    void resample(VertexId v, std::initializer_list<VertexId> parents, std::initializer_list<double> weights) const {
        if (resampler) resampler({v, {parents.begin(), parents.size()}, {weights.begin(), weights.size()}});
    }
};

/// Whether the faces that the open transaction touched may stay: different labels on both sides, no angle sharper
/// than the one of cotangent `sharpest`, label cycles in order, no region starved, no intersection with any face.
bool acceptable(const EditMesh& mesh, double sharpest);

/// Two faces with the same three vertices, and on: they cancel, or one face between the outer regions replaces them.
/// @returns false when their labels do not fit (the caller rolls back)
bool cancel_flaps(EditMesh& mesh, VertexId v);
/// Makes two vertices one at `place`; `gone` loses all its faces. @returns false when flaps appear that do not fit
bool identify(EditMesh& mesh, VertexId kept, VertexId gone, const Vec3& place);

/// Moves a free vertex such that the volumes around it are those of `before`: the shortest way, at most `farthest`.
/// See StarVolumes.
struct StarVolumes {
    SmallVector<RegionId, 8> regions;
    SmallVector<double, 8> volumes;
    void add(RegionId r, double volume);
    double of(RegionId r) const;
};
/// Volumes that the given faces contribute to their regions, seen from `origin`.
StarVolumes star_volumes(const EditMesh& mesh, const std::vector<FaceId>& faces, const Vec3& origin);
void restore_volumes(EditMesh& mesh, VertexId v, const StarVolumes& before, const Vec3& origin, double farthest);

// The passes, one file each.
void split_long_edges(Workbench& bench);
void collapse_short_edges(Workbench& bench);
void flip_edges(Workbench& bench);
/// Within the open transaction: parts a vertex where sectors without a common face meet into two, the way that saves
/// most area and passes the checks. `before`: volumes of the touched faces and the star of v before the transaction.
struct Separation {
    VertexId vertex, copy;
    TopologyEvent event;
};
std::optional<Separation> separate_vertex(
    const Workbench& bench, VertexId v, const StarVolumes& before, const Vec3& origin, double sharpest);
void separate_vertices(Workbench& bench);
void merge_close_faces(Workbench& bench);
/// Gives each piece of a region that came apart a number of its own, and lets regions too small to resolve go.
void relabel(Workbench& bench);
void absorb_small_regions(Workbench& bench);
void absorb(Workbench& bench, RegionId region, RegionId into);
double region_volume(const EditMesh& mesh, RegionId region);

}  // namespace lamella::mesh::detail
