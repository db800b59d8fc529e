#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "lamella/core/vec.h"
#include "lamella/sim/options.h"

namespace lamella::bubble {

using sim::any_number;
using sim::at_least;
using sim::between;
using sim::choices;
using sim::more_than;
using sim::strictly_between;

/// What a bubble's motion is resisted by (method sheet, section 2.2).
enum class Drag {
    kBackground,      ///< the liquid at rest, or moving with the prescribed flow
    kNeighborLagged,  ///< the mean velocity of the touching bubbles at the last step, as the published code has it
    kPairwise,        ///< each touching bubble and the background; a linear system per evaluation
};

/// How the exchange through the liquid scales as the foam coarsens (method sheet, section 3.4).
enum class MediumScaling { kArea, kRadius, kLsw };

enum class FlowKind { kNone, kRegion, kUniform, kShear };
enum class Packing { kGrid, kRandom, kFile };
enum class Sizes { kNormal, kLognormal, kBidisperse };
enum class Method { kRkc2, kAbm2 };
enum class ErrorNorm { kMax, kRms };
enum class StepControl { kDefault, kThesis, kCubble };
enum class TimeUnit { kScaled, kMechanical };

/// [bubble.flow]: a prescribed velocity of the liquid.
struct FlowOptions {
    FlowKind kind = FlowKind::kNone;
    Vec3 velocity{{0.01, 0.0, 0.0}};
    Vec3 region_low{{0.0, 0.475, 0.0}};
    Vec3 region_high{{1.0, 0.525, 1.0}};
    double edge_width = 0.0;
    double shear_rate = 0.0;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("kind", kind,
               choices<FlowKind>({{"none", FlowKind::kNone},
                                  {"region", FlowKind::kRegion},
                                  {"uniform", FlowKind::kUniform},
                                  {"shear", FlowKind::kShear}}),
               {"where the liquid moves: nowhere, in a box-shaped region, everywhere alike, or as a linear shear along x"
                " with its gradient along y",
                "-", "[Lankinen20, A.1 flowLbb, flowTfr]"});
        option("velocity", velocity, any_number(), {"liquid velocity of region and uniform", "length/time",
                                                    "[Lankinen20, A.1 flowVel]"});
        option("region_low", region_low, any_number(), {"lower corner of the region, relative to the box", "-",
                                                        "[Lankinen20, A.1 flowLbb]"});
        option("region_high", region_high, any_number(), {"upper corner of the region, relative to the box", "-",
                                                          "[Lankinen20, A.1 flowTfr]"});
        option("edge_width", edge_width, at_least(0.0),
               {"distance over which the velocity falls smoothly to zero outside the region; 0: sharp", "length"});
        option("shear_rate", shear_rate, any_number(), {"velocity gradient of shear (needs walls on y)", "1/time"});
    }
};

/// [bubble.gas]: exchange of gas between the bubbles.
struct GasOptions {
    double exchange_rate = 1e-3;
    double medium_ratio = 0.1;
    MediumScaling medium_scaling = MediumScaling::kArea;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("exchange_rate", exchange_rate, at_least(0.0),
               {"K: gas exchange through films; 0 turns all exchange off", "length^2/time", "[Lankinen20, eq. 2.23]"});
        option("medium_ratio", medium_ratio, at_least(0.0),
               {"kappa: exchange through the liquid relative to exchange through films", "-",
                "[Lankinen20, eq. 2.27]"});
        option("medium_scaling", medium_scaling,
               choices<MediumScaling>({{"area", MediumScaling::kArea},
                                       {"radius", MediumScaling::kRadius},
                                       {"lsw", MediumScaling::kLsw}}),
               {"how exchange through the liquid follows the growing bubbles: with their mean surface as published"
                " (3D dilute exponent 1/4), with their mean radius (1/3), or as diffusion around spheres (1/3, 3D only)",
                "-", "[Lankinen20, eq. 2.27]; radius, lsw: lamella"});
    }
};

