#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "lamella/sim/archive.h"

namespace lamella::io {

/// Writes a solver's complete state to an HDF5 file that readers see either whole or not at all: the data go to a
/// temporary name in the same folder, are synced, the file present so far is kept as `<path>.previous`, then the
/// new one is renamed into place.
class CheckpointWriter : public sim::StateWriter {
public:
    /// @param kind  solver name, stored and checked when read
    /// @throws IoError  the file cannot be created
    CheckpointWriter(std::filesystem::path path, std::string kind);
    ~CheckpointWriter() override;  ///< without commit(): removes the temporary file

    using StateWriter::write;
    void write(std::string_view name, std::span<const double> values) override;
    void write(std::string_view name, std::span<const std::int64_t> values) override;
    void write(std::string_view name, std::span<const std::int32_t> values) override;

    /// Makes the checkpoint the current one. @throws IoError  disk full and the like; the old one is untouched
    void commit();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Reads such a file. Every dataset carries a checksum (Fletcher32) that HDF5 verifies.
class CheckpointReader : public sim::StateReader {
public:
    /// @throws IoError     the file cannot be opened
    /// @throws InputError  it is not a checkpoint, of another version, or of another solver than `kind`
    CheckpointReader(const std::filesystem::path& path, const std::string& kind);
    ~CheckpointReader() override;

    void read(std::string_view name, std::size_t count, std::vector<double>& values) override;
    void read(std::string_view name, std::size_t count, std::vector<std::int64_t>& values) override;
    void read(std::string_view name, std::size_t count, std::vector<std::int32_t>& values) override;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lamella::io
