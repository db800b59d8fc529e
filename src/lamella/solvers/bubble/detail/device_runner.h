#pragma once

#include "lamella/solvers/bubble/clock.h"
#include "lamella/solvers/bubble/detail/device_team.h"
#include "lamella/solvers/bubble/detail/device_view.h"
#include "lamella/solvers/bubble/foam.h"
#include "lamella/solvers/bubble/integrator_state.h"
#include "lamella/solvers/bubble/options.h"

#include <memory>
#include <string>
#include <vector>

namespace lamella::bubble::detail {

/// A foam that lives on a device and advances there; the host sees it when it asks.
template <int D>
class DeviceRunner {
public:
    virtual ~DeviceRunner() = default;

    /// Takes over a foam with everything that its next step depends on.
    virtual void upload(const Foam<D>& foam, const Model& model, const Clock& clock, const IntegratorState& state) = 0;

    /// Takes steps until `limit` (solver time, met exactly), at most `steps` of them, fewer where the run ends;
    /// control().waiting says why it stopped. @throws IoError  the device fails
    virtual void advance(double limit, std::int64_t steps) = 0;

    virtual const Control& control() const = 0;
    IntegratorState integrator_state() const {
        return {control().next_step, control().stiffness, control().rates_current != 0};
    }

    /// The foam as it stands, vanished bubbles included.
    virtual void download(Foam<D>& foam) = 0;
    /// Displacements 'since the last frame' count from here.
    virtual void mark_frame() = 0;
    /// The bubbles of this device that vanished since the last call, in any order.
    virtual std::vector<VanishedBubble<D>> take_vanished() = 0;
};

/// What of these options does not run on a GPU, as the end of a sentence; empty: all of it does.
std::string not_on_device(const Options& options);

/// On the GPU. @throws IoError  the device fails
/// @param team  of the devices that share the foam; nullptr: it lives on this one
template <int D>
std::unique_ptr<DeviceRunner<D>> make_cuda_runner(const Options& options,
                                                  std::unique_ptr<DeviceTeam<D>> team = nullptr);

/// The CPU twin of it, with the threads of each loop in this order.
template <int D>
std::unique_ptr<DeviceRunner<D>> make_twin_runner(const Options& options,
                                                  HostMachine::Order order,
                                                  std::unique_ptr<DeviceTeam<D>> team = nullptr);

}  // namespace lamella::bubble::detail
