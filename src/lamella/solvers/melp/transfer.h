#pragma once

#include "lamella/solvers/melp/geometry.h"
#include "lamella/solvers/melp/particles.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::melp {

/// What coarse particles receive from the fine ones around them.
struct Gathered {
    std::vector<double> liquid_volume;  ///< [m^3]
    std::vector<double> surfactant;     ///< [mol]
    std::vector<double> seen_volume;    ///< liquid volume * the fine particles' own thickness [m^4]
    std::vector<double> heat;           ///< liquid volume * temperature [m^3 K]
    std::vector<Vec3> momentum;         ///< per density of the liquid [m^4/s]
};

/// What fine particles take from the coarse ones around them.
struct CoarseValues {
    std::span<const Vec3> position, velocity;
    std::span<const double> thickness;       ///< [m]
    std::span<const double> seen_thickness;  ///< the fine particles' own, averaged [m]
};

/// What coarse particles gain, over what they have gathered.
struct Growth {
    std::span<const double> liquid_volume;  ///< above -1 [-]
    std::span<const double> surfactant;     ///< above -1 [-]
    std::span<const Vec3> momentum;         ///< per gathered mass [m/s]
    std::span<const double> heat;           ///< liquid volume * temperature, per gathered volume [K]
};

/// Weights between fine and coarse particles of one region:
///
///   w_LE = W(|x_L - x_E|) / alpha_L,   alpha_L = sum_E W(|x_L - x_E|),
///
/// so that sum_E w_LE = 1 for each fine particle: what they give away is what arrives. Pairs whose normals disagree
/// have none. [method sheet 5, 16.5] Pictures of coarse particles beyond rims count among them: they give the velocity
/// of the film there, so that liquid does not flow through rims, and hand what they receive to their particles.
///
/// Fine particles that lie next to each other in memory lie next to each other in space (fine_order.h). Sixteen
/// of them make a block, which keeps one dense matrix of weights with all coarse particles that any of them sees: all
/// loops run over the sixteen with one instruction for eight. Sixteen blocks are a chunk, the work of one task.
class Transfer {
public:
    /// Finds the pairs and weighs them.
    /// @param normal  of the coarse particles
    Transfer(const CoarseParticles& coarse,
             std::span<const Vec3> normal,
             const FineParticles& fine,
             double support_radius,
             const Images& images = {});

    /// Sums over the fine particles; each gives a velocity that is linear in space:
    ///   p_E = sum_L w_LE V_L (u_L + C_L (x_E - x_L)).
    /// Totals of volume, surfactant and, without rims, momentum are kept to rounding.
    Gathered to_coarse(const CoarseParticles& coarse, const FineParticles& fine) const;

    /// Sets velocity and gradient of the fine particles from centered moments [method sheet 5 R, 16.5]:
    ///
    ///   u = sum w u_E,  d = sum w (x_E - x_L),  C = B D^-1 with the moments B, D about u and d,  u_L = u - C d,
    ///
    /// so that to_coarse gives back the momentum that came; and lets their thickness follow the coarse one at `rate`:
    ///   eta_L <- eta_L + rate (eta_E - seen eta_E),
    /// at most thirty times eta_E and at least a thirtieth.
    /// Fine particles that no coarse one reaches keep what they have.
    void to_fine(const CoarseValues& coarse, double rate, FineParticles& fine) const;

    /// Fine particles grow as the film around them: liquid and surfactant of each, and how thick the film is seen
    /// there, by the mean of what coarse ones gain over what they have gathered; momentum and heat by what that liquid
    /// brings. So all that coarse particles gain arrives, to rounding. Gradients of the velocity stay.
    void grow(const Growth& growth, FineParticles& fine) const;

    /// At each fine particle the mean of values of the coarse ones around it; 0 at strays.
    std::vector<double> at_fine(std::span<const double> values) const;

    /// Moves fine particles along the normals onto the patches, blended with the weights, and sets their normals.
    /// The patches may have moved on since the weights were found.
    void project(std::span<const Patch> patch, std::span<const Vec3> normal, FineParticles& fine) const;

    /// Whether no coarse particle reaches a fine one; how many such there are.
    bool stray(std::size_t p) const { return inverse_sum_[p] == 0.0; }
    std::size_t strays() const;
    /// Pairs of nonzero weight, and all places of the dense matrices: how well the blocks are filled.
    std::size_t pairs() const;
    std::size_t places() const;

private:
    static constexpr std::size_t kLanes = 16;
    static constexpr std::size_t kBlocks = 16;
    using Lanes = std::array<double, kLanes>;

    struct Block {
        std::uint32_t first, count;         // fine particles
        std::uint32_t candidates, weights;  // where its rows begin in `candidate`, and in `weight` (in rows)
        std::uint32_t rows;
    };
    struct Chunk {
        std::vector<Block> block;
        std::vector<std::uint32_t> coarse;     // coarse particles that any of its blocks sees, ascending
        std::vector<std::uint32_t> candidate;  // rows of the blocks: places in `coarse`
        std::vector<float> weight;             // W * r^2 per row and lane, 0 beyond the reach
    };

    /// A picture of a coarse particle beyond a rim: it stands behind these in the lists.
    struct Picture {
        std::uint32_t source;
        Mirror mirror;
    };

    void find(Chunk& chunk, std::span<const Vec3> position, std::span<const Vec3> normal, const FineParticles& fine);
    void hand_in_pictures(Gathered& gathered) const;
    std::vector<Vec3> places_with_pictures(std::span<const Vec3> position) const;

    double support_radius_;
    std::vector<Picture> pictures_;
    std::vector<Chunk> chunks_;
    std::vector<double> inverse_sum_;  // 1 / alpha per fine particle, 0 for strays
    // For each coarse particle, and behind them for each picture: where it stands in the chunks, chunk and place.
    std::vector<std::uint32_t> places_start_;
    std::vector<std::array<std::uint32_t, 2>> places_;
};

}  // namespace lamella::melp
