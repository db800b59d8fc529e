#pragma once

#include <stdexcept>
#include <string>

namespace lamella {

/// Where a value stands in a file that the user wrote. `line` and `column` count from 1; 0 means unknown.
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

/// "foam.toml:12", "foam.toml", or "" when nothing is known.
std::string to_string(const SourceLocation& where);

/// Something that the user gave is wrong: a scene, an argument, the contents of a file. Exit code 2.
/// The message is one line: where, what was found, and what would do.
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& message) : std::runtime_error(message) {}
    InputError(const SourceLocation& where, const std::string& message);
};

/// A run failed numerically: no convergence, a value that is not finite, a step that underflows. Exit code 3.
/// The solver that throws it still holds the state of its last completed step.
class NumericalError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A file or device could not be read or written (missing, full, no permission). Exit code 4.
class IoError : public std::runtime_error {
public:
    explicit IoError(const std::string& message) : std::runtime_error(message) {}
};

/// The user asked to stop in the middle of work that cannot be resumed half-way.
class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted") {}
};

namespace detail {
[[noreturn]] void assertion_failed(const char* expression, const char* file, int line);
}

}  // namespace lamella

/// An invariant that only a bug of ours can break; checked in debug builds and tests, never reached by user input.
#ifdef NDEBUG
#define LAMELLA_ASSERT(condition) static_cast<void>(0)
#else
#define LAMELLA_ASSERT(condition) \
    ((condition) ? static_cast<void>(0) : ::lamella::detail::assertion_failed(#condition, __FILE__, __LINE__))
#endif
