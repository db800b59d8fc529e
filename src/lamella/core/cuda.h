#pragma once

#include "lamella/core/error.h"

#include <cstddef>
#include <cstdint>
#include <string>

// The GPU as seen from C++ that knows no CUDA.

namespace lamella {

/// A GPU fails. Of several processes only the one that uses it knows.
class CudaError : public IoError {
public:
    using IoError::IoError;
};

/// Why nothing can be computed on a GPU here, as one line that says what would do; empty: it can. Looks for the device
/// on every call and leaves it alone otherwise.
std::string cuda_fault();

/// "NVIDIA H200 (compute 9.0, 139 GiB)"; empty where cuda_fault() is not.
std::string cuda_device_name();

/// Takes the n-th GPU that this process sees, counted around, for all that it computes from now on.
/// @returns  what tells it from every other GPU, on this machine and on others; 0 where there is none
/// @throws CudaError  the device fails
std::int64_t use_cuda_device(int n);

/// Bytes per second, read and written, of a copy of so many bytes within the device: what memory can give. 0 without
/// a device. @throws CudaError  the device fails
double cuda_copy_rate(std::size_t bytes);

}  // namespace lamella
