#pragma once

#include "lamella/mesh/check.h"
#include "lamella/scene/scene.h"
#include "lamella/solvers/equilibrium/equilibrium_solver.h"

#include <gtest/gtest.h>

#include <string>

namespace lamella::equilibrium {

struct Popped {
    int t1 = 0, pops = 0;
    std::size_t bubbles_left = 0;
};

/// A random cluster brought to rest and burst bubble by bubble to the last, at rest before every burst.
inline Popped pop_to_the_last(int bubbles, int seed) {
    const auto number = [](int n) { return std::to_string(n); };
    const std::string text = "solver = \"equilibrium\"\nseed = " + number(seed) + "\n[foam]\ncount = " + number(bubbles) +
                             "\nvolume = \"1 cm^3\"\n[resolution]\nedge_length = \"2.5 mm\"\n[[event]]\nkind = \"pop\"\n"
                             "time = 1.0\nregion = 0\nrepeat = " + number(bubbles - 1) +
                             "\ninterval = 1.0\n[time]\nend = " + number(bubbles) +
                             "\nframe_rate = 1\n[equilibrium]\neigenvalue = false\n";
    const auto registry = scene::all_solvers();
    const auto solver = scene::create_solver(scene::parse_scene(text, "popped.toml", {}, registry), registry);
    auto& films = dynamic_cast<EquilibriumSolver&>(*solver);
    Popped popped;
    films.start({});
    while (films.time() < bubbles || !films.answer()) {
        const bool rested = films.relaxation().at_rest();
        films.advance(bubbles);
        for (const sim::Event& event : films.take_events()) {
            popped.t1 += event.kind == "t1" ? 1 : 0;
            popped.pops += event.kind == "pop" ? 1 : 0;
        }
        if (rested || !films.relaxation().at_rest()) continue;
        const auto found = mesh::faults(films.relaxation().mesh());
        EXPECT_TRUE(found.empty()) << bubbles << " bubbles, seed " << seed << ", " << popped.pops << " burst: " << found.front();
    }
    for (const mesh::Region& region : films.relaxation().mesh().regions)
        popped.bubbles_left += region.kind == mesh::RegionKind::kClosed ? 1 : 0;
    return popped;
}

}  // namespace lamella::equilibrium
