#pragma once

#include "lamella/core/host_device.h"
#include "lamella/core/machine.h"
#include "lamella/core/vec.h"
#include "lamella/spatial/detail/pair_block.h"
#include "lamella/spatial/detail/vortex_pair.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

// Every pair on a GPU: one thread adds all sources to one target. The sources come in parts, so that few targets keep a
// whole GPU busy; the sums of the parts are added in their order, and the result repeats bit for bit.

namespace lamella::spatial::detail {

/// One number with the operations that add_pair needs of a vector.
template <class T>
struct OneWide {
    using Scalar = T;
    T v;

    LAMELLA_HOST_DEVICE static OneWide all(T a) { return {a}; }
    LAMELLA_HOST_DEVICE friend OneWide operator+(OneWide a, OneWide b) { return {a.v + b.v}; }
    LAMELLA_HOST_DEVICE friend OneWide operator-(OneWide a, OneWide b) { return {a.v - b.v}; }
    LAMELLA_HOST_DEVICE friend OneWide operator*(OneWide a, OneWide b) { return {a.v * b.v}; }
    LAMELLA_HOST_DEVICE friend OneWide fma(OneWide a, OneWide b, OneWide c) { return {std::fma(a.v, b.v, c.v)}; }
    LAMELLA_HOST_DEVICE friend OneWide fms(OneWide a, OneWide b, OneWide c) { return {std::fma(a.v, b.v, -c.v)}; }
    LAMELLA_HOST_DEVICE friend OneWide inverse_square_root(OneWide q) {
#ifdef __CUDA_ARCH__
        if constexpr (sizeof(T) == sizeof(double))
            return {rsqrt(q.v)};
        else
            return {rsqrtf(q.v)};
#else
        return {T(1) / std::sqrt(q.v)};
#endif
    }
};

/// A source as a thread reads it: position in units of delta, strength in units of the largest.
struct GatherSource {
    double x[3];
    double g[3];
};

/// Sources that are added up in the precision of a pair before they join the double sums.
inline constexpr std::size_t kGatherTile = 256;

/// The sums of one target.
template <VortexKernel kernel, bool with_potential, class T>
struct TargetSums {
    double sum[6] = {};

    /// Adds at most kGatherTile sources. The separation is taken in double: float then keeps its digits at any place.
    LAMELLA_HOST_DEVICE void add_tile(const Vec3& target, const GatherSource* source, std::size_t count) {
        using Wide = OneWide<T>;
        const Wide zero{T(0)};
        PairSums<Wide> tile{{zero, zero, zero}, {zero, zero, zero}};
        for (std::size_t j = 0; j < count; ++j) {
            const GatherSource& s = source[j];
            add_pair<kernel, with_potential, Wide>(
                tile, {static_cast<T>(target[0] - s.x[0])}, {static_cast<T>(target[1] - s.x[1])},
                {static_cast<T>(target[2] - s.x[2])}, zero, zero, zero, {static_cast<T>(s.g[0])},
                {static_cast<T>(s.g[1])}, {static_cast<T>(s.g[2])});
        }
        for (int k = 0; k < 3; ++k) {
            sum[k] += static_cast<double>(tile.u[k].v);
            if constexpr (with_potential) sum[3 + k] += static_cast<double>(tile.a[k].v);
        }
    }
};

/// Which sources belong to a part.
struct GatherParts {
    std::size_t sources;
    std::size_t parts;

