#pragma once

#include "frame_source.h"
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lamella::app {

/// The frames that `lamella render` can draw: those of a run, the one of a file, or the start of a scene.
class PictureSource {
public:
    /// @throws InputError  there is no such run, file or scene   @throws Interrupted  a signal came while a scene
    /// started
    explicit PictureSource(const std::string& source);

    /// @param text  a number, last or all   @throws InputError
    std::vector<std::size_t> chosen(const std::string& text) const;
    sim::Frame frame(std::size_t index) const { return run_ ? run_->frame(index) : single_; }
    /// Where pictures go by default: into the run, otherwise here.
    std::filesystem::path default_folder() const {
        return run_ ? run_->folder() / "pictures" : std::filesystem::path(".");
    }
    /// Name of the picture of a frame, without suffix: its number in a run, otherwise that of the file or scene.
    std::string picture_name(std::size_t index) const;

private:
    std::optional<RunReader> run_;
    sim::Frame single_;
    std::string name_;
};

}  // namespace lamella::app
