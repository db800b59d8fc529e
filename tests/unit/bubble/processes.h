// One foam on several processes has the bits of the foam on one. Processes are threads here, and MPI's in app.clusters.

#include "lamella/core/parallel.h"
#include "lamella/dist/gather.h"
#include "lamella/measure/measure.h"

#include <gtest/gtest.h>

#include "../dist/process_team.h"
#include "foams.h"

namespace lamella::bubble::test {

using lamella::test::as_processes;
using Processes = std::shared_ptr<dist::Communicator>;

/// Gathers what the processes save, and shares out what they load.
class SharedMemory : public sim::StateWriter, public sim::StateReader {
public:
    SharedMemory(dist::Communicator& processes, Memory& memory) : processes_(processes), memory_(memory) {}

    void write(std::string_view name, std::span<const double> v) override { put(name, v); }
    void write(std::string_view name, std::span<const std::int64_t> v) override { put(name, v); }
    void write(std::string_view name, std::span<const std::int32_t> v) override { put(name, v); }
    void write_part(std::string_view name, std::span<const double> v, sim::Part p) override { put_part(name, v, p); }
    void write_part(std::string_view name, std::span<const std::int64_t> v, sim::Part p) override {
        put_part(name, v, p);
    }
    void write_part(std::string_view name, std::span<const std::int32_t> v, sim::Part p) override {
        put_part(name, v, p);
    }
    void read(std::string_view name, std::size_t n, std::vector<double>& v) override { memory_.read(name, n, v); }
    void read(std::string_view name, std::size_t n, std::vector<std::int64_t>& v) override { memory_.read(name, n, v); }
    void read(std::string_view name, std::size_t n, std::vector<std::int32_t>& v) override { memory_.read(name, n, v); }
    void read_part(std::string_view name, std::size_t n, std::vector<double>& v) override { take(name, n, v); }
    void read_part(std::string_view name, std::size_t n, std::vector<std::int64_t>& v) override { take(name, n, v); }
    void read_part(std::string_view name, std::size_t n, std::vector<std::int32_t>& v) override { take(name, n, v); }

private:
    template <class T>
    void put(std::string_view name, std::span<const T> v) {
        if (processes_.rank() == 0) memory_.write(name, v);
    }
    template <class T>
    void put_part(std::string_view name, std::span<const T> v, sim::Part part) {
        const std::vector<T> all = dist::gather(processes_, v);
        if (processes_.rank() != 0) return;
        EXPECT_EQ(static_cast<std::int64_t>(all.size()), part.total);
        memory_.write(name, std::span<const T>(all));
    }
    template <class T>
    void take(std::string_view name, std::size_t n, std::vector<T>& v) {
        memory_.read(name, n, v);
        const dist::Share share = dist::share_of(static_cast<std::int64_t>(n), processes_);
        v.erase(v.begin() + share.first + share.count, v.end());
        v.erase(v.begin(), v.begin() + share.first);
    }

