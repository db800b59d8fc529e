#pragma once

namespace lamella::app {

/// From now on SIGINT, SIGTERM and SIGUSR1 are only noted, so that a run can stop at a whole step; a second SIGINT ends
/// the process at once. SIGUSR1 is what mpirun passes on without killing the processes a moment later.
void catch_stop_signals();

/// The signal that asked to stop, or 0.
int stop_signal();

}  // namespace lamella::app
