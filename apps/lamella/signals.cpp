#include "signals.h"

#include <unistd.h>

#include <csignal>

namespace lamella::app {
namespace {

volatile std::sig_atomic_t received = 0;

extern "C" void note_signal(int signal) {
    constexpr int kExitOnSignal = 128;
    if (received != 0 && signal == SIGINT) ::_exit(kExitOnSignal + signal);
    received = signal;
}

}  // namespace

void catch_stop_signals() {
    struct sigaction action {};
    action.sa_handler = note_signal;
    action.sa_flags = SA_RESTART;  // a write in progress goes on
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
    ::sigaction(SIGUSR1, &action, nullptr);
}

int stop_signal() { return received; }

}  // namespace lamella::app
