// The foam on a GPU.

#include "lamella/core/cuda_machine.cuh"
#include "lamella/solvers/bubble/detail/device_program.h"

namespace lamella::bubble::detail {

template <int D>
std::unique_ptr<DeviceRunner<D>> make_cuda_runner(const Options& options, std::unique_ptr<DeviceTeam<D>> team) {
    return std::make_unique<DeviceProgram<D, CudaMachine>>(options, std::move(team));
}

template std::unique_ptr<DeviceRunner<2>> make_cuda_runner<2>(const Options&, std::unique_ptr<DeviceTeam<2>>);
template std::unique_ptr<DeviceRunner<3>> make_cuda_runner<3>(const Options&, std::unique_ptr<DeviceTeam<3>>);

}  // namespace lamella::bubble::detail
