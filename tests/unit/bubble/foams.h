#pragma once

// Small foams for tests.

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "lamella/core/error.h"
#include "lamella/sim/archive.h"
#include "lamella/solvers/bubble/bubble_solver.h"

namespace lamella::bubble::test {

struct Ball {
    double x, y, z, radius;
};

/// Options of a foam that is exactly what the test gives: no relaxation, gas off, plain time.
inline Options given_options(int dimension, double box) {
    Options o;
    o.dimension = dimension;
    o.end_count = 1;
    o.time_unit = TimeUnit::kMechanical;
    o.gas.exchange_rate = 0.0;
    o.start.packing = Packing::kFile;
    o.start.file = "given";
    o.start.file_box = {{box, box, box}};
    o.start.max_iterations = 0;
    return o;
}

template <int D>
std::unique_ptr<BubbleSolver<D>> make_solver(const Options& options, const std::vector<Ball>& balls = {}, std::uint64_t seed = 4) {
    sim::SolverInput input;
    input.seed = seed;
    input.read_table = [balls](const std::string&) {
        sim::NumberTable table{{"x", "y", "z", "radius"}, {}};
        for (const Ball& b : balls) table.rows.push_back({b.x, b.y, b.z, b.radius});
        return table;
    };
    return std::make_unique<BubbleSolver<D>>(options, input);
}

template <int D>
std::unique_ptr<BubbleSolver<D>> start_solver(const Options& options, const std::vector<Ball>& balls = {}, std::uint64_t seed = 4) {
    auto solver = make_solver<D>(options, balls, seed);
    solver->start({});
    return solver;
}

template <class S>
void run_to(S& solver, double time) {
    while (solver.time() < time && !solver.stop_reason()) solver.advance(time);
}

template <class S>
double scalar(const S& solver, const std::string& name) {
    for (const sim::Scalar& s : solver.scalars())
        if (s.name == name) return s.value;
    ADD_FAILURE() << "no scalar " << name;
    return std::nan("");
}

/// A state in memory.
class Memory : public sim::StateWriter, public sim::StateReader {
public:
    using sim::StateWriter::write;
    void write(std::string_view name, std::span<const double> v) override { put(name, v); }
    void write(std::string_view name, std::span<const std::int64_t> v) override { put(name, v); }
    void write(std::string_view name, std::span<const std::int32_t> v) override { put(name, v); }
    void read(std::string_view name, std::size_t n, std::vector<double>& v) override { take(name, n, v); }
    void read(std::string_view name, std::size_t n, std::vector<std::int64_t>& v) override { take(name, n, v); }
    void read(std::string_view name, std::size_t n, std::vector<std::int32_t>& v) override { take(name, n, v); }
    friend bool operator==(const Memory& a, const Memory& b) { return a.entries == b.entries; }

    std::map<std::string, std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::int32_t>>> entries;

private:
    template <class T>
    void put(std::string_view name, std::span<const T> v) {
        entries[std::string(name)] = std::vector<T>(v.begin(), v.end());
    }
    template <class T>
    void take(std::string_view name, std::size_t n, std::vector<T>& v) {
        const auto it = entries.find(std::string(name));
        if (it == entries.end()) throw InputError("missing " + std::string(name));
        const auto* stored = std::get_if<std::vector<T>>(&it->second);
        if (stored == nullptr || stored->size() != n) throw InputError("wrong size of " + std::string(name));
        v = *stored;
    }
};

template <class S>
Memory saved(const S& solver) {
    Memory memory;
    solver.save(memory);
    return memory;
}

/// A small coarsening foam with every default.
inline Options coarsening(int dimension, int count, double gas_fraction) {
    Options o;
    o.dimension = dimension;
    o.count = count;
    o.gas_fraction = gas_fraction;
    o.end_count = 1;
    o.start.force_tolerance = 1e-2;
    return o;
}

}  // namespace lamella::bubble::test
