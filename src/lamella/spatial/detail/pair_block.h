#pragma once

#include "lamella/core/aligned.h"
#include "lamella/spatial/vortex_sum.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella::spatial::detail {

/// Positions (in units of delta) and strengths, as columns.
struct SourceColumns {
    std::array<Column, 3> position, strength;

    void resize(std::size_t count) {
        for (Column& c : position) c.resize(count);
        for (Column& c : strength) c.resize(count);
    }
};

/// Sources [begin, end).
struct SourceRange {
    std::uint32_t begin, end;
};

/// What is summed and how.
struct PairLaw {
    VortexKernel kernel;
    bool with_potential;
    bool single;  ///< pairs in float
};

/// At most so many targets are summed together, and so many sources are added up before they join the double sums.
inline constexpr std::size_t kTargetBlock = 256;
inline constexpr std::size_t kSourceBlock = 256;

/// A few targets and their sums (without 1/(4 pi), in units of delta).
struct TargetBlock {
    std::size_t count = 0;
    alignas(64) double position[3][kTargetBlock];
    alignas(64) double sum[6][kTargetBlock];  ///< velocity, then potential

    void start(std::size_t n) {
        count = n;
        for (auto& column : sum)
            for (double& s : column) s = 0.0;
    }
};

/// Adds the sources of `ranges`, in order, to the sums of the targets. Each target sees the same operations in the same
/// order whatever stands beside it in the block; in float its rounding depends on the middle of the block.
void add_pairs(const PairLaw& law,
               TargetBlock& targets,
               const SourceColumns& sources,
               std::span<const SourceRange> ranges);

}  // namespace lamella::spatial::detail
