// The device itself, and what is sorted and summed on it by cub.

#include "lamella/core/cuda.h"
#include "lamella/core/cuda_machine.cuh"

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

#include <cstring>
#include <string>

namespace lamella {

void check_cuda(cudaError_t status, const char* what) {
    if (status == cudaSuccess) return;
    throw CudaError(std::string("CUDA, ") + what + ": " + cudaGetErrorString(status));
}

std::string cuda_fault() {
    int devices = 0;
    const cudaError_t status = cudaGetDeviceCount(&devices);
    if (status == cudaSuccess && devices > 0) return {};
    const std::string why = status == cudaSuccess ? "none is visible" : cudaGetErrorString(status);
    cudaGetLastError();  // it has been told
    return "there is no CUDA device (" + why + "); use --device cpu";
}

std::string cuda_device_name() {
    int device = 0;
    cudaDeviceProp properties{};
    if (cudaGetDevice(&device) != cudaSuccess || cudaGetDeviceProperties(&properties, device) != cudaSuccess) return {};
    return std::string(properties.name) + " (compute " + std::to_string(properties.major) + "." +
           std::to_string(properties.minor) + ", " + std::to_string(properties.totalGlobalMem >> 30) + " GiB)";
}

std::int64_t use_cuda_device(int n) {
    int devices = 0;
    check_cuda(cudaGetDeviceCount(&devices), "counting devices");
    if (devices == 0) return 0;
    const int device = n % devices;
    check_cuda(cudaSetDevice(device), "taking a device");
    cudaDeviceProp properties{};
    check_cuda(cudaGetDeviceProperties(&properties, device), "looking at a device");
    std::int64_t halves[2] = {};
    static_assert(sizeof halves == sizeof properties.uuid);
    std::memcpy(halves, &properties.uuid, sizeof halves);
    return halves[0] ^ halves[1];
}

double cuda_copy_rate(std::size_t bytes) {
    if (!cuda_fault().empty()) return 0.0;
    constexpr int kCopies = 20;
    CudaMachine machine;
    MachineBuffer<CudaMachine, std::uint64_t> from;
    MachineBuffer<CudaMachine, std::uint64_t> to;
    from.reserve(bytes / sizeof(std::uint64_t) + 1);
    to.reserve(from.size());
    const auto copy = [&] {
        check_cuda(cudaMemcpyAsync(to.data(), from.data(), bytes, cudaMemcpyDeviceToDevice, machine.stream()),
                   "a copy");
    };
    cudaEvent_t begin = nullptr;
    cudaEvent_t end = nullptr;
    check_cuda(cudaEventCreate(&begin), "an event");
    check_cuda(cudaEventCreate(&end), "an event");
    copy();
    check_cuda(cudaEventRecord(begin, machine.stream()), "an event");
    for (int n = 0; n < kCopies; ++n) copy();
    check_cuda(cudaEventRecord(end, machine.stream()), "an event");
    check_cuda(cudaEventSynchronize(end), "the device");
    float milliseconds = 0.0F;
    check_cuda(cudaEventElapsedTime(&milliseconds, begin, end), "an event");
    cudaEventDestroy(begin);
    cudaEventDestroy(end);
    return 2.0 * kCopies * static_cast<double>(bytes) / (1e-3 * static_cast<double>(milliseconds));
}

namespace cuda {

void Scratch::reserve(std::size_t bytes) {
    if (bytes <= size) return;
    cudaFree(memory);
    memory = nullptr;
    size = 0;
    check_cuda(cudaMalloc(&memory, bytes), "memory");
    size = bytes;
}

void sort_pairs(Scratch& scratch,
                const std::uint32_t* keys,
                std::uint32_t* sorted_keys,
                const std::uint32_t* values,
                std::uint32_t* sorted_values,
                std::size_t count,
                int bits,
                cudaStream_t stream) {
    const auto sort = [&](void* memory, std::size_t& bytes) {
        check_cuda(cub::DeviceRadixSort::SortPairs(memory, bytes, keys, sorted_keys, values, sorted_values,
                                                   static_cast<int>(count), 0, bits, stream),
                   "sorting");
    };
    std::size_t bytes = 0;
    sort(nullptr, bytes);
    scratch.reserve(bytes);
    bytes = scratch.size;
    sort(scratch.memory, bytes);
}

void exclusive_sum(
    Scratch& scratch, const std::uint64_t* terms, std::uint64_t* sums, std::size_t count, cudaStream_t stream) {
    const auto add = [&](void* memory, std::size_t& bytes) {
        check_cuda(cub::DeviceScan::ExclusiveSum(memory, bytes, terms, sums, static_cast<int>(count), stream),
                   "summing");
    };
    std::size_t bytes = 0;
    add(nullptr, bytes);
    scratch.reserve(bytes);
    bytes = scratch.size;
    add(scratch.memory, bytes);
}

}  // namespace cuda
}  // namespace lamella
