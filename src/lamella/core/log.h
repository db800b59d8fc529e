#pragma once

#include <functional>
#include <string_view>

namespace lamella {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// Where the library's messages go. The library never prints; the caller hands in a sink (or an empty one).
using LogSink = std::function<void(LogLevel, std::string_view message)>;

}  // namespace lamella
