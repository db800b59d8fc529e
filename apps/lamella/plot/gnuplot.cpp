#include "gnuplot.h"

#include "external_program.h"
#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"

#include <fmt/format.h>

#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace lamella::app {
namespace {

namespace fs = std::filesystem;

std::string terminal(const fs::path& picture, int width, int height) {
    if (picture.extension() == ".png")
        return fmt::format("set terminal pngcairo size {},{} font 'DejaVu Sans,20' linewidth 2 rounded\n", width,
                           height);
    if (picture.extension() == ".svg")
        return fmt::format(
            "set terminal svg size {},{} font 'DejaVu Sans, Arial, Helvetica, sans-serif,20' linewidth 2 "
            "rounded background rgb 'white'\n",
            width, height);
    throw InputError(fmt::format("{}: a picture ends with .png or .svg", picture.string()));
}

/// Runs gnuplot on the script, its messages going to a file; returns the exit status.
int run_gnuplot(const fs::path& script, const fs::path& messages) {
    return run_external({"gnuplot", "--default-settings", script.string()}, messages,
                        "gnuplot is needed for plots and is not on the PATH (Debian: apt install gnuplot-nox)");
}

}  // namespace

Gnuplot::Gnuplot() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "lamella_plot_XXXXXX").string();
    if (error || ::mkdtemp(name.data()) == nullptr)
        throw IoError(fmt::format("no temporary folder for gnuplot: {}", std::strerror(errno)));
    folder_ = name;
}

Gnuplot::~Gnuplot() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::string Gnuplot::data(const Columns& columns) {
    const fs::path path = folder_ / fmt::format("data{}.txt", files_++);
    fmt::memory_buffer text;
    const std::size_t rows = columns.empty() ? 0 : columns.front().size();
    for (std::size_t row = 0; row < rows; ++row) {
        for (const auto& column : columns) fmt::format_to(std::back_inserter(text), "{:.9g} ", column[row]);
        text.push_back('\n');
    }
    if (rows == 0) text.append(std::string_view("NaN NaN NaN NaN\n"));  // gnuplot refuses an empty file
    io::write_file_atomically(path, {text.data(), text.size()});
    return gnuplot_text(path.string());
}

void Gnuplot::draw(const std::string& script, const fs::path& picture, int width, int height) {
    const fs::path drawn = folder_ / "picture";
    const fs::path script_file = folder_ / "script.gp";
    const fs::path messages = folder_ / "messages.txt";
    io::write_file_atomically(script_file, "set encoding utf8\n" + terminal(picture, width, height) + "set output " +
                                               gnuplot_text(drawn.string()) + "\n" + script + "\nunset output\n");
    if (run_gnuplot(script_file, messages) != 0 || !fs::exists(drawn))
        throw IoError(fmt::format("gnuplot could not draw {}: {}", picture.string(), last_line(messages)));
    io::write_file_atomically(picture, io::read_file(drawn));
}

std::string gnuplot_text(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'') result += '\'';  // doubled: the only escape inside single quotes
        result += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
    }
    return result + "'";
}

}  // namespace lamella::app
