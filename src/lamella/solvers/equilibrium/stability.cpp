#include "lamella/solvers/equilibrium/stability.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/dense.h"
#include "lamella/linalg/ldlt.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace lamella::equilibrium {
namespace {

using Vector = std::vector<double>;

double inner(const Vector& a, const Vector& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}
double inner(const Vector& a, const Vector& mass, const Vector& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * mass[i] * b[i];
    return sum;
}
void subtract(Vector& a, double factor, const Vector& b) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] -= factor * b[i];
}

/// Adds `v` to an M-orthonormal set unless it lies in its span. @returns whether it was added
bool orthonormalize(Vector v, const Vector& mass, std::vector<Vector>& set, double least) {
    const double before = std::sqrt(inner(v, mass, v));
    for (int pass = 0; pass < 2; ++pass)
        for (const Vector& u : set) subtract(v, inner(u, mass, v), u);
    const double after = std::sqrt(inner(v, mass, v));
    if (!(after > least * before) || before == 0.0) return false;
    for (double& x : v) x /= after;
    set.push_back(std::move(v));
    return true;
}

/// Shifts and turns as seen by the normal space, orthonormal. A sphere's turns do not move it: they drop out.
std::vector<Vector> rigid_motions(const RestSystem& system, const Vector& mass) {
    const Patches& patches = system.patches();
    if (std::any_of(patches.fixed.begin(), patches.fixed.end(), [](std::uint8_t f) { return f != 0; })) return {};
    Vec3 center;
    for (const Vec3& x : patches.position) center += x / static_cast<double>(patches.position.size());
    std::vector<Vector> motions;
    const int most = patches.shift.empty() ? 6 : 3;  // a periodic box cannot turn
    for (int k = 0; k < most; ++k) {
        Vec3 axis;
        axis[static_cast<std::size_t>(k % 3)] = k < 3 ? 1.0 : 1.0 / system.length();
        std::vector<Vec3> field;
        for (const Vec3& x : patches.position) field.push_back(k < 3 ? axis : cross(axis, x - center));
        constexpr double kRank = 0.1;  // of the shifts' size: less is rounding and the facets' unevenness
        Vector v = system.space().restrict(field);
        const double size = std::sqrt(inner(v, mass, v));
        const double area = std::accumulate(mass.begin(), mass.end(), 0.0);
        if (size < kRank * std::sqrt(area)) continue;
        orthonormalize(std::move(v), mass, motions, kRank);
    }
    return motions;
}

}  // namespace

double lowest_eigenvalue(RestSystem& system, const std::vector<double>& pressure) {
    const std::size_t n = system.space().size();
    if (n == 0) return 0.0;
    const Balance balance = system.balance();
    const linalg::SymmetricMatrix hessian = system.hessian(pressure);
    // A shift that is no eigenvalue; the spectrum starts at a few 1 / length^2.
    constexpr double kShift = 1e-3;
    linalg::SymmetricMatrix shifted = hessian;
    const double shift = kShift / (system.length() * system.length());
    for (std::size_t i = 0; i < n; ++i) shifted.diagonal(i) += shift * balance.mass[i];
    linalg::Ldlt factors;
    factors.analyze(shifted);
    if (!factors.factorize(shifted)) return 0.0;

    const std::size_t regions = balance.volume_slope.size();
    std::vector<Vector> y = balance.volume_slope;
    parallel_blocks(regions, 1, [&](std::size_t r, std::size_t) { factors.solve(y[r]); });
    Vector schur(regions * regions);
    for (std::size_t r = 0; r < regions; ++r)
        for (std::size_t s = 0; s <= r; ++s) schur[r * regions + s] = inner(balance.volume_slope[r], y[s]);

    // Deterministic start: smooth functions of the nodes' places would miss symmetric modes, so every node its own.
    const std::size_t width = std::min<std::size_t>(8, n);
    std::vector<Vector> modes(width, Vector(n));
    for (std::size_t k = 0; k < width; ++k)
        for (std::size_t i = 0; i < n; ++i)
            modes[k][i] = std::sin(1.0 + static_cast<double>((i + 1) * (k + 1)) * 0.7390851332151607);
    const std::vector<Vector> rigid = rigid_motions(system, balance.mass);

    double lowest = 0.0;
    constexpr int kMostSweeps = 60;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        parallel_blocks(modes.size(), 1, [&](std::size_t k, std::size_t) {
            Vector& x = modes[k];
            for (std::size_t i = 0; i < n; ++i) x[i] *= balance.mass[i];
            factors.solve(x);
            Vector flux(regions);
            for (std::size_t r = 0; r < regions; ++r) flux[r] = inner(balance.volume_slope[r], x);
            const Vector p = linalg::solve_symmetric(regions, schur, flux).x;
            for (std::size_t r = 0; r < regions; ++r) subtract(x, p[r], y[r]);
        });
        std::vector<Vector> basis = rigid;
        for (Vector& x : modes) orthonormalize(std::move(x), balance.mass, basis, 1e-10);
        basis.erase(basis.begin(), basis.begin() + static_cast<std::ptrdiff_t>(rigid.size()));
        const std::size_t m = basis.size();
        if (m == 0) return 0.0;
        std::vector<Vector> image(m, Vector(n));
        parallel_blocks(m, 1, [&](std::size_t k, std::size_t) { linalg::multiply(hessian, basis[k], image[k]); });
        Vector small(m * m);
        for (std::size_t a = 0; a < m; ++a)
            for (std::size_t b = 0; b <= a; ++b) small[a * m + b] = inner(basis[a], image[b]);
        const linalg::Eigenpairs pairs = linalg::eigenpairs(m, small);
        modes.assign(m, Vector(n, 0.0));
        for (std::size_t k = 0; k < m; ++k)
            for (std::size_t a = 0; a < m; ++a) subtract(modes[k], -pairs.vector[k * m + a], basis[a]);
        const double before = std::exchange(lowest, pairs.value[0]);
        if (sweep > 3 && std::abs(lowest - before) < 1e-6 * std::abs(lowest)) break;
    }
    return lowest;
}

}  // namespace lamella::equilibrium
