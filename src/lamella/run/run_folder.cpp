#include "lamella/run/run_folder.h"

#include "lamella/core/error.h"
#include "lamella/io/mesh_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>
#include <vector>

namespace lamella::run {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLockName = "run.lock";

/// Temporary files of io::write_file_atomically and io::CheckpointWriter; only a killed process leaves any.
bool is_temporary(const fs::path& path) { return path.filename().string().find(".tmp") != std::string::npos; }

/// Whether the folder has anything in it but what a run makes first: a lock, a folder for frames, temporary files.
bool holds_something(const fs::path& folder) {
    for (const auto& entry : fs::directory_iterator(folder)) {
        const bool empty_frames =
            entry.path().filename() == "frames" && entry.is_directory() && fs::is_empty(entry.path());
        if (entry.path().filename() != kLockName && !is_temporary(entry.path()) && !empty_frames) return true;
    }
    return false;
}

/// The index of a frame file "000012.vtp", or -1 for any other name.
std::int64_t frame_index(const fs::path& file) {
    if (file.extension() != ".vtp") return -1;
    const std::string stem = file.stem().string();
    std::int64_t index = -1;
    const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), index);
    return error == std::errc{} && end == stem.data() + stem.size() ? index : -1;
}

/// "film_1.fe": what a run copies of its scene's films.
bool is_film_copy(const fs::path& path) { return path.stem().string().starts_with("film_") && io::is_film_file(path); }

/// Turns what std::filesystem throws into the error that ends with exit code 4.
template <class Work>
auto with_io_errors(Work&& work) {
    try {
        return work();
    } catch (const fs::filesystem_error& error) {
        throw IoError(fmt::format("{}: {}", error.path1().string(), error.code().message()));
    }
}

}  // namespace

RunFolder RunFolder::create(const fs::path& path, Existing existing) {
    return with_io_errors([&] {
        const bool present = fs::exists(path);
        if (present && !fs::is_directory(path))
            throw InputError(fmt::format("{} is not a folder; choose another --out", path.string()));
        if (present && holds_something(path)) {
            if (!is_run_folder(path))
                throw InputError(
                    fmt::format("{} holds files that are not a run's; choose another --out", path.string()));
            if (existing == Existing::kRefuse)
                throw InputError(
                    fmt::format("{0} already holds a run; `lamella resume {0}` continues it, --overwrite replaces it",
                                path.string()));
        }
        fs::create_directories(path);
        RunFolder folder(path, !present);
        folder.lock();
        folder.clear();
        fs::create_directories(folder.frames());
        return folder;
    });
}

RunFolder RunFolder::open(const fs::path& path) {
    return with_io_errors([&] {
        if (!fs::is_regular_file(path / "scene.toml"))
            throw InputError(fmt::format("{} is not a run folder: it has no scene.toml", path.string()));
        RunFolder folder(path, false);
        folder.lock();
        fs::create_directories(folder.frames());
        return folder;
    });
}

RunFolder::RunFolder(fs::path path, bool made) : path_(std::move(path)), made_(made) {}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)), made_(other.made_), lock_(std::exchange(other.lock_, -1)) {}

RunFolder::~RunFolder() {
    if (lock_ >= 0) ::close(lock_);  // and with it the lock; the file stays, removing it would race
}

void RunFolder::lock() {
    const fs::path file = path_ / kLockName;
    lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_ < 0) throw IoError(fmt::format("{}: {}", file.string(), std::strerror(errno)));
    // Only a lock that somebody holds is refused: some network file systems know no locks at all.
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        throw InputError(fmt::format("another lamella process is running in {}", path_.string()));
}

void RunFolder::clear() const {
    for (const fs::path& file :
         {scene(), provenance(), series(), events(), checkpoint(), previous_checkpoint(), log(), frame_collection()})
        fs::remove(file);
    std::vector<fs::path> films;
    for (const auto& entry : fs::directory_iterator(path_))
        if (is_film_copy(entry.path())) films.push_back(entry.path());
    for (const fs::path& film : films) fs::remove(film);
    remove_frames_from(0);
    if (!fs::is_directory(plots())) return;
    std::vector<fs::path> pictures;
    for (const auto& entry : fs::directory_iterator(plots()))
        if (entry.path().extension() == ".png" || entry.path().extension() == ".svg") pictures.push_back(entry.path());
    for (const fs::path& picture : pictures) fs::remove(picture);
}

std::string RunFolder::frame_name(std::int64_t index) { return fmt::format("frames/{:06}.vtp", index); }

void RunFolder::remove_frames_from(std::int64_t first) const {
    with_io_errors([&] {
        for (const fs::path& folder : {path_, frames()}) {
            if (!fs::is_directory(folder)) continue;
            std::vector<fs::path> stale;
            for (const auto& entry : fs::directory_iterator(folder))
                if (is_temporary(entry.path()) || (folder == frames() && frame_index(entry.path()) >= first))
                    stale.push_back(entry.path());
            for (const fs::path& file : stale) fs::remove(file);
        }
    });
}

void RunFolder::discard_if_empty() {
    if (!made_) return;
    std::error_code ignored;  // tidying up after another error, which is the one to report
    fs::remove(frames(), ignored);
    if (!holds_something(path_)) {
        fs::remove(path_ / kLockName, ignored);
        fs::remove(path_, ignored);
    }
}

bool is_run_folder(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path / "scene.toml", error) &&
           (fs::is_regular_file(path / "run.json", error) || fs::is_regular_file(path / kLockName, error));
}

}  // namespace lamella::run
