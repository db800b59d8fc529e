#pragma once

#include "lamella/solvers/bubble/detail/device_columns.h"
#include "lamella/solvers/bubble/detail/device_team.h"

#include <span>
#include <utility>
#include <vector>

// One foam on the devices of several processes: bubbles that change their device, and copies of those near another's
// part. What travels is packed by a loop on the device, copied to pinned memory of the host, sent, and copied to the
// other device.

namespace lamella::bubble::detail {

/// Items on their way from device to device.
template <class Machine, class T>
class Parcel {
public:
    /// Room on the device for what leaves, in the order of routes.outgoing().
    T* room(const dist::Routes& routes) {
        leaving_.reserve(routes.leaving());
        return leaving_.data();
    }
    /// Sends what was packed into the room. `meanwhile` starts loops that the host need not wait for.
    template <class Meanwhile>
    void send(Machine& machine, const dist::Routes& routes, Meanwhile&& meanwhile) {
        sent_.reserve(routes.leaving());
        received_.reserve(routes.arriving());
        machine.begin_to_host(sent_.data(), leaving_.data(), routes.leaving());
        machine.mark();
        meanwhile();
        machine.wait_for_mark();
        routes.begin(std::as_bytes(std::span<const T>(sent_.data(), routes.leaving())),
                     std::as_writable_bytes(std::span<T>(received_.data(), routes.arriving())), sizeof(T));
    }
    /// What arrives goes to the device, by rank.
    void receive(Machine& machine, const dist::Routes& routes, T* to) {
        routes.receive();
        machine.begin_to_device(to, received_.data(), routes.arriving());
    }
    /// The same, to where it can be unpacked from.
    const T* receive(Machine& machine, const dist::Routes& routes) {
        arrived_.reserve(routes.arriving());
        receive(machine, routes, arrived_.data());
        return arrived_.data();
    }

private:
    MachineBuffer<Machine, T> leaving_, arrived_;
    MachineBuffer<Machine, T, MachineMemory::kHost> sent_, received_;
};

/// Which bubbles of a part have left it.
template <int D>
struct HasLeft {
    dist::Part<D> part;
    LAMELLA_HOST_DEVICE bool operator()(const Vec<D>& center, double /*radius*/) const { return !part.holds(center); }
};
/// Which may touch bubbles of other parts.
template <int D>
struct IsNearOthers {
    dist::Part<D> part;
    double beyond;
    LAMELLA_HOST_DEVICE bool operator()(const Vec<D>& center, double radius) const {
        return !part.holds_all_near(center, radius + beyond);
    }
};

template <int D, class Test>
struct FlagBubbles {
    DeviceView<D> view;
    Test test;
    std::size_t slots;
    std::uint64_t* flag;  ///< one more than slots, so that its sum ends with the total

    LAMELLA_HOST_DEVICE void operator()(std::size_t i) const {
        flag[i] = i < slots && view.alive(i) && test(center_of(view, i), Shape<D>::radius(view.size[i])) ? 1 : 0;
    }
};

template <int D>
struct ListFlagged {
    DeviceView<D> view;
    const std::uint64_t* flag;
    const std::uint64_t* place;
    Whereabouts<D>* list;

