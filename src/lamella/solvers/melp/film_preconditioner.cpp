#include "lamella/solvers/melp/film_preconditioner.h"

#include "lamella/solvers/melp/loops.h"

#include <cmath>

namespace lamella::melp {

FilmPreconditioner::FilmPreconditioner(const Geometry& geometry,
                                       std::span<const double> inertia,
                                       std::span<const double> diagonal,
                                       bool springs)
    : same_(geometry.neighbors.same), scale_(geometry.size()) {
    const std::size_t count = scale_.size();
    for_each_particle(count, [&](std::size_t i) { scale_[i] = 1.0 / diagonal[i]; });
    if (!springs) return;
    // One for all: where it changed from place to place, smooth motions would come out rough.
    const double beta =
        static_cast<double>(count) / parallel_sum(count, [&](std::size_t i) { return inertia[i] * scale_[i]; });
    smooth_.resize(count);
    eased_.resize(count);
    for_each_particle(count, [&](std::size_t i) { smooth_[i] = std::sqrt(beta * geometry.area[i] * scale_[i]); });
}

void FilmPreconditioner::apply(const std::vector<double>& u, std::vector<double>& v) {
    v.resize(u.size());
    if (smooth_.empty()) {
        for_each_particle(u.size(), [&](std::size_t i) { v[i] = scale_[i] * u[i]; });
        return;
    }
    const double own = same_.kernel.value(0.0);
    for_each_particle(u.size(), [&](std::size_t i) { eased_[i] = smooth_[i] * u[i]; });
    for_each_particle(u.size(), [&](std::size_t i) {
        const double mean = own * eased_[i] + sum_of_products(same_, same_.weight, eased_, i);
        v[i] = scale_[i] * u[i] + smooth_[i] * mean;
    });
}

}  // namespace lamella::melp
