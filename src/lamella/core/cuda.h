#pragma once

#include <cstddef>
#include <string>

// The GPU as seen from C++ that knows no CUDA.

namespace lamella {

/// Why nothing can be computed on a GPU here, as one line that says what would do; empty: it can. Looks for the device
/// on every call and leaves it alone otherwise.
std::string cuda_fault();

/// "NVIDIA H200 (compute 9.0, 139 GiB)"; empty where cuda_fault() is not.
std::string cuda_device_name();

/// Bytes per second, read and written, of a copy of so many bytes within the device: what memory can give. 0 without
/// a device. @throws IoError  the device fails
double cuda_copy_rate(std::size_t bytes);

}  // namespace lamella
