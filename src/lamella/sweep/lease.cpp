#include "lamella/sweep/lease.h"

#include "lamella/core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <fstream>
#include <mutex>
#include <sstream>
#include <utility>

namespace lamella::sweep {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kBeat{10};
constexpr double kStaleAfter = 60.0;  // s: six beats missed
constexpr int kMostDeaths = 10;       // of processes that held the same lease

struct Holder {
    std::string host;
    long process = 0;
    int attempt = 0;      ///< how many held it before and died
    unsigned serial = 0;  ///< of this process

    std::string text() const { return fmt::format("{} {} {} {}\n", host, process, attempt, serial); }
};

std::string host_name() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string contents(const fs::path& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// Whose it is; a file that a process died while writing is nobody's.
Holder holder_of(const std::string& text) {
    Holder holder;
    std::istringstream in(text);
    in >> holder.host >> holder.process >> holder.attempt;
    return holder;
}

double seconds(const timespec& time) {
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Seconds since a file was touched, by the clock of the machine that keeps the folder; nothing when it is gone.
std::optional<double> age(const fs::path& file) {
    const std::string clock = (file.parent_path() / ".clock").string();
    struct stat now {
    }, then{};
    const int fd = ::open(clock.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
    const bool known = fd >= 0 && ::futimens(fd, nullptr) == 0 && ::fstat(fd, &now) == 0;
    if (fd >= 0) ::close(fd);
    if (!known || ::stat(file.c_str(), &then) != 0) return std::nullopt;
    return seconds(now.st_mtim) - seconds(then.st_mtim);
}

bool is_alive(const Holder& holder, double age) {
    if (holder.host == host_name() && ::kill(static_cast<pid_t>(holder.process), 0) != 0 && errno == ESRCH)
        return false;
    return age < kStaleAfter;
}

/// Writes a new file; false when there is one already. It gets its name when it is whole: of a process that is killed
/// meanwhile nothing is left that looks like a lease.
bool create(const fs::path& file, const std::string& text) {
    static std::atomic<unsigned> serial{0};
    const std::string beside =
        (file.parent_path() / fmt::format(".{}.{}.{}.{}", file.filename().string(), host_name(), ::getpid(), ++serial))
            .string();
    const int fd = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    const bool made = fd >= 0 && ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                      ::link(beside.c_str(), file.c_str()) == 0;
    const int error = errno;
    if (fd >= 0) {
        ::close(fd);
        ::unlink(beside.c_str());
    }
    if (!made && error != EEXIST) throw IoError(fmt::format("{}: {}", file.string(), std::strerror(error)));
    return made;
}

/// Puts one's own lease in the place of a stale one. It is written beside it first, under a name that only one can
/// have, and then moved over it: at no time there is none. @returns whether it is one's own now
bool take_over(const fs::path& file, const std::string& left, const std::string& own) {
    const fs::path next = file.string() + ".next";
    if (!create(next, own)) {
        const std::string other = contents(next);
        if (const auto since = age(next); since && !is_alive(holder_of(other), *since) && contents(next) == other)
            ::unlink(next.c_str());  // whoever wrote it died before it was moved
        return false;
    }
    if (contents(file) != left || lease_state(file) != LeaseState::kStale) {
        ::unlink(next.c_str());
        return false;
    }
    ::rename(next.c_str(), file.c_str());
    return contents(file) == own;
}

void beat(const std::stop_token& stop, const fs::path& file, const std::string& holder) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    while (!wake.wait_for(lock, stop, kBeat, [&] { return stop.stop_requested(); }))
        if (contents(file) == holder) ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0);
}

}  // namespace

LeaseState lease_state(const fs::path& file) {
    const std::optional<double> since = age(file);
    if (!since) return LeaseState::kFree;
    const Holder holder = holder_of(contents(file));
    if (is_alive(holder, *since)) return LeaseState::kHeld;
    return holder.attempt + 1 >= kMostDeaths ? LeaseState::kWornOut : LeaseState::kStale;
}

std::optional<Lease> Lease::take(const fs::path& file) {
    static std::atomic<unsigned> serial{0};
    Holder self{host_name(), ::getpid(), 0, ++serial};
    const LeaseState state = lease_state(file);
    if (state == LeaseState::kHeld || state == LeaseState::kWornOut) return std::nullopt;
    if (state == LeaseState::kStale) {
        const std::string left = contents(file);
        self.attempt = holder_of(left).attempt + 1;
        if (!take_over(file, left, self.text())) return std::nullopt;
    } else if (!create(file, self.text())) {
        return std::nullopt;
    }
    return Lease(file, self.text());
}

Lease::Lease(fs::path file, std::string holder)
    : file_(std::move(file)),
      holder_(std::move(holder)),
      heart_([file = file_, holder = holder_](const std::stop_token& stop) { beat(stop, file, holder); }) {}

Lease::Lease(Lease&& other) noexcept
    : file_(std::exchange(other.file_, {})), holder_(std::move(other.holder_)), heart_(std::move(other.heart_)) {}

Lease::~Lease() {
    if (file_.empty()) return;
    heart_.request_stop();
    heart_.join();
    if (contents(file_) == holder_) ::unlink(file_.c_str());
}

}  // namespace lamella::sweep