    LAMELLA_HOST_DEVICE void operator()(std::size_t i) const {
        if (flag[i] != 0)
            list[place[i]] = {center_of(view, i), Shape<D>::radius(view.size[i]), static_cast<std::uint32_t>(i)};
    }
};

/// Finds the few bubbles of a device that pass a test.
template <int D, class Machine>
class BubbleFinder {
public:
    template <class Test>
    std::span<const Whereabouts<D>> find(Machine& machine,
                                         const DeviceView<D>& view,
                                         std::size_t slots,
                                         const Test& test) {
        flag_.reserve(slots + 1);
        place_.reserve(slots + 1);
        machine.for_each(slots + 1, FlagBubbles<D, Test>{view, test, slots, flag_.data()});
        machine.exclusive_sum(flag_.data(), place_.data(), slots + 1);
        std::uint64_t count = 0;
        machine.to_host(&count, place_.data() + slots, 1);
        list_.reserve(count);
        host_list_.reserve(count);
        machine.for_each(slots, ListFlagged<D>{view, flag_.data(), place_.data(), list_.data()});
        machine.to_host(host_list_.data(), list_.data(), count);
        return {host_list_.data(), count};
    }

private:
    MachineBuffer<Machine, std::uint64_t> flag_, place_;
    MachineBuffer<Machine, Whereabouts<D>> list_;
    MachineBuffer<Machine, Whereabouts<D>, MachineMemory::kHost> host_list_;
};

/// Slots of the bubbles that leave, in the order of routes.outgoing().
template <int D>
std::vector<std::uint32_t> leaving_slots(const dist::Routes& routes, std::span<const Whereabouts<D>> bubbles) {
    std::vector<std::uint32_t> slots;
    slots.reserve(routes.leaving());
    for (const dist::Routes::Group& group : routes.outgoing())
        for (const std::uint32_t n : group.items) slots.push_back(bubbles[n].slot);
    return slots;
}

/// Bubbles that leave do not stay: their slots are vacant like those of vanished ones.
template <int D>
struct PackBubbles {
    DeviceView<D> view;
    const std::uint32_t* slot;
    BubbleRecord<D>* record;
    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const {
        record[n] = record_of(view, slot[n]);
        view.size[slot[n]] = 0.0;
    }
};
template <int D>
struct UnpackBubbles {
    DeviceView<D> view;
    std::size_t first;
    const BubbleRecord<D>* record;
    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const { put_record(view, first + n, record[n]); }
};

/// What the lists have to know of a copy.
template <int D>
struct CopyRecord {
    double position[D];
    double size;
    std::int64_t id;
};
template <int D>
struct PackCopies {
    DeviceView<D> view;
    const std::uint32_t* slot;
    CopyRecord<D>* record;
    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const {
        const std::uint32_t i = slot[n];
        for (int k = 0; k < D; ++k) record[n].position[k] = view.position[k][i];
        record[n].size = view.size[i];
        record[n].id = view.id[i];
    }
};
template <int D>
struct UnpackCopies {
    DeviceView<D> view;
    std::size_t first;
    const CopyRecord<D>* record;
    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const {
        for (int k = 0; k < D; ++k) view.position[k][first + n] = record[n].position[k];
        view.size[first + n] = record[n].size;
        view.id[first + n] = record[n].id;
    }
};

template <int D>
struct PackStage {
    DeviceView<D> view;
    const std::uint32_t* slot;
    StagedBall<D>* ball;
    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const { ball[n] = view.stage[slot[n]]; }
};

template <int D>
struct PackVelocities {
    DeviceView<D> view;
    const std::uint32_t* slot;
    Vec<D>* velocity;
    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const {
        for (std::size_t k = 0; k < D; ++k) velocity[n][k] = view.velocity[k][slot[n]];
    }
};
template <int D>
struct UnpackVelocities {
    DeviceView<D> view;
    std::size_t first;
    const Vec<D>* velocity;
    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const {
        for (std::size_t k = 0; k < D; ++k) view.velocity[k][first + n] = velocity[n][k];
    }
};

struct RenumberSlots {
    const std::uint32_t* new_slot;
    std::uint32_t* slot;
    LAMELLA_HOST_DEVICE void operator()(std::size_t n) const { slot[n] = new_slot[slot[n]]; }
};

/// The bubbles that change their device.
template <int D, class Machine>
class DeviceMigration {
public:
    /// Sends those that have left the part to their owners. @returns how many come here instead
    std::size_t send(Machine& machine,
                     DeviceTeam<D>& team,
                     BubbleFinder<D, Machine>& finder,
                     const DeviceView<D>& view,
                     std::size_t slots,
                     const dist::Part<D>& part) {
        const auto bubbles = finder.find(machine, view, slots, HasLeft<D>{part});
        routes_ = team.to_owners(bubbles);
        slot_.reserve(routes_.leaving());
        machine.to_device(slot_.data(), leaving_slots(routes_, bubbles).data(), routes_.leaving());
        machine.for_each(routes_.leaving(), PackBubbles<D>{view, slot_.data(), parcel_.room(routes_)});
        parcel_.send(machine, routes_, [] {});
        return routes_.arriving();
    }
    std::size_t leaving() const { return routes_.leaving(); }

