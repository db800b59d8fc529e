#include "lamella/solvers/vortex_sheet/flow.h"

#include <gtest/gtest.h>

#include "films.h"

namespace lamella::vortex_sheet {
namespace {

using mesh::FaceId;
using mesh::VertexId;

TEST(FaceStrengths, SumToZeroOnClosedFilms) {
    for (const auto& [name, mesh] : films_of_every_kind()) {
        if (name == "disk") continue;  // open
        const SheetTopology topology = sheet_topology(mesh);
        Vec3 sum;
        double size = 0.0;
        for (const Vec3& g : face_strengths(mesh, topology, random_values(2, topology.size()))) {
            sum += g;
            size += norm(g);
        }
        EXPECT_LT(norm(sum), 1e-14 * size) << name;
    }
}

TEST(FaceStrengths, VanishOnAFilmThatEndsWithoutCirculation) {
    // The vortex lines of a disk close within it when the circulation is zero at its rim.
    const auto mesh = films_of_every_kind().back().mesh;
    const SheetTopology topology = sheet_topology(mesh);
    Circulation phi = random_values(2, topology.size());
    for (const VertexId v : mesh.position.ids())
        if (topology.hold[v] == Hold::kRim)
            for (std::size_t i = topology.first(v); i < topology.last(v); ++i) phi[i] = 0.0;
    Vec3 sum;
    double size = 0.0;
    for (const Vec3& g : face_strengths(mesh, topology, phi)) {
        sum += g;
        size += norm(g);
    }
    EXPECT_LT(norm(sum), 1e-14 * size);
}

TEST(FaceStrengths, DoNotSeeAConstantOfARegionOnAClosedFilmNorOneOfAVertex) {
    for (const auto& [name, mesh] : films_of_every_kind()) {
        const SheetTopology topology = sheet_topology(mesh);
        Circulation phi = random_values(2, topology.size());
        const std::vector<Vec3> before = face_strengths(mesh, topology, phi);
        for (const VertexId v : mesh.position.ids())
            for (std::size_t i = topology.first(v); i < topology.last(v); ++i)
                phi[i] += random_number(3, index(v)) + (topology.entries.region[i] == mesh::RegionId{1} ? 5.0 : 0.0);
        const std::vector<Vec3> after = face_strengths(mesh, topology, phi);
        for (std::size_t f = 0; f < before.size(); ++f) EXPECT_LT(norm(after[f] - before[f]), 1e-13) << name;
    }
}

TEST(FaceStrengths, AreThoseOfALinearJump) {
    // On the flat disk, normal z, with Gamma = x: the sheet strength n x grad(Gamma) is y everywhere.
    const mesh::FoamMesh mesh = mesh::disk({}, {{0, 0, 1}}, 1.0, 0.2);
    const SheetTopology topology = sheet_topology(mesh);
    Circulation phi(topology.size(), 0.0);
    for (const VertexId v : mesh.position.ids())
        phi[*topology.entries.find(v, mesh.faces[FaceId{0}].front)] = mesh.position[v][0];
    const SheetGeometry geometry = sheet_geometry(mesh, topology);
    const std::vector<Vec3> strength = face_strengths(mesh, topology, phi);
    for (std::size_t f = 0; f < strength.size(); ++f) {
        const Vec3& a = geometry.area_vector[f];
        EXPECT_LT(norm(strength[f] - cross(a, Vec3{{1, 0, 0}})), 1e-15);
    }
}

TEST(Fluxes, OfARegionSumToZero) {
    for (const auto& [name, mesh] : films_of_every_kind()) {
        const SheetTopology topology = sheet_topology(mesh);
        std::vector<Vec3> potential(mesh.faces.size());
        for (std::size_t f = 0; f < potential.size(); ++f) potential[f] = random_vector(4, f);
        const std::vector<double> flux = fluxes(mesh, topology, potential);
        std::vector<double> of_region(mesh.regions.size(), 0.0);
        double size = 0.0;
        for (std::size_t i = 0; i < flux.size(); ++i) {
            of_region[index(topology.entries.region[i])] += flux[i];
            size += std::abs(flux[i]);
        }
        for (const double sum : of_region) EXPECT_LT(std::abs(sum), 1e-14 * size) << name;
    }
}

TEST(Fluxes, AreTheTransposeOfTheStrengths) {
    // sum phi_i w_i(A) = sum G_f(phi) . A_f for any phi and A.
    for (const auto& [name, mesh] : films_of_every_kind()) {
        const SheetTopology topology = sheet_topology(mesh);
        const Circulation phi = random_values(5, topology.size());
        std::vector<Vec3> potential(mesh.faces.size());
        for (std::size_t f = 0; f < potential.size(); ++f) potential[f] = random_vector(6, f);
        const std::vector<double> flux = fluxes(mesh, topology, potential);
        const std::vector<Vec3> strength = face_strengths(mesh, topology, phi);
        double left = 0.0, right = 0.0, size = 0.0;
        for (std::size_t i = 0; i < phi.size(); ++i) left += phi[i] * flux[i];
        for (std::size_t f = 0; f < strength.size(); ++f) {
            right += dot(strength[f], potential[f]);
            size += norm(strength[f]) * norm(potential[f]);
        }
        EXPECT_LT(std::abs(left - right), 1e-14 * size) << name;
        EXPECT_GT(std::abs(left), 1e-6 * size) << name;  // the identity is not one of zeros
    }
}

TEST(VertexVelocity, CarriesThePrescribedFluxesAndIsTheTransposeOfTheFilmPressures) {
    // For any flux w of the kind that occurs and any force g: N . u = w, and sum g . u = sum p(g) w.
    for (const auto& [name, mesh] : films_of_every_kind()) {
        const SheetTopology topology = sheet_topology(mesh);
        const SheetGeometry geometry = sheet_geometry(mesh, topology);
        std::vector<Vec3> potential(mesh.faces.size()), drift(mesh.faces.size());
        for (std::size_t f = 0; f < potential.size(); ++f)
            potential[f] = random_vector(7, f), drift[f] = random_vector(8, f);
        const std::vector<double> flux = fluxes(mesh, topology, potential);

        const auto carried = vertex_velocity(topology, geometry, drift, flux);
        double worst = 0.0, largest = 0.0;
        for (const VertexId v : mesh.position.ids())
            for (std::size_t i = topology.first(v); i < topology.last(v) && topology.hold[v] != Hold::kRim; ++i) {
                worst = std::max(worst, std::abs(dot(geometry.outward[i], carried[v]) - flux[i]));
                largest = std::max(largest, std::abs(flux[i]));
            }
        EXPECT_LT(worst, 1e-11 * largest) << name;

        IdVector<VertexId, Vec3> force(mesh.position.size());
        for (const VertexId v : force.ids())  // a rim goes with its wire, whatever pulls at it
            if (topology.hold[v] != Hold::kRim) force[v] = random_vector(9, index(v));
        const std::vector<double> pressure = film_pressures(topology, geometry, force);
        const auto along = vertex_velocity(topology, geometry, std::vector<Vec3>(mesh.faces.size()), flux);
        double left = 0.0, right = 0.0, size = 0.0;
        for (const VertexId v : force.ids()) {
            left += dot(force[v], along[v]);
            size += norm(force[v]) * norm(along[v]);
        }
        for (std::size_t i = 0; i < flux.size(); ++i) right += pressure[i] * flux[i];
        EXPECT_LT(std::abs(left - right), 1e-12 * size) << name;
        EXPECT_GT(std::abs(left), 1e-6 * size) << name;
    }
}

TEST(CarryFluxesAllTheWay, KeepsVolumesOverLongSteps) {
    // A smooth flow, by its potential; vertices go up to a fifth of an edge.
    for (const auto& [name, mesh] : films_of_every_kind()) {
        if (name == "disk") continue;  // no volume
        const SheetTopology topology = sheet_topology(mesh);
        SheetGeometry geometry = sheet_geometry(mesh, topology);
        std::vector<Vec3> potential, drift;
        for (const Vec3& c : geometry.barycenter) {
            potential.push_back({{std::sin(3.0 * c[1]), std::sin(3.0 * c[2]), std::sin(3.0 * c[0])}});
            drift.push_back(-3.0 * Vec3{{std::cos(3.0 * c[2]), std::cos(3.0 * c[0]), std::cos(3.0 * c[1])}});
        }
        const std::vector<double> flux = fluxes(mesh, topology, potential);
        constexpr double kStep = 0.015;
        const auto change = [&](const IdVector<VertexId, Vec3>& u) {
            mesh::FoamMesh moved = mesh;
            for (const VertexId v : u.ids()) moved.position[v] += kStep * u[v];
            const auto before = mesh::region_volumes(mesh), after = mesh::region_volumes(moved);
            double worst = 0.0;
            for (const mesh::RegionId r : before.ids()) worst = std::max(worst, std::abs(after[r] - before[r]));
            return worst;
        };
        auto velocity = vertex_velocity(topology, geometry, drift, flux);
        mesh::FoamMesh middle = mesh;
        for (const VertexId v : velocity.ids()) middle.position[v] += 0.5 * kStep * velocity[v];
        geometry = sheet_geometry(middle, topology);
        const double straight = change(velocity);
        carry_fluxes_all_the_way(mesh, topology, geometry, flux, kStep, velocity);
        std::printf("%-18s volume off by %.1e, corrected %.1e\n", name.c_str(), straight, change(velocity));
        EXPECT_LT(change(velocity), 0.1 * straight) << name;
    }
}

TEST(CarryFluxesAllTheWay, ChangesLittleWhereFilmsSnap) {
    // Neighbors that go several edges apart in one step: sweeps of the correction would lead to 1e100 and beyond.
    for (const auto& [name, mesh] : films_of_every_kind()) {
        const SheetTopology topology = sheet_topology(mesh);
        const SheetGeometry geometry = sheet_geometry(mesh, topology);
        const std::vector<double> flux = random_values(11, topology.size());
        IdVector<VertexId, Vec3> velocity(mesh.position.size());
        const std::vector<double> random = random_values(12, 3 * velocity.size());
        double fastest = 0.0;
        for (const VertexId v : velocity.ids()) {
            for (std::size_t k = 0; k < 3; ++k) velocity[v][k] = random[3 * index(v) + k];
            fastest = std::max(fastest, norm(velocity[v]));
        }
        const IdVector<VertexId, Vec3> before = velocity;
        carry_fluxes_all_the_way(mesh, topology, geometry, flux, 5.0, velocity);
        for (const VertexId v : velocity.ids()) ASSERT_LE(norm(velocity[v] - before[v]), 0.5 * fastest) << name;
    }
}

TEST(FilmPressures, OfABubbleAtRestAreFourSigmaOverR) {
    const double radius = 0.7, tension = 2.0;
    const mesh::FoamMesh mesh = mesh::spheres({{Vec3{}, radius}}, 0.1 * radius);
    const SheetTopology topology = sheet_topology(mesh);
    const SheetGeometry geometry = sheet_geometry(mesh, topology);
    IdVector<VertexId, Vec3> force = mesh::area_gradient(mesh);
    for (Vec3& f : force) f *= tension;
    const std::vector<double> pressure = film_pressures(topology, geometry, force);
    // Each vertex weighted with its cell. At the twelve vertices of five triangles the value itself is 15 % too large
    // on every mesh: curvature per vertex converges in the mean only.
    double sum = 0.0, weight = 0.0;
    for (const VertexId v : mesh.position.ids()) {
        const std::size_t inside = *topology.entries.find(v, mesh::RegionId{1});
        const double excess = pressure[inside] - pressure[*topology.entries.find(v, mesh::kOutside)];
        sum += norm(geometry.outward[inside]) * excess;
        weight += norm(geometry.outward[inside]);
        EXPECT_NEAR(excess, 2.0 * tension / radius, 0.2 * 2.0 * tension / radius);
    }
    EXPECT_NEAR(sum / weight, 2.0 * tension / radius, 0.01 * 2.0 * tension / radius);  // h^2 / R^2
}

TEST(FlowAt, HasTheEnergyOfItsCirculationsAndFluxes) {
    // G . A / 2 over faces = phi w / 2 over entries, and positive.
    for (const auto& [name, mesh] : films_of_every_kind()) {
        const SheetTopology topology = sheet_topology(mesh);
        const Circulation phi = random_values(10, topology.size());
        const Flow flow = flow_at(mesh, topology, sheet_geometry(mesh, topology), phi, {},
                                  {.kernel = spatial::VortexKernel::kK3, .delta = 0.3});
        double energy = 0.0;
        for (std::size_t i = 0; i < phi.size(); ++i) energy += 0.5 * phi[i] * flow.flux[i];
        EXPECT_GT(energy, 0.0) << name;
        EXPECT_NEAR(flow.energy(), energy, 1e-11 * energy) << name;
    }
}

TEST(MeetFluxes, FindsTheCirculationsOfAGivenMotion) {
    const mesh::FoamMesh mesh = mesh::spheres({{Vec3{}, 1.0}}, 0.3);
    const SheetTopology topology = sheet_topology(mesh);
    const SheetGeometry geometry = sheet_geometry(mesh, topology);
    const spatial::VortexSumOptions sum{.kernel = spatial::VortexKernel::kK3, .delta = 0.3};
    FluxTarget target;
    for (const VertexId v : mesh.position.ids())
        for (std::size_t i = topology.first(v); i < topology.last(v); ++i) {
            target.entry.push_back(static_cast<std::uint32_t>(i));
            target.flux.push_back(geometry.outward[i][0]);
        }
    Circulation phi(topology.size(), 0.0);
    const double left = meet_fluxes(mesh, topology, geometry, target, phi, 1e-6, sum, phi);
    EXPECT_LT(left, 1e-6);
    const Flow flow = flow_at(mesh, topology, geometry, phi, {}, sum);
    for (std::size_t i = 0; i < phi.size(); ++i) EXPECT_NEAR(flow.flux[i], target.flux[i], 1e-5);
}

}  // namespace
}  // namespace lamella::vortex_sheet
