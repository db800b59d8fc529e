#pragma once

#include "lamella/linalg/symmetric_matrix.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/foam_mesh.h"
#include "lamella/solvers/equilibrium/normal_space.h"
#include "lamella/solvers/equilibrium/patch_energy.h"
#include "lamella/solvers/equilibrium/patches.h"

#include <cstddef>
#include <vector>

namespace lamella::equilibrium {

/// Area and volumes of patches, with their slopes in the normal space.
struct Balance {
    double area = 0.0;                           ///< sum of tension * area [m^2]
    std::vector<double> missing;                 ///< target - volume of each constrained region [m^3]
    std::vector<double> slope;                   ///< g: d area / d unknown
    std::vector<std::vector<double>> volume_slope;  ///< G: d volume / d unknown of each constrained region
    std::vector<double> mass;                    ///< per unknown: the area of its node [m^2]
    double scale = 0.0;                          ///< sqrt(sum of |d area of patch / d node|^2): of the residual
};

/// Minimal area at given volumes, in terms of the unknowns of the normal space: what Newton's method needs.
///
///   L(x) = sum tension * area - sum_r p_r (V_r - target_r)
class RestSystem {
public:
    RestSystem(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges, Patches patches);

    const Patches& patches() const { return patches_; }
    const NormalSpace& space() const { return space_; }
    /// The regions whose volume is held: all closed ones, but the first of a foam that fills a periodic box.
    const std::vector<mesh::RegionId>& constrained() const { return constrained_; }
    double target(std::size_t constraint) const { return target_[constraint]; }

    void set_positions(std::vector<Vec3> position) { patches_.position = std::move(position); }
    void update_space() { space_.update(patches_); }

    /// @param with_slopes  false: area and missing volumes only
    Balance balance(bool with_slopes = true) const;
    /// Pressures that balance the slopes best, in the metric of the masses [N/m^2 for a tension of 1 N/m].
    std::vector<double> best_pressures(const Balance& balance) const;
    /// |g - G p| / scale.
    static double residual(const Balance& balance, const std::vector<double>& pressure);
    /// Second derivative of L.
    const linalg::SymmetricMatrix& hessian(const std::vector<double>& pressure);

    /// Back to the target volumes along M^-1 G, by Newton's method. @returns the new positions
    std::vector<Vec3> project_volumes(std::vector<Vec3> position, int rounds);

    double length() const { return length_; }  ///< a typical size: of the smallest region, or of the films [m]

private:
    double pressure_jump(std::size_t patch, const std::vector<double>& pressure) const;
    void add_patch_couplings();

    Patches patches_;
    NormalSpace space_;
    std::vector<mesh::RegionId> constrained_;
    std::vector<double> target_;
    IdVector<mesh::RegionId, int> row_;  ///< of each region among the constrained, or -1
    IdVector<mesh::RegionId, Vec3> origin_;           ///< volumes are taken as seen from here
    std::vector<Vec3> back_shift_, front_shift_;      ///< periodic foams: what brings a patch to the others of the region
    double length_ = 1.0;

    linalg::SymmetricMatrix matrix_;
    std::vector<std::size_t> slot_start_;  ///< per patch
    std::vector<int> slot_;                ///< where each entry of a patch's matrix is added
    std::vector<double> entry_;            ///< those entries
};

/// For each face, what to add to its corners on either side so that the faces of a region fit together in space.
/// Empty for a foam that is not periodic.
struct RegionShifts {
    std::vector<Vec3> back, front;
};
RegionShifts region_shifts(const mesh::FoamMesh& mesh, const mesh::EdgeFaces& edges);

}  // namespace lamella::equilibrium
