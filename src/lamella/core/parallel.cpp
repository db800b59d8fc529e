#include "lamella/core/parallel.h"

#include <thread>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace lamella {

struct ThreadLimit::Impl {
    tbb::global_control control;
};

ThreadLimit::ThreadLimit(int threads) {
    const auto all = std::max(1U, std::thread::hardware_concurrency());
    const auto wanted = threads > 0 ? static_cast<std::size_t>(threads) : static_cast<std::size_t>(all);
    impl_.reset(new Impl{tbb::global_control(tbb::global_control::max_allowed_parallelism, wanted)});
}

ThreadLimit::~ThreadLimit() = default;

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void detail::run_blocks(std::size_t blocks, void (*body)(void*, std::size_t), void* context) {
    if (blocks <= 1) {
        if (blocks == 1) body(context, 0);
        return;
    }
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) { body(context, b); });
}

}  // namespace lamella
