#include "lamella/dist/devices.h"

#include "lamella/core/error.h"

#include <fmt/format.h>

#include <set>
#include <vector>

namespace lamella::dist {

void require_own_devices(Communicator& processes, std::int64_t identity) {
    const std::vector<std::int64_t> mine(static_cast<std::size_t>(processes.size()), identity);
    const std::vector<std::int64_t> all = processes.exchange(mine);
    const std::size_t devices = std::set<std::int64_t>(all.begin(), all.end()).size();
    if (devices == all.size()) return;
    throw InputError(
        fmt::format("{} processes were started and find {} GPU{}: each needs one of its own; start as many processes "
                    "per machine as it has GPUs, or use --device cpu",
                    all.size(), devices, devices == 1 ? "" : "s"));
}

}  // namespace lamella::dist
