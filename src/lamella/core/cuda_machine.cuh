#pragma once

#include "lamella/core/error.h"
#include "lamella/core/machine.h"

#include <cuda_runtime.h>

namespace lamella {

/// Throws what a call of the CUDA runtime reports. @throws CudaError
void check_cuda(cudaError_t status, const char* what);

namespace cuda {

/// cub behind plain functions: compiled once. `scratch` grows as it is needed.
struct Scratch {
    void* memory = nullptr;
    std::size_t size = 0;
    ~Scratch() { cudaFree(memory); }
    void reserve(std::size_t bytes);
};
void sort_pairs(Scratch& scratch,
                const std::uint32_t* keys,
                std::uint32_t* sorted_keys,
                const std::uint32_t* values,
                std::uint32_t* sorted_values,
                std::size_t count,
                int bits,
                cudaStream_t stream);
void exclusive_sum(
    Scratch& scratch, const std::uint64_t* terms, std::uint64_t* sums, std::size_t count, cudaStream_t stream);

template <class Body>
__global__ void for_each_kernel(std::size_t count, Body body) {
    const std::size_t step = static_cast<std::size_t>(gridDim.x) * blockDim.x;
    for (std::size_t i = static_cast<std::size_t>(blockIdx.x) * blockDim.x + threadIdx.x; i < count; i += step) body(i);
}

/// The reductions of a block's threads, left in thread 0: by shuffles within warps, then over the warps.
template <class R>
__device__ void combine_block(R& mine) {
    constexpr int kWarp = 32;
    constexpr int kWarps = static_cast<int>(kMachineThreads) / kWarp;
    constexpr int kMaxima = static_cast<int>(sizeof(R::maximum) / sizeof(double));
    constexpr int kSums = static_cast<int>(sizeof(R::sum) / sizeof(std::int64_t));
    const auto combine_warp = [&] {
        for (int offset = kWarp / 2; offset > 0; offset /= 2) {
            R other;
            for (int k = 0; k < kMaxima; ++k) other.maximum[k] = __shfl_down_sync(0xffffffffU, mine.maximum[k], offset);
            for (int k = 0; k < kSums; ++k)
                other.sum[k] = static_cast<std::int64_t>(
                    __shfl_down_sync(0xffffffffU, static_cast<long long>(mine.sum[k]), offset));
            mine.combine(other);
        }
    };
    __shared__ alignas(16) unsigned char storage[kWarps * sizeof(R)];
    R* of_warp = reinterpret_cast<R*>(storage);
    const int warp = static_cast<int>(threadIdx.x) / kWarp;
    const int lane = static_cast<int>(threadIdx.x) % kWarp;
    combine_warp();
    if (lane == 0) of_warp[warp] = mine;
    __syncthreads();
    if (warp == 0) {
        mine = lane < kWarps ? of_warp[lane] : R{};
        combine_warp();
    }
    __syncthreads();  // the storage may be used again
}

template <class R, class Body>
__global__ void __launch_bounds__(kMachineThreads) reduce_kernel(Body body, R* parts) {
    R mine;
    const std::size_t count = body.count();
    const std::size_t step = static_cast<std::size_t>(gridDim.x) * kMachineThreads;
    for (std::size_t i = static_cast<std::size_t>(blockIdx.x) * kMachineThreads + threadIdx.x; i < count; i += step)
        body(i, mine);
    combine_block(mine);
    if (threadIdx.x == 0) parts[blockIdx.x] = mine;
}

template <class R1, class R2, class Body>
__global__ void __launch_bounds__(kMachineThreads)
    conclude_kernel(int blocks, const R1* first, const R2* second, Body body) {
    R1 total1;
    R2 total2;
    for (int b = static_cast<int>(threadIdx.x); b < blocks; b += static_cast<int>(kMachineThreads)) {
        total1.combine(first[b]);
        total2.combine(second[b]);
    }
    combine_block(total1);
    combine_block(total2);
    if (threadIdx.x == 0) body(total1, total2);
}

}  // namespace cuda

/// Runs the loops of a program as kernels, on a stream of its own: several programs share a GPU.
class CudaMachine {
public:
    CudaMachine() {
        check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "a stream");
        check_cuda(cudaEventCreateWithFlags(&mark_, cudaEventDisableTiming), "an event");
    }
    ~CudaMachine() {
        forget_recording();
        cudaEventDestroy(mark_);
        cudaStreamDestroy(stream_);
    }
    CudaMachine(const CudaMachine&) = delete;
    CudaMachine& operator=(const CudaMachine&) = delete;

