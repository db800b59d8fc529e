// Whole steps of vortex sheets with remeshing: what a run spends its time in, but for its output.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "lamella/core/parallel.h"
#include "lamella/mesh/shapes/cube.h"
#include "lamella/mesh/shapes/power_cluster.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

namespace {

using namespace lamella;
using namespace lamella::vortex_sheet;

enum Shape { kCube, kDoubleBubble };

/// The paper's cube (corners 1 from the center) or two touching bubbles of radius 1, tension and density 1.
mesh::FoamMesh films_of(Shape shape, double edge) {
    if (shape == kCube) return mesh::cube_bubble({}, 2.0 / std::sqrt(3.0), edge);
    mesh::FoamMesh bubbles = mesh::power_cluster({{{{-0.924, 0, 0}}, 1.0}, {{{0.924, 0, 0}}, 1.0}}, edge);
    for (const mesh::RegionId r : bubbles.regions.ids())
        if (bubbles.regions[r].kind == mesh::RegionKind::kClosed) bubbles.regions[r].target_volume = 4.0 / 3.0 * std::numbers::pi;
    return bubbles;
}

std::unique_ptr<VortexSheetSolver> started(Shape shape, double edge) {
    auto films = std::make_shared<film::Problem>();
    films->material.surface_tension = 1.0;
    films->material.air_density = 1.0;
    films->edge_length = edge;
    films->mesh = films_of(shape, edge);
    films->velocity.assign(films->mesh.regions.size(), {});
    sim::SolverInput input;
    input.films = films;
    auto solver = std::make_unique<VortexSheetSolver>(Options{}, input);
    solver->start({});
    return solver;
}

/// Arguments: edge length in 1e-4, threads. The first steps, in which sharp edges become round, are not timed.
template <Shape shape>
void sheet_step(benchmark::State& state) {
    constexpr int kFirst = 10;
    ThreadLimit all(0);
    const auto solver = started(shape, 1e-4 * static_cast<double>(state.range(0)));
    for (int i = 0; i < kFirst; ++i) solver->advance(1e9);
    ThreadLimit limit(static_cast<int>(state.range(1)));
    for (auto _ : state) solver->advance(1e9);
    state.counters["vertices"] = static_cast<double>(solver->mesh().position.size());
}

BENCHMARK(sheet_step<kCube>)
    ->Args({790, 1})
    ->Args({425, 1})
    ->Args({425, 2})
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK(sheet_step<kDoubleBubble>)->Args({1500, 1})->Iterations(60)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(sheet_step<kCube>)
    ->Args({224, 1})
    ->Args({224, 2})
    ->Args({112, 1})
    ->Args({71, 1})
    ->Args({71, 2})
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
