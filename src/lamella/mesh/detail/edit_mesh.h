#pragma once

#include "lamella/core/small_vector.h"
#include "lamella/mesh/detail/face_grid.h"
#include "lamella/mesh/foam_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::mesh::detail {

using FaceList = SmallVector<FaceId, 10>;

/// A foam mesh under repair: which faces are at a vertex, which are near a place, and edits that can be taken back.
///
/// All edits go through add_vertex, move_vertex, set_face, add_face and kill_face, inside a transaction. `rollback`
/// restores every list exactly, since lists are kept in ascending order and so depend on the mesh alone. The grid
/// follows at `commit`: a transaction that fails never touches it.
class EditMesh {
public:
    /// @param cell  side of a grid cell [m]
    EditMesh(FoamMesh mesh, double cell);

    const FoamMesh& mesh() const { return mesh_; }
    const Vec3& at(VertexId v) const { return mesh_.position[v]; }
    bool on_wire(VertexId v) const { return mesh_.on_wire[v] != 0; }
    const Face& face(FaceId f) const { return mesh_.faces[f]; }
    bool alive(FaceId f) const { return mesh_.faces[f].vertices[0] != kNoVertex; }
    std::array<Vec3, 3> corners(FaceId f) const {
        const auto& v = mesh_.faces[f].vertices;
        return {at(v[0]), at(v[1]), at(v[2])};
    }
    Box box(FaceId f) const;
    const FaceList& faces_at(VertexId v) const { return faces_at_[v]; }
    /// The faces that have both vertices, ascending.
    SmallVector<FaceId, 8> faces_on(VertexId v, VertexId w) const;
    /// Which faces are near a place. Only between `index_faces` and the next `set_positions` or `compact`.
    const FaceGrid& grid() const { return grid_; }
    /// Brings the grid up to date; needed before the first transaction after a motion or a compaction.
    void index_faces();
    double cell() const { return cell_; }
    /// Sides of faces that belong to a region.
    std::size_t sides(RegionId r) const { return sides_[r]; }
    IdVector<RegionId, Region>& regions() { return mesh_.regions; }
    RegionId add_region(const Region& region);
    /// True when the transaction left a region with too few faces to enclose anything (fewer than four).
    bool starves_a_region() const { return starved_ > starved_before_; }

    void begin();
    VertexId add_vertex(const Vec3& at, bool on_wire);
    void move_vertex(VertexId v, const Vec3& to);
    FaceId add_face(const Face& face);
    void set_face(FaceId f, const Face& face);
    void kill_face(FaceId f);
    void commit();
    void rollback() { rollback_to(0); }
    /// A point within the transaction to which rollback_to returns.
    std::size_t mark() const { return log_.size(); }
    void rollback_to(std::size_t mark);
    /// Faces that the transaction changed, made or moved, in the order of the first touch; some may be dead.
    const std::vector<FaceId>& touched() const { return touched_; }
    bool is_touched(FaceId f) const { return stamp_[f] == transaction_; }

    /// Whether the faces at v changed since `clear_suspicion(v)`: only then can v have become irregular, as that depends
    /// on how films hang together and not on where they are. All vertices are suspect at first.
    bool suspect(VertexId v) const { return suspect_[v] != 0; }
    void clear_suspicion(VertexId v) { suspect_[v] = 0; }

    /// New positions for all vertices at once, outside of any transaction.
    void set_positions(const IdVector<VertexId, Vec3>& position);

    struct Maps {
        IdVector<VertexId, VertexId> vertex;  ///< old to new, kNoVertex for those that are gone
        IdVector<FaceId, FaceId> face;        ///< old to new, kNoFace for those that are gone
    };
    /// Drops dead faces and vertices without faces; the order of the rest stays.
    Maps compact();

private:
    enum class Edit : std::uint8_t { kAddVertex, kMoveVertex, kAddFace, kSetFace };
    struct LogEntry {
        Edit edit;
        std::uint32_t id;
        Face face;      // before
        Vec3 position;  // before
    };

    void attach(FaceId f);
    void detach(FaceId f);
    void touch(FaceId f);
    void rebuild_lists();

    FoamMesh mesh_;
    double cell_;
    IdVector<VertexId, FaceList> faces_at_;
    IdVector<VertexId, std::uint8_t> suspect_;
    IdVector<RegionId, std::size_t> sides_;
    FaceGrid grid_;
    bool indexed_ = false;
    std::size_t starved_ = 0;  // regions with fewer than four sides
    std::size_t starved_before_ = 0;
    std::vector<LogEntry> log_;
    std::vector<FaceId> touched_;
    IdVector<FaceId, std::uint32_t> stamp_;
    std::uint32_t transaction_ = 0;
};

}  // namespace lamella::mesh::detail
