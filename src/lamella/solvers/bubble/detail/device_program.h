#pragma once

#include "lamella/solvers/bubble/detail/device_decide.h"
#include "lamella/solvers/bubble/detail/device_gather.h"
#include "lamella/solvers/bubble/detail/device_list_builder.h"
#include "lamella/solvers/bubble/detail/device_runner.h"
#include "lamella/solvers/bubble/detail/device_share.h"
#include "lamella/solvers/bubble/detail/device_update.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace lamella::bubble::detail {

/// The program that advances a foam on a machine: what the host does between the turns of the loops.
template <int D, class Machine>
class DeviceProgram final : public DeviceRunner<D> {
public:
    /// @param team  of the devices that share the foam; nullptr: it lives on this one
    template <class... Args>
    explicit DeviceProgram(const Options& options, std::unique_ptr<DeviceTeam<D>> team, Args&&... args)
        : machine_(std::forward<Args>(args)...), options_(options), team_(std::move(team)) {}

    void upload(const Foam<D>& foam, const Model& model, const Clock& clock, const IntegratorState& state) override {
        control_ = {};
        make_room(std::max<std::size_t>(foam.slots, 1));
        for_each_column(
            foam, [&](auto* on_device, const auto* on_host) { machine_.to_device(on_device, on_host, foam.slots); });
        set_constants(foam, model);
        set_control(foam, clock, state);
        rebuild();
    }

    void advance(double limit, std::int64_t steps) override {
        Control& c = control_;
        c.limit = limit;
        c.steps_left = steps;
        c.waiting = Waiting::kNot;
        const Decide<D> decide{view_, &c};
        decide.begin_step(c);
        while (true) {
            if (c.waiting == Waiting::kLists) {
                rebuild();
                c.waiting = Waiting::kNot;
                decide.with_new_lists(c);
            }
            if (!c.running()) break;
            team_ ? turn_with_others() : turns_alone();
        }
        fetch_vanished();
    }

    const Control& control() const override { return control_; }

    void download(Foam<D>& foam) override {
        foam.resize(control_.slots);
        foam.live = control_.live;
        for_each_column(
            foam, [&](const auto* on_device, auto* on_host) { machine_.to_host(on_host, on_device, control_.slots); });
    }

    void mark_frame() override { machine_.for_each(control_.slots, MarkPosition<D>{view_}); }

    std::vector<VanishedBubble<D>> take_vanished() override { return std::exchange(vanished_, {}); }

private:
    template <class T>
    using Buffer = MachineBuffer<Machine, T>;
    static constexpr int kTurns = 16;  ///< between two looks of the host

    void turns_alone() {
        machine_.to_device(device_control_.data(), &control_, 1);
        machine_.repeat(now_, kTurns, [this] {
            update();
            gather(Bubbles::kAll, blocks_, 0);
            machine_.conclude(blocks_, update_sums_.data(), gather_sums_.data(),
                              Decide<D>{view_, device_control_.data()});
        });
        machine_.to_host(&control_, device_control_.data(), 1);
    }

    /// One turn of a foam that is shared: all hosts decide alike, on what all devices have added up.
    void turn_with_others() {
        Control& c = control_;
        const Phase phase = c.phase;
        const bool evaluates = c.evaluates();
        *host_control_.data() = c;
        machine_.begin_to_device(device_control_.data(), host_control_.data(), 1);
        update();
        if (evaluates) gather_with_copies();
        machine_.conclude(blocks_, update_sums_.data(), gather_sums_.data(), KeepTurnSums{turn_sums_.data()});
        machine_.begin_to_host(host_turn_sums_.data(), turn_sums_.data(), 1);
        if (phase == Phase::kRemove)
            machine_.begin_to_host(&host_control_.data()->events, &device_control_.data()->events, 1);
        machine_.wait();
        c.events = host_control_.data()->events;
        TurnSums& sums = *host_turn_sums_.data();
        if (phase != Phase::kKeep) add_up_turn(sums, evaluates, team_->processes());
        if (phase == Phase::kKeep || phase == Phase::kAccept || phase == Phase::kRemove) velocities_copied_ = false;
        Decide<D>{view_, &c}(sums.update, sums.gather);
    }

