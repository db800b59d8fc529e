#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <vector>

namespace lamella {

/// Limits the worker threads of this process for as long as it lives. `threads` = 0: as many as there are cores.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The number of threads that parallel_for uses now.
int thread_count();

namespace detail {
/// Calls body(context, block) once for each block in [0, blocks), from any thread, in any order.
void run_blocks(std::size_t blocks, void (*body)(void*, std::size_t), void* context);
}  // namespace detail

/// Calls body(begin, end) for consecutive ranges of `block` items (the last may be shorter) that cover [0, count).
/// The ranges do not depend on the number of threads. Exceptions of `body` reach the caller.
template <class Body>
void parallel_blocks(std::size_t count, std::size_t block, Body&& body) {
    struct Context {
        Body& body;
        std::size_t count, block;
    } context{body, count, block};
    const std::size_t blocks = (count + block - 1) / block;
    detail::run_blocks(
        blocks,
        [](void* p, std::size_t b) {
            auto& c = *static_cast<Context*>(p);
            c.body(b * c.block, std::min(c.count, (b + 1) * c.block));
        },
        &context);
}

inline constexpr std::size_t kParallelBlock = 4096;  ///< items that one task handles by default

/// Calls body(i) for every i in [0, count).
template <class Body>
void parallel_for(std::size_t count, Body&& body) {
    parallel_blocks(count, kParallelBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// Combines partial(begin, end) of fixed blocks, in order: the same bits on any number of threads.
template <class Value, class Partial, class Combine>
Value parallel_reduce(std::size_t count,
                      Value identity,
                      Partial&& partial,
                      Combine&& combine,
                      std::size_t block = kParallelBlock) {
    static_assert(!std::is_same_v<Value, bool>, "neighbors in a vector<bool> share a byte: use int");
    std::vector<Value> parts((count + block - 1) / block, identity);
    parallel_blocks(count, block,
                    [&](std::size_t begin, std::size_t end) { parts[begin / block] = partial(begin, end); });
    Value total = identity;
    for (const Value& part : parts) total = combine(total, part);
    return total;
}

/// Sum of term(i) over [0, count), numbers or vectors, added in fixed blocks: the same bits on any number of threads.
template <class Term>
auto parallel_sum(std::size_t count, Term&& term) {
    using Value = std::remove_cvref_t<decltype(term(std::size_t{}))>;
    return parallel_reduce(
        count, Value{},
        [&](std::size_t begin, std::size_t end) {
            Value sum{};
            for (std::size_t i = begin; i < end; ++i) sum += term(i);
            return sum;
        },
        [](const Value& a, const Value& b) { return a + b; });
}

/// Largest term(i) over [0, count), or `floor` if that is larger.
template <class Term>
double parallel_max(std::size_t count, double floor, Term&& term) {
    return parallel_reduce(
        count, floor,
        [&](std::size_t begin, std::size_t end) {
            double largest = floor;
            for (std::size_t i = begin; i < end; ++i) largest = std::max(largest, term(i));
            return largest;
        },
        [](double a, double b) { return std::max(a, b); });
}

}  // namespace lamella
