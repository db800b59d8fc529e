#pragma once

#include "lamella/sim/options.h"
#include "lamella/spatial/vortex_sum.h"

namespace lamella::vortex_sheet {

enum class Integrator {
    kVerlet,           ///< kick, drift with the velocity at the predicted midpoint, kick [method sheet 14.5]
    kSymplecticEuler,  ///< the published one
};
enum class Form {
    kFace,   ///< velocity and vector potential at barycentres; stable on any mesh [method sheet 14.1]
    kPoint,  ///< velocity at vertices, curvature from dihedral angles, as published
};

/// How tension drives the circulations.
enum class Tension {
    kExplicit,  ///< by the integrator; the fastest capillary wave of the mesh limits the step
    kImplicit,  ///< semi-implicitly, in place of the integrator [method sheet 14.4]
    kAuto,      ///< semi-implicitly where that takes fewer evaluations of the flow
};

/// What becomes of the circulation of a film that bursts.
enum class PoppedVorticity {
    kLost,  ///< it goes with the film, as published
    kFree,  ///< it stays in the air, as a vortex sheet that no film carries [method sheet 10.1]
};

/// Published behaviour, for comparison.
struct CompatOptions {
    Form form = Form::kFace;
    double velocity_factor = 1.0;
    double smoothing = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("form", form, sim::choices<Form>({{"face", Form::kFace}, {"point", Form::kPoint}}),
               {"face: the stable one; point: velocities at vertices as published, which needs smoothing", "-", "[Da15]"});
        option("velocity_factor", velocity_factor, sim::more_than(0.0),
               {"the published program moves films twice too fast: 2 gives its frequencies", "-", "[Da15]"});
        option("smoothing", smoothing, sim::at_least(0.0),
               {"rate at which circulations follow the mean of their neighbors; depends on the mesh", "1/time", "[Da15]"});
    }
};

/// [vortex_sheet] of a scene.
struct Options {
    spatial::VortexKernel kernel = spatial::VortexKernel::kK3;
    double smoothing_length = 1.5;
    Integrator integrator = Integrator::kVerlet;
    Tension tension = Tension::kExplicit;
    double theta = 0.5;
    double steps_per_period = 20.0;
    double implicit_tolerance = 1e-4;
    double step_safety = 0.4;
    double largest_step = 0.0;
    double surface_viscosity = 0.0;
    double grid_filter = 0.0;
    int healing = 2;
    PoppedVorticity popped_vorticity = PoppedVorticity::kLost;
    double damping = 0.0;
    bool volume_projection = true;
    bool impulse_projection = true;
    bool remeshing = true;
    bool merging = true;
    double sum_tolerance = 1e-5;
    bool sum_in_double = false;
    CompatOptions compat;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("kernel", kernel,
               sim::choices<spatial::VortexKernel>({{"plummer", spatial::VortexKernel::kPlummer},
                                                    {"k2", spatial::VortexKernel::kK2},
                                                    {"k3", spatial::VortexKernel::kK3}}),
               {"how the law of Biot and Savart is smoothed: to first, second or third order"});
        option("smoothing_length", smoothing_length, sim::between(0.1, 10.0),
               {"of the kernel, in edge lengths; the paper's plummer has 0.5 to 0.75"});
        option("integrator", integrator,
               sim::choices<Integrator>(
                   {{"verlet", Integrator::kVerlet}, {"symplectic_euler", Integrator::kSymplecticEuler}}),
               {"verlet: second order; symplectic_euler: first order, as published"});
        option("tension", tension,
               sim::choices<Tension>(
                   {{"explicit", Tension::kExplicit}, {"implicit", Tension::kImplicit}, {"auto", Tension::kAuto}}),
               {"explicit: capillary waves limit the step; implicit: they do not, a step takes 3 to 6 evaluations of the "
                "flow; auto: whichever is cheaper"});
        option("theta", theta, sim::between(0.5, 1.0),
               {"of implicit steps: 0.5 keeps the energy; more damps, the shortest waves first"});
        option("steps_per_period", steps_per_period, sim::between(4.0, 10000.0),
               {"of the slowest oscillation of the largest bubble, at least, where steps are implicit"});
        option("implicit_tolerance", implicit_tolerance, sim::strictly_between(0.0, 0.1),
               {"residual of implicit steps: 1e-3 moves frequencies by up to 2 %, 1e-4 by 0.7 %, 1e-5 by 0.2 %, each for "
                "about 1.5 evaluations more"});
        option("step_safety", step_safety, sim::strictly_between(0.0, 1.0),
               {"time step over the limit that the fastest capillary wave sets"});
        option("largest_step", largest_step, sim::at_least(0.0), {"upper limit of the time step; 0: none", "time"});
        option("surface_viscosity", surface_viscosity, sim::at_least(0.0),
               {"diffusivity of the circulation along the films", "length^2/time"});
        option("grid_filter", grid_filter, sim::between(0.0, 1.0),
               {"share that the shortest wave of the mesh loses per step; long waves lose next to nothing"});
        option("healing", healing, sim::between(0, 100),
               {"sweeps that even circulations out where an edit changed the triangles; 0 lets edits set energy free"});
        option("popped_vorticity", popped_vorticity,
               sim::choices<PoppedVorticity>({{"lost", PoppedVorticity::kLost}, {"free", PoppedVorticity::kFree}}),
               {"lost: the circulation of a film that bursts goes with it, as published; free: it stays in the air, which "
                "carries it on"});
        option("damping", damping, sim::at_least(0.0),
               {"rate at which all circulations decay: a way to rest, no physics", "1/time"});
        option("volume_projection", volume_projection, {"bubbles keep their volumes to rounding"});
        option("impulse_projection", impulse_projection, {"tension gives no net push to a free cluster"});
        option("remeshing", remeshing, {"false: the triangles stay as they are, nothing merges or parts"});
        option("merging", merging, {"films that touch become one"});
        option("sum_tolerance", sum_tolerance, sim::strictly_between(0.0, 0.1),
               {"error of the fast summation over the largest velocity; small meshes are summed exactly"});
        option("sum_in_double", sum_in_double,
               {"pairs in double precision; false: in single, summed in double, off by about 1e-6 of the velocity"});
        option.group("compat", compat, "published behaviour, for comparison");
    }
};

}  // namespace lamella::vortex_sheet
