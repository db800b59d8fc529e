#pragma once

#include <string>
#include <vector>

namespace lamella {

/// What this library was built from and how: for `lamella version` and the provenance of a run.
struct BuildInfo {
    std::string version;                 ///< "0.1.0"
    std::string commit;                  ///< 12 hex digits, with "+changes" if files differed from it; or "unknown"
    std::string compiler;                ///< "GNU 12.2.0"
    std::string system;                  ///< "Linux x86_64"
    std::string flags;                   ///< compiler flags without the warnings
    std::string build_type;              ///< "Release"
    std::vector<std::string> libraries;  ///< "HDF5 1.10.8", ...: what was found when this was configured
    std::vector<std::string> parts;      ///< optional parts that are in
};

BuildInfo build_info();

}  // namespace lamella
