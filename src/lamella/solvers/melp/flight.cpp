#include "lamella/solvers/melp/flight.h"

#include "lamella/linalg/small_cholesky.h"
#include "lamella/solvers/melp/loops.h"

#include <array>

namespace lamella::melp {
namespace {

constexpr Tensor kUnit{Vec3{{1.0, 0.0, 0.0}}, Vec3{{0.0, 1.0, 0.0}}, Vec3{{0.0, 0.0, 1.0}}};

/// Rows x, y, z of a symmetric tensor; the zero tensor for one that is not safely positive definite.
Tensor inverse(const Tensor& t) {
    Tensor result{};
    for (std::size_t k = 0; k < 3; ++k) {
        std::array<double, 9> matrix{t[0][0], t[0][1], t[0][2], t[1][0], t[1][1], t[1][2], t[2][0], t[2][1], t[2][2]};
        std::array<double, 3> row{kUnit[k][0], kUnit[k][1], kUnit[k][2]};
        if (!linalg::solve_positive<3>(matrix, row)) return {};
        result[k] = {{row[0], row[1], row[2]}};
    }
    return result;
}

}  // namespace

Flight::Flight(const Geometry& geometry,
               const CoarseParticles& coarse,
               std::span<const double> mass,
               std::size_t regions)
    : geometry_(geometry), coarse_(coarse), mass_(mass), inverse_(regions) {
    std::array<std::vector<Vec3>, 3> rows;  // of sum m n n^T
    for (std::size_t k = 0; k < 3; ++k)
        rows[k] = sum_over_regions(coarse.region, regions, [&](std::size_t i) {
            return (mass[i] * geometry.normal[i][k]) * geometry.normal[i];
        });
    for (std::size_t r = 0; r < regions; ++r) inverse_[r] = inverse({rows[0][r], rows[1][r], rows[2][r]});
}

std::vector<Vec3> Flight::of(std::span<const double> along_normal) const {
    std::vector<Vec3> flight = sum_over_regions(coarse_.region, inverse_.size(), [&](std::size_t i) {
        return (mass_[i] * along_normal[i]) * geometry_.normal[i];
    });
    for (std::size_t r = 0; r < flight.size(); ++r) flight[r] = inverse_[r] * flight[r];
    return flight;
}

std::vector<Tensor> Flight::over_sphere() const {
    const std::vector<double> mass =
        sum_over_regions(coarse_.region, inverse_.size(), [&](std::size_t i) { return mass_[i]; });
    std::vector<Tensor> maps = inverse_;
    for (std::size_t r = 0; r < maps.size(); ++r) {
        for (Vec3& row : maps[r]) row = (mass[r] / 3.0) * row;
        if (maps[r] == Tensor{}) maps[r] = kUnit;
    }
    return maps;
}

}  // namespace lamella::melp
