#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace lamella::io::detail {

/// Throws the IoError "cannot <action> <path>: <the system's reason for `error`>".
[[noreturn]] void throw_io_error(std::string_view action, const std::filesystem::path& path, int error);

/// Owns a file descriptor.
class FileDescriptor {
public:
    FileDescriptor() = default;
    explicit FileDescriptor(int fd) : fd_(fd) {}
    ~FileDescriptor();
    FileDescriptor(FileDescriptor&& other) noexcept;
    FileDescriptor& operator=(FileDescriptor&& other) noexcept;

    int get() const { return fd_; }
    explicit operator bool() const { return fd_ >= 0; }
    /// Closes it and returns 0 or the error: some file systems report a full disk only now.
    int close();

private:
    int fd_ = -1;
};

/// Writes all bytes at the descriptor's position; `path` is for the message. @throws IoError
void write_all(const FileDescriptor& file, std::string_view bytes, const std::filesystem::path& path);

/// Writes all bytes at a place of the file. @returns  0 or the error number
int write_at(const FileDescriptor& file, std::size_t offset, std::string_view bytes);

/// Reads exactly `size` bytes at a place of the file. @returns  0, an error number, or -1 when the file ends before
int read_at(const FileDescriptor& file, std::size_t offset, char* out, std::size_t size);

/// What happens to the file that an AtomicFile replaces.
enum class OldFile {
    kReplace,
    kKeepAsPrevious,  ///< stays, under the name `<path>.previous`
};

/// A file that appears under its name complete or not at all. The bytes go to `<path>.tmp`, which the destructor
/// removes unless commit() was called; a fixed name, so that a killed run leaves at most one of them.
class AtomicFile {
public:
    /// @throws IoError  it cannot be created, or something that is not a file has its name
    explicit AtomicFile(std::filesystem::path path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// @throws IoError
    void write(std::string_view bytes);
    /// At a place of one's own choice. @throws IoError
    void write_at(std::size_t offset, std::string_view bytes);
    /// For what is written at places of one's own choice, and read back.
    const FileDescriptor& descriptor() const { return file_; }
    /// Syncs the bytes and the folder and gives the file its name. @throws IoError  the old file is untouched
    void commit(OldFile old_file = OldFile::kReplace);

private:
    void keep_previous() const;

    std::filesystem::path path_;
    std::filesystem::path temporary_;
    FileDescriptor file_;
    bool pending_ = false;
};

}  // namespace lamella::io::detail
