#pragma once

#include "lamella/mesh/foam_mesh.h"
#include "lamella/mesh/vertex_corners.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamella::mesh {

enum class WhichRegions : std::uint8_t {
    kAll,
    kClosed,  ///< those with a volume
};

/// The regions that touch each vertex: 2 on a film, 3 on a triple line, 4 at a junction point; compressed rows.
///
/// Row v holds the entries [start[v], start[v + 1]); regions of a row ascend. What is known per vertex and region lies
/// in a plain vector with one value per entry.
struct VertexRegions {
    std::vector<std::size_t> start;  ///< #V + 1
    std::vector<RegionId> region;    ///< one per entry

    std::span<const RegionId> of(VertexId v) const {
        return std::span(region).subspan(start[index(v)], start[index(v) + 1] - start[index(v)]);
    }
    /// The entry of a vertex and a region, or nothing if they do not touch.
    std::optional<std::size_t> find(VertexId v, RegionId r) const {
        for (std::size_t entry = start[index(v)]; entry < start[index(v) + 1]; ++entry)
            if (region[entry] == r) return entry;
        return std::nullopt;
    }
};

/// The regions that touch each vertex through its faces.
VertexRegions vertex_regions(const FoamMesh& mesh, WhichRegions which = WhichRegions::kAll);
/// The same with the corners of the mesh at hand.
VertexRegions vertex_regions(const FoamMesh& mesh,
                             const VertexCorners& corners,
                             WhichRegions which = WhichRegions::kAll);

}  // namespace lamella::mesh
