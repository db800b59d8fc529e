#include "lamella/core/error.h"
#include "lamella/io/detail/evolver_datafile.h"
#include "lamella/io/detail/film_labels.h"
#include "lamella/io/mesh_files.h"
#include "lamella/mesh/check.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/label_sides.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

namespace lamella::io {
namespace {

using detail::EvolverDatafile;
using mesh::FaceId;
using mesh::FoamMesh;
using mesh::kNoRegion;
using mesh::RegionId;
using mesh::RegionKind;
using mesh::VertexId;

class Builder {
public:
    Builder(const EvolverDatafile& file, const std::string& name) : file_(file), name_(name) {}

    FilmFile build() {
        vertices();
        for (std::size_t f = 0; f < file_.faces.size(); ++f) face(f);
        const mesh::ElementNames names{[this](VertexId v) { return vertex_name(v); },
                                       [this](FaceId f) { return face_name(f); }};
        detail::require_proper_faces(mesh_, name_, names);
        bodies();
        const mesh::EdgeFaces edges = mesh::edge_faces(mesh_);
        const bool complete = std::all_of(mesh_.faces.begin(), mesh_.faces.end(), [](const mesh::Face& face) {
            return face.back != kNoRegion && face.front != kNoRegion;
        });
        if (!complete) label(edges, names);
        volumes(edges);
        rims(edges);
        mesh::require_sound(mesh_, name_, {.names = names});
        FilmFile films{.mesh = {}, .tensions = tensions()};
        films.mesh = std::move(mesh_);
        return films;
    }

private:
    [[noreturn]] void refuse(int line, const std::string& what) const { throw InputError({name_, line, 0}, what); }

    void vertices() {
        for (const auto& vertex : file_.vertices) mesh_.add_vertex(vertex.at, vertex.held);
        for (std::size_t e = 0; e < file_.edges.size(); ++e) {
            inner_.push_back(mesh_.position.size());
            for (const Vec3& place : file_.edges[e].inner) {
                mesh_.add_vertex(place, true);
                added_.push_back(fmt::format("on edge {}", file_.edges[e].number));
            }
        }
        for (const auto& edge : file_.edges)
            if (edge.held) mesh_.on_wire[static_cast<VertexId>(edge.tail)] = mesh_.on_wire[static_cast<VertexId>(edge.head)] = 1;
        if (file_.torus) mesh_.period = file_.period;
    }

    /// The corners of a face: vertices and, in a torus, how many periods from the first one.
    struct Corner {
        VertexId vertex;
        std::array<int, 3> image;
    };

    std::vector<Corner> corners(const EvolverDatafile::Face& face) const {
        if (face.loop.size() < 3)
            refuse(face.line, fmt::format("face {} has {} edges; it needs 3 or more", face.number, face.loop.size()));
        std::vector<Corner> corners;
        std::array<int, 3> image{};
        for (std::size_t k = 0; k < face.loop.size(); ++k) {
            const auto [e, forward] = face.loop[k];
            const auto& edge = file_.edges[e];
            const auto& next_use = face.loop[(k + 1) % face.loop.size()];
            const auto& next = file_.edges[next_use.edge];
            if ((forward ? edge.head : edge.tail) != (next_use.forward ? next.tail : next.head))
                refuse(face.line, fmt::format("face {}: edge {} does not begin where edge {} ends", face.number,
                                              next.number, edge.number));
            corners.push_back({static_cast<VertexId>(forward ? edge.tail : edge.head), image});
            for (std::size_t i = 0; i < edge.inner.size(); ++i)
                corners.push_back({static_cast<VertexId>(inner_[e] + (forward ? i : edge.inner.size() - 1 - i)), image});
            for (std::size_t a = 0; a < 3; ++a) {
                image[a] += forward ? edge.wrap[a] : -edge.wrap[a];
                constexpr int kFarthest = 100;
                if (std::abs(image[a]) > kFarthest)
                    refuse(face.line, fmt::format("face {} reaches over more than {} periods", face.number, kFarthest));
            }
        }
        if (image != std::array<int, 3>{})
            refuse(face.line, fmt::format("face {}: its edges wrap around the torus and do not come back", face.number));
        return corners;
    }

    Vec3 place(const Corner& corner) const {
        Vec3 at = mesh_.position[corner.vertex];
        if (file_.torus)
            for (std::size_t a = 0; a < 3; ++a) at += corner.image[a] * mesh_.period[a];
        return at;
    }

    void triangle(std::size_t f, const Corner& a, const Corner& b, const Corner& c) {
        mesh_.add_face(a.vertex, b.vertex, c.vertex, kNoRegion, kNoRegion);
        origin_.push_back(f);
        if (!file_.torus) return;
        mesh::CornerImages images{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t x = 0; x < 3; ++x)
                images[k][x] = static_cast<std::int8_t>(std::array{&a, &b, &c}[k]->image[x]);
        mesh_.images.push_back(images);
    }

    void face(std::size_t f) {
        const EvolverDatafile::Face& face = file_.faces[f];
        const std::vector<Corner> loop = corners(face);
        first_.push_back(mesh_.faces.size());
        if (face.held)
            for (const Corner& corner : loop) mesh_.on_wire[corner.vertex] = 1;
        if (loop.size() == 3) return triangle(f, loop[0], loop[1], loop[2]);
        Vec3 middle;
        for (const Corner& corner : loop) middle += place(corner) / static_cast<double>(loop.size());
        const Corner center{mesh_.add_vertex(middle, face.held), {}};
        added_.push_back(fmt::format("in the middle of face {}", face.number));
        for (std::size_t k = 0; k < loop.size(); ++k) triangle(f, loop[k], loop[(k + 1) % loop.size()], center);
    }

