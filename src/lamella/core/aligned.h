#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace lamella {

/// Allocates on cache-line boundaries, so that loads of eight doubles never straddle two lines.
///
/// Long columns are let go of and taken anew all the time, a little longer or shorter each time. So their sizes are
/// rounded, by at most 1/32, and the alignment is made here: what was let go of then fits the next one exactly. (An
/// aligned request to the system's allocator needs more room than the aligned block that it returned before.)
template <class T>
struct CacheLineAllocator {
    using value_type = T;

    CacheLineAllocator() = default;
    template <class U>
    CacheLineAllocator(const CacheLineAllocator<U>&) {}

    T* allocate(std::size_t n) {
        if (n > SIZE_MAX / 2 / sizeof(T)) throw std::bad_array_new_length();
        auto* const block = static_cast<std::byte*>(::operator new(rounded(n * sizeof(T)) + kLine));
        // At least 16 bytes remain in front, as blocks are aligned to that: there the block's own address is kept.
        std::byte* const aligned = block + kLine - reinterpret_cast<std::uintptr_t>(block) % kLine;
        reinterpret_cast<void**>(aligned)[-1] = block;
        return reinterpret_cast<T*>(aligned);
    }
    void deallocate(T* p, std::size_t) { ::operator delete(reinterpret_cast<void**>(p)[-1]); }
    friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }

private:
    static constexpr std::size_t kLine = 64;
    static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= 16);

    static std::size_t rounded(std::size_t bytes) {
        constexpr std::size_t kLong = std::size_t{1} << 20;
        if (bytes < kLong) return bytes;
        const std::size_t step = std::bit_floor(bytes) / 32;
        return (bytes + step - 1) / step * step;
    }
};

template <class T>
using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

/// One quantity for every item of a set.
using Column = AlignedVector<double>;

}  // namespace lamella
