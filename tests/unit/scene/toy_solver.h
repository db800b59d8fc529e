#pragma once

// A solver that does nothing, with one option of every kind: what the scene reader is tested with.

#include "lamella/core/error.h"
#include "lamella/sim/read_options.h"
#include "lamella/sim/registry.h"
#include "lamella/solvers/bubble/options.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace lamella::toy {

enum class Color { kRed, kGreen, kBlue };

struct FlowOptions {
    Color color = Color::kGreen;
    Vec3 velocity{{0.5, 0.0, 0.0}};
    double tolerance = 1e-3;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("color", color,
               sim::choices<Color>({{"red", Color::kRed}, {"green", Color::kGreen}, {"blue", Color::kBlue}}),
               {"a color"});
        option("velocity", velocity, sim::any_number(), {"of the liquid", "m/s"});
        option("tolerance", tolerance, sim::more_than(0.0), {"largest error", "length"});
    }
};

struct Options {
    int count = 10;
    std::int64_t big = 1;
    double fraction = 0.25;
    double radius = 0.05;
    double tilt = 0.0;
    bool fast = false;
    std::array<bool, 3> walls{false, true, false};
    std::string file;
    std::string label = "none";
    FlowOptions flow;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("count", count, sim::between(1, 2e9), {"bubbles at the start"});
        option("big", big, sim::any_number(), {"a large number"});
        option("fraction", fraction, sim::between(0.0, 1.0), {"gas volume / box volume"});
        option("radius", radius, sim::more_than(0.0), {"of a bubble", "m", "[Key, eq. 3]"});
        option("tilt", tilt, sim::any_number(), {"of the plate", "deg"});
        option("fast", fast, {"hurry"});
        option("walls", walls, {"walls per axis"});
        option("file", file, {"positions", "path"});
        option("label", label, {"free text"});
        option.group("flow", flow, "a prescribed flow");
    }
};

class Solver final : public sim::Solver {
public:
    explicit Solver(const sim::SolverInput& input)
        : options(sim::read_options<Options>(input.options)), seed(input.seed) {}

    void start(const sim::StartContext&) override {}
    sim::StepReport advance(double time_limit) override {
        time_ = time_limit;
        return {};
    }
    double time() const override { return time_; }
    std::int64_t step() const override { return 0; }
    sim::Frame frame() const override { return {}; }
    std::vector<sim::Scalar> scalars() const override { return {}; }
    void save(sim::StateWriter&) const override {}
    void load(sim::StateReader&) override {}

    Options options;
    std::uint64_t seed;

private:
    double time_ = 0.0;
};

inline sim::SolverEntry entry(std::string name, std::string time_unit) {
    return {.name = std::move(name),
            .summary = "nothing moves",
            .time_unit = std::move(time_unit),
            .create = [](const sim::SolverInput& input) { return std::make_unique<Solver>(input); },
            .describe = [] { return sim::describe_options<Options>(); },
            .resolve = [](const sim::Node& node) { return sim::resolve_options(sim::read_options<Options>(node)); }};
}

/// The options of the bubble solver without the solver.
inline sim::SolverEntry bubble_entry() {
    return {.name = "bubble",
            .summary = "options only",
            .time_unit = "-",
            .create =
                [](const sim::SolverInput& input) {
                    sim::read_options<bubble::Options>(input.options);
                    return std::make_unique<Solver>(sim::SolverInput{});
                },
            .describe = [] { return sim::describe_options<bubble::Options>(); },
            .resolve =
                [](const sim::Node& node) { return sim::resolve_options(sim::read_options<bubble::Options>(node)); }};
}

/// "toy" counts time in seconds, "still" has none.
inline sim::SolverRegistry registry() {
    sim::SolverRegistry solvers;
    solvers.add(entry("toy", "s"));
    solvers.add(entry("still", "-"));
    solvers.add(bubble_entry());
    return solvers;
}

}  // namespace lamella::toy
