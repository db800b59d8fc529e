#include "lamella/solvers/bubble/bubble_solver.h"

#include "lamella/core/error.h"
#include "lamella/core/fixed_sum.h"
#include "lamella/core/parallel.h"
#include "lamella/dist/agree.h"
#include "lamella/dist/gather.h"
#include "lamella/solvers/bubble/census.h"
#include "lamella/solvers/bubble/detail/device_runner.h"
#include "lamella/solvers/bubble/detail/device_team.h"
#include "lamella/solvers/bubble/relax.h"
#include "lamella/solvers/bubble/removal.h"
#include "lamella/solvers/bubble/start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace lamella::bubble {
namespace {

SourceLocation location_of(const sim::Node& options, std::string_view key) {
    const sim::Node* node = options.find(key);
    return node != nullptr ? node->where : options.where;
}

/// What no single option can know.
void check_together(const Options& o, const sim::Node& given) {
    const auto fail = [&](std::string_view table, std::string_view key, const std::string& message) {
        const sim::Node* group = table.empty() ? &given : given.find(table);
        throw InputError(group != nullptr ? location_of(*group, key) : given.where, message);
    };
    if (o.time_unit == TimeUnit::kScaled && o.gas.exchange_rate == 0.0)
        fail("gas", "exchange_rate",
             "bubble.gas.exchange_rate = 0 stops the scaled time tau = K t/<R_in>^2; set bubble.time_unit = "
             "\"mechanical\"");
    if (o.gas.medium_scaling == MediumScaling::kLsw && o.dimension != 3)
        fail("gas", "medium_scaling",
             "bubble.gas.medium_scaling = \"lsw\" is diffusion around spheres and needs bubble.dimension = 3; in 2D use"
             " \"radius\"");
    if (o.start.packing == Packing::kFile && o.start.file.empty())
        fail("start", "packing",
             "bubble.start.packing = \"file\" needs bubble.start.file, a CSV file with x, y, z, radius");
    for (std::size_t k = 0; k < static_cast<std::size_t>(o.dimension); ++k)
        if ((o.start.file_box[k] > 0.0) != (o.start.file_box[0] > 0.0))
            fail("start", "file_box",
                 "bubble.start.file_box has edges that are 0 and edges that are not; give all or none");
    if (o.flow.kind == FlowKind::kShear && !o.walls[1])
        fail("flow", "kind",
             "bubble.flow.kind = \"shear\" has its gradient along y and needs walls there:"
             " bubble.walls = [false, true, false]");
    if (o.flow.kind == FlowKind::kRegion)
        for (std::size_t k = 0; k < static_cast<std::size_t>(o.dimension); ++k)
            if (o.flow.region_low[k] > o.flow.region_high[k])
                fail("flow", "region_low",
                     fmt::format("bubble.flow.region_low[{0}] = {1} lies above region_high[{0}] = {2}", k,
                                 o.flow.region_low[k], o.flow.region_high[k]));
    const bool published = o.compat.clock || o.compat.step_control != StepControl::kDefault;
    if (published && o.integrator.method != Method::kAbm2)
        fail("compat", o.compat.clock ? "clock" : "step_control",
             "bubble.compat.clock and step_control belong to the published scheme; set bubble.integrator.method = "
             "\"abm2\"");
}

std::vector<GivenBubble> read_bubbles(const Options& o, const sim::SolverInput& input) {
    if (o.start.packing != Packing::kFile) return {};
    const sim::NumberTable table = input.read_table(o.start.file);
    const auto column = [&](const std::string& name) {
        for (std::size_t c = 0; c < table.header.size(); ++c) {
            const std::string& title = table.header[c];
            if (title.substr(0, title.find('[')) == name) return c;
        }
        throw InputError({o.start.file, 1, 0}, fmt::format("there is no column {}; columns x, y, {}radius are needed",
                                                           name, o.dimension == 3 ? "z, " : ""));
    };
    const std::size_t radius = column("radius");
    std::vector<std::size_t> axes = {column("x"), column("y")};
    if (o.dimension == 3) axes.push_back(column("z"));
    if (table.rows.empty()) throw InputError({o.start.file, 1, 0}, "there are no bubbles below the header");
    std::vector<GivenBubble> given(table.rows.size());
    for (std::size_t i = 0; i < given.size(); ++i) {
        const auto& row = table.rows[i];
        given[i].radius = row[radius];
        for (std::size_t k = 0; k < axes.size(); ++k) given[i].position[k] = row[axes[k]];
        const bool good = std::isfinite(row[radius]) && row[radius] > 0.0 &&
                          std::all_of(axes.begin(), axes.end(), [&](std::size_t a) { return std::isfinite(row[a]); });
        if (!good)
            throw InputError(
                {o.start.file, static_cast<int>(i) + 2, 0},
                fmt::format("a bubble needs a finite position and a radius above 0; radius is {}", row[radius]));
    }
    return given;
}

}  // namespace