    dist::Communicator& processes_;
    Memory& memory_;
};

template <int D>
std::unique_ptr<BubbleSolver<D>> make_share(const Options& options,
                                            const Processes& processes,
                                            const std::vector<Ball>& balls = {},
                                            Device device = Device::kCpu) {
    sim::SolverInput input;
    input.device = device;
    input.seed = 4;
    input.processes = processes;
    input.read_table = [&balls](const std::string&) {
        sim::NumberTable table{{"x", "y", "z", "radius"}, {}};
        for (const Ball& b : balls) table.rows.push_back({b.x, b.y, b.z, b.radius});
        return table;
    };
    return std::make_unique<BubbleSolver<D>>(options, input);
}

struct Outcome {
    Memory state;
    std::vector<sim::Event> events;
    std::map<std::string, double> scalars;
    std::vector<double> frame;  ///< radii and all fields
    std::map<std::string, double> measures;
};

template <int D>
void look(const BubbleSolver<D>& solver, dist::Communicator& processes, Outcome& outcome) {
    SharedMemory memory(processes, outcome.state);
    solver.save(memory);
    const std::vector<sim::Scalar> scalars = solver.scalars();
    const sim::Frame frame = solver.frame();
    std::vector<double> values;
    const auto append = [&](std::span<const double> part) {
        const auto all = dist::gather(processes, part);
        values.insert(values.end(), all.begin(), all.end());
    };
    append(frame.points.radius);
    for (const sim::Field& field : frame.points.fields) append(field.values);
    const std::vector<sim::Scalar> measures = measure::measure_frame(frame, processes);
    if (processes.rank() != 0) return;
    outcome.frame = values;
    for (const sim::Scalar& s : measures) outcome.measures[s.name] = s.value;
    for (const sim::Scalar& s : scalars) outcome.scalars[s.name] = s.value;
}

/// @param steps  for a device a multiple of those that it takes at once
template <class S>
void take_steps(S& solver, std::int64_t steps) {
    const std::int64_t end = solver.step() + steps;
    while (solver.step() < end && !solver.stop_reason()) solver.advance(1e9);
}

/// A foam after `steps` steps on several processes.
template <int D>
Outcome run_shared(const Options& options,
                   int steps,
                   int processes,
                   const std::vector<Ball>& balls = {},
                   Device device = Device::kCpu) {
    Outcome outcome;
    as_processes(processes, [&](const Processes& all) {
        auto solver = make_share<D>(options, all, balls, device);
        solver->start({});
        take_steps(*solver, steps);
        look(*solver, *all, outcome);
        auto events = solver->take_events();
        if (all->rank() == 0) outcome.events = std::move(events);
    });
    return outcome;
}

inline void expect_same(const Outcome& shared, const Outcome& alone) {
    EXPECT_EQ(shared.state, alone.state);
    EXPECT_EQ(shared.scalars, alone.scalars);
    EXPECT_EQ(shared.frame, alone.frame);
    EXPECT_EQ(shared.measures, alone.measures);
    ASSERT_EQ(shared.events.size(), alone.events.size());
    for (std::size_t k = 0; k < alone.events.size(); ++k) {
        EXPECT_EQ(shared.events[k].detail, alone.events[k].detail);
        EXPECT_EQ(shared.events[k].position, alone.events[k].position);
    }
    const auto& ids = std::get<std::vector<std::int64_t>>(shared.state.entries.at("foam/id"));
    const auto& start = std::get<std::vector<std::int64_t>>(shared.state.entries.at("start_count"));
    EXPECT_EQ(static_cast<std::int64_t>(ids.size() + shared.events.size()), start[0]) << "live and dead are all";
}

/// So many processes have the foam of one process on the CPU.
template <int D>
void expect_same_on(const std::vector<int>& numbers,
                    const Options& options,
                    int steps,
                    const std::vector<Ball>& balls = {},
                    Device device = Device::kCpu) {
    ThreadLimit one(1);
    const Outcome alone = run_shared<D>(options, steps, 1, balls);
    EXPECT_FALSE(alone.events.empty());
    EXPECT_EQ(static_cast<double>(alone.scalars.at("steps")), steps);
    EXPECT_LT(std::abs(alone.scalars.at("volume_error")), 1e-14);
    for (const int processes : numbers) {
        SCOPED_TRACE(processes);
        expect_same(run_shared<D>(options, steps, processes, balls, device), alone);
    }
}

/// Discs in the left half of a box.
inline std::vector<Ball> discs_beside_a_void(int rows) {
    std::vector<Ball> balls;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < rows / 2; ++x) {
            const double shift = 0.3 * std::sin(12.9898 * x + 78.233 * y);
            balls.push_back({1.9 * x + 0.9 * (y % 2) + 0.5, 1.7 * y + shift + 0.5, 0.0, 1.0 + 0.3 * shift});
        }
    return balls;
}

}  // namespace lamella::bubble::test
