#pragma once

#include <cstddef>
#include <iterator>
#include <type_traits>
#include <utility>
#include <vector>

namespace lamella {

/// The place of an element in its columns. Ids are enumerations over an unsigned integer: one kind of id does not
/// convert to another, nor to a number without being asked.
template <class Id>
requires std::is_enum_v<Id>
constexpr std::size_t index(Id id) { return static_cast<std::size_t>(id); }

/// The ids 0, 1, ... size - 1. (std::views::iota would do, but clang 14 cannot compile it with the library of gcc 12.)
template <class Id>
class IdRange {
public:
    class Iterator {
    public:
        using value_type = Id;
        using difference_type = std::ptrdiff_t;
        using reference = Id;
        using pointer = const Id*;
        using iterator_category = std::input_iterator_tag;

        Iterator() = default;
        explicit Iterator(std::size_t i) : i_(i) {}
        Id operator*() const { return static_cast<Id>(i_); }
        Iterator& operator++() {
            ++i_;
            return *this;
        }
        Iterator operator++(int) {
            const Iterator before = *this;
            ++i_;
            return before;
        }
        friend bool operator==(const Iterator&, const Iterator&) = default;

    private:
        std::size_t i_ = 0;
    };

    explicit IdRange(std::size_t size) : size_(size) {}
    Iterator begin() const { return Iterator(0); }
    Iterator end() const { return Iterator(size_); }

private:
    std::size_t size_;
};

/// A column: one value per element of one kind, addressed by that kind's id only.
template <class Id, class T>
class IdVector {
public:
    using value_type = T;

    IdVector() = default;
    explicit IdVector(std::size_t size, const T& value = T()) : values_(size, value) {}
    explicit IdVector(std::vector<T> values) : values_(std::move(values)) {}

    T& operator[](Id id) { return values_[index(id)]; }
    const T& operator[](Id id) const { return values_[index(id)]; }

    std::size_t size() const { return values_.size(); }
    bool empty() const { return values_.empty(); }
    void clear() { values_.clear(); }
    void reserve(std::size_t size) { values_.reserve(size); }
    void resize(std::size_t size, const T& value = T()) { values_.resize(size, value); }
    void assign(std::size_t size, const T& value) { values_.assign(size, value); }
    /// Appends and says where.
    Id push_back(T value) {
        values_.push_back(std::move(value));
        return static_cast<Id>(values_.size() - 1);
    }
    void pop_back() { values_.pop_back(); }

    /// The ids of all elements, in order: `for (VertexId v : positions.ids())`.
    IdRange<Id> ids() const { return IdRange<Id>(values_.size()); }

    auto begin() { return values_.begin(); }
    auto end() { return values_.end(); }
    auto begin() const { return values_.begin(); }
    auto end() const { return values_.end(); }
    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }
    /// The values as a plain vector, for code that counts elements itself.
    std::vector<T>& values() { return values_; }
    const std::vector<T>& values() const { return values_; }

    friend bool operator==(const IdVector&, const IdVector&) = default;

private:
    std::vector<T> values_;
};

}  // namespace lamella