template <int D>
BubbleSolver<D>::BubbleSolver(const Options& options, const sim::SolverInput& input)
    : options_(options),
      input_(input),
      domain_(input.processes ? *input.processes : static_cast<dist::Communicator&>(alone_)) {
    check_together(options, input.options);
    if (input.device != Device::kCpu)
        if (const std::string what = detail::not_on_device(options); !what.empty())
            throw InputError(input.options.where, what + " does not run on a GPU; use --device cpu");
    system_ = std::make_unique<System<D>>(options_, domain_);
    time_rate_ = options.time_unit == TimeUnit::kScaled ? system_->model.scaled_time_rate() : 1.0;
    make_integrator();
}

template <int D>
BubbleSolver<D>::~BubbleSolver() = default;

template <int D>
void BubbleSolver<D>::make_integrator() {
    integrator_ = options_.integrator.method == Method::kRkc2 ? make_rkc2<D>(options_, *system_)
                                                              : make_abm2<D>(options_, *system_);
}

template <int D>
void BubbleSolver<D>::start(const sim::StartContext& context) {
    System<D>& s = *system_;
    const std::vector<GivenBubble> given =
        dist::together(domain_.processes(), [&] { return read_bubbles(options_, input_); });
    context.progress("packing", 0.0);
    pack<D>(options_, input_.seed, given, domain_.processes(), s.foam);
    domain_.expect_items(static_cast<double>(s.foam.live));
    s.distribute();
    part_coincident(options_, input_.seed, s.foam);
    const bool dilates = options_.start.relax_gas_fraction > 0.0;
    if (!has_file_box(options_))
        scale_to_gas_fraction<D>(options_, dilates ? options_.start.relax_gas_fraction : options_.gas_fraction, domain_,
                                 s.foam);
    remember_start();
    s.prepare(LiquidMotion::kAtRest);
    s.rebuild();
    if (options_.start.max_iterations > 0) {
        const Relaxation relaxation = relax(s, options_, context);
        context.log(relaxation.at_rest ? LogLevel::kInfo : LogLevel::kWarning,
                    fmt::format("relaxed for {} iterations; mean net force / mean contact force = {:.2g}{}",
                                relaxation.iterations, relaxation.residual,
                                relaxation.at_rest ? "" : ", above bubble.start.force_tolerance"));
    }
    if (dilates && !has_file_box(options_)) scale_to_gas_fraction<D>(options_, options_.gas_fraction, domain_, s.foam);
    remember_start();
    s.prepare(LiquidMotion::kAsGiven);
    s.rebuild();
    make_integrator();
    integrator_->begin(s);
    look_for_the_largest();
    take_to_device();
}

template <int D>
void BubbleSolver<D>::take_to_device() {
    if (input_.device == Device::kCpu) return;
    auto team = detail::make_device_team<D>(domain_, system_->ownership());
    device_ = input_.device == Device::kCuda
                  ? detail::make_cuda_runner<D>(options_, std::move(team))
                  : detail::make_twin_runner<D>(options_, HostMachine::Order::kShuffled, std::move(team));
    device_->upload(system_->foam, system_->model, clock_, integrator_->state());
    observed_ = true;
}

template <int D>
void BubbleSolver<D>::observe() const {
    if (observed_) return;
    device_->download(system_->foam);
    integrator_->set_state(device_->integrator_state());
    system_->rebuild();
    observed_ = true;
}

template <int D>
std::size_t BubbleSolver<D>::live() const {
    return device_ ? device_->control().live : system_->foam.live;
}

template <int D>
void BubbleSolver<D>::look_for_the_largest() {
    const Foam<D>& foam = system_->foam;
    largest_size_ = domain_.largest(parallel_max(foam.slots, 0.0, [&](std::size_t i) { return foam.size[i]; }));
}

/// As the steps of the CPU leave them: in the order of steps and ids, and with several processes on the first of them.
template <int D>
void BubbleSolver<D>::take_vanished_from_device() {
    using Vanished = detail::VanishedBubble<D>;
    const std::vector<Vanished> own = device_->take_vanished();
    std::vector<Vanished> all = dist::gather(domain_.processes(), std::span<const Vanished>(own));
    std::sort(all.begin(), all.end(),
              [](const Vanished& a, const Vanished& b) { return a.step != b.step ? a.step < b.step : a.id < b.id; });
    for (const Vanished& bubble : all) {
        sim::Event event{
            .time = bubble.time, .kind = "remove", .position = {}, .detail = fmt::format("bubble {}", bubble.id)};
        for (std::size_t k = 0; k < D; ++k) event.position[k] = bubble.position[k];
        events_.push_back(std::move(event));
    }
}