    std::string vertex_name(VertexId v) const {
        const std::size_t i = index(v);
        if (i < file_.vertices.size()) return std::to_string(file_.vertices[i].number);
        return added_[i - file_.vertices.size()];
    }
    std::string face_name(FaceId f) const { return std::to_string(file_.faces[origin_[index(f)]].number); }

    /// The triangles of a face of the file.
    std::pair<std::size_t, std::size_t> triangles(std::size_t f) const {
        return {first_[f], f + 1 < first_.size() ? first_[f + 1] : mesh_.faces.size()};
    }

    void set(std::size_t f, bool back, RegionId region, int line) {
        const auto [begin, end] = triangles(f);
        for (std::size_t t = begin; t < end; ++t) {
            mesh::Face& face = mesh_.faces[static_cast<FaceId>(t)];
            RegionId& side = back ? face.back : face.front;
            if (side != kNoRegion && side != region)
                refuse(line, fmt::format("face {} has regions {} and {} on one side", file_.faces[f].number, index(side),
                                         index(region)));
            side = region;
        }
    }

    void bodies() {
        std::int64_t most = 0;
        for (const auto& body : file_.bodies) most = std::max(most, body.number);
        for (const auto& face : file_.faces) most = std::max({most, face.back.value_or(0), face.front.value_or(0)});
        mesh_.regions.resize(static_cast<std::size_t>(most) + 1, {RegionKind::kGone, 0.0});
        mesh_.regions[mesh::kOutside].kind = RegionKind::kOpen;
        for (const auto& body : file_.bodies) {
            const auto region = static_cast<RegionId>(body.number);
            mesh_.regions[region].kind = RegionKind::kOpen;
            for (const auto& [f, outward] : body.faces) set(f, outward, region, body.line);
        }
        for (std::size_t f = 0; f < file_.faces.size(); ++f) {
            const auto& face = file_.faces[f];
            for (const auto& [label, back] : {std::pair{face.back, true}, std::pair{face.front, false}}) {
                if (!label) continue;
                const auto region = static_cast<RegionId>(*label);
                mesh_.regions[region].kind = RegionKind::kOpen;
                set(f, back, region, face.line);
            }
        }
    }

    void label(const mesh::EdgeFaces& edges, const mesh::ElementNames& names) {
        try {
            mesh::label_sides(mesh_, edges, names);
        } catch (const InputError& error) {
            refuse(0, error.what());
        }
    }

    void volumes(const mesh::EdgeFaces& edges) {
        const auto closed = mesh::closed_in(mesh_, edges);
        for (const auto& body : file_.bodies) {
            if (!body.volume) continue;
            const auto region = static_cast<RegionId>(body.number);
            if (closed[region] == 0)
                refuse(body.line, fmt::format("body {} has a volume, but its faces do not close it in", body.number));
            mesh_.regions[region] = {RegionKind::kClosed, *body.volume};
        }
    }

    /// Where a film ends, the file must say that the edge is held.
    void rims(const mesh::EdgeFaces& edges) const {
        std::map<std::pair<std::size_t, std::size_t>, const EvolverDatafile::Edge*> between;
        for (const auto& edge : file_.edges) between[std::minmax(edge.tail, edge.head)] = &edge;
        for (std::size_t e = 0; e < edges.size(); ++e) {
            if (edges.of(e).size() != 1) continue;
            const auto it = between.find(std::minmax(index(edges.edge[e].a), index(edges.edge[e].b)));
            if (it == between.end() || it->second->held) continue;
            const FaceId f = edges.of(e)[0].face;
            if (file_.faces[origin_[index(f)]].held) continue;
            refuse(0, fmt::format("edge {} has one face only and is not fixed: the film of face {} ends there, but no"
                                  " wire holds it", it->second->number, face_name(f)));
        }
    }

    std::vector<PairTension> tensions() const {
        std::map<std::pair<RegionId, RegionId>, std::size_t> first;
        std::vector<PairTension> list;
        for (std::size_t f = 0; f < file_.faces.size(); ++f) {
            const mesh::Face& face = mesh_.faces[static_cast<FaceId>(first_[f])];
            const auto [it, fresh] = first.try_emplace(std::minmax(face.back, face.front), f);
            const auto& a = file_.faces[it->second];
            const auto& b = file_.faces[f];
            if (a.tension != b.tension)
                refuse(b.line, fmt::format("faces {} and {} are between regions {} and {}, but have tensions {} and {}:"
                                           " one is possible", a.number, b.number, index(it->first.first),
                                           index(it->first.second), a.tension, b.tension));
            if (fresh && b.tension != 1.0) list.push_back({it->first.first, it->first.second, b.tension});
        }
        return list;
    }

    const EvolverDatafile& file_;
    const std::string& name_;
    FoamMesh mesh_;
    std::vector<std::size_t> origin_;     ///< of each triangle: the face of the file
    std::vector<std::size_t> first_;      ///< of each face of the file: its first triangle
    std::vector<std::size_t> inner_;      ///< of each edge of the file: its first added vertex
    std::vector<std::string> added_;      ///< of each added vertex: where it is
};

}  // namespace

FilmFile parse_surface_evolver(std::string_view text, const std::string& name) {
    const EvolverDatafile file = detail::parse_evolver_datafile(text, name);
    if (file.faces.empty()) throw InputError({name, 0, 0}, "there are no faces");
    return Builder(file, name).build();
}

}  // namespace lamella::io