    template <MachineMemory kMemory, class T>
    static T* allocate(std::size_t count) {
        void* memory = nullptr;
        if constexpr (kMemory == MachineMemory::kHost) {
            check_cuda(cudaMallocHost(&memory, count * sizeof(T)), "memory of the host");
            return static_cast<T*>(memory);
        }
        check_cuda(cudaMalloc(&memory, count * sizeof(T)), "memory");
        check_cuda(cudaMemset(memory, 0, count * sizeof(T)), "clearing memory");
        check_cuda(cudaDeviceSynchronize(), "clearing memory");
        return static_cast<T*>(memory);
    }
    template <MachineMemory kMemory, class T>
    static void release(T* memory) {
        kMemory == MachineMemory::kHost ? cudaFreeHost(memory) : cudaFree(memory);
    }
    template <class T>
    void to_device(T* to, const T* from, std::size_t count) {
        copy(to, from, count * sizeof(T), cudaMemcpyHostToDevice);
    }
    template <class T>
    void to_host(T* to, const T* from, std::size_t count) {
        copy(to, from, count * sizeof(T), cudaMemcpyDeviceToHost);
    }
    template <class T>
    void begin_to_device(T* to, const T* from, std::size_t count) {
        begin_copy(to, from, count * sizeof(T), cudaMemcpyHostToDevice);
    }
    template <class T>
    void begin_to_host(T* to, const T* from, std::size_t count) {
        begin_copy(to, from, count * sizeof(T), cudaMemcpyDeviceToHost);
    }
    template <class T>
    void copy_on_device(T* to, const T* from, std::size_t count) {
        begin_copy(to, from, count * sizeof(T), cudaMemcpyDeviceToDevice);
    }
    void wait() { check_cuda(cudaStreamSynchronize(stream_), "the device"); }
    void mark() { check_cuda(cudaEventRecord(mark_, stream_), "an event"); }
    void wait_for_mark() { check_cuda(cudaEventSynchronize(mark_), "the device"); }

    template <class Body>
    void for_each(std::size_t count, const Body& body) {
        if (count == 0) return;
        cuda::for_each_kernel<<<grid(machine_blocks(count)), kMachineThreads, 0, stream_>>>(count, body);
        check_cuda(cudaGetLastError(), "a kernel");
    }

    template <class R, class Body>
    void reduce(std::size_t blocks, const Body& body, R* parts) {
        cuda::reduce_kernel<<<grid(blocks), kMachineThreads, 0, stream_>>>(body, parts);
        check_cuda(cudaGetLastError(), "a kernel");
    }

    template <class R1, class R2, class Body>
    void conclude(std::size_t blocks, const R1* first, const R2* second, const Body& body) {
        cuda::conclude_kernel<<<1, kMachineThreads, 0, stream_>>>(static_cast<int>(blocks), first, second, body);
        check_cuda(cudaGetLastError(), "a kernel");
    }

    template <class Record>
    void repeat(int which, int times, Record&& record) {
        cudaGraphExec_t& recording = recording_[which];
        if (recording == nullptr) {
            cudaGraph_t graph = nullptr;
            check_cuda(cudaStreamBeginCapture(stream_, cudaStreamCaptureModeThreadLocal), "recording");
            for (int n = 0; n < times; ++n) record();
            check_cuda(cudaStreamEndCapture(stream_, &graph), "recording");
            const cudaError_t status = cudaGraphInstantiate(&recording, graph, 0);
            cudaGraphDestroy(graph);
            check_cuda(status, "recording");
        }
        check_cuda(cudaGraphLaunch(recording, stream_), "a recording");
    }
    void forget_recording() {
        for (cudaGraphExec_t& recording : recording_) {
            if (recording != nullptr) cudaGraphExecDestroy(recording);
            recording = nullptr;
        }
    }

    void sort_pairs(const std::uint32_t* keys,
                    std::uint32_t* sorted_keys,
                    const std::uint32_t* values,
                    std::uint32_t* sorted_values,
                    std::size_t count,
                    int bits) {
        cuda::sort_pairs(scratch_, keys, sorted_keys, values, sorted_values, count, bits, stream_);
    }
    void exclusive_sum(const std::uint64_t* terms, std::uint64_t* sums, std::size_t count) {
        cuda::exclusive_sum(scratch_, terms, sums, count, stream_);
    }

    cudaStream_t stream() const { return stream_; }

private:
    static unsigned grid(std::size_t blocks) { return static_cast<unsigned>(blocks); }

    void begin_copy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
        if (bytes > 0) check_cuda(cudaMemcpyAsync(to, from, bytes, kind, stream_), "a copy");
    }
    /// The host may use or change what it gave as soon as this returns.
    void copy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
        begin_copy(to, from, bytes, kind);
        if (bytes > 0) wait();
    }

    cudaStream_t stream_ = nullptr;
    cudaEvent_t mark_ = nullptr;
    cudaGraphExec_t recording_[2] = {};
    cuda::Scratch scratch_;
};

}  // namespace lamella
