#pragma once

#include "lamella/core/vec.h"
#include "lamella/sim/options.h"
#include "lamella/solvers/vortex_particle/transfer.h"

namespace lamella::vortex_particle {

enum class Tracer {
    kExtrapolated,  ///< with the velocity of the middle of the step, from the last two: second order [method
                    ///< sheet 12.11]
    kFrozen,        ///< with that of its beginning, as published: first order, gains energy
};
enum class Viscosity {
    kSurface,  ///< that of a curved fluid sheet: a rigid rotation of a bubble is not damped
    kLaplace,  ///< diffusion of the vorticity, as published
};
enum class ThicknessProfile { kUniform, kLinear, kStep, kCosine };
enum class SurfactantProfile {
    kUniform,
    kProportional,  ///< to the thickness
    kBalanced,      ///< such that it carries the film's weight
};

/// How thickness and surfactant lie at the start.
struct StartOptions {
    ThicknessProfile thickness = ThicknessProfile::kUniform;
    double thickness_bottom = 0.0;
    double thickness_top = 0.0;
    Vec3 up;
    SurfactantProfile surfactant = SurfactantProfile::kUniform;
    bool swirls_in_balance = false;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("thickness", thickness,
               sim::choices<ThicknessProfile>({{"uniform", ThicknessProfile::kUniform},
                                               {"linear", ThicknessProfile::kLinear},
                                               {"step", ThicknessProfile::kStep},
                                               {"cosine", ThicknessProfile::kCosine}}),
               {"uniform: material.thickness; linear: from thickness_bottom to thickness_top; step: halfway up from one"
                " to the other; cosine: half a wave from one to the other"});
        option("thickness_bottom", thickness_bottom, sim::at_least(0.0), {"0: material.thickness", "length"});
        option("thickness_top", thickness_top, sim::at_least(0.0), {"0: material.thickness", "length"});
        option("up", up, sim::any_number(), {"where the top is; [0, 0, 0]: against gravity, or along y without"});
        option("surfactant", surfactant,
               sim::choices<SurfactantProfile>({{"uniform", SurfactantProfile::kUniform},
                                                {"proportional", SurfactantProfile::kProportional},
                                                {"balanced", SurfactantProfile::kBalanced}}),
               {"proportional: to the thickness; balanced: such that its gradient carries the film's weight"});
        option(
            "swirls_in_balance", swirls_in_balance,
            {"true: liquid and surfactant are less in the cores of vortices, as much as holds them together; else they"
             " thin at once, which sends waves out"});
    }
};

/// Smooth noise on the start.
struct NoiseOptions {
    double thickness = 0.0;
    double surfactant = 0.0;
    double shape = 0.0;
    double frequency = 0.0;
    int octaves = 1;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("thickness", thickness, sim::between(0.0, 0.9), {"amplitude, relative"});
        option("surfactant", surfactant, sim::between(0.0, 0.9), {"amplitude, relative"});
        option("shape", shape, sim::at_least(0.0),
               {"of films that move: height of the noise along the normal", "length"});
        option("frequency", frequency, sim::at_least(0.0),
               {"0: eight over the square root of the film's area", "1/length"});
        option("octaves", octaves, sim::between(1, 10), {"each of twice the frequency and half the amplitude"});
    }
};

/// How films move.
struct MotionOptions {
    bool added_air = false;
    bool remeshing = true;
    double damping = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("added_air", added_air,
               {"true: the air that films push counts as inertia, as it does around spheres and planes"});
        option("remeshing", remeshing, {"true: triangles are kept even as films deform"});
        option("damping", damping, sim::at_least(0.0), {"rate at which motions along the normal die out", "1/time"});
    }
};

/// Film that streams through its frame.
struct StreamOptions {
    Vec3 velocity;
    double sponge = 0.1;

    template <class Visitor>
    void visit(Visitor&& option) {
        option(
            "velocity", velocity, sim::any_number(),
            {"[0, 0, 0]: the film is closed; else it comes in at the side that this points away from and leaves at the"
             " opposite one, of a rectangle",
             "length/time"});
        option("sponge", sponge, sim::between(0.0, 0.5),
               {"share of the film's length, before it leaves, in which vortices fade", "-", ""});
    }
};

