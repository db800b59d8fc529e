#include "lamella/core/error.h"

#include <cstdlib>

#include <fmt/format.h>

namespace lamella {

std::string to_string(const SourceLocation& where) {
    if (where.file.empty()) return {};
    return where.line > 0 ? fmt::format("{}:{}", where.file, where.line) : where.file;
}

InputError::InputError(const SourceLocation& where, const std::string& message)
    : std::runtime_error(where.file.empty() ? message : to_string(where) + ": " + message) {}

void detail::assertion_failed(const char* expression, const char* file, int line) {
    fmt::print(stderr, "{}:{}: assertion failed: {}\n", file, line, expression);
    std::abort();
}

}  // namespace lamella
