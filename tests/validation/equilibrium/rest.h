#pragma once

#include "lamella/mesh/check.h"
#include "lamella/scene/scene.h"
#include "lamella/scene/shipped.h"
#include "lamella/solvers/equilibrium/equilibrium_solver.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lamella::equilibrium {

/// A solver at rest, and what the tests ask of it.
struct Rest {
    RestAnswer answer;
    mesh::FoamMesh mesh;
    std::size_t faces = 0;
    std::int64_t steps = 0;
    int iterations = 0;
    double volume_error = 0.0;
    double residual = 0.0;
};

/// The films of a shipped scene, brought to rest.
inline Rest rest_of(const std::string& name, const std::vector<std::string>& overrides = {}) {
    const sim::SolverRegistry registry = scene::all_solvers();
    const scene::Scene scene =
        scene::load_scene(scene::resolve_scene_path("equilibrium/" + name), overrides, registry);
    const auto solver = scene::create_solver(scene, registry);
    auto& equilibrium = dynamic_cast<EquilibriumSolver&>(*solver);
    equilibrium.start({});
    while (!equilibrium.stop_reason()) equilibrium.advance(1.0);
    Rest rest{*equilibrium.answer(),      equilibrium.relaxation().mesh(),       equilibrium.relaxation().mesh().faces.size(),
              equilibrium.step(), equilibrium.relaxation().iterations(), 0.0,
              equilibrium.relaxation().residual()};
    for (const sim::Scalar& s : equilibrium.scalars())
        if (s.name == "volume_error") rest.volume_error = s.value;
    if (!equilibrium.relaxation().mesh().periodic())
        for (const std::string& fault : mesh::faults(equilibrium.relaxation().mesh())) ADD_FAILURE() << name << fault;
    return rest;
}

}  // namespace lamella::equilibrium
