// Bad starts: clusters at rest, stretched along x, pressed along y, sheared by a sine, and shaken, come to rest in fewer
// than 30 steps. Areas are a tenth to a fifth too large at the start, volumes a tenth.

#include "lamella/core/random.h"
#include "lamella/mesh/area.h"
#include "lamella/mesh/check.h"
#include "lamella/mesh/shapes/standard_clusters.h"
#include "lamella/solvers/equilibrium/relaxation.h"
#include "lamella/solvers/equilibrium/rest_answer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace lamella::equilibrium {
namespace {

struct Cluster {
    std::string name;
    mesh::FoamMesh mesh;
    double edge;
    double area;  ///< at rest, from the closed form
};

std::vector<Cluster> clusters() {
    const auto pair = [](const char* name, double second, double edge) {
        const mesh::DoubleBubble exact = mesh::double_bubble_of_volumes(1.0, second);
        return Cluster{name, mesh::double_bubble(exact, edge), edge, exact.area()};
    };
    const auto rested = [](const char* name, const mesh::FoamMesh& start, double edge, double area) {
        RelaxationOptions options;
        options.edge_length = edge;
        Relaxation relaxation(start, options);
        while (!relaxation.at_rest() && relaxation.steps() < 100) relaxation.advance();
        return Cluster{name, relaxation.mesh(), edge, area};
    };
    return {pair("double 1:1", 1.0, 0.145), pair("double 1:0.5", 0.5, 0.13), pair("double 1:0.125", 0.125, 0.11),
            rested("triple", mesh::triple_bubble(1.0, 0.18), 0.18, 13.1281682444334),
            rested("quadruple", mesh::quadruple_bubble(1.0, 0.21), 0.21, 16.8965576436161)};
}

/// x times `stretch`, y times `press`, x sheared by a sine of z, and every node moved by a tenth of an edge at random.
void warp(mesh::FoamMesh& mesh, double stretch, double press, double edge) {
    for (const mesh::VertexId v : mesh.position.ids()) {
        Vec3& x = mesh.position[v];
        x = Vec3{{stretch * x[0] + 0.1 * std::sin(3.0 * x[2]), press * x[1], x[2]}};
        for (std::uint64_t k = 0; k < 3; ++k)
            x[k] += 0.1 * edge * (2.0 * uniform01(random_bits(7, RandomStream::kAnneal, index(v), k)) - 1.0);
    }
}

TEST(WarpedStart, ComesToRestInFewerThanThirtySteps) {
    for (const auto& [stretch, press] : {std::pair{1.3, 0.85}, std::pair{1.6, 0.7}})
        for (const Cluster& c : clusters()) {
            mesh::FoamMesh mesh = c.mesh;
            warp(mesh, stretch, press, c.edge);
            const double start = mesh::total_area(mesh);
            RelaxationOptions options;
            options.edge_length = c.edge;
            Relaxation relaxation(mesh, options);
            while (!relaxation.at_rest() && relaxation.steps() < 100) relaxation.advance();
            const RestAnswer answer = rest_answer(relaxation.mesh(), {}, {.eigenvalue = false});
            const auto faces = static_cast<double>(relaxation.mesh().faces.size());
            std::printf("%-15s x %.1f: start area %+5.1f %%, F %5.0f, steps %3d, residual %.1e, area %+.1e\n",
                        c.name.c_str(), stretch, 100.0 * (start / c.area - 1.0), faces, relaxation.iterations(),
                        relaxation.residual(), answer.area / c.area - 1.0);
            ASSERT_TRUE(relaxation.at_rest()) << c.name << ' ' << stretch;
            EXPECT_LT(relaxation.iterations(), 30) << c.name << ' ' << stretch;
            EXPECT_LT(relaxation.residual(), 1e-8) << c.name << ' ' << stretch;
            EXPECT_NEAR(faces, 1000.0, 400.0) << c.name << ' ' << stretch;
            EXPECT_NEAR(answer.area / c.area, 1.0, 2e-6) << c.name << ' ' << stretch;
            EXPECT_TRUE(mesh::faults(relaxation.mesh()).empty()) << c.name << ' ' << stretch;
        }
}

}  // namespace
}  // namespace lamella::equilibrium
