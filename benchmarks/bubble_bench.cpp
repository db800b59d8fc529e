// The bubble solver at the sizes that matter: whole steps with everything in them (lists, removal, error control).

#include <benchmark/benchmark.h>

#include "lamella/core/parallel.h"
#include "lamella/solvers/bubble/bubble_solver.h"
#include "lamella/solvers/bubble/rates.h"

namespace {

using namespace lamella;
using namespace lamella::bubble;

/// A foam that has relaxed loosely and coarsened for a moment: the state that a long run spends its time in.
template <int D>
std::unique_ptr<BubbleSolver<D>> foam(int count, Method method) {
    Options o;
    o.dimension = D;
    o.count = count;
    o.gas_fraction = D == 2 ? 0.95 : 0.75;
    o.start.force_tolerance = 0.05;
    o.integrator.method = method;
    if (method == Method::kAbm2) o.integrator.tolerance = 1e-5;
    sim::SolverInput input;
    input.seed = 4;
    auto solver = std::make_unique<BubbleSolver<D>>(o, input);
    solver->start({});
    while (solver->time() < 0.05) solver->advance(0.05);
    return solver;
}

/// Arguments: bubbles, threads. Counts bubble-evaluations: live bubbles times evaluations of the right-hand side.
template <int D, Method kMethod>
void steps(benchmark::State& state) {
    ThreadLimit all(0);
    auto solver = foam<D>(static_cast<int>(state.range(0)), kMethod);
    ThreadLimit limit(static_cast<int>(state.range(1)));
    double work = 0.0;
    for (auto _ : state) {
        const auto report = solver->advance(1e9);
        work += static_cast<double>(report.evaluations) * static_cast<double>(solver->system().foam.live);
    }
    state.counters["bubble_evaluations"] = benchmark::Counter(work, benchmark::Counter::kIsRate);
}

/// One pass over the contacts alone, the kernel that the limit is computed for.
template <int D>
void contacts(benchmark::State& state) {
    ThreadLimit limit(1);
    auto solver = foam<D>(static_cast<int>(state.range(0)), Method::kRkc2);
    const System<D>& s = solver->system();
    dist::Alone alone;
    Domain domain(alone);
    Rates<D> rates;
    rates.resize(s.length());
    Stage<D> stage;
    stage.resize(s.length());
    for (std::size_t k = 0; k < D; ++k) stage.position[k] = s.foam.position[k];
    for (std::size_t i = 0; i < s.length(); ++i)
        set_radius<D>(s.model, s.foam.size[i], s.foam.alive(i), stage.radius[i], stage.inverse_radius[i]);
    for (auto _ : state)
        benchmark::DoNotOptimize(contact_pass<D>(s.model, s.foam.box, s.neighbors(), stage, Gas::kOn, Stiffness::kSkip,
                                                 domain, s.foam.live, rates));
    const auto bubbles = static_cast<double>(s.foam.live);
    state.counters["bubble_evaluations"] =
        benchmark::Counter(bubbles * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
    state.counters["list_entries"] = static_cast<double>(s.neighbors().index.size()) / bubbles;
}

/// Building the neighbor lists, per bubble.
template <int D>
void lists(benchmark::State& state) {
    ThreadLimit limit(1);
    auto solver = foam<D>(static_cast<int>(state.range(0)), Method::kRkc2);
    const System<D>& s = solver->system();
    std::vector<double> radius(s.foam.slots);
    for (std::size_t i = 0; i < radius.size(); ++i) radius[i] = Shape<D>::radius(s.foam.size[i]);
    for (auto _ : state)
        benchmark::DoNotOptimize(spatial::find_neighbors<D>(s.foam.box, pointers<D>(s.foam.position), radius.data(),
                                                            s.foam.id.data(), s.foam.slots, 0.3));
    state.counters["bubbles"] = benchmark::Counter(
        static_cast<double>(s.foam.slots) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK(contacts<2>)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(contacts<3>)->Arg(100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(lists<2>)->Arg(100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(lists<3>)->Arg(100'000)->Unit(benchmark::kMillisecond);
BENCHMARK(steps<2, Method::kRkc2>)
    ->ArgNames({"bubbles", "threads"})
    ->Args({10'000, 1})
    ->Args({100'000, 1})
    ->Args({100'000, 2})
    ->MinTime(5.0)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(steps<2, Method::kAbm2>)->Args({100'000, 1})->MinTime(3.0)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(steps<3, Method::kRkc2>)->Args({100'000, 1})->MinTime(3.0)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
