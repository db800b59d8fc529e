#include "lamella/io/detail/output_file.h"

#include "lamella/core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace lamella::io::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargest = std::size_t{1} << 30;  // one write(2) or read(2) takes less than 2 GiB

/// Makes a rename last through a power failure. File systems that cannot sync a folder say EINVAL.
void sync_folder(const fs::path& path) {
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const FileDescriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!fd) throw_io_error("sync the folder", folder, errno);
    if (::fsync(fd.get()) != 0 && errno != EINVAL) throw_io_error("sync the folder", folder, errno);
}

fs::path with_suffix(fs::path path, const char* suffix) {
    path += suffix;
    return path;
}

}  // namespace

void throw_io_error(std::string_view action, const fs::path& path, int error) {
    throw IoError(fmt::format("cannot {} {}: {}", action, path.string(), std::generic_category().message(error)));
}

FileDescriptor::~FileDescriptor() { close(); }

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
    if (this != &other) {
        close();
        fd_ = std::exchange(other.fd_, -1);
    }
    return *this;
}

int FileDescriptor::close() {
    if (fd_ < 0) return 0;
    return ::close(std::exchange(fd_, -1)) == 0 || errno == EINTR ? 0 : errno;
}

void write_all(const FileDescriptor& file, std::string_view bytes, const fs::path& path) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(file.get(), bytes.data(), std::min(bytes.size(), kLargest));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) throw_io_error("write", path, errno);
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

int write_at(const FileDescriptor& file, std::size_t offset, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n =
            ::pwrite(file.get(), bytes.data(), std::min(bytes.size(), kLargest), static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return errno;
        bytes.remove_prefix(static_cast<std::size_t>(n));
        offset += static_cast<std::size_t>(n);
    }
    return 0;
}

int read_at(const FileDescriptor& file, std::size_t offset, char* out, std::size_t size) {
    while (size > 0) {
        const ssize_t n = ::pread(file.get(), out, std::min(size, kLargest), static_cast<off_t>(offset));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return n < 0 ? errno : -1;
        out += n;
        offset += static_cast<std::size_t>(n);
        size -= static_cast<std::size_t>(n);
    }
    return 0;
}

AtomicFile::AtomicFile(fs::path path) : path_(std::move(path)), temporary_(with_suffix(path_, ".tmp")) {
    struct stat info {};
    if (::stat(path_.c_str(), &info) == 0 && !S_ISREG(info.st_mode)) {
        throw IoError(fmt::format("cannot write {}: it exists and is not a regular file", path_.string()));
    }
    // What a killed run left is removed, not reused: it may be a link, or still open elsewhere.
    if (::unlink(temporary_.c_str()) != 0 && errno != ENOENT) throw_io_error("write", path_, errno);
    file_ = FileDescriptor(::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!file_) throw_io_error("write", path_, errno);
    pending_ = true;
}

AtomicFile::~AtomicFile() {
    if (pending_) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view bytes) { write_all(file_, bytes, path_); }

void AtomicFile::write_at(std::size_t offset, std::string_view bytes) {
    if (const int error = detail::write_at(file_, offset, bytes); error != 0) throw_io_error("write", path_, error);
}

void AtomicFile::commit(OldFile old_file) {
    if (::fsync(file_.get()) != 0) throw_io_error("write", path_, errno);
    if (const int error = file_.close(); error != 0) throw_io_error("write", path_, error);
    if (old_file == OldFile::kKeepAsPrevious) keep_previous();
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) throw_io_error("write", path_, errno);
    pending_ = false;
    sync_folder(path_);
}

/// A hard link keeps the current name valid at every moment. Where there are no links (FAT, some network folders)
/// the old file is renamed, and for a moment only the previous name exists.
void AtomicFile::keep_previous() const {
    const fs::path previous = with_suffix(path_, ".previous");
    if (::access(path_.c_str(), F_OK) != 0) return;
    if (::unlink(previous.c_str()) != 0 && errno != ENOENT) throw_io_error("replace", previous, errno);
    if (::link(path_.c_str(), previous.c_str()) == 0) return;
    if (::rename(path_.c_str(), previous.c_str()) != 0) throw_io_error("replace", previous, errno);
}

}  // namespace lamella::io::detail
