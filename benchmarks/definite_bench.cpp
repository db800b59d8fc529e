// The stiff equations of films on a sphere: new values of the matrix, and a solution with them, by Cholesky factors and
// by multigrid.

#include "lamella/linalg/definite_solver.h"
#include "lamella/mesh/shapes/sphere.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

namespace {

using namespace lamella;
using namespace lamella::linalg;

/// The Poisson equation of a film as of flat triangles of equal sides; the first vertex has value 0.
/// @param sides  into so many parts each edge of an icosahedron is divided: 10 sides^2 + 2 vertices
SymmetricMatrix poisson(int sides) {
    const mesh::FoamMesh sphere = mesh::spheres({{Vec3{}, 1.0}}, 1.206 / sides);
    Groups triangles;
    for (const mesh::Face& face : sphere.faces) {
        for (const mesh::VertexId v : face.vertices)
            if (index(v) > 0) triangles.member.push_back(static_cast<int>(index(v)) - 1);
        triangles.close_group();
    }
    SymmetricMatrix matrix = coupled(sphere.position.size() - 1, triangles);
    const double half_cotangent = 0.5 / std::sqrt(3.0);
    for (const mesh::Face& face : sphere.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const int i = static_cast<int>(index(face.vertices[k])) - 1;
            const int j = static_cast<int>(index(face.vertices[(k + 1) % 3])) - 1;
            if (i >= 0) matrix.diagonal(static_cast<std::size_t>(i)) += half_cotangent;
            if (j >= 0) matrix.diagonal(static_cast<std::size_t>(j)) += half_cotangent;
            if (i >= 0 && j >= 0) matrix.value[matrix.slot(i, j)] -= half_cotangent;
        }
    return matrix;
}

DefiniteMethod method_of(const benchmark::State& state) {
    return state.range(1) == 0 ? DefiniteMethod::kFactors : DefiniteMethod::kMultigrid;
}

void definite_factorize(benchmark::State& state) {
    const SymmetricMatrix matrix = poisson(static_cast<int>(state.range(0)));
    DefiniteSolver solver(method_of(state));
    solver.analyze(matrix);
    for (auto _ : state) benchmark::DoNotOptimize(solver.factorize(matrix));
    state.counters["unknowns"] = static_cast<double>(matrix.size());
}

void definite_solve(benchmark::State& state) {
    const SymmetricMatrix matrix = poisson(static_cast<int>(state.range(0)));
    DefiniteSolver solver(method_of(state));
    solver.analyze(matrix);
    solver.factorize(matrix);
    std::vector<double> b(matrix.size());
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::sin(0.37 * static_cast<double>(i));
    for (auto _ : state) {
        std::vector<double> x = b;
        solver.solve(x);
        benchmark::DoNotOptimize(x.data());
    }
    state.counters["unknowns"] = static_cast<double>(matrix.size());
}

/// Arguments: parts of each edge of the icosahedron; 0 for factors, 1 for multigrid.
void sizes(benchmark::internal::Benchmark* bench) {
    for (const int sides : {32, 64, 128, 256})
        for (const int method : {0, 1})
            if (method == 0 || has_multigrid()) bench->Args({sides, method});
    bench->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
}
BENCHMARK(definite_factorize)->Apply(sizes);
BENCHMARK(definite_solve)->Apply(sizes);

}  // namespace
