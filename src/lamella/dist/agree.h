#pragma once

#include "lamella/dist/communicator.h"

#include <exception>
#include <type_traits>
#include <utility>

namespace lamella::dist {

namespace detail {
/// Throws on all processes if any of them has an error.
void agree_on_failure(Communicator& processes, const std::exception_ptr& error);
}  // namespace detail

/// All processes do `work`, in which they exchange nothing; where it fails for one of them, it fails for all.
/// @throws  the error of the first process that failed, on every process (text and kind of the errors in core/error.h)
template <class Work>
auto together(Communicator& processes, Work&& work) {
    using Result = decltype(work());
    std::exception_ptr error;
    if constexpr (std::is_void_v<Result>) {
        try {
            work();
        } catch (...) {
            error = std::current_exception();
        }
        detail::agree_on_failure(processes, error);
    } else {
        std::vector<Result> result;  // empty or one
        try {
            result.push_back(work());
        } catch (...) {
            error = std::current_exception();
        }
        detail::agree_on_failure(processes, error);
        return std::move(result.front());
    }
}

}  // namespace lamella::dist
