#pragma once

#include "lamella/core/host_device.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <type_traits>
#include <utility>
#include <vector>

// Programs that run on a GPU are written once, against a machine: they hand it loops whose bodies are functors of plain
// values. CudaMachine (core/cuda_machine.cuh) runs them as kernels; HostMachine runs the same bodies one after the
// other, in any order of its "threads", so that every line of such a program is tested where there is no GPU.

namespace lamella {

/// What the items of a loop add up to, besides their work: maxima of values that are not negative, and integers. Both
/// come out the same in any order, so a reduction on a GPU repeats bit for bit.
template <int kMaxima, int kSums>
struct Reduction {
    double maximum[kMaxima] = {};
    std::int64_t sum[kSums] = {};

    LAMELLA_HOST_DEVICE void raise(int k, double value) {
        if (value > maximum[k]) maximum[k] = value;
    }
    LAMELLA_HOST_DEVICE void combine(const Reduction& other) {
        for (int k = 0; k < kMaxima; ++k) raise(k, other.maximum[k]);
        for (int k = 0; k < kSums; ++k) sum[k] += other.sum[k];
    }
};

/// Loops of a program run in blocks of this many threads, at most so many blocks; a thread takes every n-th item.
inline constexpr std::size_t kMachineThreads = 256;
inline constexpr std::size_t kMachineBlocks = 2048;

inline std::size_t machine_blocks(std::size_t count) {
    return std::clamp<std::size_t>((count + kMachineThreads - 1) / kMachineThreads, 1, kMachineBlocks);
}

/// Where memory of a machine is.
enum class MachineMemory {
    kDevice,
    kHost,  ///< pinned: a GPU copies to and from it by itself
};

/// The CPU twin of a GPU.
class HostMachine {
public:
    /// In which order the threads of a loop run.
    enum class Order { kForward, kBackward, kShuffled };
    explicit HostMachine(Order order = Order::kForward) : order_(order) {}

    template <MachineMemory, class T>
    static T* allocate(std::size_t count) {
        return new T[count]();
    }
    template <MachineMemory, class T>
    static void release(T* memory) {
        delete[] memory;
    }
    template <class T>
    void to_device(T* to, const T* from, std::size_t count) {
        std::copy_n(from, count, to);
    }
    template <class T>
    void to_host(T* to, const T* from, std::size_t count) {
        std::copy_n(from, count, to);
    }

    /// Copies that take their turn among the loops; only the host's memory may be pinned, and it has to stay as it is.
    /// What goes to the host is there after wait(), or after wait_for_mark() where it was begun before mark().
    template <class T>
    void begin_to_device(T* to, const T* from, std::size_t count) {
        to_device(to, from, count);
    }
    template <class T>
    void begin_to_host(T* to, const T* from, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto* bytes = reinterpret_cast<const std::byte*>(from);
        under_way_.push_back({to, {bytes, bytes + count * sizeof(T)}});
    }
    template <class T>
    void copy_on_device(T* to, const T* from, std::size_t count) {
        std::copy_n(from, count, to);
    }
    void wait() { deliver(under_way_.size()); }
    void mark() { marked_ = under_way_.size(); }
    void wait_for_mark() { deliver(marked_); }

    /// body(i) for i in [0, count).
    template <class Body>
    void for_each(std::size_t count, const Body& body) {
        for (std::size_t n = 0; n < count; ++n) body(place(n, count));
    }

    /// body(i, reduction) for i in [0, body.count()); the reduction of block b is left in parts[b].
    /// @param blocks  number of blocks to launch, as body.count() may only be known on the device
    template <class R, class Body>
    void reduce(std::size_t blocks, const Body& body, R* parts) {
        for (std::size_t n = 0; n < blocks; ++n) {
            const std::size_t block = place(n, blocks);
            parts[block] = R{};
            for (std::size_t t = 0; t < kMachineThreads; ++t) {
                const std::size_t thread = block * kMachineThreads + place(t, kMachineThreads);
                R mine;
                for (std::size_t i = thread; i < body.count(); i += blocks * kMachineThreads) body(i, mine);
                parts[block].combine(mine);
            }
        }
    }

