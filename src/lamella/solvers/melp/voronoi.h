#pragma once

#include "lamella/core/vec.h"
#include "lamella/solvers/melp/neighbors.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// The Voronoi cell of a particle among its neighbors, laid into its tangent plane: it is cut out of a large square by
/// the bisectors of one neighbor after the other. One object's memory serves many particles.
class VoronoiCell {
public:
    static constexpr std::uint32_t kNobody = 0xffffffffU;
    struct Corner {
        double u, v;         ///< in the tangent plane, from the particle [m]
        std::uint32_t next;  ///< whose bisector the side after this corner lies on; kNobody: the square's
    };

    void build(std::span<const Vec3> position, const Vec3& normal, const Neighbors& same, std::size_t i);

    /// Counterclockwise, seen from where the normal points. Their `next` are the neighbors that the cell touches.
    std::span<const Corner> corners() const { return cell_; }
    /// [m^2]
    double area() const;

private:
    struct Seen {
        std::uint32_t j;
        double u, v, square;  // in the tangent plane, and the squared distance in space
    };
    void cut_off(std::uint32_t j, double u, double v);

    std::vector<Seen> seen_;
    std::vector<Corner> cell_, cut_;
    std::vector<double> beyond_;
    double farthest_ = 0.0;  // corner, squared [m^2]
};

/// The triangles that a particle makes with the neighbors its Voronoi cell touches. Right at folds too, where areas
/// from kernels are not.
struct Star {
    double cell_area = 0.0;  ///< of the Voronoi cell: how fast the volume under it grows along its normal [m^2]
    Vec3 area;               ///< of the triangles, along their normals [m^2]
    /// Volume between the triangles and the film. They bulge as their corners' normals say: a quadratic with the
    /// curvatures kappa along the edges stands area * sum kappa length^2 / 24 above its corners' plane. [m^3]
    double bulge = 0.0;

    /// A third of the volume between `center` and the triangles around the particle at `x`: summed over a closed film
    /// every triangle counts once [m^3].
    double volume(const Vec3& x, const Vec3& center) const { return (dot(x - center, area) / 3.0 + bulge) / 3.0; }
};
Star star_of(std::span<const Vec3> position,
             std::span<const Vec3> normal,
             const Neighbors& same,
             std::size_t i,
             VoronoiCell& cell);

}  // namespace lamella::melp
