#include "lamella/solvers/melp/fold_springs.h"

#include "lamella/solvers/melp/loops.h"

#include <algorithm>

namespace lamella::melp {
namespace {

/// What the height of a patch at its origin has of that of a place.
inline double weight_of(const FitRow& row, const Patch& patch, const Vec3& place, double per_reach) {
    const Vec3 d = per_reach * (place - patch.origin);
    const auto point =
        fit_point(dot(patch.frame.e1, d), dot(patch.frame.e2, d), dot(patch.frame.normal, d), squared_norm(d));
    double sum = 0.0;
    for (std::size_t a = 0; a < row.size(); ++a) sum += row[a] * point.term[a];
    return point.weight * sum;
}

}  // namespace

FoldSprings::FoldSprings(const NormalProblem& p, const Pairs& pairs) : same_(p.geometry.neighbors.same) {
    constexpr double kOnOthers = 0.25;  // of another film at a particle, for the full spring
    if (p.geometry.neighbors.other.index.empty()) return;
    const std::vector<Patch>& patch = p.geometry.patch;
    const std::vector<Vec3>& x = p.coarse.position;
    const double reach = same_.kernel.support_radius, per_reach = 1.0 / reach;
    const std::size_t count = x.size();
    stiffness_.resize(count);
    force_.resize(count);
    own_.resize(count);
    held_.resize(count);
    into_.resize(same_.index.size());
    from_.resize(same_.index.size());
    const std::vector<FitRow>& row = p.geometry.fit_row;
    for_each_particle(count, [&](std::size_t i) {
        const double share = std::min(pairs.gamma[i] / kOnOthers, 1.0);
        if (share == 0.0) return;
        stiffness_[i] = share * kStiffness * 2.0 * p.interface_tension[i] * p.geometry.area[i] / (reach * reach);
        force_[i] = stiffness_[i] * patch[i].c[0];
    });
    for_each_particle(count, [&](std::size_t i) {
        if (!strained(i)) return;
        double weights = 0.0;
        for (std::size_t k = same_.begin(i); k < same_.end(i); ++k) {
            const std::size_t j = same_.index[k];
            const double weight = weight_of(row[i], patch[i], x[j], per_reach);
            into_[k] = static_cast<float>(weight * dot(patch[i].frame.normal, p.geometry.normal[j]));
            weights += weight;
        }
        const Images& images = p.geometry.images;  // they stand still here, and rims take what pulls them
        for (std::size_t k = images.begin(i); k < images.end(i); ++k)
            weights += weight_of(row[i], patch[i], images.place[k], per_reach);
        own_[i] = -weights * dot(patch[i].frame.normal, p.geometry.normal[i]);
    });
    for_each_particle(count, [&](std::size_t i) {
        const auto begin = same_.index.begin();
        held_[i] = strained(i) || std::any_of(begin + same_.start[i], begin + same_.start[i + 1],
                                              [&](std::uint32_t j) { return strained(j); });
        if (held_[i] == 0) return;
        for (std::size_t k = same_.begin(i); k < same_.end(i); ++k) {
            const std::size_t j = same_.index[k];
            from_[k] = !strained(j) ? 0.0F
                                    : static_cast<float>(weight_of(row[j], patch[j], x[i], per_reach) *
                                                         dot(patch[j].frame.normal, p.geometry.normal[i]));
        }
    });
}

double FoldSprings::force(std::size_t i) const { return none() ? 0.0 : -hold(i, force_); }

double FoldSprings::diagonal(std::size_t i) const {
    if (none() || held_[i] == 0) return 0.0;
    double sum = stiffness_[i] * own_[i] * own_[i];
    for (std::size_t k = same_.begin(i); k < same_.end(i); ++k)
        sum += stiffness_[same_.index[k]] * double{from_[k]} * double{from_[k]};
    return sum;
}

}  // namespace lamella::melp
