#pragma once

namespace lamella::app {

/// From now on SIGINT and SIGTERM are only noted, so that a run can stop at a whole step; a second SIGINT ends the
/// process at once.
void catch_stop_signals();

/// The signal that asked to stop, or 0.
int stop_signal();

}  // namespace lamella::app
