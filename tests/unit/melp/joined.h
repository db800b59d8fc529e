#pragma once

// Two joined bubbles for tests of what moves films along their normals.

#include "lamella/solvers/melp/normal_motion.h"

#include "bubbles.h"
#include <memory>
#include <vector>

namespace lamella::melp {

inline std::unique_ptr<MelpSolver> joined_until(double time) {
    auto solver = started(
        "[material]\nsurface_tension = 0.025\nthickness = 5e-7\n"
        "[[bubble]]\ncenter = [-0.01005, 0, 0]\nradius = 0.01\n"
        "[[bubble]]\ncenter = [0.0093, 0, 0]\nradius = 0.0092\n"
        "[resolution]\nedge_length = 0.0015\n"
        "[melp]\nfine_ratio = 0\ndamping = 500.0\nsteps_per_period = 60.0\n");
    advance_to(*solver, time);
    return solver;
}

/// Two joined bubbles, whose particles the tests move.
class Joined {
public:
    Joined() : solver_(joined_until(0.008)) {
        coarse = solver_->coarse();
        std::size_t deepest = 0;
        const Neighbors& other = solver_->geometry().neighbors.other;
        for (std::size_t i = 0; i < coarse.size(); ++i)
            if (other.end(i) - other.begin(i) > other.end(deepest) - other.begin(deepest)) deepest = i;
        on_partition = deepest;
    }

    const MelpSolver& solver() const { return *solver_; }

    /// What `use` makes of the problem with the particles as they are now.
    template <class Use>
    void problem(Use&& use, double shape_damping = 0.0) const {
        const Geometry geometry = geometry_of(coarse, solver_->geometry().neighbors.same.kernel.support_radius);
        const std::vector<double> ones(coarse.size(), 1.0), tension(coarse.size(), kTension);
        const std::vector<Vec3> nothing(coarse.size());
        const NormalProblem problem{.coarse = coarse,
                                    .geometry = geometry,
                                    .gas = solver_->gas(),
                                    .rims = {},
                                    .walls = {},
                                    .joined = {},
                                    .outside_pressure = 1e5,
                                    .mass = ones,
                                    .interface_tension = tension,
                                    .velocity = ones,
                                    .internal = nothing,
                                    .external = nothing,
                                    .even = true,
                                    .floating = false,
                                    .junction_correction = 0.17,
                                    .damping = 0.0,
                                    .shape_damping = shape_damping,
                                    .theta = 1.0,
                                    .dt = 1e-4,
                                    .tolerance = 1e-6};
        use(problem);
    }

    CoarseParticles coarse;
    std::size_t on_partition;  ///< a particle that sees much of the other bubble

private:
    std::unique_ptr<MelpSolver> solver_;
};

}  // namespace lamella::melp
