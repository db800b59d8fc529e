#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace lamella::run {

enum class Existing { kRefuse, kOverwrite };

/// The folder of one run (docs/file-formats.md): where its files are, and a lock that keeps a second process out for
/// as long as this object lives.
class RunFolder {
public:
    /// Makes the folder, or takes an empty one. A folder that holds a run is refused or cleared, as `existing` says;
    /// clearing removes the files of a run and nothing else.
    /// @throws InputError  it holds a run (kRefuse), or other files, or is no folder, or another process runs in it
    /// @throws IoError     it cannot be made or cleared
    static RunFolder create(const std::filesystem::path& path, Existing existing);

    /// Takes the folder of an earlier run to continue it.
    /// @throws InputError  it holds no run, or another process runs in it   @throws IoError
    static RunFolder open(const std::filesystem::path& path);

    RunFolder(RunFolder&& other) noexcept;
    RunFolder& operator=(RunFolder&&) = delete;
    ~RunFolder();

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path scene() const { return path_ / "scene.toml"; }
    std::filesystem::path provenance() const { return path_ / "run.json"; }
    std::filesystem::path series() const { return path_ / "series.csv"; }
    std::filesystem::path events() const { return path_ / "events.csv"; }
    std::filesystem::path checkpoint() const { return path_ / "checkpoint.h5"; }
    std::filesystem::path previous_checkpoint() const { return path_ / "checkpoint.h5.previous"; }
    std::filesystem::path log() const { return path_ / "log.txt"; }
    std::filesystem::path frames() const { return path_ / "frames"; }
    std::filesystem::path frame_collection() const { return path_ / "frames.pvd"; }
    std::filesystem::path plots() const { return path_ / "plots"; }
    /// "frames/000012.vtp": the name of frame `index` as the collection lists it.
    static std::string frame_name(std::int64_t index);

    /// Removes every frame file from `first` on, and what a killed process left half-written.
    void remove_frames_from(std::int64_t first) const;
    /// Takes back a folder that create() made, while nothing but the lock is in it.
    void discard_if_empty();

private:
    RunFolder(std::filesystem::path path, bool made);
    void lock();
    void clear() const;

    std::filesystem::path path_;
    bool made_ = false;  ///< by create(): it was not there before
    int lock_ = -1;      ///< open file descriptor of run.lock
};

/// Whether a folder holds a run that can be read (plots, measures): it has a scene.toml, and a run.json or a
/// lock beside it.
bool is_run_folder(const std::filesystem::path& path);

}  // namespace lamella::run
