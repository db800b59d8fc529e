#pragma once

// The one place that knows how gnuplot is called: a separate program, found on PATH, that reads a script and data files
// from a temporary folder. No shell is involved, and texts are quoted for gnuplot, so a title is never a command.

#include <filesystem>
#include <string>
#include <vector>

namespace lamella::app {

/// Columns of equal length; a block is drawn as one curve.
using Columns = std::vector<std::vector<double>>;

/// One gnuplot picture in the making. Its temporary folder is gone with this object.
class Gnuplot {
public:
    Gnuplot();
    ~Gnuplot();
    Gnuplot(const Gnuplot&) = delete;
    Gnuplot& operator=(const Gnuplot&) = delete;

    /// Writes a data file and returns its name, quoted for the script. Values that are not numbers become gaps.
    /// @throws IoError
    std::string data(const Columns& columns);

    /// Runs a script and moves what it drew into `picture`. The script must not set terminal or output.
    /// @param picture  ends with .png or .svg
    /// @param width, height  in pixels
    /// @throws IoError     gnuplot is missing or fails, or the picture cannot be written
    /// @throws InputError  another kind of picture
    void draw(const std::string& script, const std::filesystem::path& picture, int width, int height);

private:
    std::filesystem::path folder_;
    int files_ = 0;
};

/// A text as a gnuplot string without any special meaning.
std::string gnuplot_text(const std::string& text);

}  // namespace lamella::app
