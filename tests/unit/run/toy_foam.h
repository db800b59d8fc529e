#pragma once

// A foam of balls that decay: small, exactly repeatable, and touchy. Its steps have uneven lengths that depend on the
// state, so a run that is resumed from anything but the exact state comes out different.

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/scene/scene.h"
#include "lamella/sim/read_options.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lamella::run {

struct ToyOptions {
    int count = 40;
    int end_count = 0;
    double fail_at = 0.0;
    bool stall = false;

    template <class Visitor>
    void visit(Visitor&& option) {
        option("count", count, sim::between(1, 100000), {"balls at the start"});
        option("end_count", end_count, sim::at_least(0), {"stop when no more than this many are left"});
        option("fail_at", fail_at, sim::at_least(0.0), {"fail numerically at this time; 0: never"});
        option("stall", stall, {"take steps that lead nowhere"});
    }
};

/// What a test wants to see or do inside the solver.
struct ToyHooks {
    std::function<void(std::int64_t step)> before_step = [](std::int64_t) {};
    std::function<void()> in_start = [] {};
};

class ToyFoam final : public sim::Solver {
public:
    ToyFoam(const sim::SolverInput& input, std::shared_ptr<ToyHooks> hooks)
        : options_(sim::read_options<ToyOptions>(input.options)), seed_(input.seed), hooks_(std::move(hooks)) {}

    void start(const sim::StartContext& context) override {
        hooks_->in_start();
        if (context.stop_requested()) throw Interrupted();
        for (int i = 0; i < options_.count; ++i) {
            const double u =
                std::fmod(static_cast<double>(i + 1) * 0.6180339887 + 1e-3 * static_cast<double>(seed_), 1.0);
            x_.push_back(10.0 * u);
            radius_.push_back(0.3 + 0.5 * std::fmod(7.3 * u, 1.0));
            id_.push_back(i);
        }
        marked_ = x_;
    }

    sim::StepReport advance(double time_limit) override {
        hooks_->before_step(step_);
        if (options_.fail_at > 0.0 && time_ >= options_.fail_at) throw NumericalError("the toy broke");
        if (options_.stall) return {};
        const double wanted = 0.013 * (1.5 + std::sin(1e3 * radius_.at(0)));
        const bool lands = time_ + wanted >= time_limit;
        const double h = lands ? time_limit - time_ : wanted;
        const double mean = parallel_sum(radius_.size(), [&](std::size_t i) { return radius_[i]; }) /
                            static_cast<double>(radius_.size());
        parallel_for(x_.size(), [&](std::size_t i) {
            x_[i] = std::fmod(x_[i] + h * std::sin(x_[i] + radius_[i]) + 10.0, 10.0);
            radius_[i] += h * 0.3 * (1.0 / mean - 1.0 / radius_[i]);
        });
        time_ = lands ? time_limit : time_ + h;
        ++step_;
        remove_small();
        return {.step = h, .evaluations = 1};
    }

    double time() const override { return time_; }
    std::string time_unit() const override { return "-"; }
    std::int64_t step() const override { return step_; }
    std::optional<std::string> stop_reason() const override {
        if (static_cast<int>(x_.size()) > std::max(1, options_.end_count)) return std::nullopt;
        return fmt::format("{} balls are left", x_.size());
    }

    sim::Frame frame() const override {
        sim::Frame frame;
        frame.solver = "toy_foam";
        frame.time = time_;
        frame.time_unit = "-";
        frame.step = step_;
        frame.box =
            sim::Box{.dimension = 2, .origin = {}, .lengths = {{10.0, 10.0, 0.0}}, .periodic = {true, true, false}};
        frame.points.length_unit = "-";
        frame.points.radius = radius_;
        sim::Field moved{"frame_displacement", "-", 3, false, std::vector<double>(3 * x_.size())};
        sim::Field ids{"id", "-", 1, true, {}};
        for (std::size_t i = 0; i < x_.size(); ++i) {
            frame.points.position.push_back({{x_[i], 5.0, 0.0}});
            moved.values[3 * i] = x_[i] - marked_[i];
            ids.values.push_back(static_cast<double>(id_[i]));
        }
        frame.points.fields = {ids, moved};
        frame.scalars = scalars();
        return frame;
    }
    void mark_frame() override { marked_ = x_; }
    std::vector<sim::Scalar> scalars() const override {
        return {{"total", "-", parallel_sum(x_.size(), [&](std::size_t i) { return x_[i] * radius_[i]; })},
                {"steps", "-", static_cast<double>(step_)}};
    }
    std::vector<sim::Event> take_events() override { return std::exchange(events_, {}); }

    void save(sim::StateWriter& out) const override {
        out.write_value("count", static_cast<std::int64_t>(x_.size()));
        out.write("x", std::span<const double>(x_));
        out.write("radius", std::span<const double>(radius_));
        out.write("marked", std::span<const double>(marked_));
        out.write("id", std::span<const std::int64_t>(id_));
        out.write_value("time", time_);
        out.write_value("step", step_);
    }
    void load(sim::StateReader& in) override {
        const auto count = static_cast<std::size_t>(in.read_integer("count"));
        in.read("x", count, x_);
        in.read("radius", count, radius_);
        in.read("marked", count, marked_);
        in.read("id", count, id_);
        time_ = in.read_double("time");
        step_ = in.read_integer("step");
    }

private:
    void remove_small() {
        for (std::size_t i = x_.size(); i-- > 0;) {
            if (radius_[i] > 0.1) continue;
            events_.push_back({time_, "remove", {{x_[i], 5.0, 0.0}}, fmt::format("ball {}, \"small\"", id_[i])});
            const auto at = static_cast<std::ptrdiff_t>(i);
            x_.erase(x_.begin() + at);
            radius_.erase(radius_.begin() + at);
            marked_.erase(marked_.begin() + at);
            id_.erase(id_.begin() + at);
        }
    }

    ToyOptions options_;
    std::uint64_t seed_;
    std::shared_ptr<ToyHooks> hooks_;
    std::vector<double> x_, radius_, marked_;
    std::vector<std::int64_t> id_;
    std::vector<sim::Event> events_;
    double time_ = 0.0;
    std::int64_t step_ = 0;
};

inline sim::SolverRegistry toy_registry(std::shared_ptr<ToyHooks> hooks = std::make_shared<ToyHooks>()) {
    sim::SolverRegistry registry;
    registry.add({.name = "toy_foam",
                  .summary = "balls that decay",
                  .time_unit = "-",
                  .create = [hooks](const sim::SolverInput& input) { return std::make_unique<ToyFoam>(input, hooks); },
                  .describe = [] { return sim::describe_options<ToyOptions>(); },
                  .resolve =
                      [](const sim::Node& node) {
                          return sim::resolve_options(sim::read_options<ToyOptions>(node), "toy_foam");
                      }});
    return registry;
}

}  // namespace lamella::run
