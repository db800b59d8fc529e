#pragma once

#include "lamella/sweep/sweep_folder.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lamella::sweep {

/// Rows of a series where a column reaches given values: "scaled_time=10,20".
struct At {
    std::string column;
    std::vector<double> values;
};
/// @throws InputError  not of that form
At parse_at(const std::string& text);

struct CollectOptions {
    std::optional<At> at;  ///< interpolated linearly between the rows of the series on either side
    bool series = false;   ///< every row
    // Neither: the last row.
};

/// One table of a sweep: number of the task, the values that vary, what the series says.
struct Collected {
    std::vector<std::string> header;
    std::vector<std::vector<std::string>> rows;
    std::size_t done = 0;              ///< tasks that are in it
    std::vector<std::string> remarks;  ///< what is not in it
};

/// The rows of all tasks that are done, in the order of tasks.csv; the same bytes however the runs went.
/// @throws InputError  no series has the column of `at`, or a series is damaged   @throws IoError
Collected collect(const SweepFolder& folder, const CollectOptions& options);

}  // namespace lamella::sweep
