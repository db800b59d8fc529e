#pragma once

#include "lamella/solvers/melp/fold_springs.h"
#include "lamella/solvers/melp/normal_motion.h"
#include "lamella/solvers/melp/pair_forces.h"

#include <cstddef>
#include <span>
#include <vector>

namespace lamella::melp {

/// How what films do to each other along the normals changes with velocities along the normals: J_film of
/// move_along_normals(), of tension, cohesion, what keeps films apart and springs at folds. It reads the problem, the
/// pairs and the springs, which have to outlive it.
class FilmStiffness {
public:
    FilmStiffness(const NormalProblem& problem, const Pairs& pairs, const FoldSprings& folds);

    bool has_springs() const { return !folds_.none(); }
    double diagonal(std::size_t i) const { return diagonal_[i] - folds_.diagonal(i); }

    /// J_film v in two passes: move() looks at all particles, then force() gives one of its entries.
    void move(std::span<const double> v);
    double force(std::size_t i) const { return folds_.none() ? force_[i] : force_[i] - folds_.hold(i, strain_); }

    /// What the motion of rims adds to (J_film v)_i.
    double of_rims(std::size_t i) const;

private:
    const NormalProblem& p_;
    const Pairs& pairs_;
    const FoldSprings& folds_;
    std::vector<double> diagonal_;  // without springs
    // Per entry of the lists. Every iteration of the solver reads them: in single precision, alike in both rows.
    RawVector<float> same_, other_;
    RawVector<double> force_;     // by the v at hand, without springs
    std::vector<double> strain_;  // and what it strains them
};

}  // namespace lamella::melp
