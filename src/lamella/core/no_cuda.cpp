// A build without CUDA.

#include "lamella/core/cuda.h"

namespace lamella {

std::string cuda_fault() { return "this build has no CUDA support; use --device cpu"; }

std::string cuda_device_name() { return {}; }

std::int64_t use_cuda_device(int) { return 0; }

double cuda_copy_rate(std::size_t) { return 0.0; }

}  // namespace lamella
