#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <thread>

namespace lamella::sweep {

/// What a lease file says.
enum class LeaseState {
    kFree,     ///< there is none
    kHeld,     ///< its heart beats
    kStale,    ///< its process is gone, or has not been heard of for a minute
    kWornOut,  ///< stale, and so many processes died with it that the task kills them
};
LeaseState lease_state(const std::filesystem::path& file);

/// The right to work on a task, among processes on any number of machines that share a folder: a file that names its
/// holder and is touched every few seconds. What a process leaves that died is taken over.
class Lease {
public:
    /// Nothing when another process has it, or it is worn out. @throws IoError
    static std::optional<Lease> take(const std::filesystem::path& file);
    Lease(Lease&& other) noexcept;
    Lease& operator=(Lease&&) = delete;
    ~Lease();  ///< gives it back

private:
    Lease(std::filesystem::path file, std::string holder);

    std::filesystem::path file_;
    std::string holder_;
    std::jthread heart_;
};

}  // namespace lamella::sweep