/// [bubble.start]: the first packing, and how it is brought to rest.
struct StartOptions {
    Packing packing = Packing::kGrid;
    std::string file;
    Vec3 file_box{{0.0, 0.0, 0.0}};
    Sizes sizes = Sizes::kNormal;
    double radius_std = 0.21;
    double size_ratio = 1.4;
    double large_fraction = 0.5;
    double relax_gas_fraction = 0.0;
    double force_tolerance = 1e-4;
    int max_iterations = 100000;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("packing", packing,
               choices<Packing>({{"grid", Packing::kGrid}, {"random", Packing::kRandom}, {"file", Packing::kFile}}),
               {"first positions: a jittered grid (count is rounded up to a full one), random points, or a CSV file", "-",
                "[Lankinen20, 3.2.1]"});
        option("file", file, {"CSV file with columns x, y, z (3D) and radius, for packing = \"file\"", "path"});
        option("file_box", file_box, at_least(0.0),
               {"edge lengths of the box that the file's bubbles stand in, lower corner at the origin; the gas fraction then"
                " follows from it. 0: the smallest box of box_shape that holds them, scaled to gas_fraction", "length"});
        option("sizes", sizes,
               choices<Sizes>({{"normal", Sizes::kNormal},
                               {"lognormal", Sizes::kLognormal},
                               {"bidisperse", Sizes::kBidisperse}}),
               {"distribution of the first radii", "-", "[Lankinen20, 3.2.1]"});
        option("radius_std", radius_std, at_least(0.0), {"standard deviation of normal and lognormal radii", "length",
                                                         "[Lankinen20, A.1 stdDevRad]"});
        option("size_ratio", size_ratio, at_least(1.0), {"large over small radius of a bidisperse foam"});
        option("large_fraction", large_fraction, between(0.0, 1.0), {"share of large bubbles in a bidisperse foam"});
        option("relax_gas_fraction", relax_gas_fraction, at_least(0.0),
               {"relax at this gas fraction first, then scale the box to gas_fraction; 0: relax at gas_fraction", "-",
                "[Lankinen20, 4.2.3]"});
        option("force_tolerance", force_tolerance, more_than(0.0),
               {"at rest when the mean net force is below this times the mean contact force"});
        option("max_iterations", max_iterations, at_least(0), {"of the minimizer; 0: start unrelaxed"});
    }
};

/// [bubble.integrator]: how time is stepped.
struct IntegratorOptions {
    Method method = Method::kRkc2;
    double tolerance = 1e-3;
    bool evaluate_again = false;
    ErrorNorm norm = ErrorNorm::kMax;
    bool relative_error = false;
    double initial_step = 1e-3;
    double max_step = 1e3;
    double skin = 0.3;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("method", method, choices<Method>({{"rkc2", Method::kRkc2}, {"abm2", Method::kAbm2}}),
               {"rkc2: stabilized Runge-Kutta-Chebyshev of order 2; abm2: Adams-Bashforth-Moulton predictor-corrector of"
                " order 2, the published scheme with its weights and clock corrected",
                "-", "[Lankinen20, eq. 3.3-3.6]; rkc2: [Sommeijer98]"});
        option("tolerance", tolerance, more_than(0.0), {"largest error estimate of one step, in position and radius",
                                                        "length", "[Lankinen20, A.1 errorTolerance]"});
        option("evaluate_again", evaluate_again, {"abm2: evaluate once more at the corrected state (PECE)"});
        option("norm", norm, choices<ErrorNorm>({{"max", ErrorNorm::kMax}, {"rms", ErrorNorm::kRms}}),
               {"the error of a step is that of the worst bubble, or the root mean square"});
        option("relative_error", relative_error, {"scale the tolerance with the current mean radius"});
        option("initial_step", initial_step, more_than(0.0), {"first step", "time", "[Lankinen20, A.1 timeStepIn]"});
        option("max_step", max_step, more_than(0.0), {"longest step", "time"});
        option("skin", skin, more_than(0.0), {"neighbor lists reach this times the mean radius beyond contact"});
    }
};

/// [bubble.compat]: the published program's behavior where it is wrong, for comparison.
struct CompatOptions {
    bool clock = false;
    StepControl step_control = StepControl::kDefault;
    bool energy = false;
    bool removal = false;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("clock", clock, {"abm2: time advances by the next trial step instead of the step taken, as published", "-",
                                "method sheet, E2"});
        option("step_control", step_control,
               choices<StepControl>({{"default", StepControl::kDefault},
                                     {"thesis", StepControl::kThesis},
                                     {"cubble", StepControl::kCubble}}),
               {"abm2: step factors 1.9/0.5 up to 0.19 (thesis) or 1.269/0.37 up to 12.7 (cubble), with constant-step"
                " weights",
                "-", "[Lankinen20, 3.3.1]"});
        option("energy", energy, {"report the energy of eq. 3.2, which is not the potential of the force, as energy", "-",
                                  "[Lankinen20, eq. 3.2]"});
        option("removal", removal, {"survivors grow by R a^(1/d) as printed, which creates gas", "-",
                                    "[Lankinen20, 3.3.2]"});
    }
};

