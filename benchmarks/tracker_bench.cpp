// The surface tracker: one safe motion and one cycle of remeshing, on clusters near rest and in a stirring flow.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lamella/core/parallel.h"
#include "lamella/core/random.h"
#include "lamella/mesh/area.h"
#include "lamella/mesh/shapes/power_cluster.h"
#include "lamella/mesh/smoothing.h"
#include "lamella/mesh/tracker.h"
#include "lamella/mesh/vertex_area.h"

namespace {

using namespace lamella;
using namespace lamella::mesh;

enum Part { kMove, kRemesh, kBoth };
enum Flow { kRest, kStir };

/// Down the area gradient over lumped masses, and tangential smoothing.
IdVector<VertexId, Vec3> shrinking(const FoamMesh& mesh, double h) {
    const auto gradient = area_gradient(mesh);
    const auto areas = barycentric_areas(mesh);
    IdVector<VertexId, Vec3> d = tangential_smoothing(mesh, 0.15);
    for (const VertexId v : d.ids()) d[v] -= (0.1 * h * h / std::max(areas[v], 0.2 * h * h)) * gradient[v];
    return d;
}

/// A swirl of 0.1 h about the z axis that turns round with height, and noise of 0.05 h.
IdVector<VertexId, Vec3> stirring(const FoamMesh& mesh, double h, std::uint64_t step) {
    IdVector<VertexId, Vec3> d = tangential_smoothing(mesh, 0.15);
    for (const VertexId v : d.ids()) {
        const Vec3& x = mesh.position[v];
        const double turn = 0.1 * h * std::sin(2.0 * x[2]);
        const double r = std::hypot(x[0], x[1]) + h;
        d[v] += Vec3{{-turn * x[1] / r, turn * x[0] / r, 0.05 * h * std::sin(3.0 * x[0] + 1.0)}};
        const RandomBits bits = random_bits(7, RandomStream::kMeshJitter, step, index(v));
        d[v] += 0.05 * h * (2.0 * uniform_vector<3>(bits) - Vec3{{1.0, 1.0, 1.0}});
    }
    return d;
}

/// A cluster of equal bubbles with about this many vertices, shortly after its start.
Tracker cluster(int vertices) {
    constexpr double kEdge = 0.4;
    constexpr int kVerticesPerBubble = 80;
    const std::vector<double> radii(static_cast<std::size_t>(vertices / kVerticesPerBubble), 1.0);
    Tracker tracker(power_cluster(pack_balls(radii, 5), kEdge), {.edge_length = kEdge});
    for (int step = 0; step < 15; ++step) {
        tracker.move(shrinking(tracker.mesh(), kEdge));
        tracker.remesh();
    }
    return tracker;
}

/// Arguments: vertices wanted, threads.
template <Part kPart, Flow kFlow>
void tracker_step(benchmark::State& state) {
    ThreadLimit all(0);
    Tracker tracker = cluster(static_cast<int>(state.range(0)));
    ThreadLimit limit(static_cast<int>(state.range(1)));
    const double h = tracker.options().edge_length;
    std::uint64_t step = 0;
    for (auto _ : state) {
        state.PauseTiming();
        const auto d = kFlow == kRest ? shrinking(tracker.mesh(), h) : stirring(tracker.mesh(), h, step++);
        if (kPart != kRemesh) state.ResumeTiming();
        tracker.move(d);
        if (kPart == kMove) state.PauseTiming();
        if (kPart == kRemesh) state.ResumeTiming();
        tracker.remesh();
        if (kPart == kMove) state.ResumeTiming();
    }
    state.counters["vertices"] = static_cast<double>(tracker.mesh().position.size());
}

#define LAMELLA_TRACKER_BENCH(part, flow)                     \
    BENCHMARK_TEMPLATE(tracker_step, part, flow)              \
        ->Args({2000, 1})                                     \
        ->Args({20000, 1})                                    \
        ->Args({200000, 1})                                   \
        ->Iterations(10)                                      \
        ->MeasureProcessCPUTime()                             \
        ->Unit(benchmark::kMillisecond)
LAMELLA_TRACKER_BENCH(kMove, kRest);
LAMELLA_TRACKER_BENCH(kRemesh, kRest);
LAMELLA_TRACKER_BENCH(kBoth, kRest);
LAMELLA_TRACKER_BENCH(kBoth, kStir);

}  // namespace
