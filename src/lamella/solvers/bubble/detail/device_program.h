#pragma once

#include "lamella/solvers/bubble/detail/device_decide.h"
#include "lamella/solvers/bubble/detail/device_gather.h"
#include "lamella/solvers/bubble/detail/device_lists.h"
#include "lamella/solvers/bubble/detail/device_runner.h"
#include "lamella/solvers/bubble/detail/device_update.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella::bubble::detail {

/// The columns of a foam on a device.
template <int D, class Machine>
struct DeviceColumns {
    template <class T>
    using Buffer = MachineBuffer<Machine, T>;

    Buffer<double> position[D], velocity[D], start[D], marked[D], built_position[D];
    Buffer<double> size, size_rate, path_length, built_radius;
    Buffer<std::int32_t> wraps[D];
    Buffer<std::int64_t> id;

    void reserve(std::size_t count) {
        for (int k = 0; k < D; ++k) {
            for (auto* column : {&position[k], &velocity[k], &start[k], &marked[k], &built_position[k]})
                column->reserve(count);
            wraps[k].reserve(count);
        }
        for (auto* column : {&size, &size_rate, &path_length, &built_radius}) column->reserve(count);
        id.reserve(count);
    }
    void show(DeviceView<D>& view) const {
        for (int k = 0; k < D; ++k) {
            view.position[k] = position[k].data();
            view.velocity[k] = velocity[k].data();
            view.start[k] = start[k].data();
            view.marked[k] = marked[k].data();
            view.wraps[k] = wraps[k].data();
            view.built_position[k] = built_position[k].data();
        }
        view.size = size.data();
        view.size_rate = size_rate.data();
        view.path_length = path_length.data();
        view.id = id.data();
        view.built_radius = built_radius.data();
    }
};

/// The program that advances a foam on a machine: what the host does between the turns of the loops.
template <int D, class Machine>
class DeviceProgram final : public DeviceRunner<D> {
public:
    template <class... Args>
    explicit DeviceProgram(const Options& options, Args&&... args)
        : machine_(std::forward<Args>(args)...), options_(options) {}

