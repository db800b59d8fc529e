#pragma once

#include "lamella/io/csv.h"
#include "lamella/sim/frame.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella::run {

/// Local growth exponent d ln(value) / d ln(time) at the last of the given rows: the least-squares slope over the
/// rows whose time lies in [t/2, t], t the last time. NaN while there are fewer than four, or a value is not positive.
///
/// @param times, values  of the same length; times increasing
double local_exponent(std::span<const double> times, std::span<const double> values);

/// series.csv: one row per output time with the time, the solver's scalars, the measures of its frame, and, where
/// there is a mean radius, its local growth exponent. The first row fixes the columns; a value that a later row
/// lacks is nan.
class Series {
public:
    /// A new file; an old one is replaced when the first row comes.
    explicit Series(std::filesystem::path path) : path_(std::move(path)) {}
    /// Continues a file at `offset` bytes, as a checkpoint recorded it; 0: as if new.
    /// @throws InputError  the file is shorter, or no series   @throws IoError
    Series(std::filesystem::path path, std::uint64_t offset);

    /// Adds a row: the frame's own scalars, then what was measured on it. @throws IoError
    void append(const sim::Frame& frame, const std::vector<sim::Scalar>& measured);
    /// Waits until all rows are on the disk; bytes written so far (0 before the first row).
    std::uint64_t sync();

private:
    std::filesystem::path path_;
    std::optional<io::CsvWriter> file_;
    std::vector<std::string> columns_;  ///< names without unit, in order
    std::vector<double> times_;
    std::vector<double> mean_radii_;
};

}  // namespace lamella::run
