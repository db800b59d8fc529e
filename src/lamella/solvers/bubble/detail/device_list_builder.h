#pragma once

#include "lamella/solvers/bubble/detail/device_lists.h"

#include <cstddef>
#include <cstdint>

namespace lamella::bubble::detail {

/// A foam whose lists are wanted: `live` of the first `slots` bubbles are there, `copies` of others' follow.
template <int D>
struct ListInput {
    spatial::SearchFrame<D> frame;
    std::size_t slots, live, copies;
    double mean_radius, largest_radius;
    double skin;
    bool images;
};

/// Builds the neighbor lists: arrange() finds new slots for the bubbles, and once they are there, fill() writes the
/// lists. Copies come to stand behind them, in the order in which they came.
template <int D, class Machine>
class DeviceListBuilder {
public:
    /// Room for `count` balls.
    void reserve(std::size_t count, bool copies) {
        for (auto* buffer : {&cell_, &sorted_cell_, &slot_, &cell_order_, &found_, &place_, &order_, &length_})
            buffer->reserve(count);
        sorted_ball_.reserve(count);
        const std::size_t slices = count / kSlice + 2;
        slice_entries_.reserve(slices);
        slice_start_.reserve(slices);
        if (!copies) return;
        for (auto* buffer : {&kind_, &sorted_kind_, &listed_, &new_slot_}) buffer->reserve(count);
        kind_start_.reserve(kKinds + 1);
    }

    void arrange(Machine& machine, const DeviceView<D>& view, const ListInput<D>& in) {
        live_ = in.live;
        images_ = in.images;
        sort_into_cells(machine, view, in);
        const auto first_copy = static_cast<std::uint32_t>(in.slots);
        const std::size_t balls = in.live + in.copies;
        machine.for_each(balls, CountNeighbors<D>{search_, cell_order_.data(), first_copy, found_.data(), kinds(in)});
        find_order(machine, in);
        machine.for_each(in.live, PlaceBalls{listed_order_, found_.data(), cell_order_.data(), interior_, in.live,
                                             place_.data(), order_.data(), length_.data()});
        machine.for_each(in.copies, PlaceCopies{listed_order_, cell_order_.data(), first_copy, in.live, place_.data()});

        const std::size_t slices = (in.live + kSlice - 1) / kSlice;
        machine.for_each(slices + 1, MeasureSlices{length_.data(), in.live, slice_entries_.data()});
        machine.exclusive_sum(slice_entries_.data(), slice_start_.data(), slices + 1);
        std::uint64_t entries = 0;
        machine.to_host(&entries, slice_start_.data() + slices, 1);
        reserve_entries(machine, entries);
    }

    /// @param id  by new slot, those of the copies too
    void fill(Machine& machine, const std::int64_t* id) {
        machine.for_each(live_, FillLists<D>{search_, listed_order_, place_.data(), id, slice_start_.data(),
                                             index_.data(), images_ ? image_.data() : nullptr});
    }

    /// Old slot of each new one.
    const std::uint32_t* order() const { return order_.data(); }
    /// New slot of each old one.
    const std::uint32_t* new_slots(Machine& machine) {
        machine.for_each(live_, InvertOrder{order_.data(), new_slot_.data()});
        return new_slot_.data();
    }
    /// The first so many new slots have no copies in their lists.
    std::size_t interior() const { return interior_; }

    void show(DeviceView<D>& view) const {
        view.slice_start = slice_start_.data();
        view.length = length_.data();
        view.index = index_.data();
        view.image = images_ ? image_.data() : nullptr;
    }

private:
    template <class T>
    using Buffer = MachineBuffer<Machine, T>;
    static constexpr std::size_t kKinds = static_cast<std::size_t>(Kind::kEnd);

    std::uint32_t* kinds(const ListInput<D>& in) { return in.copies > 0 ? kind_.data() : nullptr; }

    void sort_into_cells(Machine& machine, const DeviceView<D>& view, const ListInput<D>& in) {
        const std::size_t slots = in.slots + in.copies;
        const std::size_t balls = in.live + in.copies;
        const spatial::CellLayout<D> layout(in.frame.box, balls, 2.5 * in.mean_radius);
        FindCells<D> find{layout, in.frame, {}, view.size, cell_.data(), slot_.data()};
        SortBalls<D> sort{in.frame, {}, view.size, cell_order_.data(), sorted_ball_.data()};
        for (int k = 0; k < D; ++k) find.position[k] = sort.position[k] = view.position[k];
        machine.for_each(slots, find);
        int bits = 1;
        while (layout.count() >> bits != 0) ++bits;
        machine.sort_pairs(cell_.data(), sorted_cell_.data(), slot_.data(), cell_order_.data(), slots, bits);
        cell_start_.reserve(layout.count() + 1);
        machine.for_each(layout.count() + 1,
                         FindCellStarts{sorted_cell_.data(), static_cast<std::uint32_t>(balls), cell_start_.data()});
        machine.for_each(balls, sort);
        search_ = {layout,
                   in.frame.box,
                   in.frame.box.inverse_lengths(),
                   cell_start_.data(),
                   sorted_ball_.data(),
                   in.largest_radius,
                   in.skin,
                   in.images};
    }

    /// In which order the balls get their lists.
    void find_order(Machine& machine, const ListInput<D>& in) {
        interior_ = in.live;
        listed_order_ = {nullptr};
        if (in.copies == 0) return;
        const std::size_t balls = in.live + in.copies;
        constexpr int kBits = 2;
        // The slots before they were sorted are the numbers from 0 on.
        machine.sort_pairs(kind_.data(), sorted_kind_.data(), slot_.data(), listed_.data(), balls, kBits);
        machine.for_each(kKinds + 1,
                         FindCellStarts{sorted_kind_.data(), static_cast<std::uint32_t>(balls), kind_start_.data()});
        std::uint32_t interior = 0;
        machine.to_host(&interior, kind_start_.data() + static_cast<std::size_t>(Kind::kBorder), 1);
        interior_ = interior;
        listed_order_ = {listed_.data()};
    }

    /// With room for lists that grow: buffers are given back and taken anew only now and then.
    void reserve_entries(Machine& machine, std::uint64_t entries) {
        if (entries <= index_.size() && (!images_ || entries <= image_.size())) return;
        index_.reserve(entries + entries / 4);
        if (images_) image_.reserve(entries + entries / 4);
        machine.forget_recording();
    }

    CellSearch<D> search_{};
    ListOrder listed_order_{};
    std::size_t live_ = 0;
    std::size_t interior_ = 0;
    bool images_ = false;
    Buffer<StagedBall<D>> sorted_ball_;
    Buffer<std::uint32_t> cell_, sorted_cell_, slot_, cell_order_, found_, place_, order_, length_, cell_start_;
    Buffer<std::uint32_t> kind_, sorted_kind_, listed_, kind_start_, new_slot_;  ///< where there are copies
    Buffer<std::uint32_t> index_, image_;
    Buffer<std::uint64_t> slice_entries_, slice_start_;
};

}  // namespace lamella::bubble::detail
