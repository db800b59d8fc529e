#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace lamella::io::detail {

/// A checkpoint is an HDF5 file behind a user block of this many bytes: a few lines of text that hold the length and
/// the CRC-32 of all that follows. HDF5 1.10 can crash on damaged files, so nothing of the file reaches it before
/// the seal has been verified. HDF5 itself skips user blocks: h5py and h5dump open the file as it is.
inline constexpr std::size_t kSealSize = 512;
inline constexpr const char* kCheckpointFormat = "lamella checkpoint";
inline constexpr int kCheckpointVersion = 1;

class FileDescriptor;

/// The user block for a file of `size` bytes, this block included; reads all of it. @param path  for messages
/// @throws IoError
std::string checkpoint_seal(const FileDescriptor& file, std::size_t size, const std::filesystem::path& path);

/// @throws IoError     the file cannot be read
/// @throws InputError  it is not a checkpoint, of another version, cut short, or damaged
void verify_checkpoint_seal(const std::filesystem::path& path);

}  // namespace lamella::io::detail
