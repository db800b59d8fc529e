#pragma once

#include "lamella/core/cuda.h"
#include "lamella/core/error.h"
#include "lamella/dist/agree.h"
#include "lamella/dist/devices.h"
#include "lamella/dist/world.h"

#include <string>

namespace lamella::app {

/// Whether the device that was asked for is there. @throws InputError  it is not
inline void check_device(const std::string& device) {
    if (device != "cuda") return;
    const std::string fault = cuda_fault();
    if (!fault.empty()) throw InputError(fault);
}

/// Of several processes each takes a GPU of its machine. Collective. @throws InputError  there are too few
inline void take_device(const std::string& device, dist::Communicator& processes) {
    dist::together(processes, [&] { check_device(device); });
    if (device != "cuda" || !processes.several()) return;
    dist::require_own_devices(processes,
                              dist::together(processes, [] { return use_cuda_device(dist::rank_on_machine()); }));
}

}  // namespace lamella::app