/// [bubble]: a wet foam of discs or balls that push, move and exchange gas. Dimensionless: lengths in units of the
/// user's choice (mean_radius = 1 is natural), times in units of viscosity/surface_tension.
struct Options {
    int dimension = 2;
    int count = 10000;
    int end_count = 300;
    TimeUnit time_unit = TimeUnit::kScaled;
    double mean_radius = 1.0;
    double gas_fraction = 0.95;
    Vec3 box_shape{{1.0, 1.0, 1.0}};
    std::array<bool, 3> walls{false, false, false};
    double wall_drag = 0.1;
    bool wall_blocks_gas = false;
    double surface_tension = 1.0;
    double viscosity = 1.0;
    Drag drag = Drag::kBackground;
    double pair_viscosity = 1.0;
    double min_radius = 0.1;
    FlowOptions flow;
    GasOptions gas;
    StartOptions start;
    IntegratorOptions integrator;
    CompatOptions compat;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("dimension", dimension, between(2, 3), {"2: discs, 3: balls"});
        option("count", count, between(1, 2e9), {"bubbles at the start", "-", "[Lankinen20, A.1 numBubblesIn]"});
        option("end_count", end_count, at_least(1), {"stop when no more than this many are left", "-",
                                                     "[Lankinen20, A.1 minNumBubbles]"});
        option("time_unit", time_unit,
               choices<TimeUnit>({{"scaled", TimeUnit::kScaled}, {"mechanical", TimeUnit::kMechanical}}),
               {"the unit of every time in the scene: scaled tau = K t/<R_in>^2, or t itself", "-",
                "[Lankinen20, 2.3.2]"});
        option("mean_radius", mean_radius, more_than(0.0), {"<R_in>: mean of the first radii; sets the unit of length",
                                                            "length", "[Lankinen20, A.1 avgRad]"});
        option("gas_fraction", gas_fraction, strictly_between(0.0, 2.0),
               {"phi: volume of the balls / volume of the box, overlaps counted twice", "-",
                "[Lankinen20, A.1 phiTarget]"});
        option("box_shape", box_shape, more_than(0.0), {"relative edge lengths of the box", "-",
                                                        "[Lankinen20, A.1 boxRelDim]"});
        option("walls", walls, {"a wall at both ends of the axis instead of a periodic box, per axis", "-",
                                "cubble box.wall"});
        option("wall_drag", wall_drag, between(0.0, 1.0), {"0: bubbles slip along walls, 1: they stick", "-",
                                                           "[Lankinen20, A.1 wallDragStrength]"});
        option("wall_blocks_gas", wall_blocks_gas, {"the part of a bubble that touches a wall exchanges no gas"});
        option("surface_tension", surface_tension, more_than(0.0), {"sigma_0: stiffness of a contact", "-",
                                                                    "[Lankinen20, eq. 2.13]"});
        option("viscosity", viscosity, more_than(0.0), {"mu_0: drag against the liquid", "-", "[Lankinen20, eq. 2.15]"});
        option("drag", drag,
               choices<Drag>({{"background", Drag::kBackground},
                              {"neighbor_lagged", Drag::kNeighborLagged},
                              {"pairwise", Drag::kPairwise}}),
               {"what resists a bubble's motion: the liquid; the mean velocity of the bubbles it touched at the last step"
                " (as the published code; depends on the step size); or each bubble it touches and the liquid",
                "-", "[Lankinen20, eq. 2.15]; pairwise: [Tewari99]"});
        option("pair_viscosity", pair_viscosity, at_least(0.0), {"mu_b: drag between touching bubbles of pairwise"});
        option("min_radius", min_radius, strictly_between(0.0, 1.0),
               {"a bubble vanishes at this times mean_radius; its gas goes to the others", "-", "[Lankinen20, 3.3.2]"});
        option.group("flow", flow, "a prescribed velocity of the liquid");
        option.group("gas", gas, "exchange of gas between the bubbles");
        option.group("start", start, "the first packing, and how it is brought to rest");
        option.group("integrator", integrator, "how time is stepped");
        option.group("compat", compat, "the published program's behavior where it is wrong, for comparison");
    }
};

}  // namespace lamella::bubble
