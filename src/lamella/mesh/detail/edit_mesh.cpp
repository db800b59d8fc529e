#include "lamella/mesh/detail/edit_mesh.h"

#include "lamella/core/error.h"

#include <algorithm>

namespace lamella::mesh::detail {
namespace {

constexpr Face kDead{{kNoVertex, kNoVertex, kNoVertex}, kOutside, kOutside};

constexpr std::size_t kFewestSides = 4;  // of a region: a tetrahedron

void insert_sorted(FaceList& list, FaceId f) {
    const auto place = std::lower_bound(list.begin(), list.end(), f) - list.begin();
    list.insert(static_cast<std::size_t>(place), f);
}

void erase_sorted(FaceList& list, FaceId f) {
    const auto place = std::lower_bound(list.begin(), list.end(), f) - list.begin();
    list.erase(static_cast<std::size_t>(place));
}

}  // namespace

EditMesh::EditMesh(FoamMesh mesh, double cell) : mesh_(std::move(mesh)), cell_(cell), grid_(cell, 64) {
    suspect_.assign(mesh_.position.size(), 1);
    rebuild_lists();
    index_faces();
}

Box EditMesh::box(FaceId f) const {
    const auto [a, b, c] = corners(f);
    Box box{a, a};
    box.include(b);
    box.include(c);
    return box;
}

SmallVector<FaceId, 8> EditMesh::faces_on(VertexId v, VertexId w) const {
    SmallVector<FaceId, 8> both;
    for (const FaceId f : faces_at_[v])
        if (face(f).has(w)) both.push_back(f);
    return both;
}

RegionId EditMesh::add_region(const Region& region) {
    sides_.push_back(0);
    ++starved_;
    return mesh_.regions.push_back(region);
}

void EditMesh::attach(FaceId f) {
    const Face& face = mesh_.faces[f];
    for (const VertexId v : face.vertices) insert_sorted(faces_at_[v], f);
    for (const RegionId r : {face.back, face.front})
        if (++sides_[r] == kFewestSides) --starved_;
}

void EditMesh::detach(FaceId f) {
    const Face& face = mesh_.faces[f];
    for (const VertexId v : face.vertices) erase_sorted(faces_at_[v], f);
    for (const RegionId r : {face.back, face.front})
        if (sides_[r]-- == kFewestSides) ++starved_;
}

void EditMesh::touch(FaceId f) {
    if (stamp_[f] == transaction_) return;
    stamp_[f] = transaction_;
    touched_.push_back(f);
}

void EditMesh::begin() {
    LAMELLA_ASSERT(log_.empty() && indexed_);
    ++transaction_;
    touched_.clear();
    starved_before_ = starved_;
}

VertexId EditMesh::add_vertex(const Vec3& at, bool on_wire) {
    const VertexId v = mesh_.add_vertex(at, on_wire);
    faces_at_.push_back({});
    suspect_.push_back(1);
    log_.push_back({Edit::kAddVertex, static_cast<std::uint32_t>(v), {}, {}});
    return v;
}

void EditMesh::move_vertex(VertexId v, const Vec3& to) {
    log_.push_back({Edit::kMoveVertex, static_cast<std::uint32_t>(v), {}, at(v)});
    mesh_.position[v] = to;
    for (const FaceId f : faces_at_[v]) touch(f);
}

FaceId EditMesh::add_face(const Face& face) {
    const FaceId f = mesh_.faces.push_back(face);
    stamp_.push_back(0);
    log_.push_back({Edit::kAddFace, static_cast<std::uint32_t>(f), {}, {}});
    touch(f);
    attach(f);
    return f;
}

void EditMesh::set_face(FaceId f, const Face& face) {
    log_.push_back({Edit::kSetFace, static_cast<std::uint32_t>(f), mesh_.faces[f], {}});
    touch(f);
    detach(f);
    mesh_.faces[f] = face;
    if (alive(f)) attach(f);
}

void EditMesh::kill_face(FaceId f) { set_face(f, kDead); }

void EditMesh::commit() {
    for (const FaceId f : touched_) {
        if (grid_.holds(f)) grid_.erase(f);
        if (!alive(f)) continue;
        grid_.insert(f, box(f));
        for (const VertexId v : face(f).vertices) suspect_[v] = 1;
    }
    for (const LogEntry& entry : log_)
        if (entry.edit == Edit::kSetFace)
            for (const VertexId v : entry.face.vertices) suspect_[v] = 1;
    log_.clear();
}

void EditMesh::rollback_to(std::size_t mark) {
    for (; log_.size() > mark; log_.pop_back()) {
        const LogEntry& entry = log_.back();
        const VertexId v{entry.id};
        const FaceId f{entry.id};
        switch (entry.edit) {
            case Edit::kAddVertex:
                mesh_.position.pop_back();
                mesh_.on_wire.pop_back();
                faces_at_.pop_back();
                suspect_.pop_back();
                break;
            case Edit::kMoveVertex:
                mesh_.position[v] = entry.position;
                break;
            case Edit::kAddFace:
                detach(f);
                mesh_.faces.pop_back();
                stamp_.pop_back();
                break;
            case Edit::kSetFace:
                if (alive(f)) detach(f);
                mesh_.faces[f] = entry.face;
                attach(f);
                break;
        }
    }
    std::erase_if(touched_, [&](FaceId f) { return index(f) >= mesh_.faces.size(); });
    if (mark > 0) return;
    // The transaction goes on from its beginning: what it touches next counts as touched for the first time.
    for (const FaceId f : touched_) stamp_[f] = 0;
    touched_.clear();
}

void EditMesh::set_positions(const IdVector<VertexId, Vec3>& position) {
    mesh_.position = position;
    indexed_ = false;
}

void EditMesh::index_faces() {
    if (indexed_) return;
    indexed_ = true;
    grid_.clear(2 * mesh_.faces.size());
    for (const FaceId f : mesh_.faces.ids())
        if (alive(f)) grid_.insert(f, box(f));
}

void EditMesh::rebuild_lists() {
    faces_at_.assign(mesh_.position.size(), {});
    sides_.assign(mesh_.regions.size(), 0);
    starved_ = mesh_.regions.size();
    stamp_.assign(mesh_.faces.size(), 0);
    transaction_ = 0;
    for (const FaceId f : mesh_.faces.ids())
        if (alive(f)) attach(f);
}

EditMesh::Maps EditMesh::compact() {
    Maps maps{IdVector<VertexId, VertexId>(mesh_.position.size(), kNoVertex),
              IdVector<FaceId, FaceId>(mesh_.faces.size(), kNoFace)};
    FoamMesh kept;
    IdVector<VertexId, std::uint8_t> suspect;
    kept.regions = mesh_.regions;
    for (const VertexId v : mesh_.position.ids())
        if (!faces_at_[v].empty()) {
            maps.vertex[v] = kept.add_vertex(mesh_.position[v], on_wire(v));
            suspect.push_back(suspect_[v]);
        }
    for (const FaceId f : mesh_.faces.ids()) {
        if (!alive(f)) continue;
        Face face = mesh_.faces[f];
        for (VertexId& v : face.vertices) v = maps.vertex[v];
        maps.face[f] = kept.faces.push_back(face);
    }
    mesh_ = std::move(kept);
    suspect_ = std::move(suspect);
    rebuild_lists();
    indexed_ = false;
    return maps;
}

}  // namespace lamella::mesh::detail
