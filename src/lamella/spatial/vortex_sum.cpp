#include "lamella/spatial/vortex_sum.h"
#include "lamella/core/parallel.h"
#include <cmath>
#include <numbers>
namespace lamella::spatial {
VortexField vortex_sum(std::span<const Vec3> targets, std::span<const Vec3> centers, std::span<const Vec3> strengths, const VortexSumOptions& o, bool with_potential) {
    VortexField f;
    f.velocity.resize(targets.size());
    f.potential.resize(targets.size());
    const double d2 = o.delta * o.delta;
    const std::size_t n = centers.size();
    std::vector<double> c(6 * n);
    for (std::size_t j = 0; j < n; ++j) for (std::size_t k = 0; k < 3; ++k) { c[k*n+j] = centers[j][k]; c[(3+k)*n+j] = strengths[j][k]; }
    const double a2 = o.kernel == VortexKernel::kK2 ? 3.0 * d2 : o.kernel == VortexKernel::kK3 ? 1.5 * d2 : 0.0;
    const double a3 = o.kernel == VortexKernel::kK3 ? 7.5 * d2 * d2 : 0.0;
    const double b2 = o.kernel == VortexKernel::kK2 ? d2 : o.kernel == VortexKernel::kK3 ? 0.5 * d2 : 0.0;
    const double b3 = o.kernel == VortexKernel::kK3 ? 1.5 * d2 * d2 : 0.0;
    const double* p = c.data();
    parallel_blocks(targets.size(), 64, [&](std::size_t b, std::size_t e) {
        for (std::size_t i = b; i < e; ++i) {
            double s[6][8] = {};
            const double x = targets[i][0], y = targets[i][1], z = targets[i][2];
            const auto body = [&](std::size_t j, std::size_t l) {
                const double rx = x - p[j], ry = y - p[n+j], rz = z - p[2*n+j];
                const double gx = p[3*n+j], gy = p[4*n+j], gz = p[5*n+j];
                const double q = rx*rx + ry*ry + rz*rz + d2;
                const double i1 = 1.0 / std::sqrt(q), i2 = i1 * i1, i3 = i1 * i2;
                const double k = i3 * (1.0 + i2 * (a2 + i2 * a3));
                const double w = i1 * (1.0 + i2 * (b2 + i2 * b3));
                s[0][l] += k * (gy*rz - gz*ry); s[1][l] += k * (gz*rx - gx*rz); s[2][l] += k * (gx*ry - gy*rx);
                s[3][l] += w * gx; s[4][l] += w * gy; s[5][l] += w * gz;
            };
            std::size_t j = 0;
            for (; j + 8 <= n; j += 8) for (std::size_t l = 0; l < 8; ++l) body(j + l, l);
            for (; j < n; ++j) body(j, 0);
            for (std::size_t k = 0; k < 3; ++k) {
                double u = 0, a = 0;
                for (std::size_t l = 0; l < 8; ++l) { u += s[k][l]; a += s[3+k][l]; }
                f.velocity[i][k] = u / (4.0 * std::numbers::pi); f.potential[i][k] = a / (4.0 * std::numbers::pi);
            }
        }
    });
    if (!with_potential) f.potential.clear();
    return f;
}
}
