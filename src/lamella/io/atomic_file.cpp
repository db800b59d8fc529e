#include "lamella/io/atomic_file.h"

#include "lamella/core/error.h"
#include "lamella/io/detail/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>

namespace lamella::io {

void write_file_atomically(const std::filesystem::path& path, std::string_view contents) {
    detail::AtomicFile file(path);
    file.write(contents);
    file.commit();
}

std::string read_file(const std::filesystem::path& path, std::size_t limit) {
    const detail::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file) detail::throw_io_error("read", path, errno);
    struct stat info {};
    if (::fstat(file.get(), &info) != 0) detail::throw_io_error("read", path, errno);
    if (S_ISDIR(info.st_mode)) throw InputError({path.string()}, "is a folder, not a file");
    const auto too_large = [&] {
        return InputError({path.string()}, fmt::format("is larger than the {} bytes allowed here", limit));
    };
    const auto expected = S_ISREG(info.st_mode) ? static_cast<std::size_t>(info.st_size) : std::size_t{0};
    if (expected > limit) throw too_large();

    // The size is a hint: a pipe has none, and a log may grow while it is read.
    std::string contents(expected + 1, '\0');
    std::size_t size = 0;
    for (;;) {
        const ssize_t n = ::read(file.get(), contents.data() + size, contents.size() - size);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) detail::throw_io_error("read", path, errno);
        if (n == 0) break;
        size += static_cast<std::size_t>(n);
        if (size > limit) throw too_large();
        if (size == contents.size()) contents.resize(2 * size + 4096);
    }
    contents.resize(size);
    return contents;
}

void append_shortest(std::string& out, double value) {
    if (std::isnan(value)) {
        out += "nan";  // to_chars would show the sign bit, which means nothing
        return;
    }
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    out.append(text.data(), end);
}

std::string shortest_text(double value) {
    std::string out;
    append_shortest(out, value);
    return out;
}

}  // namespace lamella::io
