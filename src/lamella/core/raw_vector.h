#pragma once

#include "lamella/core/aligned.h"

#include <new>
#include <utility>
#include <vector>

namespace lamella {

/// Elements start without a value where none is given.
template <class T>
struct RawAllocator : CacheLineAllocator<T> {
    RawAllocator() = default;
    template <class U>
    RawAllocator(const RawAllocator<U>&) {}

    template <class U>
    void construct(U* place) {
        ::new (static_cast<void*>(place)) U;
    }
    template <class U, class... From>
    void construct(U* place, From&&... from) {
        ::new (static_cast<void*>(place)) U(std::forward<From>(from)...);
    }
};

/// A vector that resize() does not fill with zeros: for large arrays that a loop over all cores writes next, of which a
/// single core would touch every page before.
template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace lamella