    /// Whole tiles, as evenly as they go.
    LAMELLA_HOST_DEVICE std::size_t begin(std::size_t part) const {
        const std::size_t tiles = (sources + kGatherTile - 1) / kGatherTile;
        const std::size_t first = tiles * part / parts * kGatherTile;
        return first < sources ? first : sources;
    }
    LAMELLA_HOST_DEVICE std::size_t end(std::size_t part) const { return begin(part + 1); }
};

/// So many parts that a large GPU has some waves of threads to do.
inline GatherParts gather_parts(std::size_t targets, std::size_t sources) {
    constexpr std::size_t kThreads = 1U << 18;
    const std::size_t tiles = (sources + kGatherTile - 1) / kGatherTile;
    const std::size_t wanted = (kThreads + targets - 1) / targets;
    return {sources, wanted < tiles ? wanted : tiles};
}

/// The sums of all targets, part by part: column k of part p of target i stands at
/// part_sums[(p * 6 + k) * targets + i]. The body of the loop that adds the parts up.
struct AddParts {
    const double* part_sums;
    std::size_t targets;
    std::size_t parts;
    int components;
    double* sums;  ///< column by column

    LAMELLA_HOST_DEVICE void operator()(std::size_t i) const {
        for (int k = 0; k < components; ++k) {
            double sum = 0.0;
            for (std::size_t p = 0; p < parts; ++p)
                sum += part_sums[(p * 6 + static_cast<std::size_t>(k)) * targets + i];
            sums[static_cast<std::size_t>(k) * targets + i] = sum;
        }
    }
};

/// Calls f.template operator()<kernel, with_potential, T>() for a law.
template <class F>
void with_law(const PairLaw& law, F&& f) {
    const auto with_kernel = [&]<VortexKernel kernel>() {
        if (law.single)
            law.with_potential ? f.template operator()<kernel, true, float>()
                               : f.template operator()<kernel, false, float>();
        else
            law.with_potential ? f.template operator()<kernel, true, double>()
                               : f.template operator()<kernel, false, double>();
    };
    switch (law.kernel) {
        case VortexKernel::kPlummer:
            return with_kernel.template operator()<VortexKernel::kPlummer>();
        case VortexKernel::kK2:
            return with_kernel.template operator()<VortexKernel::kK2>();
        case VortexKernel::kK3:
            return with_kernel.template operator()<VortexKernel::kK3>();
    }
}

/// What the sums are taken from and where they go, in the machine's memory.
struct GatherProblem {
    const Vec3* target;
    std::size_t targets;
    const GatherSource* source;
    GatherParts parts;
    double* part_sums;
};

/// Runs a problem on a machine. @param gather  gather(machine, problem) fills the sums of the parts
template <class Machine, class Gather>
std::array<Column, 6> gather_on(Machine& machine,
                                std::span<const Vec3> targets,
                                std::span<const GatherSource> sources,
                                const PairLaw& law,
                                Gather&& gather) {
    const GatherParts parts = gather_parts(targets.size(), sources.size());
    MachineBuffer<Machine, Vec3> target;
    MachineBuffer<Machine, GatherSource> source;
    MachineBuffer<Machine, double> part_sums;
    MachineBuffer<Machine, double> total;
    target.reserve(targets.size());
    source.reserve(sources.size());
    part_sums.reserve(parts.parts * 6 * targets.size());
    total.reserve(6 * targets.size());
    machine.to_device(target.data(), targets.data(), targets.size());
    machine.to_device(source.data(), sources.data(), sources.size());
    gather(machine, GatherProblem{target.data(), targets.size(), source.data(), parts, part_sums.data()});
    const int components = law.with_potential ? 6 : 3;
    machine.for_each(targets.size(), AddParts{part_sums.data(), targets.size(), parts.parts, components, total.data()});
    std::array<Column, 6> sums;
    for (int k = 0; k < components; ++k) {
        Column& column = sums[static_cast<std::size_t>(k)];
        column.resize(targets.size());
        machine.to_host(column.data(), total.data() + static_cast<std::size_t>(k) * targets.size(), targets.size());
    }
    return sums;
}

/// On the GPU. @throws IoError  the device fails
std::array<Column, 6> gather_on_gpu(std::span<const Vec3> targets,
                                    std::span<const GatherSource> sources,
                                    const PairLaw& law);
/// The CPU twin of it.
std::array<Column, 6> gather_on_twin(std::span<const Vec3> targets,
                                     std::span<const GatherSource> sources,
                                     const PairLaw& law);

}  // namespace lamella::spatial::detail
