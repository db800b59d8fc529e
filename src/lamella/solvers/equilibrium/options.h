#pragma once

#include "lamella/sim/options.h"
#include "lamella/solvers/equilibrium/newton.h"

namespace lamella::equilibrium {

/// [equilibrium] of a scene.
struct Options {
    Goal goal = Goal::kMinimum;
    double tolerance = 1e-8;
    int coarse_faces = 2000;
    double flow_step = 0.1;
    int max_steps = 800;
    bool merging = true;
    bool separating = true;
    bool eigenvalue = true;
    double angle_tolerance = 0.0;
    int anneal_rounds = 0;
    double anneal_strength = 0.8;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("goal", goal, sim::choices<Goal>({{"minimum", Goal::kMinimum}, {"stationary", Goal::kStationary}}),
               {"minimum: least area, leaving saddles; stationary: the resting shape next to the start, saddles too, on"
                " the mesh as it is"});
        option("tolerance", tolerance, sim::strictly_between(0.0, 1.0),
               {"force out of balance, relative to the films' own, at which they are at rest"});
        option("coarse_faces", coarse_faces, sim::at_least(100),
               {"bubbles come to rest on about so many faces first, then on finer meshes"});
        option("flow_step", flow_step, sim::strictly_between(0.0, 10.0),
               {"pseudo time of a flow step, in squared radii of the smallest bubble"});
        option("max_steps", max_steps, sim::at_least(1), {"steps to one rest after which the run fails"});
        option("merging", merging, {"films that touch become one"});
        option("separating", separating, {"crossings that Plateau's laws forbid part; false keeps them"});
        option("eigenvalue", eigenvalue, {"report the lowest eigenvalue of the second variation"});
        option("angle_tolerance", angle_tolerance, sim::between(0.0, 0.2),
               {"triangles are made finer where angles break Plateau's laws by more, and the angles measured there; 0: on the mesh as it is",
                "rad"});
        option("anneal_rounds", anneal_rounds, sim::between(0, 10000),
               {"bubbles are inflated and deflated at random so many times, and the least area is kept"});
        option("anneal_strength", anneal_strength, sim::strictly_between(0.0, 1.0),
               {"by how much of their volume, at most"});
    }
};

}  // namespace lamella::equilibrium
