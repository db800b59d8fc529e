#include "lamella/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <thread>

#ifdef LAMELLA_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace lamella {

namespace {

// What a parallel loop guarantees, told to the thread sanitizer: everything before the loop happens before every
// block, and every block happens before whatever follows the loop. Nothing is said about two blocks, so that a race
// between them is found. Empty in other builds.
#ifdef LAMELLA_THREAD_SANITIZER
class ForkJoin {
public:
    ForkJoin() { __tsan_release(&fork_); }
    ~ForkJoin() { __tsan_acquire(&join_); }
    ForkJoin(const ForkJoin&) = delete;
    ForkJoin& operator=(const ForkJoin&) = delete;

    class Block {
    public:
        explicit Block(ForkJoin& loop) : loop_(loop) { __tsan_acquire(&loop_.fork_); }
        ~Block() { __tsan_release(&loop_.join_); }  // also when the block throws
        Block(const Block&) = delete;
        Block& operator=(const Block&) = delete;

    private:
        ForkJoin& loop_;
    };

private:
    char fork_ = 0;
    char join_ = 0;
};
#else
struct ForkJoin {
    struct Block {
        explicit Block(ForkJoin&) {}
    };
};
#endif

}  // namespace

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
    ForkJoin loop;
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
        const ForkJoin::Block scope(loop);
        body(context, b);
    });
}

}  // namespace lamella
