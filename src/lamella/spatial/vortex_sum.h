#pragma once

#include "lamella/core/vec.h"

#include <span>
#include <vector>

namespace lamella::spatial {

/// How the singular law is smoothed over the length delta (q = r^2 + delta^2), [method sheet 6.3, 14.1]:
///   plummer  q^(-3/2);  k2  (r^2 + 4 delta^2) q^(-5/2);  k3  q^(-3/2) + 3/2 delta^2 q^(-5/2) + 15/2 delta^4 q^(-7/2)
enum class VortexKernel { kPlummer, kK2, kK3 };
struct VortexSumOptions {
    VortexKernel kernel = VortexKernel::kK3;
    double delta = 0.0;              ///< regularisation length [m], > 0
    enum class Method { kAuto, kDirect, kTree } method = Method::kAuto;
    enum class Precision { kDouble, kSingle } precision = Precision::kDouble;
    double tolerance = 1e-5;
};
struct VortexField { std::vector<Vec3> velocity; std::vector<Vec3> potential; };
VortexField vortex_sum(std::span<const Vec3> targets, std::span<const Vec3> centers, std::span<const Vec3> strengths, const VortexSumOptions& options, bool with_potential);

}  // namespace lamella::spatial