    void update() { machine_.reduce(blocks_, UpdateBubble<D>{view_, device_control_.data()}, update_sums_.data()); }
    void gather(Bubbles which, std::size_t blocks, std::size_t first_block) {
        machine_.reduce(blocks, GatherBubble<D>{view_, device_control_.data(), which},
                        gather_sums_.data() + first_block);
    }
    /// Bubbles that have no copies in their lists are computed while the copies travel.
    void gather_with_copies() {
        halo_.send_stage(machine_, view_, [this] { gather(Bubbles::kInterior, interior_blocks_, 0); });
        halo_.receive_stage(machine_, view_, control_.slots);
        if (options_.drag == Drag::kNeighborLagged && !velocities_copied_) {
            halo_.refresh_velocities(machine_, view_, control_.slots);
            velocities_copied_ = true;
        }
        gather(Bubbles::kBorder, blocks_ - interior_blocks_, interior_blocks_);
    }

    /// Room for `count` bubbles and copies; the foam as it stands is kept.
    void make_room(std::size_t count) {
        if (count <= columns_[now_].room()) return;
        if (team_) count += count / 4;  // copies and bubbles of others come and go
        columns_[now_].grow(machine_, count, control_.slots);
        columns_[1 - now_].reserve(count);
        lists_.reserve(count, team_ != nullptr);
        for (auto* buffer : {&film_, &weight_}) buffer->reserve(count);
        for (auto& buffer : rate_) buffer.reserve(count);
        for (auto& set : increment_)
            for (auto& buffer : set) buffer.reserve(count);
        stage_.reserve(count);
        vanished_on_device_.reserve(count);
        device_control_.reserve(1);
        host_control_.reserve(1);
        turn_sums_.reserve(1);
        host_turn_sums_.reserve(1);
        radius_sum_.reserve(1);
        radius_sums_.reserve(kMachineBlocks);
        update_sums_.reserve(2 * kMachineBlocks);
        gather_sums_.reserve(2 * kMachineBlocks);
        machine_.forget_recording();
        show_buffers();
    }

    void show_buffers() {
        columns_[now_].show(view_);
        view_.stage = stage_.data();
        view_.film = film_.data();
        view_.weight = weight_.data();
        view_.vanished = vanished_on_device_.data();
        for (int k = 0; k < D; ++k) view_.rate[k] = rate_[k].data();
        for (int set = 0; set < 2; ++set) {
            for (int k = 0; k < D; ++k) view_.increment[set][k] = increment_[set][k].data();
            view_.size_increment[set] = increment_[set][D].data();
        }
    }

    /// copy(on_device, on_host) for each column of the foam.
    template <class HostFoam, class Copy>
    void for_each_column(HostFoam& foam, Copy&& copy) {
        for (std::size_t k = 0; k < D; ++k) {
            copy(view_.position[k], foam.position[k].data());
            copy(view_.velocity[k], foam.velocity[k].data());
            copy(view_.start[k], foam.start[k].data());
            copy(view_.marked[k], foam.marked[k].data());
            copy(view_.wraps[k], foam.wraps[k].data());
        }
        copy(view_.size, foam.size.data());
        copy(view_.size_rate, foam.size_rate.data());
        copy(view_.path_length, foam.path_length.data());
        copy(view_.id, foam.id.data());
    }

    void set_constants(const Foam<D>& foam, const Model& model) {
        view_.model = model;
        view_.liquid = LiquidLaw<D>::from(options_, model.push_rate, foam.box);
        view_.inverse_lengths = foam.box.inverse_lengths();
        view_.no_gas = empty_gas_sums<D>(model);
        view_.min_radius = Shape<D>::radius(model.min_size);

        constexpr int kMost = chebyshev::kMostStages;
        std::vector<chebyshev::StageWeights> table(static_cast<std::size_t>((kMost + 1) * (kMost + 2) / 2));
        for (int s = 2; s <= kMost; ++s) {
            const auto weights = chebyshev::stage_weights(s);
            std::copy(weights.begin(), weights.end(), table.begin() + s * (s + 1) / 2);
        }
        weights_.reserve(table.size());
        machine_.to_device(weights_.data(), table.data(), table.size());
        view_.weights = weights_.data();
    }

