#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella::dist {

/// Bytes for another process; they must stay as they are until Communicator::end.
struct Outgoing {
    int to;
    std::span<const std::byte> bytes;
};

/// Room for what another process sends.
struct Incoming {
    int from;
    std::span<std::byte> bytes;
};

/// The processes that compute one simulation together; "rank" is a process's number among them, from 0.
///
/// Everything but rank(), size() and the clocks is collective: all processes call the same function in the same order.
/// What comes out of sum() and largest() is the same on all, so that decisions that rest on it are.
class Communicator {
public:
    virtual ~Communicator() = default;
    virtual int rank() const = 0;
    virtual int size() const = 0;
    bool several() const { return size() > 1; }

    /// Each of `sums` becomes its sum over all processes, each of `maxima` the largest; one that is not a number counts
    /// as infinite. Processes wait for each other here: what can be asked together should be.
    virtual void reduce(std::span<std::int64_t> sums, std::span<double> maxima) = 0;
    void sum(std::span<std::int64_t> values) { reduce(values, {}); }
    void largest(std::span<double> values) { reduce({}, values); }
    /// The bytes of process 0 reach all.
    virtual void broadcast(std::span<std::byte> bytes) = 0;
    /// Tells each process one number. @param to_each  one per process   @returns  what each process told this one
    virtual std::vector<std::int64_t> exchange(std::span<const std::int64_t> to_each) = 0;

    /// Messages to and from some of the others; at most one per pair of processes, whose ends agree on its length.
    /// What comes in is there after end(), and work can be done in between. Not for messages to oneself.
    virtual void begin(std::span<const Outgoing> outgoing, std::span<const Incoming> incoming) = 0;
    virtual void end() = 0;
    /// As end(), but what goes out may still be on its way: it must stay as it is until the next call of a function
    /// that all processes call, begin() among them. Who sends does not wait for who receives.
    virtual void receive() { end(); }

    /// Time that this process has spent in reduce, exchange, begin and end: moving data, and waiting for others [s].
    virtual double seconds() const { return 0.0; }
    /// A clock that stands while this process waits for others or moves data [s].
    virtual double work_clock() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count() - seconds();
    }

    /// Ends the other processes, and maybe this one: it met an error that they do not know of. Not collective.
    virtual void abort(int exit_code) = 0;
};

/// One process on its own.
class Alone final : public Communicator {
public:
    int rank() const override { return 0; }
    int size() const override { return 1; }
    void reduce(std::span<std::int64_t>, std::span<double>) override {}
    void broadcast(std::span<std::byte>) override {}
    std::vector<std::int64_t> exchange(std::span<const std::int64_t> to_each) override {
        return {to_each.begin(), to_each.end()};
    }
    void begin(std::span<const Outgoing>, std::span<const Incoming>) override {}
    void end() override {}
    void abort(int) override {}
};

}  // namespace lamella::dist
