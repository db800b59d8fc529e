// A build without CUDA.

#include "lamella/core/cuda.h"
#include "lamella/core/error.h"
#include "lamella/spatial/detail/vortex_gather.h"

namespace lamella::spatial::detail {

std::array<Column, 6> gather_on_gpu(std::span<const Vec3>, std::span<const GatherSource>, const PairLaw&) {
    throw InputError(cuda_fault());
}

}  // namespace lamella::spatial::detail
