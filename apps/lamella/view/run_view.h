#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace lamella::app::view {

class RunProcess;

/// A run folder as the page sees it; every answer is read from the folder anew, so a run that goes on is followed.
/// Nothing outside the folder is read: frames that the collection or a link leads elsewhere to are refused.
class RunView {
public:
    /// `process`: the run that was started for this page, or nullptr; it must outlive the view.
    /// @throws InputError  no run folder
    RunView(const std::filesystem::path& folder, RunProcess* process);

    /// JSON: title, solver, state, stop_reason, frame times, the uniform thickness of its films, whether the page may
    /// control it (`controlled`, `paused`).
    std::string state() const;
    /// JSON: the columns of the series with their units, and the rows from `first` on; NaN is null.
    std::string series(std::size_t first) const;
    std::string scene() const;       ///< the resolved scene, TOML
    std::string provenance() const;  ///< run.json
    /// frame_message and regions_text of one frame. @throws InputError  there is none, it is damaged or lies elsewhere
    std::string frame(std::size_t index) const;
    std::string regions(std::size_t index) const;

    RunProcess* process() const { return process_; }

private:
    std::filesystem::path frame_file(std::size_t index) const;
    std::string text_of(const char* name) const;

    std::filesystem::path folder_;  ///< canonical
    RunProcess* process_;
    std::optional<double> thickness_;  ///< of films that have no field of it [m]
    std::string note_;                 ///< why that is not known
};

}  // namespace lamella::app::view
