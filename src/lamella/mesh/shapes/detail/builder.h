#pragma once

#include "lamella/mesh/foam_mesh.h"

#include <array>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

namespace lamella::mesh::detail {

/// @throws InputError  `value` is not positive and finite
void require_positive(double value, std::string_view name);
/// @throws InputError  films of this area in faces of this edge length would have more than 20 million faces
void require_affordable(double area, double edge_length);

/// A mesh with the outside and `regions` more of a kind.
FoamMesh empty_mesh(std::size_t regions, RegionKind kind);

/// Vertices by place: the same place (to 1e-9 of `scale`) gives the same vertex.
class Welder {
public:
    Welder(FoamMesh& mesh, double scale) : mesh_(mesh), grid_(1e-9 * scale) {}
    VertexId at(const Vec3& place, bool wire = false);

private:
    FoamMesh& mesh_;
    double grid_;
    std::map<std::array<long long, 3>, VertexId> known_;
};

/// A triangle of `n` x `n` small ones; place(u, v) of the corners (0,0), (1,0), (0,1).
void add_triangle_grid(FoamMesh& mesh,
                       int n,
                       const std::function<VertexId(double u, double v)>& vertex,
                       RegionId back,
                       RegionId front);

/// An axis with two directions across it.
struct Axis {
    Vec3 center, x, y, z;
    Axis(const Vec3& center, const Vec3& direction);
    Vec3 at(double radius, double angle, double height) const;
};

/// Rings of vertices around an axis, joined to a film. Normals are e_phi x (direction of the profile): a profile that
/// goes up at constant radius gives outward normals.
class Revolution {
public:
    Revolution(FoamMesh& mesh, const Axis& axis, double edge_length, RegionId back, RegionId front)
        : mesh_(mesh), axis_(axis), edge_(edge_length), back_(back), front_(front) {}

    /// Where the profile is at s in [0, 1]: radius and height.
    using Profile = std::function<std::array<double, 2>(double s)>;
    std::vector<VertexId> ring(double radius, double height, bool wire, double offset = 0.0);
    /// From a ring to the pole where the profile ends at radius 0.
    void close(std::vector<VertexId> ring, double length, const Profile& profile);
    /// From one ring to another.
    void join(const std::vector<VertexId>& from,
              const std::vector<VertexId>& to,
              double length,
              const Profile& profile);

private:
    void stitch(const std::vector<VertexId>& from, const std::vector<VertexId>& to);
    std::vector<VertexId> inner_rows(std::vector<VertexId> row, int rows, const Profile& profile);
    int rows_of(double length) const;

    FoamMesh& mesh_;
    Axis axis_;
    double edge_;
    RegionId back_, front_;
};

}  // namespace lamella::mesh::detail
