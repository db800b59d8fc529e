#include "output.h"

#include "lamella/core/error.h"
#include "lamella/io/atomic_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>

namespace lamella::app {

void print_result(std::string_view text) {
    errno = 0;
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (!written && errno != EPIPE) throw IoError(fmt::format("standard output: {}", std::strerror(errno)));
}

void write_result(const std::string& path, const std::function<void(std::ostream&)>& write) {
    std::ostringstream text;
    write(text);
    if (path == "-")
        print_result(text.view());
    else
        io::write_file_atomically(path, text.view());
}

void print_error(std::string_view text) { fmt::print(stderr, "lamella: {}\n", text); }

std::string number_text(double value) {
    constexpr double kLargestCount = 1e15;
    if (value == std::floor(value) && std::abs(value) < kLargestCount) return fmt::format("{:.0f}", value);
    return fmt::format("{:.6g}", value);
}

std::string two_columns(const std::vector<std::pair<std::string, std::string>>& rows, std::size_t width) {
    std::size_t first = 0;
    for (const auto& [left, right] : rows) first = std::max(first, left.size());
    const std::size_t indent = first + 4;
    const std::size_t room = width > indent + 20 ? width - indent : 20;
    std::string text;
    for (const auto& [left, right] : rows) {
        text += fmt::format("  {:<{}}  ", left, first);
        std::size_t column = 0;
        std::istringstream words(right);
        for (std::string word; words >> word;) {
            if (column > 0 && column + 1 + word.size() > room) {
                text.append(1, '\n').append(indent, ' ');
                column = 0;
            }
            if (column > 0) text += ' ';
            text += word;
            column += word.size() + 1;
        }
        while (text.ends_with(' ')) text.pop_back();
        text += '\n';
    }
    return text;
}

}  // namespace lamella::app