    void set_control(const Foam<D>& foam, const Clock& clock, const IntegratorState& state) {
        Control& c = control_;
        c.end_count = options_.end_count;
        c.time_rate = options_.time_unit == TimeUnit::kScaled ? view_.model.scaled_time_rate() : 1.0;
        c.max_step = options_.integrator.max_step;
        c.tolerance = options_.integrator.tolerance;
        c.relative_error = options_.integrator.relative_error ? 1 : 0;
        c.rms_error = options_.integrator.norm == ErrorNorm::kRms ? 1 : 0;
        c.printed_removal = options_.compat.removal ? 1 : 0;
        c.shortest_edge = foam.box.shortest_edge();
        c.box_volume = foam.box.volume();
        c.slots = foam.slots;
        c.live = foam.live;
        own_ = 0;
        for (std::size_t i = 0; i < foam.slots; ++i) {
            c.max_size = std::max(c.max_size, foam.size[i]);
            if (foam.alive(i)) ++own_;
        }
        if (team_) {
            c.most_terms = team_->most_terms();
            team_->processes().largest(std::span(&c.max_size, 1));
        }
        c.clock = clock;
        c.next_step = state.next_step;
        c.stiffness = state.stiffness;
        c.rates_current = state.rates_current ? 1 : 0;
    }

    /// New lists for the current state; vanished bubbles leave their slots. See System::rebuild.
    void rebuild() {
        fetch_vanished();
        Control& c = control_;
        const double mean = mean_radius();
        const double largest = Shape<D>::radius(c.max_size);
        const double skin = std::max(options_.integrator.skin * mean, 2.0 * c.least_reach);
        const spatial::PeriodicBox<D>& box = view_.liquid.box;
        bool images = false;
        for (std::size_t k = 0; k < D; ++k)
            images = images || (box.periodic[k] && box.lengths[k] <= 2.0 * (2.0 * largest + skin));
        ListInput<D> input{.frame = spatial::SearchFrame<D>(box),
                           .slots = c.slots,
                           .live = own_,
                           .copies = 0,
                           .mean_radius = mean,
                           .largest_radius = largest,
                           .skin = skin,
                           .images = images};
        if (team_) exchange_bubbles(input);
        lists_.arrange(machine_, view_, input);
        reorder(input);
        lists_.show(view_);
        lists_.fill(machine_, view_.id);
        c.slots = own_;
        c.interior = lists_.interior();
        c.reach = 0.5 * skin;
        c.expansion = 0.0;
        choose_blocks(images);
    }

    /// Every bubble goes to the device that owns its place, and copies come of those that may touch the bubbles here.
    void exchange_bubbles(ListInput<D>& input) {
        Control& c = control_;
        std::array<std::vector<double>, D> position;
        const dist::Part<D> part = team_->own_part(input.frame.box, c.slots, [&] {
            std::array<const double*, D> columns;
            for (std::size_t k = 0; k < D; ++k) {
                position[k].resize(c.slots);
                machine_.to_host(position[k].data(), view_.position[k], c.slots);
                columns[k] = position[k].data();
            }
            return columns;
        });
        const std::size_t arriving = migration_.send(machine_, *team_, finder_, view_, c.slots, part);
        make_room(c.slots + arriving);
        migration_.receive(machine_, view_, c.slots);
        c.slots += arriving;
        own_ += arriving;
        own_ -= migration_.leaving();
        team_->settle(own_, c.live);

        const double beyond = input.largest_radius + input.skin;
        input.slots = c.slots;
        input.live = own_;
        input.copies = halo_.send(machine_, *team_, finder_, view_, c.slots, part, beyond);
        make_room(c.slots + input.copies);
        halo_.receive(machine_, view_, c.slots);
        velocities_copied_ = false;
        if (!input.images) input.frame = frame_around(part, input.largest_radius + beyond);
    }

