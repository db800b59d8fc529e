#pragma once

#include <span>

#include "lamella/core/aligned.h"
#include "lamella/core/fixed_sum.h"

namespace lamella::bubble {

/// What the algorithm needs from the place it runs on. One process owns all bubbles (LocalDomain); a distributed
/// foam, where each process owns some and sees copies of its neighbors' bubbles, is another Domain.
///
/// Every decision of the solver rests on numbers that went through sum() or largest(), and sums are integers: all
/// processes decide alike, and the result does not depend on how many there are.
class Domain {
public:
    virtual ~Domain() = default;
    /// Adds the sums of all processes.
    virtual void sum(std::span<FixedSum> sums) = 0;
    /// Largest value over all processes.
    virtual double largest(double value) = 0;
    /// Refreshes the copies of other processes' bubbles in these columns.
    virtual void halo(std::span<Column* const> columns) = 0;
};

class LocalDomain final : public Domain {
public:
    void sum(std::span<FixedSum>) override {}
    double largest(double value) override { return value; }
    void halo(std::span<Column* const>) override {}
};

}  // namespace lamella::bubble
