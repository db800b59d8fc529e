// A build without CUDA.

#include "lamella/core/cuda.h"
#include "lamella/core/error.h"
#include "lamella/solvers/bubble/detail/device_runner.h"

namespace lamella::bubble::detail {

template <int D>
std::unique_ptr<DeviceRunner<D>> make_cuda_runner(const Options&, std::unique_ptr<DeviceTeam<D>>) {
    throw InputError(cuda_fault());
}

template std::unique_ptr<DeviceRunner<2>> make_cuda_runner<2>(const Options&, std::unique_ptr<DeviceTeam<2>>);
template std::unique_ptr<DeviceRunner<3>> make_cuda_runner<3>(const Options&, std::unique_ptr<DeviceTeam<3>>);

}  // namespace lamella::bubble::detail
