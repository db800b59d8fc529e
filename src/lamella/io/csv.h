#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace lamella::io {

/// Appends rows to a CSV file, each flushed to the system before append() returns.
class CsvWriter {
public:
    /// Starts a new file with this header (truncates an old one). Header entries look like "total_area[m^2]".
    CsvWriter(std::filesystem::path path, const std::vector<std::string>& header);
    /// Continues a file at `offset` bytes (what came later, written after the checkpoint, is cut off).
    /// @throws InputError  the file is shorter than that
    CsvWriter(std::filesystem::path path, std::uint64_t offset);
    ~CsvWriter();
    CsvWriter(CsvWriter&&) noexcept;
    CsvWriter& operator=(CsvWriter&&) noexcept;

    /// Numbers in their shortest exact text. @throws IoError
    void append(const std::vector<double>& row);
    void append_text(const std::vector<std::string>& row);  ///< quoted where needed
    /// Waits until the rows are on the disk; bytes written so far.
    std::uint64_t sync();

private:
    struct Impl;
    struct ImplDeleter {
        void operator()(Impl*) const;
    };
    std::unique_ptr<Impl, ImplDeleter> impl_;
};

/// A CSV table of numbers with a header.
struct CsvTable {
    std::vector<std::string> header;
    std::vector<std::vector<double>> rows;
    /// Index of the column whose header is `name` or starts with "name["; -1 when there is none.
    int column(const std::string& name) const;
};
/// @throws IoError, InputError (file:line)
CsvTable read_csv(const std::filesystem::path& path);

}  // namespace lamella::io