    /// @param reach  how far from the part there may be copies
    spatial::SearchFrame<D> frame_around(const dist::Part<D>& part, double reach) const {
        const spatial::PeriodicBox<D>& box = view_.liquid.box;
        spatial::SearchFrame<D> frame(box);
        reach *= 1.001;  // rounding puts nothing at the frame's ends
        for (std::size_t k = 0; k < D; ++k) {
            double low = part.low(k) - reach;
            double high = part.high(k) + reach;
            if (!box.periodic[k]) {
                low = std::max(low, 0.0);
                high = std::min(high, box.lengths[k]);
            }
            if (high - low < box.lengths[k]) frame.narrow(k, low, high - low);
        }
        return frame;
    }

    double mean_radius() {
        const double scale = control_.sum_bound(Shape<D>::radius(control_.max_size));
        const std::size_t blocks = machine_blocks(control_.slots);
        machine_.reduce(blocks, AddRadii<D>{view_.size, control_.slots, scale}, radius_sums_.data());
        machine_.conclude(blocks, radius_sums_.data(), radius_sums_.data(), KeepRadiusSum{radius_sum_.data()});
        RadiusSum sum;
        machine_.to_host(&sum, radius_sum_.data(), 1);
        if (team_) {
            carry(sum.sum);
            team_->processes().sum(sum.sum);
        }
        return sum_of(FixedSum(scale), sum.sum).value() / static_cast<double>(control_.live);
    }

    void reorder(const ListInput<D>& input) {
        const DeviceView<D> from = view_;
        now_ = 1 - now_;
        columns_[now_].show(view_);
        machine_.for_each(input.live, ReorderBubble<D>{from, view_, lists_.order()});
        if (!team_) return;
        machine_.for_each(input.copies, MoveIds{from.id + input.slots, view_.id + input.live});
        halo_.renumber(machine_, lists_.new_slots(machine_));
    }

    void choose_blocks(bool images) {
        const Control& c = control_;
        interior_blocks_ = machine_blocks(c.interior);
        const std::size_t blocks = interior_blocks_ + (team_ ? machine_blocks(c.slots - c.interior) : 0);
        if (blocks == blocks_ && images == images_) return;
        blocks_ = blocks;
        images_ = images;
        machine_.forget_recording();
    }

    void fetch_vanished() {
        if (control_.events == 0) return;
        const std::size_t known = vanished_.size();
        vanished_.resize(known + control_.events);
        machine_.to_host(vanished_.data() + known, vanished_on_device_.data(), control_.events);
        own_ -= control_.events;
        control_.events = 0;
    }

    Machine machine_;
    Options options_;
    std::unique_ptr<DeviceTeam<D>> team_;
    Control control_;
    DeviceView<D> view_{};
    std::size_t own_ = 0;  ///< live bubbles of this device
    std::size_t blocks_ = 0;
    std::size_t interior_blocks_ = 0;  ///< of them, for a loop over the interior
    bool images_ = false;
    std::vector<VanishedBubble<D>> vanished_;

    DeviceColumns<D, Machine> columns_[2];
    int now_ = 0;  ///< which of them holds the foam: the loops are recorded for either
    DeviceListBuilder<D, Machine> lists_;
    BubbleFinder<D, Machine> finder_;
    DeviceMigration<D, Machine> migration_;
    DeviceHalo<D, Machine> halo_;
    bool velocities_copied_ = false;  ///< since they last changed
    Buffer<double> rate_[D], film_, weight_, increment_[2][D + 1];
    Buffer<StagedBall<D>> stage_;
    Buffer<chebyshev::StageWeights> weights_;
    Buffer<VanishedBubble<D>> vanished_on_device_;
    Buffer<Control> device_control_;
    Buffer<UpdateSums> update_sums_;
    Buffer<GatherSums> gather_sums_;
    Buffer<TurnSums> turn_sums_;
    Buffer<RadiusSum> radius_sum_, radius_sums_;
    MachineBuffer<Machine, Control, MachineMemory::kHost> host_control_;
    MachineBuffer<Machine, TurnSums, MachineMemory::kHost> host_turn_sums_;
};

}  // namespace lamella::bubble::detail
