#include "lamella/solvers/melp/fold_springs.h"

#include "lamella/linalg/small_cholesky.h"
#include "lamella/solvers/melp/loops.h"

#include <algorithm>
#include <array>

namespace lamella::melp {
namespace {

/// The first row of the inverse of a fit's matrix: with it the height of a patch is a sum over places. Zeros for
/// particles without a spring.
using FitRow = std::array<double, Patch::kTerms>;

FitRow row_of_fit(const NormalProblem& p, std::size_t i) {
    const Patch& patch = p.geometry.patch[i];
    const Neighbors& same = p.geometry.neighbors.same;
    const Images& images = p.geometry.images;
    const double reach = same.kernel.support_radius;
    FitMatrix matrix = empty_fit();
    for (std::size_t k = same.begin(i); k < same.end(i); ++k)
        add_to_fit(point_of(patch, p.coarse.position[same.index[k]], reach), matrix);
    for (std::size_t k = images.begin(i); k < images.end(i); ++k)
        add_to_fit(point_of(patch, images.place[k], reach), matrix);
    FitRow row{1.0};
    const bool flat = patch.c == decltype(patch.c){};  // too few neighbors
    return !flat && linalg::solve_positive<Patch::kTerms>(matrix, row) ? row : FitRow{};
}

/// What the height of a patch at its origin has of that of a place.
double weight_of(const FitRow& row, const Patch& patch, const Vec3& place, double reach) {
    const FitPoint point = point_of(patch, place, reach);
    double sum = 0.0;
    for (std::size_t a = 0; a < row.size(); ++a) sum += row[a] * point.term[a];
    return point.weight * sum;
}

}  // namespace

FoldSprings::FoldSprings(const NormalProblem& p, const Pairs& pairs) : same_(p.geometry.neighbors.same) {
    // With a quarter of this nothing tears either, but caps at nine spacings to a radius meet at 122 degrees.
    constexpr double kStiffness = 144.0;
    constexpr double kOnOthers = 0.25;  // of another film at a particle, for the full spring
    if (p.geometry.neighbors.other.index.empty()) return;
    const std::vector<Patch>& patch = p.geometry.patch;
    const std::vector<Vec3>& x = p.coarse.position;
    const double reach = same_.kernel.support_radius;
    const std::size_t count = x.size();
    stiffness_.resize(count);
    force_.resize(count);
    own_.resize(count);
    into_.resize(same_.index.size());
    from_.resize(same_.index.size());
    std::vector<FitRow> row(count);
    for_each_particle(count, [&](std::size_t i) {
        const double share = std::min(pairs.gamma[i] / kOnOthers, 1.0);
        if (share == 0.0) return;
        stiffness_[i] = share * kStiffness * 2.0 * p.interface_tension[i] * p.geometry.area[i] / (reach * reach);
        force_[i] = stiffness_[i] * patch[i].c[0];
        row[i] = row_of_fit(p, i);
    });
    for_each_particle(count, [&](std::size_t i) {
        const Vec3& normal = p.geometry.normal[i];
        double weights = 0.0;
        for (std::size_t k = same_.begin(i); k < same_.end(i); ++k) {
            const std::size_t j = same_.index[k];
            if (stiffness_[i] > 0.0) {
                const double weight = weight_of(row[i], patch[i], x[j], reach);
                into_[k] = static_cast<float>(weight * dot(patch[i].frame.normal, p.geometry.normal[j]));
                weights += weight;
            }
            if (stiffness_[j] > 0.0)
                from_[k] =
                    static_cast<float>(weight_of(row[j], patch[j], x[i], reach) * dot(patch[j].frame.normal, normal));
        }
        const Images& images = p.geometry.images;  // they stand still here, and rims take what pulls them
        for (std::size_t k = images.begin(i); k < images.end(i); ++k)
            weights += weight_of(row[i], patch[i], images.place[k], reach);
        own_[i] = -weights * dot(patch[i].frame.normal, normal);
    });
}

std::vector<double> FoldSprings::strain(std::span<const double> v) const {
    std::vector<double> strain(own_.size());
    for_each_particle(strain.size(), [&](std::size_t i) {
        if (stiffness_[i] == 0.0) return;
        strain[i] = stiffness_[i] * (own_[i] * v[i] + sum_of_products(same_, into_, v, i));
    });
    return strain;
}

double FoldSprings::product(std::span<const double> strain, std::size_t i) const {
    if (strain.empty()) return 0.0;
    return own_[i] * strain[i] + sum_of_products(same_, from_, strain, i);
}

double FoldSprings::diagonal(std::size_t i) const {
    if (own_.empty()) return 0.0;
    double sum = stiffness_[i] * own_[i] * own_[i];
    for (std::size_t k = same_.begin(i); k < same_.end(i); ++k)
        sum += stiffness_[same_.index[k]] * double{from_[k]} * double{from_[k]};
    return sum;
}

}  // namespace lamella::melp
