#pragma once

#include "lamella/core/device.h"
#include "lamella/core/vec.h"

#include <span>
#include <vector>

namespace lamella::spatial {

/// How the singular law is smoothed over the length delta. With q = r^2 + delta^2 the velocity kernel K and the
/// potential psi (K = -psi'/r) are
///   plummer  K = q^(-3/2)                      psi = q^(-1/2)
///   k2       K = (r^2 + 4 delta^2) q^(-5/2)    psi = q^(-1/2) + delta^2 q^(-3/2)
///   k3       K = q^(-3/2) + 3/2 delta^2 q^(-5/2) + 15/2 delta^4 q^(-7/2)
///            psi = q^(-1/2) + 1/2 delta^2 q^(-3/2) + 3/2 delta^4 q^(-5/2)
/// On a sheet they are of first, second and third order in delta, see docs/theory/fast-sums.md.
enum class VortexKernel { kPlummer, kK2, kK3 };

struct VortexSumOptions {
    enum class Method {
        kAuto,    ///< whichever is expected to be faster at this size, tolerance and precision
        kDirect,  ///< every pair
        kTree     ///< distant clusters act through proxy points
    };
    enum class Precision {
        kDouble,
        kSingle  ///< pairs in float, sums in double: relative error about 1e-6. Points spread wider than 1e6 delta:
                 ///< double
    };

    VortexKernel kernel = VortexKernel::kK3;
    double delta = 0.0;  ///< regularization length [m], > 0
    Method method = Method::kAuto;
    Precision precision = Precision::kDouble;
    Device device = Device::kCpu;  ///< kCuda: every pair on the GPU, whatever the method, but kTree
    double tolerance =
        1e-5;  ///< of the tree, in [1e-8, 1e-1]: largest error of the velocity over the largest |velocity|
};

struct VortexField {
    std::vector<Vec3> velocity;   ///< u [m/s], one for each target
    std::vector<Vec3> potential;  ///< A [m^2/s], u = curl A; empty when not asked for
};

/// Velocity and vector potential of vortex elements (regularized law of Biot and Savart),
///
///   u(x) = 1/(4 pi) sum_g G_g x (x - c_g) K(|x - c_g|),   A(x) = 1/(4 pi) sum_g G_g psi(|x - c_g|).
///
/// An element at a target adds nothing to its velocity and G psi(0) / (4 pi) to its potential. The same input gives the
/// same bits on any number of threads; another instruction set or a GPU may give other last bits.
///
/// @param targets    points where the field is wanted [m]; the same memory as `centers` saves a second tree
/// @param centers    #S centers c_g of the elements [m]
/// @param strengths  #S strengths G_g, area times sheet strength [m^3/s]
/// @throws InputError  delta or tolerance out of range, lengths that differ, a value that is not finite (named by its
///                     index), or points that spread over more than 1e15 delta
/// @throws IoError     the GPU fails
VortexField vortex_sum(std::span<const Vec3> targets,
                       std::span<const Vec3> centers,
                       std::span<const Vec3> strengths,
                       const VortexSumOptions& options,
                       bool with_potential);

}  // namespace lamella::spatial
