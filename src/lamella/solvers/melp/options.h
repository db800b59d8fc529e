#pragma once

#include "lamella/core/vec.h"
#include "lamella/sim/options.h"

namespace lamella::melp {

/// What the rims of films on wires are.
enum class RimHold {
    kWire,      ///< held at their places, the same air on both sides
    kPlate,     ///< held on a plate that closes in the gas
    kWetPlate,  ///< sliding on such a plate
};
/// What surfactant films start with.
enum class StartSurfactant {
    kProportional,  ///< to the thickness
    kUniform,       ///< the same everywhere
};

/// Where the air is warm.
enum class HeatSource {
    kNone,   ///< nowhere: films have material.temperature
    kBelow,  ///< below a plane across gravity, and less so up to it
    kBall,   ///< around a point
};

/// Warm, or cold, air at the films.
struct HeatOptions {
    HeatSource source = HeatSource::kNone;
    double temperature = 0.0;
    Vec3 center;
    double reach = 0.0;
    double time = 0.1;
    double tension_slope = -1.5e-4;
    double buoyancy = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("source", source,
               sim::choices<HeatSource>(
                   {{"none", HeatSource::kNone}, {"below", HeatSource::kBelow}, {"ball", HeatSource::kBall}}),
               {"none; below: material.temperature at the height of center, linear in height to temperature at reach "
                "below it and farther down; ball: the same with the distance from center, from reach inward"});
        option("temperature", temperature, sim::at_least(0.0), {"of the source", "K"});
        option("center", center, sim::any_number(), {"see source", "length"});
        option("reach", reach, sim::at_least(0.0), {"see source", "length"});
        option("time", time, sim::more_than(0.0),
               {"in which films take all but 1/e of the air's temperature: rho eta c / (2 h) = 0.1 s for 500 nm of "
                "water and h = 10 W/(m^2 K)",
                "time", "[Deng22]: 1 to 2 s"});
        option("tension_slope", tension_slope, sim::any_number(),
               {"of an interface's tension with temperature, N/(m K); as of water", "-"});
        option("buoyancy", buoyancy, sim::at_least(0.0),
               {"per K: warm film weighs less by this, along the film; as published, in reality it does not", "-",
                "[Deng22]: 0.3"});
    }
};

/// How films differ from even, resting ones at the start.
struct StartOptions {
    double thickness_top = 0.0;
    double thickness_bottom = 0.0;
    StartSurfactant surfactant = StartSurfactant::kProportional;
    double thickness_noise = 0.0;
    double noise_length = 0.0;
    int noise_octaves = 2;
    int mode = 2;
    double mode_amplitude = 0.0;
    int spots = 0;
    double spot_radius = 0.0;
    double spot_thickness = 40e-9;
    Vec3 spot_center;
    double spot_spread = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("thickness_top", thickness_top, sim::at_least(0.0),
               {"where a film is highest, linear in height down to thickness_bottom; 0: bubble.thickness, or the "
                "material's",
                "length"});
        option("thickness_bottom", thickness_bottom, sim::at_least(0.0), {"where it is lowest; 0: likewise", "length"});
        option("surfactant", surfactant,
               sim::choices<StartSurfactant>(
                   {{"proportional", StartSurfactant::kProportional}, {"uniform", StartSurfactant::kUniform}}),
               {"of films of uneven thickness: proportional to it, or the same everywhere"});
        option("thickness_noise", thickness_noise, sim::between(0.0, 1.2),
               {"amplitude of the first octave, over the thickness", "-", "[Deng22]"});
        option("noise_length", noise_length, sim::at_least(0.0),
               {"wave length of the first octave; 0: 1.4 times the largest bubble's radius", "length", "[Deng22]"});
        option("noise_octaves", noise_octaves, sim::between(1, 12),
               {"each half as long and half as high as the one before"});
        option("mode", mode, sim::between(1, 8),
               {"bubbles swing in this mode: degree of the Legendre polynomial about x"});
        option("mode_amplitude", mode_amplitude, sim::between(-0.3, 0.3), {"over the radius; 0: they start round"});
        option("spots", spots, sim::between(0, 1000), {"of black film in each film, with the surfactant of the rest"});
        option("spot_radius", spot_radius, sim::at_least(0.0), {"of each", "length"});
        option("spot_thickness", spot_thickness, sim::more_than(0.0), {"of the film there", "length"});
        option("spot_center", spot_center, sim::any_number(), {"they lie at random around this place", "length"});
        option("spot_spread", spot_spread, sim::at_least(0.0),
               {"as far from it as this, on fine particles; 0: one at the nearest", "length"});
    }
};

/// Black film: what is thinner than `thickness`.
struct BlackFilmOptions {
    double thickness = 0.0;
    double line_tension = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("thickness", thickness, sim::at_least(0.0),
               {"film at half of this is all black, at twice of it all common; 0: there is none", "length"});
        option("line_tension", line_tension, sim::at_least(0.0),
               {"of the border between both; measured ones are far below 1e-9 N", "mass*length/time^2"});
    }
};

