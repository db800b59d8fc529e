#include "lamella/solvers/vortex_sheet/film_laplacian.h"

#include "films.h"

#include <gtest/gtest.h>

namespace lamella::vortex_sheet {
namespace {

using mesh::RegionId;
using mesh::VertexId;

double product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

TEST(FilmLaplacian, IsSymmetricAndPositive) {
    for (const auto& [name, mesh] : films_of_every_kind()) {
        const SheetTopology topology = sheet_topology(mesh);
        const FilmLaplacian laplacian(mesh, topology);
        const std::vector<double> x = random_values(1, topology.size()), y = random_values(2, topology.size());
        std::vector<double> kx, ky;
        laplacian.multiply(x, kx);
        laplacian.multiply(y, ky);
        EXPECT_NEAR(product(y, kx), product(x, ky), 1e-12 * product(x, kx)) << name;
        EXPECT_GT(product(x, kx), 0.0) << name;
    }
}

TEST(FilmLaplacian, DoesNotSeeConstantsOfRegionsNorOfVertices) {
    for (const auto& [name, mesh] : films_of_every_kind()) {
        const SheetTopology topology = sheet_topology(mesh);
        const FilmLaplacian laplacian(mesh, topology);
        std::vector<double> phi(topology.size()), image;
        for (const VertexId v : mesh.position.ids())
            for (std::size_t i = topology.first(v); i < topology.last(v); ++i)
                phi[i] = 3.0 * static_cast<double>(index(topology.entries.region[i])) + random_number(3, index(v));
        laplacian.multiply(phi, image);
        for (std::size_t i = 0; i < image.size(); ++i) EXPECT_NEAR(image[i], 0.0, 1e-12 * (1.0 + laplacian.diagonal()[i])) << name;
    }
}

TEST(FilmLaplacian, KeepsTheSumOverTheRegionsOfAVertex) {
    const mesh::FoamMesh mesh = mesh::quadruple_bubble(1.0, 0.3);
    const SheetTopology topology = sheet_topology(mesh);
    std::vector<double> image;
    FilmLaplacian(mesh, topology).multiply(random_values(4, topology.size()), image);
    for (const VertexId v : mesh.position.ids()) {
        double sum = 0.0;
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i) sum += image[i];
        EXPECT_NEAR(sum, 0.0, 1e-12);
    }
}

TEST(Diffuse, DecaysAModeOfASphereAtItsRate) {
    // d Gamma / dt = nu Laplacian(Gamma): e^(-nu l (l + 1) t / R^2), here one implicit step 1 / (1 + ...).
    const double radius = 1.5, viscosity = 0.02, dt = 0.3;
    std::vector<double> errors;
    for (const double edge : {0.6, 0.3, 0.15}) {
        const mesh::FoamMesh mesh = mesh::spheres({{Vec3{}, radius}}, edge);
        const SheetTopology topology = sheet_topology(mesh);
        Circulation phi(topology.size());
        for (const VertexId v : mesh.position.ids()) {
            const double value = legendre(2, mesh.position[v][0] / radius);
            phi[*topology.entries.find(v, RegionId{1})] = -0.5 * value;
            phi[*topology.entries.find(v, mesh::kOutside)] = 0.5 * value;
        }
        const Circulation before = phi;
        diffuse(FilmLaplacian(mesh, topology), viscosity, dt, phi);
        const double kept = product(phi, before) / product(before, before);
        errors.push_back((1.0 / kept - 1.0) / (viscosity * dt * 6.0 / (radius * radius)) - 1.0);
    }
    EXPECT_LT(std::abs(errors[2]), 0.005);
    EXPECT_LT(std::abs(errors[1]), 0.35 * std::abs(errors[0]));  // second order
    EXPECT_LT(std::abs(errors[2]), 0.35 * std::abs(errors[1]));
}

TEST(Smoothing, OfEveryKindLowersTheRoughness) {
    for (const auto& [name, mesh] : films_of_every_kind()) {
        const SheetTopology topology = sheet_topology(mesh);
        const FilmLaplacian laplacian(mesh, topology);
        const Circulation start = random_values(5, topology.size());
        const auto roughness = [&](const Circulation& phi) {
            std::vector<double> image;
            laplacian.multiply(phi, image);
            return product(phi, image);
        };
        Circulation diffused = start, filtered = start, evened = start;
        diffuse(laplacian, 0.01, 0.1, diffused);
        filter_grid_noise(laplacian, 0.5, filtered);
        std::vector<std::uint32_t> all;
        for (std::uint32_t i = 0; i < start.size(); i += 2) all.push_back(i);
        even_out(laplacian, all, 3, evened);
        EXPECT_LT(roughness(diffused), roughness(start)) << name;
        EXPECT_LT(roughness(filtered), roughness(start)) << name;
        EXPECT_LT(roughness(evened), roughness(start)) << name;
        for (std::size_t i = 1; i < start.size(); i += 2) EXPECT_EQ(evened[i], start[i]);
    }
}

TEST(Smoothing, LeavesTheRimOfAFilmAlone) {
    const mesh::FoamMesh mesh = mesh::disk({}, {{0, 0, 1}}, 1.0, 0.2);
    const SheetTopology topology = sheet_topology(mesh);
    const FilmLaplacian laplacian(mesh, topology);
    Circulation phi = random_values(6, topology.size());
    const Circulation start = phi;
    diffuse(laplacian, 1.0, 1.0, phi);
    filter_grid_noise(laplacian, 0.5, phi);
    for (const VertexId v : mesh.position.ids())
        for (std::size_t i = topology.first(v); i < topology.last(v) && topology.hold[v] == Hold::kRim; ++i)
            EXPECT_NEAR(phi[i], start[i], 1e-9);
}

TEST(GridFilter, LeavesLongWavesNextToUntouched) {
    const mesh::FoamMesh mesh = mesh::spheres({{Vec3{}, 1.0}}, 0.15);
    const SheetTopology topology = sheet_topology(mesh);
    Circulation phi(topology.size(), 0.0);
    for (const VertexId v : mesh.position.ids()) phi[*topology.entries.find(v, RegionId{1})] = legendre(2, mesh.position[v][0]);
    fix_gauge(topology, phi);
    const Circulation before = phi;
    filter_grid_noise(FilmLaplacian(mesh, topology), 1.0, phi);
    // (k h / pi)^4 with k^2 = 6 and h = 0.15 is 2e-4, somewhat more where the diagonal is smaller (7.4e-4 measured)
    EXPECT_NEAR(product(phi, before) / product(before, before), 1.0, 1e-3);
}

}  // namespace
}  // namespace lamella::vortex_sheet
