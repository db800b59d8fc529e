#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::io {

/// Appends rows to a CSV file, each handed to the system before append() returns. A row that cannot be written
/// whole (full disk) is cut off again, so the file always ends with a complete row.
class CsvWriter {
public:
    /// Starts a new file with this header (truncates an old one). Header entries look like "total_area[m^2]".
    /// @throws IoError
    CsvWriter(std::filesystem::path path, const std::vector<std::string>& header);
    /// Continues a file at `offset` bytes (what came later, written after the checkpoint, is cut off).
    /// @throws InputError  the file is shorter than that, or no row ends there   @throws IoError
    CsvWriter(std::filesystem::path path, std::uint64_t offset);
    ~CsvWriter();
    CsvWriter(CsvWriter&&) noexcept;
    CsvWriter& operator=(CsvWriter&&) noexcept;

    /// Numbers in their shortest exact text. @throws IoError
    void append(const std::vector<double>& row);
    void append_text(const std::vector<std::string>& row);  ///< quoted where needed. @throws IoError
    /// Waits until the rows are on the disk; bytes written so far. @throws IoError
    std::uint64_t sync();

private:
    struct Impl;
    struct ImplDeleter {
        void operator()(Impl*) const;
    };
    std::unique_ptr<Impl, ImplDeleter> impl_;
};

/// One row, with its end of line; fields are quoted where needed.
std::string csv_line(const std::vector<std::string>& fields);

/// A CSV table of numbers with a header.
struct CsvTable {
    std::vector<std::string> header;
    std::vector<std::vector<double>> rows;
    /// Index of the column whose header is `name` or starts with "name["; -1 when there is none.
    int column(const std::string& name) const;
};
/// Every row has one number per header entry; "nan" and "inf" are numbers, blank lines are skipped.
/// @throws IoError, InputError (file:line)
CsvTable read_csv(const std::filesystem::path& path);
/// The same from text (tests, fuzzing); `name` stands for the file in messages.
CsvTable parse_csv(std::string_view text, const std::string& name);

/// A CSV table of anything, with a header.
struct CsvTextTable {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;  ///< each as long as the header
};
/// @throws IoError, InputError (file:line)
CsvTextTable read_csv_text(const std::filesystem::path& path);

}  // namespace lamella::io
