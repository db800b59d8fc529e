#include "lamella/dist/world.h"

#include "lamella/dist/detail/launcher.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace lamella::dist {
namespace detail {
namespace {

/// The first of these variables that holds a number above 0, or 0.
int number_in(std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (const char* text = std::getenv(name))
            if (const int value = std::atoi(text); value > 0) return value;
    return 0;
}

}  // namespace

/// Open MPI's mpirun, the PMI of MPICH and of Slurm, and PMIx set these.
Launch launch() {
    Launch found;
    found.launched = std::getenv("OMPI_COMM_WORLD_RANK") != nullptr || std::getenv("PMIX_RANK") != nullptr ||
                     std::getenv("PMI_RANK") != nullptr;
    found.processes = std::max(1, number_in({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"}));
    found.on_this_machine =
        std::max(1, number_in({"OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_STEP_TASKS_PER_NODE"}));
    // Ranks as such will do where there is one machine; on more of them they may meet at one of its devices.
    for (const char* name : {"OMPI_COMM_WORLD_LOCAL_RANK", "MPI_LOCALRANKID", "SLURM_LOCALID", "PMIX_RANK", "PMI_RANK"})
        if (const char* text = std::getenv(name)) {
            found.rank_on_this_machine = std::max(0, std::atoi(text));
            break;
        }
    return found;
}

}  // namespace detail

int rank_on_machine() { return detail::launch().rank_on_this_machine; }

int threads_per_process() {
    cpu_set_t allowed;
    CPU_ZERO(&allowed);
    const long online = std::max(1L, ::sysconf(_SC_NPROCESSORS_ONLN));
    const long own = ::sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : online;
    // A launcher that binds processes to cores has shared them out already.
    const long share = std::max(1L, online / detail::launch().on_this_machine);
    return static_cast<int>(std::min(own, share));
}

}  // namespace lamella::dist
