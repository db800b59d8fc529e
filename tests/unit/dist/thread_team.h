#pragma once

// Processes of one run as threads of one process: what MPI does, for tests without it.

#include "lamella/dist/communicator.h"

#include <algorithm>
#include <barrier>
#include <cstring>
#include <exception>
#include <memory>
#include <thread>

namespace lamella::test {

class ThreadTeam {
public:
    explicit ThreadTeam(int size)
        : size_(size),
          barrier_(size),
          outgoing_(static_cast<std::size_t>(size)),
          integers_(outgoing_.size()),
          reals_(outgoing_.size()) {}

    class Member final : public dist::Communicator {
        template <class List>
        auto& mine(List& list) {
            return list[static_cast<std::size_t>(rank_)];
        }

    public:
        Member(ThreadTeam& team, int rank) : team_(team), rank_(rank) {}
        int rank() const override { return rank_; }
        int size() const override { return team_.size_; }

        void sum(std::span<std::int64_t> values) override {
            mine(team_.integers_).assign(values.begin(), values.end());
            meet();
            for (std::size_t k = 0; k < values.size(); ++k) {
                values[k] = 0;
                for (const auto& theirs : team_.integers_) values[k] += theirs[k];
            }
            meet();
        }
        void largest(std::span<double> values) override {
            mine(team_.reals_).assign(values.begin(), values.end());
            meet();
            for (std::size_t k = 0; k < values.size(); ++k)
                for (const auto& theirs : team_.reals_) values[k] = std::max(values[k], theirs[k]);
            meet();
        }
        void broadcast(std::span<std::byte> bytes) override {
            if (rank_ == 0) team_.broadcast_ = bytes;
            meet();
            if (rank_ != 0) std::copy(team_.broadcast_.begin(), team_.broadcast_.end(), bytes.begin());
            meet();
        }
        std::vector<std::int64_t> exchange(std::span<const std::int64_t> to_each) override {
            mine(team_.integers_).assign(to_each.begin(), to_each.end());
            meet();
            std::vector<std::int64_t> from;
            for (const auto& theirs : team_.integers_) from.push_back(theirs[static_cast<std::size_t>(rank_)]);
            meet();
            return from;
        }
        /// As MPI may: nothing moves before end().
        void begin(std::span<const dist::Outgoing> outgoing, std::span<const dist::Incoming> incoming) override {
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
        void abort(int) override { std::terminate(); }

    private:
        void meet() { team_.barrier_.arrive_and_wait(); }

        ThreadTeam& team_;
        int rank_;
        std::vector<dist::Incoming> incoming_;
    };

private:
    int size_;
    std::barrier<> barrier_;
    std::vector<std::vector<dist::Outgoing>> outgoing_;
    std::vector<std::vector<std::int64_t>> integers_;
    std::vector<std::vector<double>> reals_;
    std::span<std::byte> broadcast_;
};

/// Calls work(communicator) as each of `size` processes. An error of process 0 reaches the caller.
template <class Work>
void as_processes(int size, Work&& work) {
    ThreadTeam team(size);
    std::exception_ptr error;
    std::vector<std::thread> threads;
    for (int rank = 0; rank < size; ++rank)
        threads.emplace_back([&, rank] {
            const auto member = std::make_shared<ThreadTeam::Member>(team, rank);
            try {
                work(std::shared_ptr<dist::Communicator>(member));
            } catch (...) {
                if (rank == 0) error = std::current_exception();
            }
        });
    for (std::thread& thread : threads) thread.join();
    if (error) std::rethrow_exception(error);
}

}  // namespace lamella::test
