#include "lamella/spatial/detail/pair_block.h"

#include "lamella/spatial/detail/vortex_pair.h"
#include "lamella/spatial/detail/wide.h"

#include <algorithm>

namespace lamella::spatial::detail {

namespace {

/// One block of sources, relative to the middle of the targets.
template <class T>
struct LocalSources {
    alignas(64) T position[3][kSourceBlock];
    alignas(64) T strength[3][kSourceBlock];
};

template <class T>
void localize(
    LocalSources<T>& local, const SourceColumns& sources, const Vec3& middle, std::size_t begin, std::size_t count) {
    for (std::size_t k = 0; k < 3; ++k) {
        const double* x = sources.position[k].data() + begin;
        const double* g = sources.strength[k].data() + begin;
        for (std::size_t i = 0; i < count; ++i) {
            local.position[k][i] = static_cast<T>(x[i] - middle[k]);
            local.strength[k][i] = static_cast<T>(g[i]);
        }
    }
}

template <VortexKernel kernel, bool with_potential, class Wide>
void add_source_block(TargetBlock& targets,
                      const typename Wide::Scalar (&local)[3][kTargetBlock],
                      const LocalSources<typename Wide::Scalar>& s,
                      std::size_t count) {
    for (std::size_t i = 0; i < targets.count; i += Wide::kSize) {
        const Wide x = Wide::load(local[0] + i), y = Wide::load(local[1] + i), z = Wide::load(local[2] + i);
        const Wide zero = Wide::all(0);
        PairSums<Wide> sums{{zero, zero, zero}, {zero, zero, zero}};
        for (std::size_t j = 0; j < count; ++j)
            add_pair<kernel, with_potential, Wide>(
                sums, x, y, z, Wide::all(s.position[0][j]), Wide::all(s.position[1][j]), Wide::all(s.position[2][j]),
                Wide::all(s.strength[0][j]), Wide::all(s.strength[1][j]), Wide::all(s.strength[2][j]));
        for (std::size_t k = 0; k < 3; ++k) {
            add_to(targets.sum[k] + i, sums.u[k]);
            if constexpr (with_potential) add_to(targets.sum[3 + k] + i, sums.a[k]);
        }
    }
}

/// The middle of the targets' box: near it float has digits to spare where pairs are close.
Vec3 middle_of(const TargetBlock& targets) {
    Vec3 middle;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax_element(targets.position[k], targets.position[k] + targets.count);
        middle[k] = 0.5 * (*low + *high);
    }
    return middle;
}

template <VortexKernel kernel, bool with_potential, class Wide>
void add_ranges(TargetBlock& targets, const SourceColumns& sources, std::span<const SourceRange> ranges) {
    using T = typename Wide::Scalar;
    const Vec3 middle = sizeof(T) == sizeof(double) ? Vec3{} : middle_of(targets);
    alignas(64) T local[3][kTargetBlock];
    const std::size_t padded = std::min(kTargetBlock, (targets.count + Wide::kSize - 1) / Wide::kSize * Wide::kSize);
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < padded; ++i)
            local[k][i] = static_cast<T>(targets.position[k][std::min(i, targets.count - 1)] - middle[k]);
    LocalSources<T> block;
    for (const SourceRange& range : ranges)
        for (std::size_t begin = range.begin; begin < range.end; begin += kSourceBlock) {
            const std::size_t count = std::min<std::size_t>(kSourceBlock, range.end - begin);
            localize(block, sources, middle, begin, count);
            add_source_block<kernel, with_potential, Wide>(targets, local, block, count);
        }
}

template <VortexKernel kernel>
void add_with_kernel(const PairLaw& law,
                     TargetBlock& targets,
                     const SourceColumns& sources,
                     std::span<const SourceRange> ranges) {
    if (law.single)
        law.with_potential ? add_ranges<kernel, true, WideFloat>(targets, sources, ranges)
                           : add_ranges<kernel, false, WideFloat>(targets, sources, ranges);
    else
        law.with_potential ? add_ranges<kernel, true, WideDouble>(targets, sources, ranges)
                           : add_ranges<kernel, false, WideDouble>(targets, sources, ranges);
}

}  // namespace

void add_pairs(const PairLaw& law,
               TargetBlock& targets,
               const SourceColumns& sources,
               std::span<const SourceRange> ranges) {
    if (targets.count == 0) return;
    switch (law.kernel) {
        case VortexKernel::kPlummer:
            return add_with_kernel<VortexKernel::kPlummer>(law, targets, sources, ranges);
        case VortexKernel::kK2:
            return add_with_kernel<VortexKernel::kK2>(law, targets, sources, ranges);
        case VortexKernel::kK3:
            return add_with_kernel<VortexKernel::kK3>(law, targets, sources, ranges);
    }
}

}  // namespace lamella::spatial::detail