    /// body(first, second): once, with what two loops have added up to.
    template <class R1, class R2, class Body>
    void conclude(std::size_t blocks, const R1* first, const R2* second, const Body& body) {
        R1 total1;
        R2 total2;
        for (std::size_t n = 0; n < blocks; ++n) {
            total1.combine(first[place(n, blocks)]);
            total2.combine(second[place(n, blocks)]);
        }
        body(total1, total2);
    }

    /// Runs record() `times` times; on a GPU it is recorded once for each `which` (0 or 1), and again only after
    /// forget_recording.
    template <class Record>
    void repeat(int /*which*/, int times, Record&& record) {
        for (int n = 0; n < times; ++n) record();
    }
    void forget_recording() {}

    /// Sorts (key, value) pairs by key; equal keys keep their order. Keys are below 2^bits.
    void sort_pairs(const std::uint32_t* keys,
                    std::uint32_t* sorted_keys,
                    const std::uint32_t* values,
                    std::uint32_t* sorted_values,
                    std::size_t count,
                    int /*bits*/) {
        std::vector<std::uint32_t> order(count);
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return keys[a] < keys[b]; });
        for (std::size_t n = 0; n < count; ++n) {
            sorted_keys[n] = keys[order[n]];
            sorted_values[n] = values[order[n]];
        }
    }
    /// sums[n] = terms[0] + ... + terms[n - 1].
    void exclusive_sum(const std::uint64_t* terms, std::uint64_t* sums, std::size_t count) {
        std::uint64_t sum = 0;
        for (std::size_t n = 0; n < count; ++n) {
            const std::uint64_t term = terms[n];
            sums[n] = sum;
            sum += term;
        }
    }

private:
    /// What the host looks at before it has waited is not there.
    struct UnderWay {
        void* to;
        std::vector<std::byte> bytes;
    };
    void deliver(std::size_t copies) {
        for (std::size_t n = 0; n < copies; ++n)
            if (!under_way_[n].bytes.empty())
                std::memcpy(under_way_[n].to, under_way_[n].bytes.data(), under_way_[n].bytes.size());
        under_way_.erase(under_way_.begin(), under_way_.begin() + static_cast<std::ptrdiff_t>(copies));
        marked_ = 0;
    }

    std::size_t place(std::size_t n, std::size_t count) const {
        switch (order_) {
            case Order::kForward:
                return n;
            case Order::kBackward:
                return count - 1 - n;
            case Order::kShuffled:
                break;
        }
        constexpr std::size_t kPrimes[] = {7919, 104729};  // one of them has no factor in common with count
        const std::size_t step = std::gcd(count, kPrimes[0]) == 1 ? kPrimes[0] : kPrimes[1];
        return (n * step + 13) % count;
    }

    Order order_;
    std::vector<UnderWay> under_way_;
    std::size_t marked_ = 0;
};

/// Memory of a machine.
template <class Machine, class T, MachineMemory kMemory = MachineMemory::kDevice>
class MachineBuffer {
public:
    MachineBuffer() = default;
    ~MachineBuffer() { clear(); }
    MachineBuffer(const MachineBuffer&) = delete;
    MachineBuffer& operator=(const MachineBuffer&) = delete;

    /// At least `count` entries; what was in it is lost when it has to grow.
    void reserve(std::size_t count) {
        if (count <= size_) return;
        clear();
        data_ = Machine::template allocate<kMemory, T>(count);
        size_ = count;
    }
    /// The same, but the first `kept` entries stay.
    void grow(Machine& machine, std::size_t count, std::size_t kept) {
        if (count <= size_) return;
        MachineBuffer larger;
        larger.reserve(count);
        machine.copy_on_device(larger.data_, data_, kept);
        machine.wait();
        swap(larger);
    }
    T* data() const { return data_; }
    std::size_t size() const { return size_; }
    void swap(MachineBuffer& other) {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
    }

private:
    void clear() {
        if (data_ != nullptr) Machine::template release<kMemory>(data_);
        data_ = nullptr;
        size_ = 0;
    }
    T* data_ = nullptr;
    std::size_t size_ = 0;
};

/// *counter += 1 by whichever thread; returns what it was. The order of threads is arbitrary: only for what is sorted
/// afterwards.
LAMELLA_HOST_DEVICE inline std::uint32_t count_one(std::uint32_t* counter) {
#ifdef __CUDA_ARCH__
    return atomicAdd(counter, 1U);
#else
    return (*counter)++;
#endif
}

}  // namespace lamella
