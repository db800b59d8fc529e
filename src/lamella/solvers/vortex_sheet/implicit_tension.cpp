// When steps are semi-implicit, and how long they may be.

#include "lamella/core/error.h"
#include "lamella/mesh/area.h"
#include "lamella/solvers/vortex_sheet/vortex_sheet_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lamella::vortex_sheet {

using mesh::FoamMesh;
using mesh::RegionKind;
using mesh::VertexId;

namespace {

bool any_pinned(const SheetTopology& topology) {
    return std::find(topology.hold.begin(), topology.hold.end(), Hold::kPinned) != topology.hold.end();
}

}  // namespace

/// What `tension = "implicit"` does not go with.
void VortexSheetSolver::check_implicit() const {
    const auto refuse = [](const char* what) {
        throw InputError(fmt::format("vortex_sheet.tension = \"implicit\" does not go with {}; \"explicit\" and \"auto\" do",
                                     what));
    };
    if (options_.integrator != Integrator::kVerlet) refuse("integrator = \"symplectic_euler\"");
    if (options_.compat.form != Form::kFace) refuse("compat.form = \"point\"");
    if (options_.compat.velocity_factor != 1.0) refuse("a compat.velocity_factor other than 1");
    if (options_.popped_vorticity == PoppedVorticity::kFree) refuse("popped_vorticity = \"free\"");
    if (any_pinned(sheet_topology(input_.films->mesh))) refuse("wires that run through films (films may end on wires)");
}

bool VortexSheetSolver::implicit_possible() const {
    return options_.integrator == Integrator::kVerlet && options_.compat.form == Form::kFace &&
           options_.compat.velocity_factor == 1.0 && loose_.empty() && !any_pinned(tracker_ ? topology_ : sheet_topology(input_.films->mesh));
}

/// Of the oscillation l = 2 of a sphere as large as the largest bubble [Lamb32, art. 275]; without bubbles, of a round
/// film with as much area as all films, in a ring [method sheet 14.3].
double VortexSheetSolver::slowest_period() const {
    const FoamMesh& films = tracker_ ? mesh() : input_.films->mesh;
    double volume = 0.0;
    for (const mesh::Region& r : films.regions)
        if (r.kind == RegionKind::kClosed) volume = std::max(volume, r.target_volume);
    const film::Material& material = input_.films->material;
    const auto period = [&](double stiffness, double radius) {
        return 2.0 * std::numbers::pi *
               std::sqrt(material.air_density * radius * radius * radius / (stiffness * material.surface_tension));
    };
    if (volume > 0.0) return period(9.6, std::cbrt(0.75 * volume / std::numbers::pi));
    return period(3.423393 * 3.423393, std::sqrt(mesh::total_area(films) / std::numbers::pi));
}

/// Longest semi-implicit step that still follows the oscillations.
double VortexSheetSolver::implicit_limit() const { return slowest_period() / options_.steps_per_period; }

/// The step from which on a semi-implicit one is cheaper: it takes about 4 evaluations of the flow on films that do not
/// meet and 6 with triple lines, the explicit one takes 1 [method sheet 14.4].
double VortexSheetSolver::break_even() const {
    const FoamMesh& films = tracker_ ? mesh() : input_.films->mesh;
    const SheetTopology& topology = tracker_ ? topology_ : sheet_topology(films);
    bool meet = false;
    for (const VertexId v : films.position.ids()) meet = meet || topology.last(v) - topology.first(v) > 2;
    return (meet ? 6.0 : 4.0) * options_.step_safety * capillary_limit();
}

bool VortexSheetSolver::starts_implicitly() const {
    if (options_.tension != Tension::kAuto) return options_.tension == Tension::kImplicit;
    return implicit_possible() && farthest_step(implicit_limit()) > break_even();
}

/// A semi-implicit step, if there is to be one now.
/// @throws NumericalError  no convergence, or a film has met a wire that now runs through it, which needs explicit steps
std::optional<ImplicitStep> VortexSheetSolver::try_implicit(double time_limit) const {
    const bool automatic = options_.tension == Tension::kAuto;
    if (options_.tension == Tension::kExplicit || (automatic && !implicit_possible())) return std::nullopt;
    if (!automatic && any_pinned(topology_))
        throw NumericalError(fmt::format("t = {:.6g} s: a wire runs through a film now; vortex_sheet.tension = \"auto\" can "
                                         "go on from here",
                                         time_));
    double dt = fitted(farthest_step(implicit_limit()), time_limit);
    constexpr double kTooFar = 0.5;  // edges: twice what was planned
    int evaluations = 0;
    while (!automatic || dt > break_even()) {
        ImplicitStep step = solve_implicitly(dt);
        step.evaluations += evaluations;
        double fastest = 0.0;
        for (const Vec3& u : step.velocity) fastest = std::max(fastest, norm(u));
        const double edges = dt * fastest / input_.films->edge_length;
        if (edges <= kTooFar) return step;
        evaluations = step.evaluations;
        // Films at rest that tension pulls go a way that grows with the square of the time.
        dt *= 0.8 * std::max(0.1, std::sqrt(0.5 * kTooFar / edges));
    }
    return std::nullopt;
}

ImplicitStep VortexSheetSolver::solve_implicitly(double dt) const {
    const film::Problem& films = *input_.films;
    const double half = options_.theta * dt;
    const FoamMesh middle = films_ahead(half);
    const SheetGeometry geometry = sheet_geometry(middle, topology_);
    const std::vector<BlownRing> blown = blown_rings(films.wires, time_ + half);
    const auto rest_wires = [&](VertexVelocity u) {
        for (const VertexId v : u.ids())
            if (topology_.hold[v] != Hold::kFree) u[v] = {};
        return u;
    };
    const VertexVelocity expected = rest_wires(velocity_);
    const FilmLaplacian laplacian(middle, topology_);
    const FilmFilter inverse = flat_film_inverse(laplacian, sum_options(), films.material.surface_tension,
                                                 films.material.air_density, half);
    const ImplicitProblem problem{
        .middle = middle,
        .expected = expected,
        .rate =
            [&](const FoamMesh& mesh) {
                Circulation rate = tension_rate(mesh, sheet_geometry(mesh, topology_));
                fix_gauge(topology_, rate);
                return rate;
            },
        .velocity =
            [&](const Circulation& phi, bool driven) {
                return rest_wires(flow_at(middle, topology_, geometry, phi, driven ? blown : std::vector<BlownRing>{},
                                          sum_options())
                                      .velocity);
            },
        .precondition = [&](const Circulation& x, Circulation& y) { inverse.apply(x, y); },
        .edge_length = films.edge_length,
        .tolerance = options_.implicit_tolerance};
    return implicit_step(problem, phi_, options_.theta, dt);
}

}  // namespace lamella::vortex_sheet
