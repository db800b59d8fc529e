#pragma once

#include "lamella/sim/archive.h"

#include <filesystem>
#include <memory>
#include <string>

namespace lamella::io {

/// Writes a solver's complete state to an HDF5 file that readers see either whole or not at all: commit() writes a
/// temporary name in the same folder and syncs it, keeps the file present so far as `<path>.previous`, then renames
/// the new one into place.
///
/// HDF5 writes through lamella, which notices the write that failed, with the system's own reason (a full disk, say):
/// HDF5 hides the reason and is left in a state that may crash when it ends. It costs a few MiB of memory, whatever
/// the size of the state.
///
/// Unless HDF5 was built thread-safe, as Linux distributions do, use one checkpoint at a time in a process.
class CheckpointWriter : public sim::StateWriter {
public:
    /// @param kind  solver name, stored and checked when read
    /// @throws IoError  the file cannot be created
    CheckpointWriter(std::filesystem::path path, const std::string& kind);
    ~CheckpointWriter() override;  ///< without commit(): removes the temporary file

    using StateWriter::write;
    /// @throws InputError  the name is empty, used twice, or not words separated by "/"   @throws IoError  no memory
    void write(std::string_view name, std::span<const double> values) override;
    void write(std::string_view name, std::span<const std::int64_t> values) override;
    void write(std::string_view name, std::span<const std::int32_t> values) override;
    /// The parts of a column one after another, and nothing else in between; the file does not show how it was cut.
    void write_part(std::string_view name, std::span<const double> values, sim::Part part) override;
    void write_part(std::string_view name, std::span<const std::int64_t> values, sim::Part part) override;
    void write_part(std::string_view name, std::span<const std::int32_t> values, sim::Part part) override;

    /// Makes the checkpoint the current one; to be called once, last.
    /// @throws IoError  disk full and the like; the old one is untouched
    void commit();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Reads such a file. A checksum of the whole file is verified before HDF5 sees it, and every dataset carries one of
/// its own (Fletcher32) that HDF5 verifies, so damage is an InputError whatever its place.
///
/// A checksum is no signature: whoever forges a file that is malformed inside HDF5's own structures and seals it
/// again can still crash HDF5. Resume only from files whose origin you know.
class CheckpointReader : public sim::StateReader {
public:
    /// @throws IoError     the file cannot be opened
    /// @throws InputError  it is not a checkpoint, damaged, of another version, or of another solver than `kind`
    CheckpointReader(const std::filesystem::path& path, const std::string& kind);
    ~CheckpointReader() override;

    void read(std::string_view name, std::size_t count, std::vector<double>& values) override;
    void read(std::string_view name, std::size_t count, std::vector<std::int64_t>& values) override;
    void read(std::string_view name, std::size_t count, std::vector<std::int32_t>& values) override;
    void read_stretch(std::string_view name, sim::Part part, std::size_t count, std::vector<double>& values) override;
    void read_stretch(std::string_view name,
                      sim::Part part,
                      std::size_t count,
                      std::vector<std::int64_t>& values) override;
    void read_stretch(std::string_view name,
                      sim::Part part,
                      std::size_t count,
                      std::vector<std::int32_t>& values) override;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lamella::io
