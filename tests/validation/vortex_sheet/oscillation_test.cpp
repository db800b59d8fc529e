// A bubble oscillates at Lamb's frequency [Lamb32, art. 275], times the exact factor of the smoothed kernel.

#include "oscillation.h"

#include "lamella/mesh/shapes/wire_films.h"

#include <cstdio>

namespace lamella::vortex_sheet {
namespace {

using spatial::VortexKernel;

TEST(Oscillation, HasLambsFrequencyTimesTheFactorOfTheKernel) {
    const double edge = 0.151;
    struct Case {
        VortexKernel kernel;
        int l;
    };
    // Measured over predicted: plummer 0.9972, k2 0.9978, k3 0.9989, 0.9894, 0.9761.
    for (const Case& c : {Case{VortexKernel::kPlummer, 2}, Case{VortexKernel::kK2, 2}, Case{VortexKernel::kK3, 2},
                          Case{VortexKernel::kK3, 3}, Case{VortexKernel::kK3, 4}}) {
        std::size_t vertices = 0;
        const double omega = frequency(edge, c.l, plain(c.kernel), &vertices);
        const double wanted = predicted(c.kernel, edge, c.l);
        std::printf("%zu vertices l %d kernel %d: omega/Lamb %.4f predicted %.4f\n", vertices, c.l,
                    static_cast<int>(c.kernel), omega / lamb(c.l), wanted);
        EXPECT_EQ(vertices, 642U);
        EXPECT_NEAR(omega / lamb(c.l) / wanted, 1.0, mesh_error(c.l, edge));
    }
}

TEST(Oscillation, ConvergesWithTheKernelsOrder) {
    // From 162 to 642 vertices the error of omega against Lamb's falls as h, h^2 and h^3; with k3 the triangles' h^2 shows.
    for (const auto& [kernel, least, most] : {std::tuple{VortexKernel::kPlummer, 0.8, 1.2}, {VortexKernel::kK2, 1.6, 2.3},
                                              {VortexKernel::kK3, 1.8, 3.3}}) {
        const double coarse = 1.0 - frequency(0.302, 2, plain(kernel)) / lamb(2);
        const double fine = 1.0 - frequency(0.151, 2, plain(kernel)) / lamb(2);
        const double order = std::log2(coarse / fine);
        std::printf("kernel %d: errors %.4f %.4f order %.2f\n", static_cast<int>(kernel), coarse, fine, order);
        EXPECT_GT(order, least);
        EXPECT_LT(order, most);
    }
}

TEST(Oscillation, OfAFlatFilmOnARingHasItsFrequency) {
    // 3.423393 sqrt(sigma / (rho a^3)), the spectral solution for a film of two surfaces on a ring in free air.
    const double edge = 0.068;
    mesh::FoamMesh disk = mesh::disk({}, {{0, 0, 1}}, 1.0, edge);
    for (const mesh::VertexId v : disk.position.ids())
        if (disk.on_wire[v] == 0) disk.position[v][2] = 0.01 * (1.0 - squared_norm(disk.position[v]));
    const auto solver = started(unit_problem(disk, edge), plain(VortexKernel::kK3));
    const auto lift = [&] {
        double sum = 0.0;
        for (const mesh::FaceId f : solver->mesh().faces.ids()) {
            const Vec3 a = solver->mesh().corner(f, 0), b = solver->mesh().corner(f, 1), c = solver->mesh().corner(f, 2);
            sum += std::abs(cross(b - a, c - a)[2]) * (a[2] + b[2] + c[2]);
        }
        return sum;
    };
    const double omega = 2.0 * 3.14159265358979323846 / period(*solver, lift);
    std::printf("disk, %zu vertices: omega %.4f, over exact %.4f\n", solver->mesh().position.size(), omega, omega / 3.423393);
    EXPECT_NEAR(omega / 3.423393, 1.0, 0.01);
}

}  // namespace
}  // namespace lamella::vortex_sheet
