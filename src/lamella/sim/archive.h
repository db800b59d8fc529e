#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::sim {

/// A stretch of a column that several processes hold together, ranks in order.
struct Part {
    std::int64_t first = 0;
    std::int64_t total = 0;
};

/// Where a solver saves its complete state. Names are unique within one state; groups are written "foam/position".
class StateWriter {
public:
    virtual ~StateWriter() = default;
    virtual void write(std::string_view name, std::span<const double> values) = 0;
    virtual void write(std::string_view name, std::span<const std::int64_t> values) = 0;
    virtual void write(std::string_view name, std::span<const std::int32_t> values) = 0;

    /// Writes a column of which each process holds a part; collective. One process holds all of it.
    virtual void write_part(std::string_view name, std::span<const double> values, Part) { write(name, values); }
    virtual void write_part(std::string_view name, std::span<const std::int64_t> values, Part) { write(name, values); }
    virtual void write_part(std::string_view name, std::span<const std::int32_t> values, Part) { write(name, values); }

    void write_value(std::string_view name, double value) { write(name, std::span<const double>(&value, 1)); }
    void write_value(std::string_view name, std::int64_t value) {
        write(name, std::span<const std::int64_t>(&value, 1));
    }
};

/// Where a solver finds it again. Every read says how many values it expects, so that a damaged or hostile file is
/// refused before memory is taken.
class StateReader {
public:
    virtual ~StateReader() = default;
    /// @throws InputError  the entry is missing, has another type, or another number of values
    virtual void read(std::string_view name, std::size_t count, std::vector<double>& values) = 0;
    virtual void read(std::string_view name, std::size_t count, std::vector<std::int64_t>& values) = 0;
    virtual void read(std::string_view name, std::size_t count, std::vector<std::int32_t>& values) = 0;

    /// Reads this process's share of a column of `total` values (dist::share_of); collective. One process gets all.
    virtual void read_part(std::string_view name, std::size_t total, std::vector<double>& v) { read(name, total, v); }
    virtual void read_part(std::string_view name, std::size_t total, std::vector<std::int64_t>& v) {
        read(name, total, v);
    }
    virtual void read_part(std::string_view name, std::size_t total, std::vector<std::int32_t>& v) {
        read(name, total, v);
    }

    double read_double(std::string_view name) {
        std::vector<double> value;
        read(name, 1, value);
        return value[0];
    }
    std::int64_t read_integer(std::string_view name) {
        std::vector<std::int64_t> value;
        read(name, 1, value);
        return value[0];
    }
};

}  // namespace lamella::sim