/// [vortex_particle] of a scene.
struct Options {
    int particles_per_triangle = 10;
    int most_per_triangle = 0;
    double rupture_thickness = 0.0;
    Reach transfer = Reach::kHat;
    double kernel_radius = 1.5;
    Tracer tracer = Tracer::kExtrapolated;
    bool incompressible = false;
    Viscosity viscosity = Viscosity::kSurface;
    Walls walls = Walls::kSlip;
    double air_drag = 0.0;
    double largest_step = 0.01;
    double courant = 1.0;
    double area_relaxation = 0.0;
    double border_release = 30.0;
    Junction junction = Junction::kLeaves;
    double leaf_exchange = 10.0;
    double velocity_blend = 2.0;
    double solve_tolerance = 1e-10;
    bool particles_in_frames = false;
    bool moving = false;
    MotionOptions motion;
    StreamOptions stream;
    StartOptions start;
    NoiseOptions noise;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("particles_per_triangle", particles_per_triangle, sim::between(1, 1000),
               {"at the start", "-", "[Tao24]"});
        option("most_per_triangle", most_per_triangle, sim::at_least(0),
               {"more particles than that in a triangle merge; 0: four times particles_per_triangle"});
        option("rupture_thickness", rupture_thickness, sim::at_least(0.0),
               {"a film that gets as thin as that bursts, and the run ends where it bounds no bubble or does not move; 0: never", "length"});
        option("transfer", transfer, sim::choices<Reach>({{"hat", Reach::kHat}, {"kernel", Reach::kKernel}}),
               {"between particles and vertices; hat: to the corners of the triangle; kernel: to all vertices within"
                " kernel_radius, as published, which blurs more and costs more"});
        option("kernel_radius", kernel_radius, sim::between(1.0, 10.0), {"in longest edges; the paper's is 3"});
        option("tracer", tracer,
               sim::choices<Tracer>({{"extrapolated", Tracer::kExtrapolated}, {"frozen", Tracer::kFrozen}}),
               {"velocity that particles move with; extrapolated: second order in time; frozen: first order, as "
                "published"});
        option("incompressible", incompressible,
               {"true: the film keeps its thickness along the flow, whatever its surfactant"});
        option("viscosity", viscosity,
               sim::choices<Viscosity>({{"surface", Viscosity::kSurface}, {"laplace", Viscosity::kLaplace}}),
               {"surface: of a curved sheet, which leaves rigid rotations alone; laplace: as published"});
        option("walls", walls, sim::choices<Walls>({{"slip", Walls::kSlip}, {"no_slip", Walls::kNoSlip}}),
               {"what frames and wires do to the flow along them; no_slip needs a viscosity"});
        option("air_drag", air_drag, sim::at_least(0.0), {"rate at which air at rest stops the flow", "1/time"});
        option("largest_step", largest_step, sim::more_than(0.0), {"upper limit of the time step", "time"});
        option("courant", courant, sim::more_than(0.0), {"edges that the fastest particle moves in a step, at most"});
        option("area_relaxation", area_relaxation, sim::at_least(0.0),
               {"rate at which particles' areas follow the room that they have; measured: 0 is best", "1/time"});
        option("border_release", border_release, sim::at_least(0.0),
               {"films that move: rate at which the liquid that a burst film has left in its borders goes into the films",
                "1/time"});
        option(
            "junction", junction,
            sim::choices<Junction>({{"leaves", Junction::kLeaves}, {"sheets", Junction::kSheets}}),
            {"films that meet in triple lines; leaves: each bubble has half of those around it, which flows on its own;"
             " sheets: one flow per film, which goes on over the lines (films that do not move)"});
        option("leaf_exchange", leaf_exchange, sim::at_least(0.0),
               {"rate at which a leaf gives liquid and surfactant to the other one of its film where that has none; the"
                " paper: 0.1 per step",
                "1/time", "[Tao24]"});
        option("velocity_blend", velocity_blend, sim::at_least(0.0),
               {"rate at which particles' velocity follows that of the mesh", "1/time"});
        option("solve_tolerance", solve_tolerance, sim::strictly_between(0.0, 1e-2),
               {"residual of the surfactant's equation, relative"});
        option("particles_in_frames", particles_in_frames, {"true: frames show the particles too"});
        option("moving", moving, {"true: tension, gas and weight move films; false: they stand still"});
        option.group("motion", motion, "films that move");
        option.group("stream", stream, "film that comes in at one side and leaves at the other");
        option.group("start", start, "thickness and surfactant at the start");
        option.group("noise", noise, "smooth noise on them");
    }
};

}  // namespace lamella::vortex_particle
