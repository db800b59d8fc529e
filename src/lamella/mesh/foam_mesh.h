#pragma once

#include <array>
#include <cstdint>

#include "lamella/core/id_vector.h"
#include "lamella/core/vec.h"

namespace lamella::mesh {

enum class VertexId : std::uint32_t {};
enum class FaceId : std::uint32_t {};
enum class RegionId : std::uint32_t {};  ///< a region of gas; 0 is the outside

inline constexpr VertexId kNoVertex{0xffffffffU};
inline constexpr FaceId kNoFace{0xffffffffU};
inline constexpr RegionId kOutside{0};

/// One triangle of film between two regions.
///
/// The normal (v1 - v0) x (v2 - v0) points from region `back` into region `front`.
struct Face {
    std::array<VertexId, 3> vertices;
    RegionId back;
    RegionId front;

    bool has(VertexId v) const { return vertices[0] == v || vertices[1] == v || vertices[2] == v; }
    friend bool operator==(const Face&, const Face&) = default;
};

enum class RegionKind : std::uint8_t {
    kClosed,  ///< a bubble: its films close it in, so it has a volume
    kOpen,    ///< air beside a film that ends on a wire, or the outside: no volume
    kGone,    ///< burst or absorbed; its number is not used again
};

struct Region {
    RegionKind kind = RegionKind::kClosed;
    double target_volume = 0.0;  ///< [m^3] of a closed region: what its gas fills at rest

    friend bool operator==(const Region&, const Region&) = default;
};

/// Of each corner of a face, how many periods along each axis.
using CornerImages = std::array<std::array<std::int8_t, 3>, 3>;

/// Films between regions of gas: triangles with two region labels, any number of them around an edge or a vertex.
///
/// Rules that hold for every mesh of a simulation (mesh/check.h tests them all):
///   - no face has the same region on both sides, none has a vertex twice, no two faces have the same vertices;
///   - label cycle: going around an edge, each face's far label is the next face's near label. Only an edge between
///     two wire vertices may lack this: there the film ends;
///   - no two faces meet other than in shared vertices and edges.
///
/// Regions that a film only separates inside a wire frame get their own label too (kind kOpen): the two sides of a
/// catenoid are 'inside' and 'outside', so that every rule about labels holds for films on wires as well.
struct FoamMesh {
    IdVector<VertexId, Vec3> position;        ///< [m]
    IdVector<VertexId, std::uint8_t> on_wire; ///< 1: held by a wire or a rim, moved by nothing else
    IdVector<FaceId, Face> faces;
    IdVector<RegionId, Region> regions;       ///< regions[kOutside] is kOpen

    /// Edges of the unit cell of a foam that fills space [m]; all zero for a foam in open air.
    std::array<Vec3, 3> period{};
    /// Periodic foams only, otherwise empty: corner k of a face lies at position + sum_a image[k][a] * period[a].
    IdVector<FaceId, CornerImages> images;

    VertexId add_vertex(const Vec3& at, bool wire = false) {
        on_wire.push_back(wire ? 1 : 0);
        return position.push_back(at);
    }
    bool periodic() const { return !images.empty(); }
    /// Where corner k of a face is [m].
    Vec3 corner(FaceId f, std::size_t k) const {
        Vec3 at = position[faces[f].vertices[k]];
        if (periodic())
            for (std::size_t a = 0; a < 3; ++a) at += images[f][k][a] * period[a];
        return at;
    }
    FaceId add_face(VertexId a, VertexId b, VertexId c, RegionId back, RegionId front) {
        return faces.push_back({{a, b, c}, back, front});
    }

    friend bool operator==(const FoamMesh&, const FoamMesh&) = default;
};

}  // namespace lamella::mesh
