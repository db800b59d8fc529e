#include "lamella/solvers/vortex_sheet/flow.h"

#include "lamella/core/parallel.h"
#include "lamella/linalg/conjugate_gradient.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::vortex_sheet {

using mesh::FaceId;
using mesh::FoamMesh;
using mesh::VertexId;

std::vector<BlownRing> blown_rings(std::span<const film::Wire> wires, double time) {
    constexpr std::size_t kSides = 64;
    constexpr double kCore = 0.5;  // of the ring's radius
    std::vector<BlownRing> blown;
    for (const film::Wire& wire : wires) {
        if (!wire.ring || wire.ring->blow == 0.0 || time < wire.start || time > wire.end) continue;
        BlownRing ring{{}, {}, kCore * wire.ring->radius};
        const double circulation = 2.0 * wire.ring->radius * wire.ring->blow;
        const Vec3& axis = wire.ring->axis;
        const Vec3 side = std::abs(axis[0]) < 0.6 ? Vec3{{1, 0, 0}} : Vec3{{0, 1, 0}};
        const Vec3 u = cross(axis, side) / norm(cross(axis, side));
        const Vec3 v = cross(axis, u);
        const auto corner = [&](std::size_t k) {
            const double a = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(kSides);
            return wire.carried(wire.center + wire.ring->radius * (std::cos(a) * u + std::sin(a) * v), 0.0, time);
        };
        for (std::size_t k = 0; k < kSides; ++k) {
            const Vec3 a = corner(k), b = corner(k + 1);
            ring.center.push_back(0.5 * (a + b));
            ring.strength.push_back(circulation * (b - a));
        }
        blown.push_back(std::move(ring));
    }
    return blown;
}

double Flow::energy() const {
    return 0.5 * parallel_sum(strength.size(), [&](std::size_t f) { return dot(strength[f], potential[f]); });
}

Flow flow_at(const FoamMesh& mesh,
             const SheetTopology& topology,
             const SheetGeometry& geometry,
             const Circulation& phi,
             std::span<const BlownRing> blown,
             const spatial::VortexSumOptions& sum,
             const LooseSheets& loose) {
    Flow flow;
    flow.strength = face_strengths(mesh, topology, phi);
    std::vector<Vec3> with_loose;
    if (!loose.empty()) {
        with_loose = loose.barycenters();
        with_loose.insert(with_loose.begin(), geometry.barycenter.begin(), geometry.barycenter.end());
        const std::vector<Vec3> strength = loose.strengths();
        flow.strength.insert(flow.strength.end(), strength.begin(), strength.end());
    }
    const std::vector<Vec3>& center = loose.empty() ? geometry.barycenter : with_loose;
    spatial::VortexField field = spatial::vortex_sum(center, center, flow.strength, sum, true);
    flow.potential = field.potential;
    for (const BlownRing& ring : blown) {
        spatial::VortexSumOptions smooth = sum;
        smooth.delta = ring.core;
        smooth.kernel = spatial::VortexKernel::kPlummer;  // the others are of higher order on sheets only
        const spatial::VortexField jet = spatial::vortex_sum(center, ring.center, ring.strength, smooth, true);
        for (std::size_t f = 0; f < field.velocity.size(); ++f) {
            field.velocity[f] += jet.velocity[f];
            field.potential[f] += jet.potential[f];
        }
    }
    flow.flux = fluxes(mesh, topology, field.potential);
    flow.velocity = vertex_velocity(topology, geometry, field.velocity, flow.flux);
    flow.loose_velocity = loose.mean_at_vertices(field.velocity.data() + mesh.faces.size());
    return flow;
}

double meet_fluxes(const FoamMesh& mesh,
                   const SheetTopology& topology,
                   const SheetGeometry& geometry,
                   const FluxTarget& target,
                   std::span<const double> flux,
                   double tolerance,
                   const spatial::VortexSumOptions& sum,
                   Circulation& phi) {
    // The triangles that touch an entry in question.
    std::vector<std::uint8_t> in_target(topology.size(), 0);
    for (const std::uint32_t e : target.entry) in_target[e] = 1;
    std::vector<FaceId> faces;
    for (const FaceId f : mesh.faces.ids()) {
        const auto& corners = topology.entry[f];
        if (std::any_of(corners.begin(), corners.end(),
                        [&](const auto& e) { return in_target[e[0]] + in_target[e[1]] > 0; }))
            faces.push_back(f);
    }
    std::vector<Vec3> center;
    for (const FaceId f : faces) center.push_back(geometry.barycenter[index(f)]);

    Circulation change(topology.size(), 0.0);
    std::vector<Vec3> strength(faces.size()), potential(mesh.faces.size());
    const auto apply = [&](const std::vector<double>& x, std::vector<double>& y) {
        for (std::size_t i = 0; i < x.size(); ++i) change[target.entry[i]] = x[i];
        const std::vector<Vec3> all = face_strengths(mesh, topology, change);
        for (std::size_t i = 0; i < faces.size(); ++i) strength[i] = all[index(faces[i])];
        const spatial::VortexField field = spatial::vortex_sum(center, center, strength, sum, true);
        for (std::size_t i = 0; i < faces.size(); ++i) potential[index(faces[i])] = field.potential[i];
        const std::vector<double> w = fluxes(mesh, topology, potential);
        y.resize(x.size());
        for (std::size_t i = 0; i < x.size(); ++i) y[i] = w[target.entry[i]];
    };
    std::vector<double> missing(target.entry.size()), x(target.entry.size(), 0.0);
    for (std::size_t i = 0; i < missing.size(); ++i) missing[i] = target.flux[i] - flux[target.entry[i]];
    constexpr int kMostIterations = 200;
    const linalg::IterativeSolution done =
        linalg::conjugate_gradient(apply, {}, missing, x, tolerance, kMostIterations);
    for (std::size_t i = 0; i < x.size(); ++i) phi[target.entry[i]] += x[i];
    return done.residual;
}

}  // namespace lamella::vortex_sheet
