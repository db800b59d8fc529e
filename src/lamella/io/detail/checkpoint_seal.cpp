#include "lamella/io/detail/checkpoint_seal.h"

#include "lamella/core/error.h"
#include "lamella/core/parallel.h"
#include "lamella/io/detail/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <vector>

namespace lamella::io::detail {
namespace {

constexpr std::size_t kBlock = std::size_t{4} << 20;

std::uint32_t crc_of(std::string_view bytes) {
    return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string seal_text(std::size_t bytes, std::uint32_t crc) {
    std::string text = fmt::format(
        "{} {}\nAn HDF5 file that starts at byte {}: h5py, h5dump and other tools open it as it is.\n"
        "bytes {}\ncrc32 {:08x}\n",
        kCheckpointFormat, kCheckpointVersion, kSealSize, bytes, crc);
    text.resize(kSealSize, '\0');
    return text;
}

/// CRC-32 of the `size` bytes behind the seal, from those of blocks.
std::uint32_t file_crc(const FileDescriptor& file, std::size_t size, const std::filesystem::path& path) {
    std::vector<std::uint32_t> parts((size + kBlock - 1) / kBlock);
    std::atomic<int> error = 0;
    parallel_blocks(size, kBlock, [&](std::size_t begin, std::size_t end) {
        std::string block(end - begin, '\0');
        if (const int code = read_at(file, kSealSize + begin, block.data(), block.size()); code != 0) error = code;
        parts[begin / kBlock] = crc_of(block);
    });
    if (error < 0) throw InputError({path.string()}, "became shorter while it was read");
    if (error > 0) throw_io_error("read", path, error);
    uLong crc = crc32_z(0, nullptr, 0);
    for (std::size_t b = 0; b < parts.size(); ++b)
        crc = crc32_combine(crc, parts[b], static_cast<z_off_t>(std::min(kBlock, size - b * kBlock)));
    return static_cast<std::uint32_t>(crc);
}

/// What a seal that starts well says of the length; 0 when it does not.
std::size_t sealed_length(std::string_view seal) {
    std::size_t bytes = 0;
    const std::size_t mark = seal.find("\nbytes ");
    if (mark != std::string_view::npos) std::from_chars(seal.data() + mark + 7, seal.data() + seal.size(), bytes);
    return bytes;
}

}  // namespace

std::string checkpoint_seal(const FileDescriptor& file, std::size_t size, const std::filesystem::path& path) {
    return seal_text(size - kSealSize, file_crc(file, size - kSealSize, path));
}

void verify_checkpoint_seal(const std::filesystem::path& path) {
    const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat info {};
    if (!file || ::fstat(file.get(), &info) != 0) throw_io_error("read", path, errno);
    const auto refuse = [&](const std::string& why) { return InputError({path.string()}, why); };
    if (!S_ISREG(info.st_mode)) throw refuse("is not a regular file");

    const auto size = static_cast<std::size_t>(info.st_size);
    std::string seal(std::min(kSealSize, size), '\0');
    if (const int code = read_at(file, 0, seal.data(), seal.size()); code > 0) throw_io_error("read", path, code);
    const std::string start = std::string(kCheckpointFormat) + " ";
    if (!seal.starts_with(start)) throw refuse("is not a checkpoint of lamella");
    if (!seal.starts_with(fmt::format("{}{}\n", start, kCheckpointVersion))) {
        const std::string version =
            seal.substr(start.size(), std::min<std::size_t>(seal.find('\n'), 32) - start.size());
        throw refuse(fmt::format("is a checkpoint of version \"{}\"; this program reads version {}", version,
                                 kCheckpointVersion));
    }
    if (size < kSealSize || size - kSealSize != sealed_length(seal)) {
        throw refuse(fmt::format("is damaged: it has {} bytes, and had {} when it was written", size,
                                 kSealSize + sealed_length(seal)));
    }
    if (seal != seal_text(size - kSealSize, file_crc(file, size - kSealSize, path))) {
        throw refuse("is damaged: its content does not match its checksum");
    }
}

}  // namespace lamella::io::detail