    /// Those that come here stand from slot `first` on.
    void receive(Machine& machine, const DeviceView<D>& view, std::size_t first) {
        machine.for_each(routes_.arriving(), UnpackBubbles<D>{view, first, parcel_.receive(machine, routes_)});
    }

private:
    dist::Routes routes_;
    MachineBuffer<Machine, std::uint32_t> slot_;
    Parcel<Machine, BubbleRecord<D>> parcel_;
};

/// Copies of other devices' bubbles that are near this one's part.
template <int D, class Machine>
class DeviceHalo {
public:
    /// Sends copies of the bubbles that may touch bubbles of others. @returns how many come here
    /// @param beyond  the largest radius and the skin
    std::size_t send(Machine& machine,
                     DeviceTeam<D>& team,
                     BubbleFinder<D, Machine>& finder,
                     const DeviceView<D>& view,
                     std::size_t slots,
                     const dist::Part<D>& part,
                     double beyond) {
        const auto bubbles = finder.find(machine, view, slots, IsNearOthers<D>{part, beyond});
        routes_ = team.to_neighbors(bubbles, beyond);
        slot_.reserve(routes_.leaving());
        machine.to_device(slot_.data(), leaving_slots(routes_, bubbles).data(), routes_.leaving());
        machine.for_each(routes_.leaving(), PackCopies<D>{view, slot_.data(), copies_.room(routes_)});
        copies_.send(machine, routes_, [] {});
        return routes_.arriving();
    }
    /// The copies stand from slot `first` on.
    void receive(Machine& machine, const DeviceView<D>& view, std::size_t first) {
        machine.for_each(routes_.arriving(), UnpackCopies<D>{view, first, copies_.receive(machine, routes_)});
    }
    /// The bubbles have new slots.
    void renumber(Machine& machine, const std::uint32_t* new_slot) {
        machine.for_each(routes_.leaving(), RenumberSlots{new_slot, slot_.data()});
    }

    /// Sends the bubbles' stage to where they are copied; what `meanwhile` starts does not read copies.
    template <class Meanwhile>
    void send_stage(Machine& machine, const DeviceView<D>& view, Meanwhile&& meanwhile) {
        machine.for_each(routes_.leaving(), PackStage<D>{view, slot_.data(), stage_.room(routes_)});
        stage_.send(machine, routes_, meanwhile);
    }
    void receive_stage(Machine& machine, const DeviceView<D>& view, std::size_t first) {
        stage_.receive(machine, routes_, view.stage + first);
    }

    void refresh_velocities(Machine& machine, const DeviceView<D>& view, std::size_t first) {
        machine.for_each(routes_.leaving(), PackVelocities<D>{view, slot_.data(), velocities_.room(routes_)});
        velocities_.send(machine, routes_, [] {});
        machine.for_each(routes_.arriving(), UnpackVelocities<D>{view, first, velocities_.receive(machine, routes_)});
    }

private:
    dist::Routes routes_;
    MachineBuffer<Machine, std::uint32_t> slot_;  ///< of the bubbles that are copied
    Parcel<Machine, CopyRecord<D>> copies_;
    Parcel<Machine, StagedBall<D>> stage_;
    Parcel<Machine, Vec<D>> velocities_;
};

}  // namespace lamella::bubble::detail
