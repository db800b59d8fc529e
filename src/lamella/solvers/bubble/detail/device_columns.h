#pragma once

#include "lamella/solvers/bubble/detail/device_view.h"

namespace lamella::bubble::detail {

template <int D>
LAMELLA_HOST_DEVICE Vec<D> center_of(const DeviceView<D>& v, std::size_t i) {
    Vec<D> x;
    for (std::size_t k = 0; k < D; ++k) x[k] = v.position[k][i];
    return x;
}

/// All that belongs to a bubble, as it moves to another slot or to another device.
template <int D>
struct BubbleRecord {
    double position[D], velocity[D], start[D], marked[D];
    double size, size_rate, path_length;
    std::int64_t id;
    std::int32_t wraps[D];
};

template <int D>
LAMELLA_HOST_DEVICE BubbleRecord<D> record_of(const DeviceView<D>& v, std::size_t i) {
    BubbleRecord<D> b;
    for (int k = 0; k < D; ++k) {
        b.position[k] = v.position[k][i];
        b.velocity[k] = v.velocity[k][i];
        b.start[k] = v.start[k][i];
        b.marked[k] = v.marked[k][i];
        b.wraps[k] = v.wraps[k][i];
    }
    b.size = v.size[i];
    b.size_rate = v.size_rate[i];
    b.path_length = v.path_length[i];
    b.id = v.id[i];
    return b;
}

template <int D>
LAMELLA_HOST_DEVICE void put_record(const DeviceView<D>& v, std::size_t i, const BubbleRecord<D>& b) {
    for (int k = 0; k < D; ++k) {
        v.position[k][i] = b.position[k];
        v.velocity[k][i] = b.velocity[k];
        v.start[k][i] = b.start[k];
        v.marked[k][i] = b.marked[k];
        v.wraps[k][i] = b.wraps[k];
    }
    v.size[i] = b.size;
    v.size_rate[i] = b.size_rate;
    v.path_length[i] = b.path_length;
    v.id[i] = b.id;
}

/// The columns of a foam on a device.
template <int D, class Machine>
class DeviceColumns {
public:
    std::size_t room() const { return id_.size(); }
    /// Room for `count` bubbles; what is in it is lost.
    void reserve(std::size_t count) {
        for_each_buffer([&](auto& buffer) { buffer.reserve(count); });
    }
    /// The same, but the first `kept` bubbles stay.
    void grow(Machine& machine, std::size_t count, std::size_t kept) {
        for_each_buffer([&](auto& buffer) { buffer.grow(machine, count, kept); });
    }
    void show(DeviceView<D>& view) const {
        for (int k = 0; k < D; ++k) {
            view.position[k] = position_[k].data();
            view.velocity[k] = velocity_[k].data();
            view.start[k] = start_[k].data();
            view.marked[k] = marked_[k].data();
            view.wraps[k] = wraps_[k].data();
            view.built_position[k] = built_position_[k].data();
        }
        view.size = size_.data();
        view.size_rate = size_rate_.data();
        view.path_length = path_length_.data();
        view.id = id_.data();
        view.built_radius = built_radius_.data();
    }

private:
    template <class T>
    using Buffer = MachineBuffer<Machine, T>;

    template <class Visit>
    void for_each_buffer(Visit&& visit) {
        for (int k = 0; k < D; ++k) {
            for (auto* column : {&position_[k], &velocity_[k], &start_[k], &marked_[k], &built_position_[k]})
                visit(*column);
            visit(wraps_[k]);
        }
        for (auto* column : {&size_, &size_rate_, &path_length_, &built_radius_}) visit(*column);
        visit(id_);
    }

    Buffer<double> position_[D], velocity_[D], start_[D], marked_[D], built_position_[D];
    Buffer<double> size_, size_rate_, path_length_, built_radius_;
    Buffer<std::int32_t> wraps_[D];
    Buffer<std::int64_t> id_;
};

}  // namespace lamella::bubble::detail