    void upload(const Foam<D>& foam, const Model& model, const Clock& clock, const IntegratorState& state) override {
        reserve(foam.slots);
        columns_[now_].show(view_);
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
            machine_.to_device(device_control_.data(), &c, 1);
            machine_.repeat(now_, kTurns, [this] { turn(); });
            machine_.to_host(&c, device_control_.data(), 1);
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

    std::vector<VanishedBubble<D>> take_vanished() override {
        std::sort(vanished_.begin(), vanished_.end(),
                  [](const auto& a, const auto& b) { return a.step != b.step ? a.step < b.step : a.id < b.id; });
        return std::exchange(vanished_, {});
    }

private:
    template <class T>
    using Buffer = MachineBuffer<Machine, T>;
    static constexpr int kTurns = 16;  ///< between two looks of the host

    void turn() {
        machine_.reduce(blocks_, UpdateBubble<D>{view_, device_control_.data()}, update_sums_.data());
        machine_.reduce(blocks_, GatherBubble<D>{view_, device_control_.data()}, gather_sums_.data());
        machine_.conclude(blocks_, update_sums_.data(), gather_sums_.data(), Decide<D>{view_, device_control_.data()});
    }

    /// Room for `count` bubbles.
    void reserve(std::size_t count) {
        for (auto& columns : columns_) columns.reserve(count);
        for (auto* buffer : {&film_, &weight_}) buffer->reserve(count);
        for (auto& buffer : rate_) buffer.reserve(count);
        for (auto& set : increment_)
            for (auto& buffer : set) buffer.reserve(count);
        stage_.reserve(count);
        sorted_ball_.reserve(count);
        vanished_on_device_.reserve(count);
        for (auto* buffer : {&cell_, &sorted_cell_, &slot_, &cell_order_, &found_, &place_, &order_, &length_})
            buffer->reserve(count);
        const std::size_t slices = count / kSlice + 2;
        slice_entries_.reserve(slices);
        slice_start_.reserve(slices);
        device_control_.reserve(1);
        radius_sum_.reserve(1);
        radius_sums_.reserve(kMachineBlocks);
        update_sums_.reserve(kMachineBlocks);
        gather_sums_.reserve(kMachineBlocks);
        machine_.forget_recording();

        view_.stage = stage_.data();
        view_.film = film_.data();
        view_.weight = weight_.data();
        view_.vanished = vanished_on_device_.data();
        view_.length = length_.data();
        view_.slice_start = slice_start_.data();
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
        c = {};
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
        for (std::size_t i = 0; i < foam.slots; ++i) c.max_size = std::max(c.max_size, foam.size[i]);
        c.clock = clock;
        c.next_step = state.next_step;
        c.stiffness = state.stiffness;
        c.rates_current = state.rates_current ? 1 : 0;
    }

    /// New lists for the current state; vanished bubbles leave their slots. See System::rebuild.
    void rebuild() {
        fetch_vanished();
        Control& c = control_;
        const std::size_t slots = c.slots;
        const std::size_t live = c.live;
        const double mean = mean_radius();
        const double skin = std::max(options_.integrator.skin * mean, 2.0 * c.least_reach);
        const CellSearch<D> search = sort_into_cells(slots, live, mean, skin);

        machine_.for_each(live, CountNeighbors<D>{search, found_.data()});
        machine_.for_each(
            live, PlaceBalls{found_.data(), cell_order_.data(), live, place_.data(), order_.data(), length_.data()});
        const std::size_t slices = (live + kSlice - 1) / kSlice;
        machine_.for_each(slices + 1, MeasureSlices{length_.data(), live, slice_entries_.data()});
        machine_.exclusive_sum(slice_entries_.data(), slice_start_.data(), slices + 1);
        std::uint64_t entries = 0;
        machine_.to_host(&entries, slice_start_.data() + slices, 1);
        reserve_lists(entries, search.images);

        reorder(live);
        view_.index = index_.data();
        view_.image = search.images ? image_.data() : nullptr;
        machine_.for_each(live, FillLists<D>{search, place_.data(), view_.id, slice_start_.data(), index_.data(),
                                             search.images ? image_.data() : nullptr});
        c.slots = live;
        c.reach = 0.5 * skin;
        c.expansion = 0.0;
        if (machine_blocks(live) != blocks_ || search.images != images_) {
            blocks_ = machine_blocks(live);
            images_ = search.images;
            machine_.forget_recording();
        }
    }

    /// With room for lists that grow: buffers are given back and taken anew only now and then.
    void reserve_lists(std::uint64_t entries, bool images) {
        if (entries <= index_.size() && (!images || entries <= image_.size())) return;
        index_.reserve(entries + entries / 4);
        if (images) image_.reserve(entries + entries / 4);
        machine_.forget_recording();
    }

    double mean_radius() {
        const double scale = sum_bound(Shape<D>::radius(control_.max_size));
        const std::size_t blocks = machine_blocks(control_.slots);
        machine_.reduce(blocks, AddRadii<D>{view_.size, control_.slots, scale}, radius_sums_.data());
        machine_.conclude(blocks, radius_sums_.data(), radius_sums_.data(), KeepSums{radius_sum_.data()});
        Reduction<1, 2> sum;
        machine_.to_host(&sum, radius_sum_.data(), 1);
        return sum_of(FixedSum(scale), sum.sum).value() / static_cast<double>(control_.live);
    }

    CellSearch<D> sort_into_cells(std::size_t slots, std::size_t live, double mean, double skin) {
        const spatial::PeriodicBox<D>& box = view_.liquid.box;
        const double largest = Shape<D>::radius(control_.max_size);
        bool images = false;
        for (std::size_t k = 0; k < D; ++k)
            images = images || (box.periodic[k] && box.lengths[k] <= 2.0 * (2.0 * largest + skin));

        const spatial::CellLayout<D> layout(box, live, 2.5 * mean);
        FindCells<D> find{layout, {}, view_.size, cell_.data(), slot_.data()};
        SortBalls<D> sort{{}, view_.size, cell_order_.data(), sorted_ball_.data()};
        for (int k = 0; k < D; ++k) find.position[k] = sort.position[k] = view_.position[k];
        machine_.for_each(slots, find);
        int bits = 1;
        while (layout.count() >> bits != 0) ++bits;
        machine_.sort_pairs(cell_.data(), sorted_cell_.data(), slot_.data(), cell_order_.data(), slots, bits);
        cell_start_.reserve(layout.count() + 1);
        machine_.for_each(layout.count() + 1,
                          FindCellStarts{sorted_cell_.data(), static_cast<std::uint32_t>(live), cell_start_.data()});
        machine_.for_each(live, sort);
        return {layout, box, view_.inverse_lengths, cell_start_.data(), sorted_ball_.data(), largest, skin, images};
    }

    void reorder(std::size_t live) {
        const DeviceView<D> from = view_;
        now_ = 1 - now_;
        columns_[now_].show(view_);
        machine_.for_each(live, ReorderBubble<D>{from, view_, order_.data()});
    }

    void fetch_vanished() {
        if (control_.events == 0) return;
        const std::size_t known = vanished_.size();
        vanished_.resize(known + control_.events);
        machine_.to_host(vanished_.data() + known, vanished_on_device_.data(), control_.events);
        control_.events = 0;
    }

    Machine machine_;
    Options options_;
    Control control_;
    DeviceView<D> view_{};
    std::size_t blocks_ = 0;
    std::vector<VanishedBubble<D>> vanished_;

    DeviceColumns<D, Machine> columns_[2];
    int now_ = 0;  ///< which of them holds the foam: the loops are recorded for either
    bool images_ = false;
    Buffer<double> rate_[D], film_, weight_, increment_[2][D + 1];
    Buffer<StagedBall<D>> stage_, sorted_ball_;
    Buffer<chebyshev::StageWeights> weights_;
    Buffer<VanishedBubble<D>> vanished_on_device_;
    Buffer<Control> device_control_;
    Buffer<UpdateSums> update_sums_;
    Buffer<GatherSums> gather_sums_;
    Buffer<Reduction<1, 2>> radius_sum_, radius_sums_;
    Buffer<std::uint32_t> cell_, sorted_cell_, slot_, cell_order_, found_, place_, order_, length_, cell_start_;
    Buffer<std::uint32_t> index_, image_;
    Buffer<std::uint64_t> slice_entries_, slice_start_;
};

}  // namespace lamella::bubble::detail