/// Many steps at once, as far as nothing of the host's is due.
template <int D>
sim::StepReport BubbleSolver<D>::advance_on_device(double time_limit) {
    constexpr std::int64_t kStepsPerVisit = 64;
    const auto working = system_->ownership().working();
    const Clock before = clock_;
    const std::uint64_t live_before = device_->control().live;
    device_->advance(time_limit, kStepsPerVisit);
    observed_ = false;
    const detail::Control& control = device_->control();
    clock_ = control.clock;
    largest_size_ = control.max_size;
    if (control.live < live_before) take_vanished_from_device();
    if (control.waiting == detail::Waiting::kUnderflow)
        throw NumericalError(step_underflow(control.error, control.step_tolerance));
    if (control.waiting == detail::Waiting::kNothing)
        throw NumericalError(fmt::format("all {} bubbles would vanish in one step", control.live));
    return {.step = clock_.time - before.time,
            .evaluations = clock_.evaluations - before.evaluations,
            .iterations = 0,
            .residual = control.error};
}

/// The state from which times, paths, displacements and means of the start count.
template <int D>
void BubbleSolver<D>::remember_start() {
    Foam<D>& foam = system_->foam;
    Model& model = system_->model;
    for (std::size_t k = 0; k < D; ++k) {
        foam.start[k] = foam.marked[k] = foam.position[k];
        std::fill(foam.wraps[k].begin(), foam.wraps[k].end(), 0);
        std::fill(foam.velocity[k].begin(), foam.velocity[k].end(), 0.0);
    }
    std::fill(foam.path_length.begin(), foam.path_length.end(), 0.0);
    start_count_ = static_cast<std::int64_t>(foam.live);
    start_gas_ = system_->total_size();
    model.total_size = start_gas_;
    model.largest_count = static_cast<double>(start_count_);
    model.initial_mean_radius = system_->mean_radius();
    model.initial_mean_surface = domain_.exact_sum(foam.slots, [&](std::size_t i) {
        return Shape<D>::surface(Shape<D>::radius(foam.size[i]));
    }) / model.largest_count;
}

template <int D>
sim::StepReport BubbleSolver<D>::advance(double time_limit) {
    if (device_) return advance_on_device(time_limit);
    const auto working = system_->ownership().working();
    const double wanted = std::min(integrator_->next_step(), options_.integrator.max_step);
    const Landing landing = clock_.landing(time_limit, time_rate_, wanted);
    const Step step = integrator_->step(*system_, landing.longest);
    clock_.tick(step, landing, time_limit, time_rate_);

    Removal removal = remove_vanished(*system_, options_.compat.removal);
    if (!removal.events.empty()) integrator_->foam_changed();
    system_->follow_images();  // builds lists of what is left, so not before the vanished are known
    largest_size_ = removal.largest_size;
    for (sim::Event& event : removal.events) {
        event.time = clock_.time;
        events_.push_back(std::move(event));
    }
    return {.step = step.clock * time_rate_, .evaluations = step.evaluations, .iterations = 0, .residual = step.error};
}

template <int D>
std::optional<std::string> BubbleSolver<D>::stop_reason() const {
    if (live() <= static_cast<std::size_t>(options_.end_count))
        return fmt::format("{} bubbles are left (bubble.end_count = {})", live(), options_.end_count);
    const double largest = Shape<D>::radius(largest_size_);
    if (2.0 * largest >= system_->foam.box.shortest_edge())
        return fmt::format("the largest bubble, of radius {:.4g}, spans the box", largest);
    return std::nullopt;
}

/// Work goes roughly with the logarithm of time: as the foam coarsens there are fewer bubbles and longer steps. The
/// time at which end_count is reached follows from N ~ (1 + tau/tau_c)^-0.9, with tau_c from the foam itself once
/// enough bubbles have vanished. Only the progress display rests on this.
template <int D>
std::optional<double> BubbleSolver<D>::progress() const {
    constexpr double kDecay = 1.0 / 0.9;
    constexpr double kEarly = 0.6;
    const auto start = static_cast<double>(start_count_);
    if (!system_->model.exchanges_gas() || start <= options_.end_count) return std::nullopt;
    const double tau = clock_.mechanical_time * system_->model.scaled_time_rate();
    const double shrunk = start / static_cast<double>(live());
    const double crossover = shrunk > 1.1 ? tau / (std::pow(shrunk, kDecay) - 1.0) : 2.5;
    const double end = crossover * (std::pow(start / options_.end_count, kDecay) - 1.0);
    return std::min(0.99, std::log1p(tau / kEarly) / std::log1p(end / kEarly));
}

template <int D>
std::vector<sim::Event> BubbleSolver<D>::take_events() {
    return std::exchange(events_, {});
}

template <int D>
void BubbleSolver<D>::mark_frame() {
    if (device_) device_->mark_frame();
    if (observed_) system_->foam.marked = system_->foam.position;
}

template class BubbleSolver<2>;
template class BubbleSolver<3>;

}  // namespace lamella::bubble
