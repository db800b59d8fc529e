// What can be seen of films in air: the frame, its scalars, and the numbers that `lamella check` prints.

#include "lamella/film/tension.h"
#include "lamella/mesh/angles.h"
#include "lamella/mesh/area.h"
#include "lamella/mesh/quality.h"
#include "lamella/mesh/volume.h"
#include "lamella/sim/film_surface.h"
#include "lamella/solvers/vortex_sheet/impulse.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

#include <algorithm>
#include <cmath>

namespace lamella::vortex_sheet {
namespace {

using mesh::FaceId;
using mesh::RegionKind;

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

double worst_volume_error(const mesh::FoamMesh& mesh) {
    const IdVector<mesh::RegionId, double> volume = mesh::region_volumes(mesh);
    double worst = 0.0;
    for (const mesh::RegionId r : mesh.regions.ids())
        if (mesh.regions[r].kind == RegionKind::kClosed && mesh.regions[r].target_volume > 0.0)
            worst = std::max(worst, std::abs(volume[r] / mesh.regions[r].target_volume - 1.0));
    return worst;
}

double bubbles(const mesh::FoamMesh& mesh) {
    return static_cast<double>(std::count_if(mesh.regions.begin(), mesh.regions.end(), [](const mesh::Region& r) {
        return r.kind == RegionKind::kClosed;
    }));
}

}  // namespace

sim::Frame VortexSheetSolver::frame() const {
    sim::Frame frame;
    frame.solver = "vortex_sheet";
    frame.time = time_;
    frame.step = steps_;
    frame.surface = sim::film_surface(mesh());
    const Flow& flow = observed();
    sim::Field velocity{"velocity", "m/s", 3, false, {}};
    for (const Vec3& u : flow.velocity) velocity.values.insert(velocity.values.end(), u.v, u.v + 3);
    frame.surface.vertex_fields.push_back(std::move(velocity));
    // The jump of the air's velocity across the film: gamma = n x [u], so [u] = gamma x n.
    const SheetGeometry geometry = sheet_geometry(mesh(), topology_);
    sim::Field slip{"velocity_jump", "m/s", 3, false, {}};
    for (const FaceId f : mesh().faces.ids()) {
        const Vec3& area = geometry.area_vector[index(f)];
        const double square = squared_norm(area);
        const Vec3 jump = square > 0.0 ? cross(flow.strength[index(f)], area) / square : Vec3{};
        slip.values.insert(slip.values.end(), jump.v, jump.v + 3);
    }
    frame.surface.face_fields.push_back(std::move(slip));
    frame.scalars = scalars();
    return frame;
}

std::vector<sim::Scalar> VortexSheetSolver::scalars() const {
    const film::Problem& films = *input_.films;
    const double density = films.material.air_density;
    const SheetGeometry geometry = sheet_geometry(mesh(), topology_);
    const IdVector<FaceId, double> tension =
        film::face_tensions(mesh(), films.material.film_tension(), films.tensions);
    double area = 0.0, surface = 0.0;
    for (const FaceId f : mesh().faces.ids()) {
        const double a = norm(geometry.area_vector[index(f)]);
        area += a;
        surface += tension[f] * a;
    }
    const double kinetic = density * observed().energy();
    const Vec3 p = density * (impulse(mesh(), topology_, geometry, phi_) + loose_.impulse());
    const Vec3 l = density * (angular_impulse(mesh(), topology_, geometry, phi_) + loose_.angular_impulse());
    const auto films_apart = mesh::deviation_from_plateau(mesh::triple_edge_angles(mesh(), mesh::AngleMethod::kWide));
    const auto lines_apart = mesh::deviation_from_plateau(mesh::junction_angles(mesh(), mesh::AngleMethod::kQuadratic));
    double fastest = 0.0;
    for (const Vec3& u : observed().velocity) fastest = std::max(fastest, norm(u));
    return {
        {"energy_kinetic", "J", kinetic, "of the air"},
        {"energy_surface", "J", surface, "film tension * area"},
        {"energy", "J", kinetic + surface, "of both"},
        {"polyhedral_area", "m^2", area, "of the flat triangles"},
        {"bubbles", "-", bubbles(mesh()), "closed regions"},
        {"volume_error", "-", worst_volume_error(mesh()), "largest relative error of a bubble's volume"},
        {"impulse_x", "kg m/s", p[0], "of the air"},
        {"impulse_y", "kg m/s", p[1], "of the air"},
        {"impulse_z", "kg m/s", p[2], "of the air"},
        {"angular_impulse_x", "kg m^2/s", l[0], "of the air, about the origin"},
        {"angular_impulse_y", "kg m^2/s", l[1], "of the air, about the origin"},
        {"angular_impulse_z", "kg m^2/s", l[2], "of the air, about the origin"},
        {"film_angle_mean_error", "deg", kDegrees * films_apart.mean, "from 120 degrees, between curved films"},
        {"film_angle_max_error", "deg", kDegrees * films_apart.largest, "from 120 degrees, between curved films"},
        {"line_angle_mean_error", "deg", kDegrees * lines_apart.mean, "from 109.47 degrees, between triple lines"},
        {"line_angle_max_error", "deg", kDegrees * lines_apart.largest, "from 109.47 degrees, between triple lines"},
        {"wire_residual", "-", wire_residual_, "flux through pinned films that no circulation takes away, relative"},
        {"max_velocity", "m/s", fastest, "of the films"},
        {"time_step", "s", step_, "the last one"},
        {"implicit_evaluations", "-", static_cast<double>(evaluations_), "of the flow in the last step; 0: it was explicit"},
        {"vertices", "-", static_cast<double>(mesh().position.size()), "of the films"},
        {"faces", "-", static_cast<double>(mesh().faces.size()), "triangles"},
        {"loose_triangles", "-", static_cast<double>(loose_.triangles.size()), "of vortex sheets that burst films left"},
        {"min_angle", "deg", kDegrees * mesh::min_angle(mesh()), "smallest angle of a triangle"},
    };
}

std::vector<sim::Scalar> VortexSheetSolver::characteristic_numbers() const {
    const film::Problem& films = *input_.films;
    return {
        {"film_tension", "N/m", films.material.film_tension(), "twice the surface tension"},
        {"bubbles", "-", bubbles(films.mesh), "closed regions"},
        {"vertices", "-", static_cast<double>(films.mesh.position.size()), "at the start"},
        {"faces", "-", static_cast<double>(films.mesh.faces.size()), "triangles at the start"},
        {"edge_length", "m", films.edge_length, "wanted"},
        {"kernel_length", "m", options_.smoothing_length * films.edge_length, "over which the flow is smoothed"},
        {"capillary_step_limit", "s", capillary_limit(), "explicit steps must stay below"},
        {"explicit_step", "s", options_.step_safety * capillary_limit(), "step_safety * that"},
        {"velocity_factor", "-", options_.compat.velocity_factor, "1: physics; 2: the published program"},
        {"slowest_period", "s", slowest_period(), "of a sphere as large as the largest bubble, or a disk of all films"},
        {"implicit_step_limit", "s", implicit_limit(), "semi-implicit steps stay below: slowest_period / steps_per_period"},
        {"implicit_break_even", "s", break_even(), "longer semi-implicit steps are cheaper than explicit ones"},
        {"implicit_possible", "-", implicit_possible() ? 1.0 : 0.0,
         "0: steps are explicit (a wire runs through a film, or the integrator or [vortex_sheet.compat] is the published)"},
        {"implicit_at_start", "-", starts_implicitly() ? 1.0 : 0.0, "1: semi-implicit steps pay at the start, unless outputs lie closer together"},
    };
}

}  // namespace lamella::vortex_sheet
