#pragma once

#include "lamella/core/log.h"

#include <filesystem>
#include <memory>
#include <string_view>

namespace lamella::run {

/// RUN/log.txt: one line per message with date, time and level. Appends.
///
/// A log that cannot be written any more (disk full) is no reason to end a run: what matters goes to files that are
/// checked, so later messages are dropped in silence.
class LogFile {
public:
    /// @throws IoError  the file cannot be opened
    explicit LogFile(const std::filesystem::path& path);
    ~LogFile();

    void write(LogLevel level, std::string_view message);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lamella::run
