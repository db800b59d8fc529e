#pragma once

// Processes of one run as fibers of one thread: what MPI does, for tests without it. Fibers and not threads, because
// processes that share few cores with other work wait for each other thousands of times.

#include "lamella/dist/communicator.h"

#include <ucontext.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <memory>
#include <vector>

namespace lamella::test {

class ProcessTeam {
public:
    explicit ProcessTeam(int size)
        : size_(size),
          outgoing_(static_cast<std::size_t>(size)),
          integers_(outgoing_.size()),
          reals_(outgoing_.size()),
          pace_(outgoing_.size(), 1.0) {}

    /// How far the clock of each process goes whenever it is read [s].
    void set_pace(std::vector<double> pace) { pace_ = std::move(pace); }

    class Member final : public dist::Communicator {
        template <class List>
        auto& mine(List& list) {
            return list[static_cast<std::size_t>(rank_)];
        }

    public:
        Member(ProcessTeam& team, int rank) : team_(team), rank_(rank) {}
        int rank() const override { return rank_; }
        int size() const override { return team_.size_; }

        void reduce(std::span<std::int64_t> sums, std::span<double> maxima) override {
            look_at_what_was_on_its_way();
            mine(team_.integers_).assign(sums.begin(), sums.end());
            mine(team_.reals_).assign(maxima.begin(), maxima.end());
            meet();
            for (std::size_t k = 0; k < sums.size(); ++k) {
                sums[k] = 0;
                for (const auto& theirs : team_.integers_) sums[k] += theirs[k];
            }
            for (std::size_t k = 0; k < maxima.size(); ++k)
                for (const auto& theirs : team_.reals_) maxima[k] = std::max(maxima[k], theirs[k]);
            meet();
        }
        void broadcast(std::span<std::byte> bytes) override {
            look_at_what_was_on_its_way();
            if (rank_ == 0) team_.broadcast_ = bytes;
            meet();
            if (rank_ != 0) std::copy(team_.broadcast_.begin(), team_.broadcast_.end(), bytes.begin());
            meet();
        }
        std::vector<std::int64_t> exchange(std::span<const std::int64_t> to_each) override {
            look_at_what_was_on_its_way();
            mine(team_.integers_).assign(to_each.begin(), to_each.end());
            meet();
            std::vector<std::int64_t> from;
            for (const auto& theirs : team_.integers_) from.push_back(theirs[static_cast<std::size_t>(rank_)]);
            meet();
            return from;
        }
        /// As MPI may: nothing moves before end().
        void begin(std::span<const dist::Outgoing> outgoing, std::span<const dist::Incoming> incoming) override {
            look_at_what_was_on_its_way();
            mine(team_.outgoing_).assign(outgoing.begin(), outgoing.end());
            incoming_.assign(incoming.begin(), incoming.end());
        }
        void end() override {
            meet();
            for (const dist::Incoming& message : incoming_) {
                bool found = false;
                for (const dist::Outgoing& sent : team_.outgoing_[static_cast<std::size_t>(message.from)]) {
                    if (sent.to != rank_) continue;
                    if (sent.bytes.size() != message.bytes.size()) std::terminate();
                    std::copy(sent.bytes.begin(), sent.bytes.end(), message.bytes.begin());
                    found = true;
                }
                if (!found) std::terminate();
            }
            meet();
        }
        void receive() override {
            for (const dist::Outgoing& sent : mine(team_.outgoing_))
                on_its_way_.push_back({sent.bytes, {sent.bytes.begin(), sent.bytes.end()}});
            end();
        }
        void abort(int) override { std::terminate(); }
        double work_clock() const override { return clock_ += team_.pace_[static_cast<std::size_t>(rank_)]; }

    private:
        struct OnItsWay {
            std::span<const std::byte> bytes;
            std::vector<std::byte> sent;
        };

        void meet() { team_.meet(); }
        /// What was sent has to be there still.
        void look_at_what_was_on_its_way() {
            for (const OnItsWay& message : on_its_way_)
                if (!std::equal(message.sent.begin(), message.sent.end(), message.bytes.begin())) std::terminate();
            on_its_way_.clear();
        }

        ProcessTeam& team_;
        int rank_;
        std::vector<dist::Incoming> incoming_;
        std::vector<OnItsWay> on_its_way_;
        mutable double clock_ = 0.0;
    };

    /// Calls work(communicator) as each process, all of which must meet equally often.
    template <class Work>
    void run(Work&& work) {
        constexpr std::size_t kStack = std::size_t{4} << 20;
        struct Fiber {
            ProcessTeam& team;
            Work& work;
            int rank;
            ucontext_t context{};
            std::unique_ptr<char[]> stack = std::make_unique<char[]>(kStack);
            std::exception_ptr error = nullptr;
            bool done = false;

            static void enter(unsigned low, unsigned high) {
                auto* fiber = reinterpret_cast<Fiber*>((static_cast<std::uintptr_t>(high) << 32) | low);
                try {
                    fiber->work(
                        std::shared_ptr<dist::Communicator>(std::make_shared<Member>(fiber->team, fiber->rank)));
                } catch (...) {
                    fiber->error = std::current_exception();
                }
                fiber->done = true;
                swapcontext(&fiber->context, &fiber->team.scheduler_);
            }
        };
        std::vector<std::unique_ptr<Fiber>> fibers;
        for (int rank = 0; rank < size_; ++rank) {
            Fiber& fiber = *fibers.emplace_back(new Fiber{*this, work, rank});
            getcontext(&fiber.context);
            fiber.context.uc_stack.ss_sp = fiber.stack.get();
            fiber.context.uc_stack.ss_size = kStack;
            const auto address = reinterpret_cast<std::uintptr_t>(&fiber);
            makecontext(&fiber.context, reinterpret_cast<void (*)()>(&Fiber::enter), 2,
                        static_cast<unsigned>(address & 0xffffffffU), static_cast<unsigned>(address >> 32));
        }
        // Each runs until it meets the others, then the next one does.
        for (bool any = true; any;) {
            any = false;
            for (auto& fiber : fibers) {
                if (fiber->done) continue;
                any = true;
                current_ = &fiber->context;
                swapcontext(&scheduler_, &fiber->context);
            }
        }
        if (fibers[0]->error) std::rethrow_exception(fibers[0]->error);
    }

private:
    void meet() { swapcontext(current_, &scheduler_); }

    int size_;
    ucontext_t scheduler_{};
    ucontext_t* current_ = nullptr;
    std::vector<std::vector<dist::Outgoing>> outgoing_;
    std::vector<std::vector<std::int64_t>> integers_;
    std::vector<std::vector<double>> reals_;
    std::span<std::byte> broadcast_;
    std::vector<double> pace_;
};

/// Calls work(communicator) as each of `size` processes. An error of process 0 reaches the caller.
template <class Work>
void as_processes(int size, Work&& work) {
    ProcessTeam(size).run(work);
}

}  // namespace lamella::test
