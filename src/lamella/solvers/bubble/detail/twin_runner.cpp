// The CPU twin of the foam on a GPU: the same program, its loops run one after the other.

#include "lamella/solvers/bubble/detail/device_program.h"

namespace lamella::bubble::detail {

template <int D>
std::unique_ptr<DeviceRunner<D>> make_twin_runner(const Options& options,
                                                  HostMachine::Order order,
                                                  std::unique_ptr<DeviceTeam<D>> team) {
    return std::make_unique<DeviceProgram<D, HostMachine>>(options, std::move(team), order);
}

template std::unique_ptr<DeviceRunner<2>> make_twin_runner<2>(const Options&,
                                                              HostMachine::Order,
                                                              std::unique_ptr<DeviceTeam<2>>);
template std::unique_ptr<DeviceRunner<3>> make_twin_runner<3>(const Options&,
                                                              HostMachine::Order,
                                                              std::unique_ptr<DeviceTeam<3>>);

std::string not_on_device(const Options& options) {
    if (options.integrator.method == Method::kAbm2) return "bubble.integrator.method = \"abm2\"";
    if (options.drag == Drag::kPairwise) return "bubble.drag = \"pairwise\"";
    return {};
}

}  // namespace lamella::bubble::detail
