#include "lamella/solvers/melp/film_stiffness.h"

#include "lamella/solvers/melp/loops.h"

namespace lamella::melp {

FilmStiffness::FilmStiffness(const NormalProblem& p, const Pairs& pairs, const FoldSprings& folds)
    : p_(p),
      pairs_(pairs),
      folds_(folds),
      diagonal_(p.coarse.size()),
      same_(pairs.same.size()),
      other_(pairs.other.size()),
      force_(p.coarse.size()),
      strain_(p.coarse.size(), 0.0) {
    const Neighbors& same = p.geometry.neighbors.same;
    const Neighbors& other = p.geometry.neighbors.other;
    const std::vector<Vec3>& n = p.geometry.normal;
    for_each_particle(diagonal_.size(), [&](std::size_t i) {
        // At a junction films fold: full stiffness there, none of it forgiven for moving as a whole.
        const bool free = other.index.empty();
        double sum = 0.0;
        for (std::size_t k = same.begin(i); k < same.end(i); ++k) {
            same_[k] = static_cast<float>(pairs.same[k]);
            sum -= double{same_[k]} * (free ? dot(n[i], n[same.index[k]]) : 1.0);
        }
        for (std::size_t k = other.begin(i); k < other.end(i); ++k) {
            sum -= pairs.other[k] + pairs.push[k].stiffness;
            other_[k] = static_cast<float>(pairs.other[k] * dot(n[i], n[other.index[k]]) - pairs.push[k].stiffness);
        }
        const Images& images = p.geometry.images;
        for (std::size_t k = images.begin(i); k < images.end(i); ++k)
            sum -= pairs.image[k] * dot(n[i], images.normal[k]);
        diagonal_[i] = sum;
    });
}

void FilmStiffness::move(std::span<const double> v) {
    const Neighbors& same = p_.geometry.neighbors.same;
    const Images& images = p_.geometry.images;
    for_each_particle(v.size(), [&](std::size_t i) {
        double sum = diagonal_[i] * v[i] + sum_of_products(p_.geometry.neighbors.other, other_, v, i);
        if (folds_.none() || !folds_.strained(i)) {
            sum += sum_of_products(same, same_, v, i);
        } else {
            const auto [pull, lifted] = sums_of_products<RawVector<float>>(same, {&same_, &folds_.heights()}, v, i);
            sum += pull;
            strain_[i] = folds_.strain(i, v[i], lifted);
        }
        for (std::size_t k = images.begin(i); k < images.end(i); ++k)
            sum += pairs_.image[k] * images.mirrors[images.mirror[k]].sign * images.follow[k] * v[images.index[k]];
        force_[i] = sum;
    });
}

double FilmStiffness::of_rims(std::size_t i) const {
    const Images& images = p_.geometry.images;
    double sum = 0.0;
    for (std::size_t k = images.begin(i); k < images.end(i); ++k)
        sum += pairs_.image[k] * dot(images.mirrors[images.mirror[k]].drift, images.normal[k]);
    return sum;
}

}  // namespace lamella::melp
