#include "lamella/core/error.h"
#include "lamella/dist/detail/launcher.h"
#include "lamella/dist/world.h"

#include <fmt/format.h>

namespace lamella::dist {

std::shared_ptr<Communicator> join_world() {
    const detail::Launch launch = detail::launch();
    if (launch.processes > 1)
        throw InputError(
            fmt::format("{} processes were started, and this build of lamella has no MPI: one process "
                        "computes a run; build with -DLAMELLA_MPI=ON (docs/clusters.md)",
                        launch.processes));
    return std::make_shared<Alone>();
}

}  // namespace lamella::dist