/// [melp] of a scene.
struct Options {
    RimHold rim = RimHold::kWire;
    int fine_ratio = 16;
    double support_radius = 3.0;
    double theta = 0.51;
    double steps_per_period = 20.0;
    double cfl = 0.5;
    double largest_step = 0.0;
    double outside_pressure = 101325.0;
    double air_mass = 0.0;
    double air_drag = 0.0;
    Vec3 wind;
    Vec3 wind_spin;
    Vec3 wind_center;
    double wind_radius = 0.0;
    bool floating = false;
    double damping = 0.0;
    double shape_damping = 0.0;
    double grid_filter = 0.1;
    double junction_correction = 0.17;
    bool joining = true;
    double joining_delay = 0.0;
    double exchange_rate = 0.0;
    bool redistribution = true;
    bool insertion = true;
    double volume_rate = 20.0;
    double thickness_rate = 0.2;
    int slow_motion = 15;
    double solver_tolerance = 1e-6;
    int jacobi_sweeps = 0;
    HeatOptions heat;
    BlackFilmOptions black_film;
    StartOptions start;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("rim", rim,
               sim::choices<RimHold>(
                   {{"wire", RimHold::kWire}, {"plate", RimHold::kPlate}, {"wet_plate", RimHold::kWetPlate}}),
               {"what [[film]] ends on: wire: held, the same air on both sides; plate: held on a plate that closes in "
                "the gas of a hemisphere; wet_plate: sliding on such a plate"});
        option("fine_ratio", fine_ratio, sim::between(0, 1000),
               {"fine particles, the liquid, per coarse one; 0: films of even thickness and constant tension", "-",
                "[Deng22]: 16 to 64"});
        option("support_radius", support_radius, sim::between(2.0, 6.0),
               {"of the kernels, in spacings of the coarse particles", "-", "[method sheet 16]"});
        option("theta", theta, sim::between(0.5, 1.0),
               {"of the motion along the normals: 0.5 damps nothing, 0.51 the waves between particles, 1 all; steps "
                "longer than a tenth of the slowest swing of the smallest bubble take 1, and bubbles that touch",
                "-", "[method sheet 16.2]"});
        option("steps_per_period", steps_per_period, sim::at_least(0.0),
               {"of the slowest swing of the smallest bubble; 0: only how far particles move limits the step"});
        option("cfl", cfl, sim::between(0.01, 2.0), {"how far particles move in a step, in spacings"});
        option("largest_step", largest_step, sim::at_least(0.0), {"upper limit of the time step; 0: none", "time"});
        option("outside_pressure", outside_pressure, sim::more_than(0.0), {"of the air", "Pa"});
        option(
            "air_mass", air_mass, sim::between(0.0, 2.0),
            {"share of the air that swings with a bubble: air_density * radius * this is added to the film's mass per "
             "area; 5/6 is right for mode 2; 0: the film swings alone, as published",
             "-", "[method sheet 15.3]"});
        option("air_drag", air_drag, sim::at_least(0.0),
               {"force of the air per area and speed along the film, and against the side that the wind blows on; the "
                "paper has 1e-3",
                "mass/(length^2*time)", "[Deng22]"});
        option("wind", wind, sim::any_number(), {"velocity of the air that drags", "length/time"});
        option("wind_spin", wind_spin, sim::any_number(),
               {"angular velocity of air that turns about wind_center and drags likewise", "1/time"});
        option("wind_center", wind_center, sim::any_number(), {"of the air that turns", "length"});
        option("wind_radius", wind_radius, sim::at_least(0.0),
               {"at which it turns 1/e as fast, with exp(-(r / this)^2); 0: all of it turns", "length"});
        option("floating", floating,
               {"the air carries the weight of free bubbles, by forces along the normals: they drain and do not fall"});
        option("damping", damping, sim::at_least(0.0),
               {"rate at which the motion along normals decays: to settle", "1/time"});
        option("shape_damping", shape_damping, sim::at_least(0.0),
               {"the same of all motion along normals that is no flight of a bubble as a whole", "1/time"});
        option("grid_filter", grid_filter, sim::between(0.0, 1.0),
               {"share of the motion along normals that the shortest waves between particles lose per step; bubbles "
                "that fly or swing lose next to nothing"});
        option("junction_correction", junction_correction, sim::between(0.0, 1.0),
               {"beta of the cohesion between bubbles: cancels the tension of the blurred line where films meet", "-",
                "[method sheet 16.4]"});
        option("joining", joining,
               {"false: bubbles that touch never join, a spacing of air stays between their films"});
        option("joining_delay", joining_delay, sim::at_least(0.0),
               {"from the first contact until films begin to join; a fifth of it later they have", "time",
                "[Deng22]: a threshold"});
        option(
            "exchange_rate", exchange_rate, sim::at_least(0.0),
            {"at which the films of two bubbles that lie on each other even out: their liquid, its surfactant and its "
             "momentum; 0: each keeps its own",
             "1/time", "[Deng22]: a chance per step"});
        option("redistribution", redistribution, {"coarse particles are kept evenly spread"});
        option("insertion", insertion,
               {"films that stretch get coarse particles, those that shrink lose some: the spacing is kept", "-",
                "[method sheet 7]"});
        option("volume_rate", volume_rate, sim::at_least(0.0),
               {"at which the gas volume that films have swept follows the particles' own", "1/time",
                "[method sheet 16.2]"});
        option("thickness_rate", thickness_rate, sim::at_least(0.0),
               {"at which the thickness of fine particles follows that of the coarse ones", "1/time", "[Deng22]"});
        option("slow_motion", slow_motion, sim::between(1, 1000),
               {"so many times as many frames while a film bursts", "-", "[Deng22]"});
        option("solver_tolerance", solver_tolerance, sim::strictly_between(0.0, 0.1),
               {"residual of the linear systems, relative"});
        option("jacobi_sweeps", jacobi_sweeps, sim::between(0, 100000),
               {"0: conjugate gradients find the surfactant to solver_tolerance; more: so many relaxed sweeps after "
                "Jacobi, with a factor of 0.2, whatever is left then",
                "-", "[Deng22]: 30 to 100"});
        option.group("heat", heat, "warm air: films are less tense there, and their surfactant presses harder");
        option.group("black_film", black_film, "spots of film a few nanometers thick, which have a border");
        option.group("start", start, "how films differ from even, resting ones at the start");
    }
};

}  // namespace lamella::melp
