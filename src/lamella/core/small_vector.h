#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace lamella {

/// A short list of plain values: the first `N` lie in the object itself, more of them on the heap.
template <class T, std::size_t N>
requires std::is_trivially_copyable_v<T>
class SmallVector {
public:
    using value_type = T;

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    T* begin() { return data(); }
    T* end() { return data() + size_; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size_; }
    T& operator[](std::size_t i) { return data()[i]; }
    const T& operator[](std::size_t i) const { return data()[i]; }
    T& back() { return data()[size_ - 1]; }
    const T& back() const { return data()[size_ - 1]; }
    const T* data() const { return size_ <= N ? inside_.data() : more_.data(); }
    T* data() { return size_ <= N ? inside_.data() : more_.data(); }

    void clear() { size_ = 0; }
    void push_back(const T& value) {
        if (size_ < N) {
            inside_[size_] = value;
        } else {
            if (size_ == N) more_.assign(inside_.begin(), inside_.end());
            more_.resize(size_);
            more_.push_back(value);
        }
        ++size_;
    }
    void pop_back() {
        --size_;
        if (size_ == N) std::copy_n(more_.begin(), N, inside_.begin());
    }
    /// Puts `value` before the element at `place`.
    void insert(std::size_t place, const T& value) {
        push_back(value);
        T* all = data();
        for (std::size_t i = size_ - 1; i > place; --i) all[i] = all[i - 1];
        all[place] = value;
    }
    void erase(std::size_t place) {
        T* all = data();
        for (std::size_t i = place; i + 1 < size_; ++i) all[i] = all[i + 1];
        pop_back();
    }
    bool contains(const T& value) const { return std::find(begin(), end(), value) != end(); }

private:
    std::array<T, N> inside_{};
    std::uint32_t size_ = 0;
    std::vector<T> more_;
};

}  // namespace lamella
