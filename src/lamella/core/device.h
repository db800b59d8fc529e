#pragma once

namespace lamella {

/// Where something is computed.
enum class Device {
    kCpu,
    kCuda,
    kCudaTwin,  ///< the program for the GPU, run on the CPU: for tests
};

}  // namespace lamella
