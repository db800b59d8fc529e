#pragma once

#include "lamella/io/csv.h"
#include "lamella/io/frame_files.h"
#include "lamella/sim/frame.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lamella::app {

/// The frames and the series of a run folder, for the commands that read one.
class RunReader {
public:
    /// @throws InputError  `folder` is no run folder
    explicit RunReader(std::filesystem::path folder);

    const std::filesystem::path& folder() const { return folder_; }
    const std::vector<io::FrameEntry>& frames() const { return frames_; }
    /// @throws InputError  the run has no such frame, or none at all
    sim::Frame frame(std::size_t index) const;
    /// The index that "--frame 12" or "--frame last" means. @throws InputError
    std::size_t frame_index(const std::string& text) const;
    /// @throws InputError  the run has written no series yet
    io::CsvTable series() const;

private:
    std::filesystem::path folder_;
    std::vector<io::FrameEntry> frames_;
};

/// The values of one column, or nothing when the table has none of that name.
std::optional<std::vector<double>> find_column(const io::CsvTable& table, const std::string& name);

}  // namespace lamella::app
