#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace lamella::mesh {

/// How a mesh is kept even. Lengths and volumes in units of the wanted edge length h, angles in degrees.
struct TrackerOptions {
    double edge_length = 0.0;          ///< h [m]
    double longest_edge = 1.45;        ///< longer ones are split
    double shortest_edge = 0.55;       ///< shorter ones are collapsed
    double irregular_edge = 0.25;      ///< only edges shorter than this collapse onto other triple lines (then: T1)
    double kept_irregular_edge = 0.1;  ///< below this the crossing is kept even when it cannot be separated yet
    double flip_angle = 1.02;          ///< an edge flips if the angles opposite it add up to more, in units of pi
    double separation = 0.15;          ///< how far each copy of a separated vertex moves
    double separation_cost = 0.0;      ///< area that a separation may add [h^2]: leaves crossings that balance
    double merge_distance = 0.15;      ///< films this close that face each other become one
    double longest_step = 0.15;        ///< no vertex moves farther in one `move`
    double least_volume = 0.5;         ///< smaller regions are absorbed by a neighbor [h^3]
    bool merging = true;               ///< films that touch become one
    bool separating = true;            ///< T1 and pinch
};

/// Something that changed which region touches which.
struct TopologyEvent {
    enum class Kind { kT1, kPinch, kMerge, kSplit, kAbsorb, kPop };
    Kind kind;
    Vec3 position;          ///< where [m]
    RegionId a = kOutside;  ///< merge: the regions that met; split: old and new; absorb, pop: gone and heir;
    RegionId b = kOutside;  ///< t1: the regions that parted
};
std::string_view name(TopologyEvent::Kind kind);

/// Where two regions that no film parts meet in a point.
struct Crossing {
    RegionId a = kOutside, b = kOutside;
    Vec3 position;  ///< [m]
};

/// How the values of a vertex follow from values before an edit: value = sum of weight * value(parent).
///
/// It comes right after its edit was accepted, edits in the order they are made:
///   - split: the new vertex from the ends of the edge; collapse: the vertex that stays from both ends;
///   - merge: each vertex that stays from the pair that it stands for;
///   - T1, pinch: the vertex that stays from itself, then its copy from it. A collapse that ends in a T1: first the
///     vertex that stays from both ends, then the copy from the vertex that parted.
/// `Tracker::mesh()` shows the mesh after the edit, with all ids as they were before the compaction that ends `remesh`
/// and `pop`: new vertices get the next free ids in the order of the calls, and those that are gone keep theirs, with
/// no faces, until the compaction. `maps` then leads from these ids to the final ones. Values per vertex and region
/// also follow the events: on `kSplit` what region a had at the vertices of its piece goes to region b, on `kAbsorb`
/// and `kPop` what a had goes to b. A flip changes no values.
struct Resampling {
    VertexId vertex;  ///< new, or with a new place
    std::span<const VertexId> parents;
    std::span<const double> weights;
};

/// What one `remesh` did.
struct RemeshReport {
    int splits = 0, collapses = 0, flips = 0, separations = 0, merges = 0, absorbed = 0;
    int stuck = 0;  ///< vertices that no accepted edit makes regular for now
    bool changed() const { return splits + collapses + flips + separations + merges + absorbed > 0; }
};

/// Old to new ids after a compaction; kNoVertex and kNoFace for what is gone.
struct CompactionMaps {
    IdVector<VertexId, VertexId> vertex;
    IdVector<FaceId, FaceId> face;
};

/// Keeps a foam mesh even, free of intersections and topologically right while its films move.
///
/// Every edit is a transaction, accepted only after local checks (labels, shape, label cycles, exact intersections)
/// and otherwise taken back. docs/mesh.md tells the whole recipe. Deterministic: the same calls give the same bits on
/// any number of threads. The mesh between two calls obeys all rules of FoamMesh.
class Tracker {
public:
    /// The mesh must obey the rules of FoamMesh. @throws InputError  it is periodic, or the edge length is not positive
    Tracker(FoamMesh mesh, const TrackerOptions& options);
    ~Tracker();
    Tracker(Tracker&&) noexcept;
    Tracker& operator=(Tracker&&) noexcept;

    const FoamMesh& mesh() const;
    const TrackerOptions& options() const;

    /// Called for every accepted edit that gives a vertex a new value or place.
    void set_resampler(std::function<void(const Resampling&)> resampler);

    /// Moves the vertices as far along `displacement` [m] as is safe: no vertex farther than the longest step, and no
    /// two primitives (vertex and face, edge and edge) by more than 0.9 of their distance together, so that nothing
    /// can cross. Vertices on wires move as told too: the caller knows where the wire goes.
    /// @param later  how far each vertex will probably go in further calls before the next `remesh` [m]. A good guess spares
    ///               them the search for films that are near; the motion is the same without it.
    struct MoveReport {
        std::size_t limited = 0;  ///< vertices that did not go all the way
    };
    MoveReport move(const IdVector<VertexId, Vec3>& displacement, const IdVector<VertexId, double>& later = {});

    /// One cycle: merge, split, collapse, flip, separate, relabel, absorb, compact.
    RemeshReport remesh();

    /// Bursts the films between two regions: `region` joins `into`, which gets its target volume.
    /// @throws InputError  there is no such region, or the two share no film
    void pop(RegionId region, RegionId into);

    void set_target_volume(RegionId region, double volume);

    /// These crossings stay closed from now on: within two edge lengths of its place, the two regions of each are not
    /// parted. For films that are shorter at rest than the mesh can show, which would part and close without end.
    void hold(std::vector<Crossing> crossings);

    /// Topological events since the last call.
    std::vector<TopologyEvent> take_events();
    /// From the ids within the last remesh or pop (those before it and, after them, those it added) to the ids now.
    const CompactionMaps& maps() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lamella::mesh
