#pragma once

#include "lamella/core/cuda.h"
#include "lamella/core/error.h"

#include <string>

namespace lamella::app {

/// Whether the device that was asked for is there. @throws InputError  it is not
inline void check_device(const std::string& device) {
    if (device != "cuda") return;
    const std::string fault = cuda_fault();
    if (!fault.empty()) throw InputError(fault);
}

}  // namespace lamella::app
