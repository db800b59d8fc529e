#pragma once

#include <sys/types.h>

#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace lamella::app::view {

/// A `lamella run` that the server started: it can be paused, resumed and stopped. The run gets SIGTERM, writes its
/// checkpoint and ends when the object goes, or when this process dies.
class RunProcess {
public:
    /// Starts `arguments` (the first is the program). @throws IoError  it cannot be started
    explicit RunProcess(const std::vector<std::string>& arguments);
    ~RunProcess();
    RunProcess(const RunProcess&) = delete;
    RunProcess& operator=(const RunProcess&) = delete;

    enum class State { kRunning, kPaused, kEnded };
    State state();
    /// What the run returned, 128 + number for a signal; nothing while it goes on.
    std::optional<int> exit_code();

    // Each does nothing where it makes no sense (a pause of what has ended).
    void pause();
    void resume();
    void stop();  ///< at the next whole step, with a checkpoint; a paused run is woken for it

private:
    void look();  ///< takes notice of its end; the mutex is held
    void send(int signal);

    std::mutex mutex_;
    pid_t process_ = -1;
    bool paused_ = false;
    std::optional<int> exit_code_;
};

}  // namespace lamella::app::view
