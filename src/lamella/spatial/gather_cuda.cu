// The sum over every pair on a GPU.

#include "lamella/core/cuda_machine.cuh"
#include "lamella/spatial/detail/vortex_gather.h"

namespace lamella::spatial::detail {

namespace {

/// A block takes as many targets as it has threads, and the sources of part blockIdx.y through shared memory.
template <VortexKernel kernel, bool with_potential, class T>
__global__ void __launch_bounds__(kGatherTile) gather_kernel(GatherProblem problem) {
    __shared__ GatherSource tile[kGatherTile];
    const std::size_t i = static_cast<std::size_t>(blockIdx.x) * kGatherTile + threadIdx.x;
    const std::size_t part = blockIdx.y;
    Vec3 target;
    if (i < problem.targets) target = problem.target[i];
    TargetSums<kernel, with_potential, T> sums;
    const std::size_t end = problem.parts.end(part);
    for (std::size_t at = problem.parts.begin(part); at < end; at += kGatherTile) {
        const std::size_t count = end - at < kGatherTile ? end - at : kGatherTile;
        if (threadIdx.x < count) tile[threadIdx.x] = problem.source[at + threadIdx.x];
        __syncthreads();
        sums.add_tile(target, tile, count);
        __syncthreads();
    }
    if (i >= problem.targets) return;
    for (std::size_t k = 0; k < 6; ++k) problem.part_sums[(part * 6 + k) * problem.targets + i] = sums.sum[k];
}

}  // namespace

std::array<Column, 6> gather_on_gpu(std::span<const Vec3> targets,
                                    std::span<const GatherSource> sources,
                                    const PairLaw& law) {
    CudaMachine machine;
    return gather_on(machine, targets, sources, law, [&](CudaMachine& m, const GatherProblem& problem) {
        const dim3 grid(static_cast<unsigned>((problem.targets + kGatherTile - 1) / kGatherTile),
                        static_cast<unsigned>(problem.parts.parts));
        with_law(law, [&]<VortexKernel kernel, bool with_potential, class T>() {
            gather_kernel<kernel, with_potential, T><<<grid, kGatherTile, 0, m.stream()>>>(problem);
        });
        check_cuda(cudaGetLastError(), "a kernel");
    });
}

}  // namespace lamella::spatial::detail
