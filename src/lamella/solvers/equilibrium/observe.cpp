// What can be seen of films at rest: the frame, its scalars, and the numbers that `lamella check` prints.

#include "lamella/mesh/area.h"
#include "lamella/mesh/edge_faces.h"
#include "lamella/mesh/quality.h"
#include "lamella/sim/film_surface.h"
#include "lamella/solvers/equilibrium/equilibrium_solver.h"
#include "lamella/solvers/equilibrium/rest_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella::equilibrium {
namespace {

using mesh::FoamMesh;
using mesh::RegionKind;

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

double worst_volume_error(const FoamMesh& mesh) {
    const RestSystem system(mesh, mesh::edge_faces(mesh), flat_patches(mesh, {}));
    const Balance balance = system.balance(false);
    double worst = 0.0;
    for (std::size_t c = 0; c < balance.missing.size(); ++c)
        worst = std::max(worst, std::abs(balance.missing[c]) / system.target(c));
    return worst;
}

}  // namespace

sim::Frame EquilibriumSolver::frame() const {
    const FoamMesh& mesh = relaxation_->mesh();
    sim::Frame frame;
    frame.solver = "equilibrium";
    frame.time = time_;
    frame.step = steps_;
    frame.surface = sim::film_surface(mesh);
    frame.box = sim::film_box(mesh);
    sim::Surface& surface = frame.surface;
    const double tension = input_.films->material.film_tension();
    sim::Field jump{"pressure_difference", "Pa", 1, false, {}};
    const auto pressure = [&](mesh::RegionId r) {
        const auto& known = answer_ && !answer_->pressure.empty() ? answer_->pressure : relaxation_->pressure();
        return index(r) < known.size() ? tension * known[index(r)] : 0.0;
    };
    for (const mesh::Face& face : mesh.faces) jump.values.push_back(pressure(face.back) - pressure(face.front));
    surface.face_fields.push_back(std::move(jump));
    if (answer_ && !answer_->curved.empty()) {
        sim::Field nodes{sim::kCurvedNodes, "m", 18, false, {}};
        for (const geometry::CurvedTriangle& patch : answer_->curved)
            for (const Vec3& x : patch) nodes.values.insert(nodes.values.end(), {x[0], x[1], x[2]});
        surface.face_fields.push_back(std::move(nodes));
    }
    sim::Field above{"pressure", "Pa", 1, false, {}};
    const bool pressure_known = answer_ || !relaxation_->pressure().empty();
    for (const mesh::RegionId r : mesh.regions.ids()) {
        const bool bubble = mesh.regions[r].kind == RegionKind::kClosed;
        above.values.push_back(!bubble ? 0.0 : pressure_known ? pressure(r) : std::numeric_limits<double>::quiet_NaN());
    }
    surface.region_fields.push_back(std::move(above));
    frame.scalars = scalars();
    return frame;
}

std::vector<sim::Scalar> EquilibriumSolver::scalars() const {
    const FoamMesh& mesh = relaxation_->mesh();
    const double tension = input_.films->material.film_tension();
    const bool known = answer_ && answer_->area > 0.0;
    const auto at_rest = [&](auto&& value) {  // not a number until the films are at rest
        return known ? static_cast<double>(value(*answer_)) : std::numeric_limits<double>::quiet_NaN();
    };
    const double flat = mesh::total_area(mesh);
    const auto bubbles = std::count_if(mesh.regions.begin(), mesh.regions.end(),
                                       [](const mesh::Region& r) { return r.kind == RegionKind::kClosed; });
    return {
        {"at_rest", "-", known ? 1.0 : 0.0, "1 when the films are at rest"},
        {"residual", "-", relaxation_->residual(), "force out of balance, relative to the films' own"},
        {"bubbles", "-", static_cast<double>(bubbles), "closed regions"},
        {"polyhedral_area", "m^2", flat, "of the flat triangles"},
        {"area", "m^2", at_rest([](const RestAnswer& a) { return a.area; }),
         "of curved triangles at rest, weighted with the films' tensions"},
        {"estimated_area", "m^2", at_rest([](const RestAnswer& a) { return a.estimated_area; }),
         "the same after one Newton step only"},
        {"surface_energy", "J", tension * at_rest([](const RestAnswer& a) { return a.area; }), "film tension * area"},
        {"volume_error", "-", worst_volume_error(mesh), "largest relative error of a bubble's volume"},
        {"virial", "-", at_rest([](const RestAnswer& a) { return a.virial; }),
         "1.5 sum p V / area - 1: the error of the pressures; 0 with wires"},
        {"unstable_modes", "-", at_rest([](const RestAnswer& a) { return a.index; }),
         "negative eigenvalues of the second variation"},
        {"lowest_eigenvalue", "1/m^2", at_rest([](const RestAnswer& a) { return a.lowest_eigenvalue; }),
         "of the second variation per area, over the film tension"},
        {"irregular_vertices", "-", at_rest([](const RestAnswer& a) { return a.irregular_vertices; }),
         "where films cross as Plateau's laws forbid"},
        {"stable", "-", at_rest([](const RestAnswer& a) { return a.stable() ? 1.0 : 0.0; }),
         "1: at rest, no unstable mode, nothing that could part"},
        {"film_angle_mean_error", "deg", at_rest([](const RestAnswer& a) { return kDegrees * a.film_angles.mean; }),
         "from 120 degrees, between curved films"},
        {"film_angle_max_error", "deg", at_rest([](const RestAnswer& a) { return kDegrees * a.film_angles.largest; }),
         "from 120 degrees, between curved films"},
        {"line_angle_mean_error", "deg",
         at_rest([](const RestAnswer& a) { return kDegrees * a.junction_angles.mean; }),
         "from 109.47 degrees, between curved triple lines"},
        {"line_angle_max_error", "deg",
         at_rest([](const RestAnswer& a) { return kDegrees * a.junction_angles.largest; }),
         "from 109.47 degrees, between curved triple lines"},
        {"faces", "-", static_cast<double>(mesh.faces.size()), "triangles"},
        {"min_angle", "deg", kDegrees * mesh::min_angle(mesh), "smallest angle of a triangle"},
        {"steps", "-", static_cast<double>(steps_), "taken"},
        {"iterations", "-", static_cast<double>(relaxation_->iterations()), "of the flow and of Newton's method"},
    };
}

std::vector<sim::Scalar> EquilibriumSolver::characteristic_numbers() const {
    const film::Problem& films = *input_.films;
    const auto bubbles = std::count_if(films.mesh.regions.begin(), films.mesh.regions.end(),
                                       [](const mesh::Region& r) { return r.kind == RegionKind::kClosed; });
    double gas = 0.0;
    for (const mesh::Region& r : films.mesh.regions)
        if (r.kind == RegionKind::kClosed) gas += r.target_volume;
    return {
        {"film_tension", "N/m", films.material.film_tension(), "twice the surface tension"},
        {"bubbles", "-", static_cast<double>(bubbles), "closed regions"},
        {"gas_volume", "m^3", gas, "of all bubbles"},
        {"edge_length", "m", films.edge_length, "of the mesh at rest"},
        {"faces", "-", static_cast<double>(films.mesh.faces.size()), "triangles at the start"},
        {"start_area", "m^2", mesh::total_area(films.mesh), "of the films at the start"},
    };
}

}  // namespace lamella::equilibrium
