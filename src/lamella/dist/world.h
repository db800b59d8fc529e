#pragma once

#include "lamella/dist/communicator.h"

#include <memory>

namespace lamella::dist {

/// The processes that a launcher (mpirun, srun) started together with this one; this one alone where none did, or
/// where it started a single one. MPI begins with this call and ends with the last owner: call it once.
/// @throws InputError  there are several, and this build has no MPI
std::shared_ptr<Communicator> join_world();

/// The number of this process among those of its machine, from 0, as the launcher gave it.
int rank_on_machine();

/// Worker threads for this process, so that the processes of one machine share its cores.
int threads_per_process();

}  // namespace lamella::dist
